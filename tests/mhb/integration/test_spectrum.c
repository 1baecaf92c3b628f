/* Lines of sampled signals with known frequencies and amplitudes. */
#include "mesh/base/constants.h"
#include "mhb/integration/spectrum.h"
#include "tests/support/check.h"

enum { N = 3072 };

static const double DURATION = 7.3;

static void add_tone(double hz, double amplitude, double *x) {
  for (int i = 0; i < N; i++) x[i] += amplitude * cos(2 * SHB_PI * hz * DURATION * i / N + 0.4);
}

/* Tones on bins: exact. A constant is no line. */
static void tones_on_bins(void **state) {
  (void)state;
  double x[N], hz[MHB_SPECTRUM_LINES], amplitude[MHB_SPECTRUM_LINES];
  for (int i = 0; i < N; i++) x[i] = 5;
  add_tone(40 / DURATION, 0.3, x);
  add_tone(101 / DURATION, 1.7, x);
  add_tone(210 / DURATION, 0.9, x); /* above the highest bin */
  mhb_spectrum_lines(N, x, DURATION, 200, hz, amplitude);
  assert_near(hz[0], 101 / DURATION, 1e-9);
  assert_near(amplitude[0], 1.7, 1e-12);
  assert_near(hz[1], 40 / DURATION, 1e-9);
  assert_near(amplitude[1], 0.3, 1e-12);
  assert_true(amplitude[2] < 1e-3 && amplitude[MHB_SPECTRUM_LINES - 1] <= amplitude[2]);
}

/* Between bins the frequency is interpolated, to 1 % of a bin. */
static void tone_between_bins(void **state) {
  (void)state;
  for (int k = 1; k < 10; k++) {
    double x[N] = {0}, hz[MHB_SPECTRUM_LINES], amplitude[MHB_SPECTRUM_LINES];
    double bin  = 57 + 0.1 * k;
    add_tone(bin / DURATION, 0.8, x);
    mhb_spectrum_lines(N, x, DURATION, 200, hz, amplitude);
    assert_near(hz[0] * DURATION, bin, 0.01);
    assert_true(amplitude[0] > 0.84 * 0.8 && amplitude[0] <= 0.8 * (1 + 1e-6));
  }
}

/* More tones than lines: the largest are kept, largest first. */
static void largest_are_kept(void **state) {
  (void)state;
  double x[N] = {0}, hz[MHB_SPECTRUM_LINES], amplitude[MHB_SPECTRUM_LINES];
  for (int k = 0; k < 12; k++) add_tone((30 + 20 * k) / DURATION, 1 + 0.1 * ((5 * k) % 12), x);
  mhb_spectrum_lines(N, x, DURATION, N / 2 - 1, hz, amplitude);
  for (int i = 0; i < MHB_SPECTRUM_LINES; i++) assert_near(amplitude[i], 2.1 - 0.1 * i, 1e-11);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tones_on_bins),
      cmocka_unit_test(tone_between_bins),
      cmocka_unit_test(largest_are_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
