/* Gradient of the amplitude of probes and contacts against central differences. */
#include "mhb/tracking/output_amplitude.h"

#include <math.h>
#include <string.h>

#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/solution.h"

enum { H = 4, PAIRS = 2, N = 3 * PAIRS * (2 * H + 1) };

static double amplitude_at(mhb_balance *b, const double *x, double omega, int output,
                           mhb_size size) {
  double         r[N], by_x[N];
  double complex weight[3 * PAIRS * (H + 1)];
  mhb_amplitude  a = {.by_x = by_x, .weight = weight, .size = size};
  mhb_balance_linearise(b, x, omega, r, NULL);
  mhb_output_amplitude(b, x, output, &a);
  return a.amplitude;
}

static void check_gradient(int harmonic, mhb_size size) {
  modal_model model;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 7, &model);
  mhb_settings settings    = random_settings(H);
  settings.output_harmonic = harmonic;
  settings.n0[0]           = 0.05; /* it slips: else the load's harmonics are all */
  mhb_balance *b;
  double       x[N], r[N], by_x[N], omega = 1.07, worst = 0;
  cold_solution(&model, &settings, omega, 1e-11, x);
  assert_ok(mhb_balance_create(&model, &settings, &b));
  for (int output = 0; output < 2 + PAIRS; output++) {
    double complex weight[3 * PAIRS * (H + 1)];
    mhb_amplitude  a = {.by_x = by_x, .weight = weight, .size = size};
    mhb_balance_linearise(b, x, omega, r, NULL);
    mhb_output_amplitude(b, x, output, &a);
    assert_true(a.amplitude > 1e-6);
    double most = 0;
    for (int i = 0; i < N; i++) most = fmax(most, fabs(by_x[i]));
    for (int i = 0; i < N; i++) {
      double e = 1e-6, y[N];
      memcpy(y, x, sizeof y);
      y[i] += e;
      double up = amplitude_at(b, y, omega, output, size);
      y[i] -= 2 * e;
      double difference = (up - amplitude_at(b, y, omega, output, size)) / (2 * e);
      worst             = fmax(worst, fabs(difference - by_x[i]) / most);
    }
    double e = 1e-5, up = amplitude_at(b, x, omega + e, output, size);
    double difference = (up - amplitude_at(b, x, omega - e, output, size)) / (2 * e);
    assert_near(a.by_omega, difference, 1e-7 * (1 + fabs(difference)));
  }
  print_message("harmonic %d, gradient by x against differences: %.1e\n", harmonic, worst);
  assert_below(worst, 1e-6);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

static void the_gradient_is_that_of_differences(void **state) {
  (void)state;
  check_gradient(0, MHB_SIZE_HALF_AXIS);
}

static void so_is_that_of_another_harmonic(void **state) {
  (void)state;
  check_gradient(3, MHB_SIZE_HALF_AXIS);
}

static void so_are_those_of_the_rss_and_the_peak_to_peak(void **state) {
  (void)state;
  check_gradient(0, MHB_SIZE_RSS);
  check_gradient(0, MHB_SIZE_PEAK_TO_PEAK);
}

/* The amplitude is that of the harmonic, of a pair and of a probe: here from x and the receptance
 * directly. */
static void the_harmonic_is_the_one_asked_for(void **state) {
  (void)state;
  modal_model model;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 7, &model);
  for (int k = 1; k <= H; k++) {
    mhb_settings   settings = random_settings(H);
    double         x[N], r[N], by_x[N], square = 0;
    double complex p[3 * PAIRS], q[6], weight[3 * PAIRS * (H + 1)];
    mhb_amplitude  a = {.by_x = by_x, .weight = weight, .size = MHB_SIZE_RSS};
    mhb_balance   *b;
    settings.output_harmonic = k;
    settings.n0[0]           = 0.05;
    cold_solution(&model, &settings, 1.07, 1e-11, x);
    assert_ok(mhb_balance_create(&model, &settings, &b));
    mhb_balance_linearise(b, x, 1.07, r, NULL);
    for (int axis = 0; axis < 3; axis++)
      for (int part = 0; part < 2; part++)
        square += pow(x[axis * (2 * H + 1) + 2 * k - 1 + part], 2);
    mhb_output_amplitude(b, x, model.n_probes, &a);
    assert_near(a.amplitude, sqrt(square), 1e-14);
    mhb_receptance_update(b->receptance, k);
    mhb_balance_contact_force(b, k, p);
    mhb_receptance_probe(b->receptance, k, p, q);
    mhb_output_amplitude(b, x, 0, &a);
    square = 0;
    for (int axis = 0; axis < 3; axis++) square += pow(cabs(q[axis]), 2);
    assert_near(a.amplitude, sqrt(square), 1e-14);
    mhb_balance_destroy(b);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_gradient_is_that_of_differences),
                                     cmocka_unit_test(so_is_that_of_another_harmonic),
                                     cmocka_unit_test(so_are_those_of_the_rss_and_the_peak_to_peak),
                                     cmocka_unit_test(the_harmonic_is_the_one_asked_for)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
