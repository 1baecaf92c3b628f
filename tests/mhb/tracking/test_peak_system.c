/* The equations of a peak: their derivatives against differences. */
#include "mhb/tracking/peak_system.h"

#include <math.h>
#include <string.h>

#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/solution.h"
#include "tests/support/three_degree.h"

enum { H = 4, N = 3 * (2 * H + 1) };

static const double OMEGA = 1.383; /* near a peak of the probe */

typedef struct {
  modal_model       model;
  mhb_settings      settings;
  mhb_balance      *balance;
  mhb_curve_system *system;
  mhb_curve_point   point;
} fixture;

static void set_up(fixture *f, mhb_parameter parameter, double omega) {
  double           x[N];
  mhb_peak_system *system;
  three_degree_model(&f->model);
  f->settings           = ground_settings(0.4, 0.8, 0.5, 0.2, H);
  f->settings.tolerance = 1e-12;
  cold_solution(&f->model, &f->settings, omega, 1e-11, x);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  assert_ok(mhb_peak_system_create(f->balance, MHB_TRACK_PEAK, 0, parameter, 1.5, 0.7, &system));
  f->system = mhb_peak_system_base(system);
  mhb_curve_point_create(f->system, &f->point);
  mhb_peak_system_pack(f->system, x, omega, f->point.x);
  mhb_operating_point at = mhb_operating_point_of(&f->settings);
  f->point.value         = mhb_parameter_get(&at, parameter);
  assert_near(mhb_peak_system_omega(f->system, f->point.x), omega, 1e-14);
}

static void tear_down(fixture *f) {
  mhb_curve_point_destroy(f->system, &f->point);
  f->system->destroy(f->system);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

/* dA/ds by the program at the point, and by differences along the response curve. Those come from
 * two solutions at frequencies beside it. */
static void the_slope_of_the_amplitude_is_that_of_the_curve(void **state) {
  (void)state;
  fixture      f;
  const double omega = OMEGA - 0.04; /* on the flank of the peak */
  set_up(&f, MHB_IN_N0, omega);
  f.system->linearise(f.system, &f.point);
  double g = f.point.r[N], amplitude[2], z[2][N + 1], step = 1e-5, length = 0;
  for (int side = 0; side < 2; side++) {
    double at = omega + (side ? step : -step);
    cold_solution(&f.model, &f.settings, at, 1e-12, z[side]);
    mhb_peak_system_pack(f.system, z[side], at, z[side]);
    mhb_curve_point beside;
    mhb_curve_point_create(f.system, &beside);
    memcpy(beside.x, z[side], sizeof z[side]);
    beside.value    = f.point.value;
    amplitude[side] = mhb_peak_system_report(f.system, &beside).amplitude;
    mhb_curve_point_destroy(f.system, &beside);
  }
  for (int i = 0; i <= N; i++) length += pow(z[1][i] - z[0][i], 2);
  double difference = (amplitude[1] - amplitude[0]) / sqrt(length);
  print_message("dA/ds %.9f, by differences %.9f\n", g, difference);
  assert_near(fabs(g), fabs(difference), 1e-6 * fabs(g) + 1e-9);
  tear_down(&f);
}

/* Newton's method at a fixed parameter converges to a point where A is stationary. */
static void a_peak_is_found_and_its_amplitude_is_largest(void **state) {
  (void)state;
  fixture f;
  double  beside[2], x[N];
  set_up(&f, MHB_IN_N0, OMEGA);
  assert_int_equal(f.system->solve_at_value(f.system, 1e-11, &f.point), MHB_CONVERGED);
  mhb_peak_report report = mhb_peak_system_report(f.system, &f.point);
  double          omega = mhb_peak_system_omega(f.system, f.point.x), step = 1e-4;
  memcpy(x, f.point.x, sizeof x);
  for (int side = 0; side < 2; side++) {
    double at = omega + (side ? step : -step);
    cold_solution(&f.model, &f.settings, at, 1e-12, x);
    mhb_peak_system_pack(f.system, x, at, f.point.x);
    beside[side] = mhb_peak_system_report(f.system, &f.point).amplitude;
  }
  print_message("omega %.9f, A %.9f, beside %.9f %.9f, curvature %g\n", omega, report.amplitude,
                beside[0], beside[1], report.curvature);
  if (report.curvature < 0) assert_true(report.amplitude > fmax(beside[0], beside[1]));
  if (report.curvature > 0) assert_true(report.amplitude < fmin(beside[0], beside[1]));
  tear_down(&f);
}

/* dA/dq of a peak by the adjoint against peaks solved at two values of each parameter. */
static void the_adjoint_is_that_of_solved_peaks(void **state) {
  (void)state;
  static const mhb_parameter parameter[] = {MHB_IN_N0, MHB_IN_SCALE, MHB_IN_MU, MHB_IN_KU,
                                            MHB_IN_KV};
  double                     worst       = 0;
  for (int p = 0; p < 5; p++) {
    fixture f;
    double  amplitude[2];
    set_up(&f, parameter[p], OMEGA);
    assert_int_equal(f.system->solve_at_value(f.system, 1e-12, &f.point), MHB_CONVERGED);
    double by_value = mhb_peak_system_report(f.system, &f.point).by_value, value = f.point.value;
    double step = 1e-4 * value;
    for (int side = 0; side < 2; side++) {
      f.point.value = value + (side ? step : -step);
      assert_int_equal(f.system->solve_at_value(f.system, 1e-12, &f.point), MHB_CONVERGED);
      amplitude[side] = mhb_peak_system_report(f.system, &f.point).amplitude;
    }
    double difference = (amplitude[1] - amplitude[0]) / (2 * step);
    print_message("%-6s dA/dq %.9f, by differences %.9f\n", mhb_parameter_name(parameter[p]),
                  by_value, difference);
    worst = fmax(worst, fabs(by_value - difference) * value / amplitude[0]);
    tear_down(&f);
  }
  assert_below(worst, 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_slope_of_the_amplitude_is_that_of_the_curve),
      cmocka_unit_test(a_peak_is_found_and_its_amplitude_is_largest),
      cmocka_unit_test(the_adjoint_is_that_of_solved_peaks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
