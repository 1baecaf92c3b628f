/* The least highest peak of tracked branches, of two modes whose contact sticks: in closed form.
 *
 * Modes 1 and w2, shapes 1 and c at the contact and 1 and p at the probe. With the stiffness ku at
 * the contact q = [1 - w^2 + 2 j z1 w + ku, ku c; ku c, w2^2 - w^2 + 2 j z2 w2 w + ku c^2]^-1 f. */
#include "mhb/tracking/optimum.h"

#include <complex.h>

#include "mesh/base/constants.h"
#include "mhb/tracking/corner.h"
#include "tests/support/check.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 2, N = 3 * (2 * H + 1), BRANCHES = 2 };

static const double w2 = 2.2, z1 = 0.01, z2 = 0.006, f1 = 0.05, f2 = 0.08;

/* A model, and its stuck peaks followed along the tangential stiffness. */
typedef struct {
  double        c, p;
  modal_model   model;
  mhb_settings  settings;
  mhb_tracking  tracking;
  mhb_response *response;
} fixture;

/* ------------------------------------------------------------------ closed form */

static double amplitude_at(const fixture *f, double ku, double w) {
  const double complex a = CMPLX(1 - w * w + ku, 2 * z1 * w), b = ku * f->c;
  const double complex d = CMPLX(w2 * w2 - w * w + ku * f->c * f->c, 2 * z2 * w2 * w);
  return cabs((d * f1 - b * f2 + f->p * (a * f2 - b * f1)) / (a * d - b * b));
}

/* The undamped frequency of mode i, 0 or 1. */
static double frequency_of(const fixture *f, double ku, int i) {
  const double a = 1 + ku, b = ku * f->c, d = w2 * w2 + ku * f->c * f->c;
  return sqrt((a + d) / 2 + (i ? 1 : -1) * hypot((a - d) / 2, b));
}

/* The highest amplitude near it, by golden sections. */
static double peak_of(const fixture *f, double ku, int i, double *w) {
  const double golden = (sqrt(5) - 1) / 2, centre = frequency_of(f, ku, i);
  double       low = 0.97 * centre, high = 1.03 * centre;
  while (high - low > 1e-9 * centre) {
    const double x = high - golden * (high - low), y = low + golden * (high - low);
    if (amplitude_at(f, ku, x) > amplitude_at(f, ku, y))
      high = y;
    else
      low = x;
  }
  *w = (low + high) / 2;
  return amplitude_at(f, ku, *w);
}

/* ------------------------------------------------------------------ branches */

static void follow(fixture *f, int mode) {
  const double     middle = (f->tracking.low + f->tracking.high) / 2;
  double           x[N], omega;
  mhb_balance     *balance;
  mhb_tracking_end end;
  int              branch;
  bool             found;
  peak_of(f, middle, mode, &omega);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &balance));
  mhb_balance_go_to(balance, MHB_IN_KU, middle);
  assert_ok(mhb_balance_linear_limit(balance, omega, 1, x));
  const mhb_tracking_seed seed = {.x = x, .omega = omega, .value = middle};
  branch                       = mhb_response_branch(f->response, MHB_BRANCH_TRACKED);
  assert_ok(mhb_trace_corner(balance, &f->tracking, &seed, f->response, branch, &found, &end));
  assert_true(found);
  assert_int_equal(end.low, MHB_END_LOW);
  assert_int_equal(end.high, MHB_END_HIGH);
  mhb_balance_destroy(balance);
}

/* Branches 0 and 1 are the peaks of modes 0 and 1. */
static void set_up(fixture *f, double c, double p, double low, double high) {
  *f = (fixture){.c = c, .p = p, .settings = ground_settings(0.4, 0.8, (low + high) / 2, 1000, H)};
  two_mode_model(w2, z2, c, p, f2, &f->model);
  f->settings.frequency[0] = 0.8 / SHB_TWO_PI;
  f->settings.frequency[1] = 3 / SHB_TWO_PI;
  f->settings.tolerance    = 1e-10;
  f->tracking              = (mhb_tracking){.kind       = MHB_TRACK_PEAK,
                                            .parameter  = MHB_IN_KU,
                                            .low        = low,
                                            .high       = high,
                                            .frequency  = {0.8, 3},
                                            .max_points = 2000};
  f->response              = mhb_response_create(1, f->model.n_probes, H);
  assert_non_null(f->response);
  f->response->parameter = MHB_IN_KU;
  for (int mode = 0; mode < BRANCHES; mode++) follow(f, mode);
}

static void tear_down(fixture *f) {
  mhb_response_destroy(f->response);
  modal_model_free(&f->model);
}

static mhb_optimum find(fixture *f) {
  assert_ok(mhb_find_optimum(&f->model, &f->settings, &f->tracking, f->response));
  assert_false(f->response->optimum.verified);
  return f->response->optimum;
}

/* ------------------------------------------------------------------ tests */

/* The first peak falls, the second rises: the least is where they are equal. */
static void two_peaks_exchange_their_rank(void **state) {
  (void)state;
  fixture f;
  double  low = 0.4, high = 1.6, w[2];
  set_up(&f, 0.4, 0.5, low, high);
  const mhb_optimum o = find(&f);
  while (high - low > 1e-13) {
    const double middle = (low + high) / 2;
    if (peak_of(&f, middle, 0, &w[0]) > peak_of(&f, middle, 1, &w[1]))
      low = middle;
    else
      high = middle;
  }
  const double a = peak_of(&f, low, 0, &w[0]);
  print_message("ku %.12f, wanted %.12f; amplitude off by %.1e\n", o.value, low,
                o.amplitude / a - 1);
  assert_int_equal(o.kind, MHB_OPTIMUM_EXCHANGE);
  assert_within(o.value, low, 1e-8);
  assert_true(o.error >= 0 && o.error <= 1e-8);
  assert_within(o.amplitude, a, 1e-8);
  for (int i = 0; i < 2; i++) assert_within(SHB_TWO_PI * o.frequency[i], w[i], 1e-6);
  tear_down(&f);
}

/* While the first peak is the highest and falls, the least is at the end of the range. */
static void a_falling_peak_is_least_at_the_end(void **state) {
  (void)state;
  fixture f;
  double  w;
  set_up(&f, 0.4, 0.5, 0.4, 1.0);
  const mhb_optimum o = find(&f);
  assert_int_equal(o.kind, MHB_OPTIMUM_END);
  assert_near(o.value, 1, 1e-12);
  assert_within(o.amplitude, peak_of(&f, 1, 0, &w), 1e-8);
  assert_within(SHB_TWO_PI * o.frequency[0], w, 1e-6);
  assert_true(o.frequency[1] == 0);
  tear_down(&f);
}

/* The highest peak has a minimum of its own. */
static void one_peak_is_stationary(void **state) {
  (void)state;
  const double golden = (sqrt(5) - 1) / 2;
  fixture      f;
  double       low = 0.3, high = 1.4, w;
  set_up(&f, -0.4, 1, low, high);
  const mhb_optimum o = find(&f);
  while (high - low > 1e-7) {
    const double x = high - golden * (high - low), y = low + golden * (high - low);
    if (peak_of(&f, x, 0, &w) < peak_of(&f, y, 0, &w))
      high = y;
    else
      low = x;
  }
  print_message("ku %.9f, wanted %.9f\n", o.value, low);
  assert_int_equal(o.kind, MHB_OPTIMUM_SMOOTH);
  assert_within(o.value, low, 1e-5); /* of a minimum by its values */
  assert_within(o.amplitude, peak_of(&f, low, 0, &w), 1e-9);
  assert_within(SHB_TWO_PI * o.frequency[0], w, 1e-5);
  tear_down(&f);
}

/* A branch that ends inside the range leaves a gap. */
static void a_branch_that_ends_is_a_jump(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.4, 0.5, 0.4, 1.0);
  mhb_branch *b       = f.response->branch;
  const int   left    = b[0].n_points * 2 / 3;
  b[0].n_points       = left;
  b[1].n_points       = 0; /* only the falling peak is there, up to its last point */
  const mhb_optimum o = find(&f);
  assert_int_equal(o.kind, MHB_OPTIMUM_JUMP);
  assert_near(o.value, b[0].value[left - 1], 0);
  assert_within(o.amplitude, mhb_response_output(f.response, &b[0], left - 1), 1e-12);
  tear_down(&f);
}

static void folds_and_empty_branches_have_no_optimum(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.4, 0.5, 0.4, 1.0);
  f.tracking.kind = MHB_TRACK_FOLD;
  assert_int_equal(find(&f).kind, MHB_OPTIMUM_NONE);
  f.tracking.kind = MHB_TRACK_PEAK;
  for (int i = 0; i < BRANCHES; i++) f.response->branch[i].n_points = 0;
  assert_int_equal(find(&f).kind, MHB_OPTIMUM_NONE);
  tear_down(&f);
}

/* A point is highest up to a share of the branches' highest at its value. */
static void points_are_compared_with_all_branches(void **state) {
  (void)state;
  fixture f;
  set_up(&f, 0.4, 0.5, 0.4, 1.6);
  for (int b = 0; b < BRANCHES; b++)
    for (int i = 0; i < f.response->branch[b].n_points; i += 7) {
      double       w;
      const double value = f.response->branch[b].value[i];
      const double own = peak_of(&f, value, b, &w), other = peak_of(&f, value, 1 - b, &w);
      const double share = own / fmax(own, other);
      assert_true(mhb_is_highest(&f.tracking, f.response, b, i, share * (1 - 1e-3)));
      assert_false(mhb_is_highest(&f.tracking, f.response, b, i, share * (1 + 1e-3)));
    }
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_peaks_exchange_their_rank),
      cmocka_unit_test(a_falling_peak_is_least_at_the_end),
      cmocka_unit_test(one_peak_is_stationary),
      cmocka_unit_test(a_branch_that_ends_is_a_jump),
      cmocka_unit_test(folds_and_empty_branches_have_no_optimum),
      cmocka_unit_test(points_are_compared_with_all_branches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
