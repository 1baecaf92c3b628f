/* A motion followed through its Neimark-Sacker point by time integration. The blade has three
 * degrees of freedom and rubs on the ground. Its multipliers and the integrator share no code. */
#include "mesh/base/constants.h"
#include "mhb/ring/ring_output.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { STEPS = 256, BEFORE = 15000, AFTER = 1000 };

/* The Neimark-Sacker point by multipliers, rad/s: unstable below, down to 1.2006. */
static const double POINT = 1.256349;

/* Root mean square of the first harmonic about its mean, relative, once the motion has settled. */
static double modulation(const modal_model *model, const mhb_settings *s, double omega) {
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  double complex  none[3] = {0}, mean = 0;
  double          square = 0;
  assert_ok(mhb_ring_model_create(model, s, s->n0[0], omega, &m));
  mhb_ring_model_set(m, omega, STEPS);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  mhb_ring_start(&ring, 0, none);
  for (int i = 0; i < BEFORE; i++) mhb_ring_period(&ring);
  for (int i = 0; i < AFTER; i++) {
    mhb_ring_period(&ring);
    mhb_ring_first_harmonics(&ring, &out);
    double complex a = out.first[0];
    mean += a / AFTER;
    square += (creal(a) * creal(a) + cimag(a) * cimag(a)) / AFTER;
  }
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  double size = cabs(mean);
  return sqrt(fmax(0, square - size * size)) / size;
}

/* Beyond the point the amplitude of the modulation grows with the root of the distance. The line
 * through its squares meets zero where the multipliers have modulus 1. */
static void modulation_grows_with_the_root(void **state) {
  (void)state;
  static const double distance[] = {0.001, 0.002};
  modal_model         model;
  double              size[2];
  mhb_settings        s = ground_settings(0.4, 0.8, 0.5, 0.1, 15);
  three_degree_model(&model);
  assert_below(modulation(&model, &s, POINT + 0.002), 1e-6);
  for (int i = 0; i < 2; i++) size[i] = modulation(&model, &s, POINT - distance[i]);
  double exponent = log2(size[1] / size[0]), slope = (pow(size[1], 2) - pow(size[0], 2)) / 0.001;
  double zero = distance[0] - pow(size[0], 2) / slope;
  print_message("modulated by %.4f and %.4f: exponent %.3f, vanishes %.0e rad/s from the point\n",
                size[0], size[1], exponent, zero);
  assert_below(fabs(exponent - 0.5), 0.02);
  assert_below(fabs(zero), 1e-4);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modulation_grows_with_the_root),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
