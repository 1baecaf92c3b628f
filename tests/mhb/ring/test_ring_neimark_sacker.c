/* The travelling wave of a ring of six blades followed through its Neimark-Sacker point by time
 * integration. The wave is unstable to side waves whose nodal diameters add up to twice its own. */
#include "mesh/base/constants.h"
#include "mhb/ring/ring_output.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { BLADES = 6, HARMONICS = 15, SUBSTEPS = 256, STEPS = 256, BEFORE = 20000, AFTER = 1000 };

static const double LOW = 0.88, HIGH = 0.92; /* rad/s: the wave is unstable, stable there */

static mhb_settings ring_settings(void) {
  mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.1, HARMONICS);
  s.to_ground    = false;
  s.blades       = BLADES;
  s.engine_order = 1;
  return s;
}

static double largest_multiplier(const modal_model *model, const mhb_settings *s, double omega) {
  periodic       p;
  double complex multiplier[400];
  periodic_create(model, s, omega, NULL, &p);
  mhb_multipliers found = periodic_multipliers(&p, SUBSTEPS, multiplier);
  assert_true(cimag(multiplier[0]) != 0); /* a pair, so no fold */
  periodic_destroy(&p);
  return found.largest;
}

/* Where the largest multipliers of the wave have modulus 1. */
static double neimark_sacker_point(const modal_model *model, const mhb_settings *s) {
  double low = LOW, high = HIGH;
  for (int i = 0; i < 18; i++) {
    double middle = 0.5 * (low + high);
    if (largest_multiplier(model, s, middle) > 1)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

/* Mean square of the part of each nodal diameter in the last period's first harmonics. */
static void add_waves(const mhb_ring_output *out, double square[BLADES], double complex *wave) {
  for (int n = 0; n < BLADES; n++) {
    double complex part = 0;
    for (int b = 0; b < BLADES; b++)
      part += out->first[b] * cexp(I * SHB_TWO_PI * n * b / BLADES) / BLADES;
    square[n] += (creal(part) * creal(part) + cimag(part) * cimag(part)) / AFTER;
    if (n == 1) *wave += part / AFTER;
  }
}

/* Root mean square of all side waves over the wave, once the ring has settled. */
static double side_waves(const modal_model *model, const mhb_settings *s, double omega,
                         double square[BLADES]) {
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  mhb_noise       noise   = {7};
  double complex  none[3] = {0}, wave = 0;
  double          sum = 0;
  memset(square, 0, sizeof *square * BLADES);
  assert_ok(mhb_ring_model_create(model, s, s->n0[0], omega, &m));
  mhb_ring_model_set(m, omega, STEPS);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  mhb_ring_start(&ring, 0, none);
  mhb_ring_disturb(&ring, &out, 1e-3, &noise);
  for (int i = 0; i < BEFORE; i++) mhb_ring_period(&ring);
  for (int i = 0; i < AFTER; i++) {
    mhb_ring_period(&ring);
    mhb_ring_first_harmonics(&ring, &out);
    add_waves(&out, square, &wave);
  }
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  for (int n = 0; n < BLADES; n++) sum += n == 1 ? 0 : square[n];
  return sqrt(sum) / cabs(wave);
}

static void side_waves_grow_with_the_root(void **state) {
  (void)state;
  static const double distance[] = {0.0005, 0.001, 0.002};
  modal_model         model;
  double              size[3], square[BLADES];
  mhb_settings        s = ring_settings();
  random_model(1, WITH_LEFT, 2, &model);
  for (int i = 0; i < model.n_modes; i++) model.damping_ratio[i] = 0.003;
  double point = neimark_sacker_point(&model, &s);
  double above = side_waves(&model, &s, point + 0.002, square);
  for (int i = 0; i < 3; i++) size[i] = side_waves(&model, &s, point - distance[i], square);
  double exponent = log(size[2] / size[0]) / log(distance[2] / distance[0]);
  double slope    = (pow(size[1], 2) - pow(size[0], 2)) / (distance[1] - distance[0]);
  double zero     = distance[0] - pow(size[0], 2) / slope;
  print_message("point %.7f rad/s, side waves %.1e above it, %.4f, %.4f, %.4f below\n", point,
                above, size[0], size[1], size[2]);
  print_message("exponent %.3f, the squares vanish %.0e rad/s from the point\n", exponent, zero);
  for (int n = 0; n < BLADES; n++) print_message("nodal diameter %d: %.2e\n", n, sqrt(square[n]));
  assert_below(above, 1e-3); /* of a disturbance that still decays */
  assert_below(fabs(exponent - 0.5), 0.02);
  assert_below(fabs(zero), 1e-4);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(side_waves_grow_with_the_root)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
