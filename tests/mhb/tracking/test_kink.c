/* The search for a peak on a kink, where the peak is smooth: that of a linear oscillator in closed
 * form, with all derivatives. Kinks themselves are those of a blade
 * (cases.scenes.tracked_peaks). */
#include "mhb/tracking/kink.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 5, N = 3 * (2 * H + 1) };

typedef struct {
  modal_model    model;
  mhb_settings   settings;
  mhb_tracking   tracking;
  mhb_balance   *balance;
  mhb_kink      *kink;
  mhb_peak_place at; /* the guess */
  double         x[N];
} fixture;

static void set_up(fixture *f, mhb_parameter parameter, double value) {
  f->settings.frequency[0] = 0.9 / SHB_TWO_PI;
  f->settings.frequency[1] = 1.8 / SHB_TWO_PI;
  f->settings.tolerance    = 1e-10;
  f->tracking              = (mhb_tracking){.kind       = MHB_TRACK_PEAK,
                                            .parameter  = parameter,
                                            .low        = 0.9 * value,
                                            .high       = 1.1 * value,
                                            .frequency  = {0.9, 1.8},
                                            .max_points = 200};
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  f->kink = mhb_kink_create(f->balance, &f->tracking);
}

static void tear_down(fixture *f) {
  mhb_kink_destroy(f->kink);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

/* An oscillator of mass and stiffness 1 whose contact sticks throughout. */
static void linear(fixture *f, double zeta, double force, double ku) {
  *f = (fixture){.settings = ground_settings(0.4, 0.8, ku, 50, H)};
  one_degree_model(zeta, 1, force, &f->model);
  set_up(f, MHB_IN_N0, 50);
}

/* w^2 = k - 2 zeta^2, A = F/(2 zeta sqrt(k - zeta^2)), from either side. */
static void a_smooth_peak_is_told_and_found(void **state) {
  (void)state;
  const double zeta = 0.03, force = 0.05, ku = 0.5, k = 1 + ku, rest = k - zeta * zeta;
  const double peak = sqrt(k - 2 * zeta * zeta), a = force / (2 * zeta * sqrt(rest));
  for (int side = -1; side <= 1; side += 2) {
    fixture f;
    mhb_end why;
    double  x[N], by[MHB_PEAK_PARAMETERS], omega = peak * (1 + 0.001 * side);
    linear(&f, zeta, force, ku);
    assert_ok(mhb_balance_linear_limit(f.balance, omega, 1, f.x));
    f.at = (mhb_peak_place){.value = 50, .omega = omega};
    assert_false(mhb_kink_start(f.kink, f.x, &f.at, &why));
    assert_int_equal(why, MHB_END_SMOOTH);
    print_message("peak off by %.1e, amplitude by %.1e\n", f.at.omega / peak - 1,
                  f.at.amplitude / a - 1);
    assert_within(f.at.omega, peak, 1e-7);
    assert_within(f.at.amplitude, a, 1e-12);
    assert_near(mhb_kink_slip_share(f.kink), 0, 0);
    mhb_kink_maximum(f.kink, x, by);
    assert_within(by[MHB_PEAK_BY_SCALE], a, 1e-8);
    assert_within(by[MHB_PEAK_BY_KU], -a / (2 * rest), 1e-6);
    assert_within(by[MHB_PEAK_BY_DAMPING], -a * (1 - zeta * zeta / rest), 1e-7);
    assert_small(by[MHB_PEAK_BY_N0], 1e-12);
    assert_small(by[MHB_PEAK_BY_MU], 1e-12);
    assert_small(by[MHB_PEAK_BY_KV], 1e-12);
    mhb_kink_maximum(f.kink, x, NULL);
    assert_within(hypot(x[2 * H + 2], x[2 * H + 3]), a, 1e-12); /* u_1 */
    tear_down(&f);
  }
}

/* The way along the curve is bounded: from far away no maximum is met. */
static void a_peak_out_of_reach_is_none(void **state) {
  (void)state;
  for (int side = -1; side <= 1; side += 2) {
    const double omega = sqrt(1.5) + 0.3 * side;
    fixture      f;
    mhb_end      why;
    linear(&f, 0.03, 0.05, 0.5);
    assert_ok(mhb_balance_linear_limit(f.balance, omega, 1, f.x));
    f.at = (mhb_peak_place){.value = 50, .omega = omega};
    assert_false(mhb_kink_start(f.kink, f.x, &f.at, &why));
    assert_int_equal(why, MHB_END_TURNED);
    tear_down(&f);
  }
}

/* A seed at a smooth peak, and one of a fold, start no curve of kinks. */
static void a_smooth_seed_starts_no_curve(void **state) {
  (void)state;
  for (int fold = 0; fold < 2; fold++) {
    fixture          f;
    mhb_tracking_end end;
    mhb_response    *r;
    int              branch;
    bool             found = true;
    linear(&f, 0.03, 0.05, 0.5);
    if (fold) f.tracking.kind = MHB_TRACK_FOLD;
    r            = mhb_response_create(1, f.model.n_probes, H);
    r->parameter = MHB_IN_N0;
    branch       = mhb_response_branch(r, MHB_BRANCH_TRACKED);
    assert_ok(mhb_balance_linear_limit(f.balance, sqrt(1.5), 1, f.x));
    const mhb_tracking_seed seed = {.x = f.x, .omega = sqrt(1.5), .value = 50};
    assert_ok(mhb_trace_kink(f.balance, &f.tracking, &seed, r, branch, &found, &end));
    assert_false(found);
    assert_int_equal(end.low, MHB_END_NO_START);
    assert_int_equal(end.high, MHB_END_NO_START);
    assert_int_equal(r->branch[branch].n_points, 0);
    mhb_response_destroy(r);
    tear_down(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_smooth_peak_is_told_and_found),
      cmocka_unit_test(a_peak_out_of_reach_is_none),
      cmocka_unit_test(a_smooth_seed_starts_no_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
