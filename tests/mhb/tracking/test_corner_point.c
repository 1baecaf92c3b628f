/* A corner and a stuck peak of an oscillator in closed form, with all derivatives.
 *
 * Mass and stiffness are 1, damping ratio zeta. The contact moves along u only, so the normal force
 * is n0 throughout. While it sticks the motion is linear with stiffness k = 1 + ku,
 *
 *   A = F/|k - w^2 + 2 j zeta w|,   h = ku A - mu n0,   no mean friction.
 *
 * The corner has A = mu n0/ku.
 * The stuck peak has w^2 = k - 2 zeta^2, A = F/(2 zeta sqrt(k - zeta^2)). */
#include "mhb/tracking/corner_point.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 3, N = 3 * (2 * H + 1) };

static const double zeta = 0.03, force = 0.05, mu = 0.4, ku = 0.5;

static const mhb_parameter parameters[] = {MHB_IN_N0, MHB_IN_SCALE, MHB_IN_MU, MHB_IN_KU,
                                           MHB_IN_KV};

enum { PARAMETERS = sizeof parameters / sizeof *parameters };

typedef struct {
  modal_model  model;
  mhb_settings settings;
  mhb_tracking tracking;
  mhb_balance *balance;
  mhb_corner  *corner;
  double       x[N];
} fixture;

static double amplitude_at(double omega) {
  return force / hypot(1 + ku - omega * omega, 2 * zeta * omega);
}

static double slope_at(double omega) { /* dA/domega */
  const double d = 1 + ku - omega * omega, a = amplitude_at(omega);
  return a * a * a / (force * force) * (2 * omega * d - 4 * zeta * zeta * omega);
}

/* The corner above the resonance (side 1) or below it (-1), where
 * (k - w^2)^2 + (2 zeta w)^2 = (F/A)^2. */
static double corner_of(double n0, int side) {
  const double k = 1 + ku, a = mu * n0 / ku, p = k - 2 * zeta * zeta;
  return sqrt(p + side * sqrt(p * p - k * k + pow(force / a, 2)));
}

static double stuck_peak(void) {
  return sqrt(1 + ku - 2 * zeta * zeta);
}

/* A balance with the stuck motion at omega. */
static void set_up(fixture *f, double n0, mhb_parameter parameter, double omega) {
  one_degree_model(zeta, 1, force, &f->model);
  f->settings              = ground_settings(mu, 0.8, ku, n0, H);
  f->settings.frequency[0] = 0.5 / SHB_TWO_PI;
  f->settings.frequency[1] = 2 / SHB_TWO_PI;
  f->settings.tolerance    = 1e-12;
  f->tracking              = (mhb_tracking){.kind      = MHB_TRACK_PEAK,
                                            .parameter = parameter,
                                            .low       = 0.01,
                                            .high      = 2,
                                            .frequency = {0.5, 2}};
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  assert_int_equal(f->balance->n, N);
  mhb_balance_set_preload(f->balance, n0);
  f->corner = mhb_corner_create(f->balance, &f->tracking);
  assert_ok(mhb_balance_linear_limit(f->balance, omega, 1, f->x));
}

static void tear_down(fixture *f) {
  mhb_corner_destroy(f->corner);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static double value_of(const fixture *f) {
  return mhb_parameter_get(&f->balance->eval->at, f->tracking.parameter);
}

static void the_corners_are_those_of_the_closed_form(void **state) {
  (void)state;
  for (double n0 = 0.3; n0 < 0.7; n0 += 0.1)
    for (int side = -1; side <= 1; side += 2) {
      fixture      f;
      const double wanted = corner_of(n0, side);
      double       omega  = wanted * 1.004;
      set_up(&f, n0, MHB_IN_N0, omega);
      mhb_corner_take(f.corner, 0, n0, f.x);
      assert_true(mhb_corner_solve(f.corner, n0, 0, &omega));
      const mhb_corner_state s = mhb_corner_evaluate(f.corner, omega, n0);
      print_message("n0 %.1f: corner off by %.1e, amplitude by %.1e\n", n0, omega / wanted - 1,
                    s.amplitude * ku / (mu * n0) - 1);
      assert_within(omega, wanted, 1e-10);
      assert_within(s.amplitude, mu * n0 / ku, 1e-9);
      assert_small(s.onset, 1e-9 * mu * n0);
      tear_down(&f);
    }
}

/* sense is that of dh/domega: below the resonance h rises, above it falls. */
static void the_sense_tells_the_corners_apart(void **state) {
  (void)state;
  for (int side = -1; side <= 1; side += 2)
    for (int sense = -1; sense <= 1; sense += 2) {
      fixture f;
      double  omega = corner_of(0.4, side) * 1.002;
      set_up(&f, 0.4, MHB_IN_N0, omega);
      mhb_corner_take(f.corner, 0, 0.4, f.x);
      assert_true(mhb_corner_solve(f.corner, 0.4, sense, &omega) == (sense == -side));
      tear_down(&f);
    }
}

static void derivatives_at_fixed_frequency(void **state) {
  (void)state;
  fixture      f;
  const double n0 = 0.5, omega = 1.1713;
  set_up(&f, n0, MHB_IN_N0, omega);
  mhb_corner_take(f.corner, 0, n0, f.x);
  const mhb_corner_state s = mhb_corner_linearise(f.corner, omega, n0);
  assert_within(s.amplitude, amplitude_at(omega), 1e-11);
  assert_within(s.onset, ku * amplitude_at(omega) - mu * n0, 1e-10);
  assert_within(s.by_omega, slope_at(omega), 1e-10);
  assert_within(s.onset_by_omega, ku * slope_at(omega), 1e-9);
  assert_small(s.by_value, 1e-12);
  assert_within(s.onset_by_value, -mu, 1e-9);
  tear_down(&f);
}

/* Along corners A = mu n0/ku, whatever load, normal stiffness and damping are. */
static void derivatives_along_corners(void **state) {
  (void)state;
  const double n0 = 0.5, wanted[PARAMETERS] = {mu / ku, 0, n0 / ku, -mu * n0 / (ku * ku), 0};
  for (int p = 0; p < PARAMETERS; p++) {
    fixture f;
    double  omega = corner_of(n0, -1);
    set_up(&f, n0, parameters[p], omega);
    const double value = value_of(&f);
    mhb_corner_take(f.corner, 0, value, f.x);
    assert_true(mhb_corner_solve(f.corner, value, 0, &omega));
    const mhb_corner_state s     = mhb_corner_linearise(f.corner, omega, value);
    const double           along = mhb_corner_derivative(f.corner, &s, omega, parameters[p], false);
    print_message("%-5s %.12f, wanted %.12f\n", mhb_parameter_name(parameters[p]), along,
                  wanted[p]);
    assert_near(along, wanted[p], 1e-9);
    assert_small(mhb_corner_derivative(f.corner, &s, omega, parameters[p], true), 1e-10);
    tear_down(&f);
  }
}

static void the_stuck_peak_and_its_derivatives(void **state) {
  (void)state;
  const double peak = stuck_peak(), a = amplitude_at(peak), k = 1 + ku, rest = k - zeta * zeta;
  const double wanted[PARAMETERS] = {0, a, 0, -a / (2 * rest), 0};
  for (int p = 0; p < PARAMETERS; p++) {
    fixture      f;
    double       omega = peak * 0.995;
    const double n0    = 1.7; /* it does not slip: ku A = 0.34 N */
    set_up(&f, n0, parameters[p], omega);
    const double value = value_of(&f);
    mhb_corner_take(f.corner, -1, value, f.x);
    assert_true(mhb_corner_solve(f.corner, value, -1, &omega));
    const mhb_corner_state s = mhb_corner_linearise(f.corner, omega, value);
    assert_within(omega, peak, 1e-8);
    assert_within(s.amplitude, force / (2 * zeta * sqrt(rest)), 1e-11);
    assert_within(s.onset, ku * s.amplitude - mu * n0, 1e-9);
    assert_small(s.by_omega, 1e-6);
    const double along   = mhb_corner_derivative(f.corner, &s, omega, parameters[p], false);
    const double damping = mhb_corner_derivative(f.corner, &s, omega, parameters[p], true);
    print_message("%-5s %.12f, wanted %.12f; damping %.12f\n", mhb_parameter_name(parameters[p]),
                  along, wanted[p], damping);
    assert_near(along, wanted[p], 1e-7);
    assert_near(damping, -a * (1 - zeta * zeta / rest), 1e-7); /* zeta dA/dzeta */
    tear_down(&f);
  }
}

/* A pair is a candidate by its distance from the limit; one that is open is none. */
static void candidates_are_near_the_limit(void **state) {
  (void)state;
  const double n0 = 0.5, omega = 1.15, h = ku * amplitude_at(omega) - mu * n0;
  const double share = fabs(h) / (mu * n0);
  fixture      f;
  int          pair[1] = {7};
  set_up(&f, n0, MHB_IN_N0, omega);
  assert_int_equal(mhb_corner_candidates(f.corner, n0, f.x, share * 0.999, pair), 0);
  assert_int_equal(mhb_corner_candidates(f.corner, n0, f.x, share * 1.001, pair), 1);
  assert_int_equal(pair[0], 0);
  assert_int_equal(mhb_corner_candidates(f.corner, -0.1, f.x, 1e9, pair), 0);
  tear_down(&f);
}

/* Without a normal motion and mean friction no stuck motion goes beyond the corner. */
static void no_motion_overhangs(void **state) {
  (void)state;
  fixture f;
  double  omega = corner_of(0.5, -1), x[N], end = 0;
  set_up(&f, 0.5, MHB_IN_N0, omega);
  mhb_corner_take(f.corner, 0, 0.5, f.x);
  assert_true(mhb_corner_solve(f.corner, 0.5, 0, &omega));
  memcpy(f.x, f.corner->x, sizeof x);
  assert_false(mhb_corner_overhangs(f.corner, omega, 0.5, 1, x, &end));
  assert_memory_equal(f.x, f.corner->x, sizeof x);
  tear_down(&f);
}

/* Below the load at which the peak reaches the limit there is a corner, above it there is none. */
static void no_corner_where_nothing_slips(void **state) {
  (void)state;
  const double most = ku * amplitude_at(stuck_peak()) / mu;
  for (int i = 0; i < 2; i++) {
    fixture      f;
    const double n0    = most * (i ? 1.02 : 0.999);
    double       omega = stuck_peak() * 0.999;
    set_up(&f, n0, MHB_IN_N0, omega);
    mhb_corner_take(f.corner, 0, n0, f.x);
    memcpy(f.x, f.corner->x, sizeof f.x);
    assert_true(mhb_corner_solve(f.corner, n0, 0, &omega) == !i);
    if (i) assert_memory_equal(f.x, f.corner->x, sizeof f.x); /* the motion stays */
    tear_down(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_corners_are_those_of_the_closed_form),
      cmocka_unit_test(the_sense_tells_the_corners_apart),
      cmocka_unit_test(derivatives_at_fixed_frequency),
      cmocka_unit_test(derivatives_along_corners),
      cmocka_unit_test(the_stuck_peak_and_its_derivatives),
      cmocka_unit_test(candidates_are_near_the_limit),
      cmocka_unit_test(no_motion_overhangs),
      cmocka_unit_test(no_corner_where_nothing_slips),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
