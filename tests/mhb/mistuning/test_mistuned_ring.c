/* A ring of different blades: order of blades, load that lags, what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/mistuning/dense_ring.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = 4, MODES = 6 };

static void check_mode(const modal_model *blade, const modal_model *w, int b, int i, double delta,
                       int engine_order) {
  assert_near(w->frequency[b * MODES + i], (1 + delta) * blade->frequency[i], 1e-15);
  for (int k = 0; k <= blade->n_load; k++) {
    const double         lag    = SHB_TWO_PI * engine_order / N * k * b;
    const double complex wanted = blade->modal_force[k * MODES + i] * cexp(-I * lag);
    assert_small(cabs(w->modal_force[(k * N + b) * MODES + i] - wanted), 1e-14);
  }
}

static void check_blade(const modal_model *blade, const modal_model *w, int b, double delta,
                        int engine_order) {
  char last[8];
  snprintf(last, sizeof last, ".%d", b);
  assert_has(w->probe_name[b * blade->n_probes], last);
  for (int i = 0; i < MODES; i++) check_mode(blade, w, b, i, delta, engine_order);
  assert_near(w->area[2 * b + 1], blade->area[1], 0);
}

static void blade_0_comes_first(void **state) {
  const double       delta[N] = {0.02, -0.1, 0, 0.3};
  modal_model        blade;
  mhb_settings       s = random_settings(3);
  mhb_mistuned_ring *ring;
  (void)state;
  s.blades       = N;
  s.engine_order = 3;
  random_model(2, WITH_LEFT | WITH_AREAS, 3, &blade);
  assert_ok(mhb_mistuned_ring_create(&blade, &s, delta, 1, &ring));
  assert_int_equal(ring->whole.n_pairs, 2 * N);
  assert_int_equal(ring->whole.n_modes, MODES * N);
  for (int b = 0; b < N; b++) check_blade(&blade, &ring->whole, b, delta[b], s.engine_order);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

static void what_cannot_be_is_refused(void **state) {
  const double       zero[N] = {0}, half[N] = {0, 0, -0.5, 0};
  modal_model        blade, alone;
  mhb_settings       s = random_settings(3);
  mhb_mistuned_ring *ring;
  (void)state;
  s.blades = N;
  random_model(1, WITH_LEFT, 3, &blade);
  random_model(1, 0, 3, &alone);
  assert_refused(mhb_mistuned_ring_create(&blade, &s, half, 1, &ring), SHB_ERR_INPUT,
                 "the deviation of blade 2 is -0.5");
  assert_refused(mhb_mistuned_ring_create(&alone, &s, zero, 1, &ring), SHB_ERR_INPUT,
                 "no /contact/left");
  blade.coriolis = calloc((size_t)(blade.n_modes * blade.n_modes), sizeof *blade.coriolis);
  assert_refused(mhb_mistuned_ring_create(&blade, &s, zero, 1, &ring), SHB_ERR_INPUT,
                 "rotor.mistuning does not go with Coriolis terms (/modes/coriolis of the modal "
                 "file); give rotor.coriolis: no");
  free(blade.coriolis);
  blade.coriolis = NULL;
  s.to_ground    = true;
  assert_refused(mhb_mistuned_ring_create(&blade, &s, zero, 1, &ring), SHB_ERR_INPUT,
                 "contact.to is ground");
  modal_model_free(&blade);
  modal_model_free(&alone);
}

/* Number of modes of a blade that a mode of the dense model is. Its shape is then checked. */
static int found_on(const modal_model *dense, int i, const modal_model *blade, int b,
                    const double *delta) {
  const size_t all = N * MODES, before = (size_t)((b + N - 1) % N);
  int          found = 0;
  for (size_t j = 0; j < MODES; j++) {
    const double f = (1 + delta[j]) * blade->frequency[j];
    if (dense->frequency[i] != f || dense->right[3 * (size_t)b * all + (size_t)i] == 0) continue;
    found++;
    assert_near(dense->right[(3 * (size_t)b + 1) * all + (size_t)i], blade->right[MODES + j], 0);
    assert_near(dense->left[(3 * before + 2) * all + (size_t)i], blade->left[2 * MODES + j], 0);
  }
  return found;
}

/* Each deviation by mode goes to its mode, and the frequencies of the dense model ascend with
 * their shapes. */
static void modes_deviate_one_by_one(void **state) {
  double             delta[N][MODES];
  modal_model        blade, dense;
  mhb_settings       s = random_settings(3);
  mhb_mistuned_ring *ring;
  int                found = 0;
  (void)state;
  s.blades = N;
  for (int i = 0; i < N * MODES; i++) delta[i / MODES][i % MODES] = 0.001 * (i * 7 % 11);
  random_model(1, WITH_LEFT, 3, &blade);
  assert_ok(mhb_mistuned_ring_create(&blade, &s, &delta[0][0], MODES, &ring));
  mhb_dense_ring(ring, &dense);
  for (int i = 0; i < N * MODES; i++) {
    if (i > 0) assert_true(dense.frequency[i] >= dense.frequency[i - 1]);
    for (int b = 0; b < N; b++) found += found_on(&dense, i, &blade, b, delta[b]);
  }
  assert_int_equal(found, N * MODES);
  modal_model_free(&dense);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(blade_0_comes_first),
                                     cmocka_unit_test(what_cannot_be_is_refused),
                                     cmocka_unit_test(modes_deviate_one_by_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
