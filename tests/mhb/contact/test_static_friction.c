/* The smallest admissible mean friction of a stuck contact, and its derivative. */
#include "mesh/base/constants.h"
#include "mhb/contact/static_friction.h"
#include "tests/support/check.h"

enum { M = 4, SIZE = 2 * M + 1 };

static mhb_signals signals;

static mhb_static_friction solve(double a[3][SIZE], double mu) {
  mhb_static_friction s;
  mhb_signals_set(&signals, (const double *const[3]){a[0], a[1], a[2]});
  mhb_static_friction_solve(&signals, mu, &s);
  return s;
}

/* f = cos t + cos 2t/2 spans 1.5 to -.75; a mean of x does not count. */
static void along_a_line(void **state) {
  (void)state;
  double a[3][SIZE] = {{1}, {.37, 1, 0, .5}, {0}};
  assert_true(solve(a, 1.6).feasible);
  assert_near(solve(a, 1.6).c[0], 0, 0);
  assert_int_equal(solve(a, 1.6).n_active, 0);
  mhb_static_friction s = solve(a, 1.3);
  assert_true(s.feasible);
  assert_int_equal(s.n_active, 1);
  assert_near(s.c[0], -.2, 1e-13);
  assert_near(s.c[1], 0, 1e-13);
  assert_near(remainder(s.time[0], SHB_TWO_PI), 0, 1e-12);
  assert_true(solve(a, 1.126).feasible);
  assert_false(solve(a, 1.124).feasible); /* (1.5 + .75)/2 is the limit */
}

static unsigned long long seed = 5;

static double uniform(void) {
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(seed >> 11) / 4503599627370496. - 1;
}

static void random_motion(double a[3][SIZE]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < SIZE; j++) a[i][j] = uniform() / (1 + j);
  a[0][0] = 3;
}

/* No time violates |f + c| <= mu n, and the active ones touch. */
static void random_motions_keep_the_limit(void **state) {
  (void)state;
  int seen[3] = {0};
  for (int i = 0; i < 3000; i++) {
    double a[3][SIZE], mu = .12 + .2 * fabs(uniform());
    random_motion(a);
    mhb_static_friction s = solve(a, mu);
    if (!s.feasible) continue;
    seen[s.n_active]++;
    double worst = -INFINITY, y[3], dy[3];
    for (int k = 0; k < 1000; k++) {
      mhb_signals_at(&signals, SHB_TWO_PI * k / 1000, y, dy, NULL);
      worst = fmax(worst, hypot(y[1] - a[1][0] + s.c[0], y[2] - a[2][0] + s.c[1]) - mu * y[0]);
    }
    assert_true(worst < 1e-12);
    for (int k = 0; k < s.n_active; k++) {
      mhb_signals_at(&signals, s.time[k], y, dy, NULL);
      assert_near(hypot(y[1] - a[1][0] + s.c[0], y[2] - a[2][0] + s.c[1]), mu * y[0], 1e-12);
    }
  }
  print_message("active: none %d, one %d, two %d\n", seen[0], seen[1], seen[2]);
  assert_true(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
}

/* dc by the weights and by central differences, with one and with two active times. */
static void gradient_by_differences(void **state) {
  (void)state;
  const double h       = 1e-6;
  int          seen[3] = {0};
  double       worst   = 0;
  for (int i = 0; i < 20000 && (seen[1] < 10 || seen[2] < 10); i++) {
    double a[3][SIZE], da[3][SIZE], mu = .12 + .2 * fabs(uniform()), weight[2][2][6];
    random_motion(a);
    random_motion(da);
    mhb_static_friction s = solve(a, mu);
    if (!s.feasible || s.n_active == 0) continue;
    mhb_static_friction_gradient(&signals, mu, &s, weight);
    da[1][0] = da[2][0] = 0;
    double dc[2]        = {0, 0}, y[3], dy[3], c[2][2];
    mhb_signals_set(&signals, (const double *const[3]){da[0], da[1], da[2]});
    for (int k = 0; k < s.n_active; k++) {
      mhb_signals_at(&signals, s.time[k], y, dy, NULL);
      for (int l = 0; l < 2; l++)
        for (int j = 0; j < 3; j++) dc[l] += weight[l][k][j] * y[j] + weight[l][k][3 + j] * dy[j];
    }
    int same = 1;
    for (int sign = 0; sign < 2; sign++) {
      double moved[3][SIZE];
      for (int k = 0; k < 3; k++)
        for (int j = 0; j < SIZE; j++) moved[k][j] = a[k][j] + (sign ? h : -h) * da[k][j];
      mhb_static_friction other = solve(moved, mu);
      same &= other.feasible && other.n_active == s.n_active;
      memcpy(c[sign], other.c, sizeof other.c);
    }
    if (!same) continue;
    seen[s.n_active]++;
    for (int l = 0; l < 2; l++)
      worst = fmax(worst, fabs(dc[l] - (c[1][l] - c[0][l]) / (2 * h)) / (1 + fabs(dc[l])));
  }
  print_message("worst %.1e, one active %d, two %d\n", worst, seen[1], seen[2]);
  assert_true(seen[1] >= 10 && seen[2] >= 10);
  assert_true(worst < 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(along_a_line),
      cmocka_unit_test(random_motions_keep_the_limit),
      cmocka_unit_test(gradient_by_differences),
  };
  if (mhb_signals_create(M, &signals) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  mhb_signals_destroy(&signals);
  return failed;
}
