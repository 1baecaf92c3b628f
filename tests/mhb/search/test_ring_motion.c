/* How a motion is spread over a ring: closed forms of open blades, and of few waves. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/search/ring_motion.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { N = 8, E = 3 };

static const double ZETA = 0.013, FORCE = 0.37, OMEGA = 1.07;

/* Energies of open blades of one degree of freedom at OMEGA; wide gaps. */
static void open_ring(const double *deviation, double *energy, double *wave, double *standing) {
  modal_model        blade;
  mhb_settings       s = ground_settings(0, 1, 1, -1e6, 2);
  mhb_mistuned_ring *ring;
  mhb_balance       *b;
  one_degree_model(ZETA, 0, FORCE, &blade);
  blade.left     = calloc(3, sizeof(double));
  blade.left[0]  = 1;
  blade.has_left = true;
  s.to_ground    = false;
  s.blades       = N;
  s.engine_order = E;
  assert_ok(mhb_mistuned_ring_create(&blade, &s, deviation, 1, &ring));
  s.ring = ring;
  assert_ok(mhb_balance_create(&ring->whole, &s, &b));
  mhb_balance_set_preload(b, s.n0[0]);
  double x[b->n], r[b->n];
  assert_ok(mhb_balance_linear_limit(b, OMEGA, 0, x));
  mhb_balance_linearise(b, x, OMEGA, r, NULL);
  mhb_ring_motion_energies(b, energy, wave, standing);
  mhb_balance_destroy(b);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

static double complex amplitude(double deviation) {
  const double w = 1 + deviation;
  return FORCE / (w * w - OMEGA * OMEGA + 2 * I * ZETA * w * OMEGA);
}

static void equal_blades_are_the_wave(void **state) {
  static const double none[N] = {0};
  double              energy[N], wave[N], standing;
  (void)state;
  open_ring(none, energy, wave, &standing);
  const double e = 0.25 * pow(OMEGA * cabs(amplitude(0)), 2);
  for (int b = 0; b < N; b++) assert_near(energy[b], e, 1e-12 * e);
  assert_near(wave[0], 1, 1e-12);
  assert_below(standing, 1e-12);
  assert_near(mhb_ring_participation(N, energy), 1, 1e-12);
  assert_int_equal(mhb_ring_kind_of(1, wave[0], standing), MHB_RING_WAVE);
}

/* Blade b moves with a_b exp(-2 pi i E b/N): the waves are the discrete transform of a. */
static void different_blades_are_several_waves(void **state) {
  static const double deviation[N] = {0.11, -0.07, 0.03, 0.2, -0.02, 0.05, 0.071, -0.13};
  double              energy[N], wave[N], standing, total = 0, sum = 0, squares = 0, meet = 0;
  double complex      a[N];
  double              by_hand[N];
  (void)state;
  open_ring(deviation, energy, wave, &standing);
  for (int b = 0; b < N; b++) {
    a[b] = amplitude(deviation[b]);
    assert_near(energy[b], 0.25 * pow(OMEGA * cabs(a[b]), 2), 1e-12 * energy[b]);
    total += pow(cabs(a[b]), 2);
    sum += energy[b];
    squares += energy[b] * energy[b];
  }
  for (int j = 0; j < N; j++) {
    double complex A = 0;
    for (int b = 0; b < N; b++) A += a[b] * cexp(2 * I * SHB_PI * j * b / N) / N;
    by_hand[j] = N * pow(cabs(A), 2) / total;
    assert_near(wave[j], by_hand[j], 1e-12);
  }
  for (int d = 0; d < N; d++) /* d = E + j meets N - d */
    if (2 * d % N) meet += fmin(by_hand[(d - E + N) % N], by_hand[(2 * N - d - E) % N]);
  assert_near(standing, meet, 1e-12);
  assert_near(mhb_ring_participation(N, energy), sum * sum / (N * squares), 1e-12);
  assert_true(wave[0] < 0.9 && standing > 0.01);
}

/* One of n blades: 1/n. Two waves of amplitudes a and b, j diameters apart: their energies beat. */
static void few_waves_are_not_localised(void **state) {
  enum { BLADES = 24 };
  double energy[BLADES] = {0}, least = 1;
  (void)state;
  assert_near(mhb_ring_participation(BLADES, energy), 0, 0);
  energy[7] = 0.31;
  assert_near(mhb_ring_participation(BLADES, energy), 1. / BLADES, 1e-15);
  assert_int_equal(mhb_ring_kind_of(1. / BLADES, 0.5, 0), MHB_RING_LOCALISED);
  for (int j = 1; j < BLADES; j++)
    for (int share = 0; share <= 10; share++) {
      const double a = 1, b = 0.1 * share;
      for (int i = 0; i < BLADES; i++)
        energy[i] = pow(cabs(a + b * cexp(2 * I * SHB_PI * j * i / BLADES)), 2);
      const double part = mhb_ring_participation(BLADES, energy);
      const double beat = (2 * j == BLADES ? 4 : 2) * a * a * b * b;
      assert_near(part, pow(a * a + b * b, 2) / (pow(a * a + b * b, 2) + beat), 1e-12);
      least = fmin(least, part);
    }
  assert_near(least, 0.5, 1e-12);
  assert_int_equal(mhb_ring_kind_of(0.67, 0.5, 0.95), MHB_RING_STANDING);
  assert_int_equal(mhb_ring_kind_of(0.67, 0.5, 0.5), MHB_RING_WAVES);
  assert_int_equal(mhb_ring_kind_of(0, 0, 0), MHB_RING_UNKNOWN);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(equal_blades_are_the_wave),
                                     cmocka_unit_test(different_blades_are_several_waves),
                                     cmocka_unit_test(few_waves_are_not_localised)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
