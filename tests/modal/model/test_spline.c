/* Interpolation between speeds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "modal/model/spline.h"

static void check(double value, double wanted, double tolerance, const char *what) {
  if (!(fabs(value - wanted) <= tolerance))
    fail_msg("%s: %.15g, wanted %.15g within %g", what, value, wanted, tolerance);
}

static double at(const modal_spline *s, const double *y, double x, double *slope) {
  double w[64], d[64], value = 0;
  modal_spline_weights(s, x, w, d);
  *slope = 0;
  for (int i = 0; i < s->n; i++) {
    value += w[i] * y[i];
    *slope += d[i] * y[i];
  }
  return value;
}

/* Polynomials up to degree n - 1 <= 3 are exact on an uneven grid, also beyond its ends. */
static void polynomials_are_exact(void **state) {
  (void)state;
  const double x[7] = {-0.7, 0.2, 0.35, 1.9, 2.385, 4, 4.1};
  for (int n = 1; n <= 7; n++) {
    modal_spline s;
    double       y[7];
    int          degree = n < 4 ? n - 1 : 3;
    modal_spline_create(n, x, &s);
    for (int i = 0; i < n; i++) y[i] = pow(x[i] - 0.3, degree) - 2;
    for (double t = -1; t < 4.5; t += 0.0613) {
      double slope, value = at(&s, y, t, &slope);
      check(value, pow(t - 0.3, degree) - 2, 1e-11, "value");
      check(slope, degree ? degree * pow(t - 0.3, degree - 1) : 0, 1e-11, "slope");
    }
    modal_spline_free(&s);
  }
}

/* The error for a smooth function is of order h^4, that of its slope of order h^3. */
static void order_is_four(void **state) {
  (void)state;
  double error[3] = {0}, tilt[3] = {0};
  for (int level = 0; level < 3; level++) {
    int          n = (8 << level) + 1;
    double       x[64], y[64];
    modal_spline s;
    for (int i = 0; i < n; i++) {
      x[i] = 2. * i / (n - 1);
      y[i] = sin(2.385 * x[i]);
    }
    modal_spline_create(n, x, &s);
    for (double t = 0; t <= 2; t += 0.003) {
      double slope, value = at(&s, y, t, &slope);
      error[level] = fmax(error[level], fabs(value - sin(2.385 * t)));
      tilt[level]  = fmax(tilt[level], fabs(slope - 2.385 * cos(2.385 * t)));
    }
    modal_spline_free(&s);
  }
  for (int i = 0; i < 2; i++) {
    assert_true(log2(error[i] / error[i + 1]) > 3.6);
    assert_true(log2(tilt[i] / tilt[i + 1]) > 2.6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(polynomials_are_exact),
                                     cmocka_unit_test(order_is_four)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
