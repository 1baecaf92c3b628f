/* Side waves of made-up signals: diameters, offsets, amplitudes, the rule of pairs. */
#include "mesh/base/constants.h"
#include "mhb/ring/noise.h"
#include "mhb/ring/side_waves.h"
#include "tests/support/check.h"

enum { PERIODS = 64, S = MHB_SIDE_SAMPLES };

typedef struct {
  int    diameter;
  double offset, size, phase;
} line;

/* Sum of a wave of amplitude 1, a second harmonic, lines and noise. */
static double *signal_of(int blades, int engine_order, int n, const line *lines, double noise) {
  double   *x       = calloc((size_t)(PERIODS * S * 3 * blades), sizeof *x);
  mhb_noise dice    = {.state = 3};
  double    axis[3] = {.6, -.64, .48}; /* of unit length */
  assert_non_null(x);
  for (int i = 0; i < PERIODS * S; i++)
    for (int c = 0; c < 3; c++)
      for (int b = 0; b < blades; b++) {
        double t = SHB_TWO_PI * i / S, lag = SHB_TWO_PI * b / blades, sum;
        sum = cos(t - engine_order * lag) + .1 * cos(2 * (t - engine_order * lag)) + .3;
        for (int k = 0; k < n; k++)
          sum += lines[k].size *
                 cos((1 + lines[k].offset) * t - lines[k].diameter * lag + lines[k].phase);
        x[(i * 3 + c) * blades + b] = axis[c] * sum + noise * mhb_noise_normal(&dice);
      }
  return x;
}

static void a_pair_is_found(void **state) {
  (void)state;
  const int      N = 40, E = 5;
  const line     pair[2] = {{34, -.0413, .21, .8}, {16, .0413, .17, 2}};
  double        *x       = signal_of(N, E, 2, pair, 1e-3);
  mhb_side_waves found;
  mhb_side_waves_find(x, PERIODS, N, E, &found);
  for (int i = 0; i < 2; i++) {
    print_message("line %d: diameter %d, offset %+.5f, size %.4f\n", i, found.wave[i].diameter,
                  found.wave[i].offset, found.wave[i].size);
    assert_int_equal(found.wave[i].diameter, pair[i].diameter);
    assert_near(found.wave[i].offset, pair[i].offset, 5e-4);
    assert_within(found.wave[i].size, pair[i].size, .01);
  }
  assert_int_equal((found.wave[0].diameter + found.wave[1].diameter) % N, 2 * E);
  assert_true(found.share > .95);
  free(x);
}

/* A blade on the ground: one diameter, two frequencies. */
static void one_blade_has_lines_too(void **state) {
  (void)state;
  const line     lines[2] = {{0, .3303, .2, 0}, {0, -.3303, .1, 1}};
  double        *x        = signal_of(1, 0, 2, lines, 1e-4);
  mhb_side_waves found;
  mhb_side_waves_find(x, PERIODS, 1, 0, &found);
  assert_int_equal(found.wave[0].diameter, 0);
  assert_near(found.wave[0].offset, .3303, 1e-3);
  assert_near(found.wave[1].offset, -.3303, 1e-3);
  free(x);
}

static void noise_has_no_lines(void **state) {
  (void)state;
  double        *x = signal_of(24, 3, 0, NULL, .2);
  mhb_side_waves found;
  mhb_side_waves_find(x, PERIODS, 24, 3, &found);
  print_message("share of five lines in noise: %.3f\n", found.share);
  assert_below(found.share, .2);
  free(x);
}

static void a_pure_wave_has_no_side_waves(void **state) {
  (void)state;
  double        *x = signal_of(24, 3, 0, NULL, 0);
  mhb_side_waves found;
  mhb_side_waves_find(x, PERIODS, 24, 3, &found);
  assert_int_equal(found.wave[0].diameter, -1);
  free(x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pair_is_found),
      cmocka_unit_test(one_blade_has_lines_too),
      cmocka_unit_test(noise_has_no_lines),
      cmocka_unit_test(a_pure_wave_has_no_side_waves),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
