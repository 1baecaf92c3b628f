/* A mode at 0 Hz: a body that only its contact holds. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/ring/ring_step.h"
#include "mhb/structure/stiffness_check.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 7 };

/* A mass of 1 kg, free along one axis (0 v, 1 u), or on a spring of hz. */
static mhb_response *curve_of(int axis, double hz, mhb_settings s) {
  modal_model   model;
  mhb_response *response;
  one_degree_model(0, axis, 0.1, &model);
  model.frequency[0] = hz;
  s.frequency[0]     = 0.8 / SHB_TWO_PI;
  s.frequency[1]     = 2.2 / SHB_TWO_PI;
  s.harmonics        = H;
  assert_ok(main_curve(&model, &s, H, NULL, &response));
  modal_model_free(&model);
  return response;
}

static double first(const mhb_branch *b, int point, int axis) {
  return cabs(b->motion[((size_t)point * 3 + (size_t)axis) * (H + 1) + 1]);
}

/* Pressed on throughout: F/(kv - w^2). */
static void a_body_on_its_contact_stiffness(void **state) {
  (void)state;
  double        worst    = 0;
  mhb_response *response = curve_of(0, 0, ground_settings(0.3, 9, 1, 5, H));
  mhb_branch   *b        = &response->branch[0];
  assert_true(b->n_points > 2);
  for (int i = 0; i < b->n_points; i++) {
    const double w = SHB_TWO_PI * b->frequency[i];
    worst          = fmax(worst, fabs(first(b, i, 0) * (9 - w * w) / 0.1 - 1));
  }
  print_message("largest error %.1e\n", worst);
  assert_below(worst, 1e-9);
  mhb_response_destroy(response);
}

/* It slips about its resonance; a spring of 1e-4 of the range's frequency makes no difference. */
static void a_body_that_slips(void **state) {
  (void)state;
  const mhb_settings s     = ground_settings(0.3, 1, 2, 0.2, H);
  mhb_response      *free_ = curve_of(1, 0, s), *held = curve_of(1, 1e-4 / SHB_TWO_PI, s);
  double             top[2] = {0, 0};
  mhb_response      *both[] = {free_, held};
  for (int k = 0; k < 2; k++) {
    mhb_branch *b = &both[k]->branch[0];
    assert_true(b->complete);
    for (int i = 0; i < b->n_points; i++) top[k] = fmax(top[k], first(b, i, 1));
  }
  print_message("peaks %.9f and %.9f\n", top[0], top[1]);
  assert_true(top[0] > 0.15 && fabs(top[0] / top[1] - 1) < 1e-7);
  mhb_response_destroy(free_);
  mhb_response_destroy(held);
}

/* m w^2 of the body counts. */
static void its_inertia_limits_the_contact_stiffness(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(0, 0, 0.1, &model);
  model.frequency[0] = 0;
  for (int over = 0; over < 2; over++) {
    mhb_settings    s = ground_settings(0.3, 1, 1, 1, H);
    mhb_receptance *receptance;
    s.frequency[0] = s.frequency[1] = 2 / SHB_TWO_PI;
    s.kv                            = (over ? 1.001 : 0.999) * 4 * MHB_STIFFNESS_LIMIT;
    assert_ok(mhb_receptance_create(&model, &s, H, &receptance));
    assert_int_equal(mhb_stiffness_check(receptance, &s), over ? SHB_ERR_INPUT : SHB_OK);
    mhb_receptance_destroy(receptance);
  }
  modal_model_free(&model);
}

/* ---- blades of a ring, of which one mode is at 0 Hz ---- */

/* The first mode at 0 Hz, or at 1e-5 of the excitation. */
static void blade_of(double hz, modal_model *model) {
  random_model(1, WITH_LEFT, 3, model);
  for (int i = 0; i < model->n_modes; i++) model->damping_ratio[i] = 0.01;
  model->frequency[0] = hz;
}

static const double NEARLY[] = {0, 1e-5 / SHB_TWO_PI};

enum { N = 4 };
static const double DEVIATION[N] = {0.02, -0.01, 0.015, -0.03};

/* The main curve with its stability, of a wave or of blades that differ. */
static mhb_response *judged_curve(double hz, bool mistuned) {
  modal_model        blade;
  mhb_mistuned_ring *ring     = NULL;
  mhb_response      *response = NULL;
  mhb_settings       s        = random_settings(3);
  blade_of(hz, &blade);
  s.blades       = N;
  s.stability    = MHB_STABILITY_ALWAYS;
  s.n0[0]        = 0.3;
  s.frequency[0] = 1.2 / SHB_TWO_PI;
  s.frequency[1] = 1.4 / SHB_TWO_PI;
  if (mistuned) assert_ok(mhb_mistuned_ring_create(&blade, &s, DEVIATION, 1, &ring));
  s.ring = ring;
  assert_ok(main_curve(mistuned ? &ring->whole : &blade, &s, 3, NULL, &response));
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
  return response;
}

/* The same points with the same verdicts. */
static void its_curves_are_judged(void **state) {
  (void)state;
  for (int mistuned = 0; mistuned < 2; mistuned++) {
    mhb_response     *r[2] = {judged_curve(NEARLY[0], mistuned), judged_curve(NEARLY[1], mistuned)};
    const mhb_branch *a = &r[0]->branch[0], *b = &r[1]->branch[0];
    const int         K      = a->n_harmonics + 1;
    double            away   = 0;
    int               judged = 0;
    assert_true(a->complete && a->n_points > 3);
    assert_int_equal(a->n_points, b->n_points);
    for (int i = 0; i < a->n_points; i++) {
      const double complex x =
          a->motion[((size_t)i * (size_t)(3 * r[0]->n_pairs) + 1) * (size_t)K + 1];
      const double complex y =
          b->motion[((size_t)i * (size_t)(3 * r[0]->n_pairs) + 1) * (size_t)K + 1];
      away = fmax(away, cabs(x - y) / cabs(y));
      assert_int_equal(a->stable[i], b->stable[i]);
      judged += a->stable[i] >= 0;
    }
    print_message("%s: %d points, %d judged, apart %.1e\n", mistuned ? "different blades" : "wave",
                  a->n_points, judged, away);
    assert_int_equal(judged, a->n_points);
    assert_below(away, 1e-6);
    mhb_response_destroy(r[0]);
    mhb_response_destroy(r[1]);
  }
}

/* Positions of the ring after some periods from rest in the fast integrator: finite, and those of a
 * body that is hardly held. */
static void it_is_integrated_by_the_fast_ring(void **state) {
  (void)state;
  enum { PERIODS = 10, MOST = 400 };
  double q[2][MOST], v[MOST], away = 0, size = 0;
  int    n = 0;
  for (int i = 0; i < 2; i++) {
    modal_model     model;
    mhb_settings    s = random_settings(3);
    mhb_ring_model *m;
    mhb_ring        ring;
    double complex  none[3] = {0};
    blade_of(NEARLY[i], &model);
    s.blades       = N;
    s.frequency[0] = s.frequency[1] = 1.3 / SHB_TWO_PI;
    assert_ok(mhb_ring_model_create(&model, &s, 0.3, 1.3, &m));
    mhb_ring_model_set(m, 1.3, 256);
    mhb_ring_create(m, &ring);
    n = m->modes * m->lanes;
    assert_true(n <= MOST);
    mhb_ring_start(&ring, 0, none);
    for (int k = 0; k < PERIODS; k++) mhb_ring_period(&ring);
    memset(q[i], 0, sizeof q[i]);
    mhb_ring_get(&ring, q[i], v);
    mhb_ring_destroy(&ring);
    mhb_ring_model_destroy(m);
    modal_model_free(&model);
  }
  for (int k = 0; k < n; k++) {
    assert_true(isfinite(q[0][k]));
    away = fmax(away, fabs(q[0][k] - q[1][k]));
    size = fmax(size, fabs(q[1][k]));
  }
  print_message("fast ring: apart %.1e\n", away / size);
  assert_true(size > 0);
  assert_below(away / size, 1e-5);
}

/* Time integration of the wave, from rest. */
static void it_is_integrated(void **state) {
  (void)state;
  enum { PERIODS = 10 };
  double end[2][200];
  int    n = 0;
  for (int i = 0; i < 2; i++) {
    modal_model     model;
    mhb_settings    s = random_settings(3);
    mhb_integrator *g;
    blade_of(NEARLY[i], &model);
    s.blades       = N;
    s.frequency[0] = s.frequency[1] = 1.3 / SHB_TWO_PI;
    assert_ok(mhb_integrator_create(&model, &s, 3, &g));
    mhb_integrator_set(g, 1.3, 0.3, 48);
    mhb_integrator_rest(g);
    for (int k = 0; k < PERIODS; k++) assert_true(mhb_integrator_period(g));
    n = 2 * g->blades * g->modes;
    assert_true(n <= 200);
    memcpy(end[i], g->z, sizeof(double) * (size_t)n);
    mhb_integrator_destroy(g);
    modal_model_free(&model);
  }
  double away = 0, size = 0;
  for (int k = 0; k < n; k++) {
    assert_true(isfinite(end[0][k]));
    away = fmax(away, fabs(end[0][k] - end[1][k]));
    size = fmax(size, fabs(end[1][k]));
  }
  print_message("integration: apart %.1e\n", away / size);
  assert_true(size > 0);
  assert_below(away / size, 1e-5);
}

/* Two roots at 0 have one shape: Coriolis terms are refused in one line. */
static void with_coriolis_terms_it_is_refused(void **state) {
  (void)state;
  modal_model     model;
  mhb_settings    s = random_settings(3);
  mhb_receptance *receptance;
  blade_of(0, &model);
  const size_t m = (size_t)model.n_modes;
  model.coriolis = calloc(m * m, sizeof(double));
  assert_non_null(model.coriolis);
  model.coriolis[1] = 0.1;
  model.coriolis[m] = -0.1;
  s.blades          = N;
  s.frequency[0]    = 1.2 / SHB_TWO_PI;
  s.frequency[1]    = 1.4 / SHB_TWO_PI;
  assert_refused(mhb_receptance_create(&model, &s, 3, &receptance), SHB_ERR_INPUT, "at 0 Hz");
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(its_curves_are_judged),
                                     cmocka_unit_test(it_is_integrated_by_the_fast_ring),
                                     cmocka_unit_test(it_is_integrated),
                                     cmocka_unit_test(with_coriolis_terms_it_is_refused),
                                     cmocka_unit_test(a_body_on_its_contact_stiffness),
                                     cmocka_unit_test(a_body_that_slips),
                                     cmocka_unit_test(its_inertia_limits_the_contact_stiffness)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
