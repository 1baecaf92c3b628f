/* Distance of curves: the definition by brute force, and its invariances. */
#include "postproc/analysis/curve_distance.h"

#include "tests/support/check.h"

enum { N = 60 };

/* A folded curve: the frequency turns twice. */
static void folded(int n, double *f, double *a) {
  for (int i = 0; i < n; i++) {
    double s = (double)i / (n - 1) * 3;
    f[i]     = 130 + 17 * (s + 0.9 * sin(2.1 * s));
    a[i]     = 3e-4 * (1.3 + sin(1.7 * s));
  }
}

static void of_points(void **state) {
  (void)state;
  double a[2] = {100, 2e-3}, b[2] = {100.7, 2.013e-3};
  assert_near(post_point_distance(a, b, 2e-3), log(1.007), 1e-15);
  assert_near(post_point_distance(b, a, 5e-4), 0.026, 1e-13);
}

/* The nearest of a hundred thousand points on the polyline. */
static double brute(const double point[2], const post_polyline *line, double unit) {
  double least = INFINITY;
  for (int i = 0; i + 1 < line->n; i++)
    for (int k = 0; k <= 1700; k++) {
      double t = k / 1700., x0 = log(line->frequency[i]), y0 = line->amplitude[i];
      double p[2] = {exp(x0 + t * (log(line->frequency[i + 1]) - x0)),
                     y0 + t * (line->amplitude[i + 1] - y0)};
      least       = fmin(least, post_point_distance(point, p, unit));
    }
  return least;
}

static void of_a_point_from_a_folded_line(void **state) {
  (void)state;
  double        f[N], a[N];
  post_polyline line = {N, f, a};
  folded(N, f, a);
  for (int i = 0; i < 40; i++) {
    double point[2] = {120 + 1.7 * i, 3e-4 * (0.2 + 0.061 * ((i * 7) % 40))};
    int    near     = -1;
    double d        = post_curve_distance(point, &line, 7e-4, &near);
    assert_near(d, brute(point, &line, 7e-4), 2e-5);
    double at[2] = {f[near], a[near]}; /* an end of the nearest segment */
    assert_true(post_point_distance(point, at, 7e-4) >= d - 1e-12);
    assert_true(post_point_distance(point, at, 7e-4) <= d + 0.04);
  }
  for (int i = 0; i < N; i++) {
    double point[2] = {f[i], a[i]};
    assert_near(post_curve_distance(point, &line, 7e-4, NULL), 0, 0);
  }
}

static void of_degenerate_lines(void **state) {
  (void)state;
  double        f[3] = {100, 100, 100}, a[3] = {1, 1, 1}, point[2] = {100 * exp(0.2), 1.1};
  post_polyline none = {0, f, a}, one = {1, f, a}, same = {3, f, a};
  assert_true(isinf(post_curve_distance(point, &none, 1, NULL)));
  assert_near(post_curve_distance(point, &one, 1, NULL), 0.2, 1e-14);
  assert_near(post_curve_distance(point, &same, 1, NULL), 0.2, 1e-14);
  assert_near(post_chord_deviation(&same, 0, 1), 0, 0);
}

/* The estimated deviation bounds the distance of the true curve from its chords, and falls with the
 * square of the spacing. */
static void sag_bounds_the_interpolation(void **state) {
  (void)state;
  double        worst[2] = {0, 0};
  static double ff[10000], fa[10000];
  folded(10000, ff, fa);
  for (int r = 0; r < 2; r++) {
    int           n = r ? 2 * N - 1 : N;
    double        f[2 * N], a[2 * N];
    post_polyline line = {n, f, a};
    folded(n, f, a);
    for (int i = 0; i < 10000; i++) {
      double point[2] = {ff[i], fa[i]};
      int    near;
      double d   = post_curve_distance(point, &line, 7e-4, &near);
      double sag = fmax(post_chord_deviation(&line, near, 7e-4),
                        near > 0 ? post_chord_deviation(&line, near - 1, 7e-4) : 0);
      worst[r]   = fmax(worst[r], d);
      assert_true(d <= 1.5 * sag + 1e-9);
    }
  }
  assert_true(worst[0] / worst[1] > 3.5 && worst[0] / worst[1] < 4.6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(of_points), cmocka_unit_test(of_a_point_from_a_folded_line),
      cmocka_unit_test(of_degenerate_lines), cmocka_unit_test(sag_bounds_the_interpolation)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
