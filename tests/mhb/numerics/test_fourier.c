/* Signals in real form: basis, its integrals, the grid and evaluation at a point. */
#include "mesh/base/constants.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/check.h"
#include "tests/support/complex_form.h"

enum { M = 7, SIZE = 2 * M + 1 };

static const double AT[] = {0, .37, 1.9, 3.3, 5.81};

/* A_k of decreasing size with phases of their own. */
static void coefficients(int m, double seed, double *a) {
  for (int i = 0; i < 2 * m + 1; i++) a[i] = cos(seed + 2.3 * i) / (1 + .4 * i);
}

static double value_of(int m, const double *a, double t, int derivative) {
  double sum = derivative ? 0 : a[0];
  for (int k = 1; k <= m; k++) {
    double phase = k * t + derivative * SHB_PI / 2;
    sum += pow(k, derivative) * (a[2 * k - 1] * cos(phase) - a[2 * k] * sin(phase));
  }
  return sum;
}

static void real_form_is_complex_form(void **state) {
  (void)state;
  double         a[SIZE], b[SIZE];
  double complex A[M + 1];
  coefficients(M, .7, a);
  to_complex(M, a, A);
  mhb_to_real(M, A, b);
  for (int i = 0; i < SIZE; i++) assert_near(b[i], a[i], 0);
  double complex sum = 0;
  for (int k = 0; k <= M; k++) sum += A[k] * cexp(I * k * AT[1]);
  assert_near(creal(sum), value_of(M, a, AT[1], 0), 1e-14);
}

static void basis_is_cosine_and_minus_sine(void **state) {
  (void)state;
  for (int i = 0; i < 5; i++) {
    double b[SIZE], slope[SIZE], alone[SIZE];
    mhb_basis(M, AT[i], b, slope);
    mhb_basis(M, AT[i], alone, NULL);
    assert_near(b[0], 1, 0);
    assert_near(slope[0], 0, 0);
    for (int k = 1; k <= M; k++) {
      assert_near(b[2 * k - 1], cos(k * AT[i]), 1e-14);
      assert_near(b[2 * k], -sin(k * AT[i]), 1e-14);
      assert_near(slope[2 * k - 1], -k * sin(k * AT[i]), 1e-13);
      assert_near(slope[2 * k], -k * cos(k * AT[i]), 1e-13);
    }
    for (int j = 0; j < SIZE; j++) assert_near(alone[j], b[j], 0);
  }
}

/* Against antiderivatives; the integrals of two intervals add up. */
static void integrals_are_differences_of_antiderivatives(void **state) {
  (void)state;
  double whole[SIZE] = {0}, parts[SIZE] = {0};
  mhb_basis_integral(M, .4, 3.1, whole);
  mhb_basis_integral(M, .4, 1.7, parts);
  mhb_basis_integral(M, 1.7, 3.1, parts);
  assert_near(whole[0], 2.7, 1e-15);
  for (int k = 1; k <= M; k++) {
    assert_near(whole[2 * k - 1], (sin(k * 3.1) - sin(k * .4)) / k, 2e-15);
    assert_near(whole[2 * k], (cos(k * 3.1) - cos(k * .4)) / k, 2e-15);
  }
  for (int i = 0; i < SIZE; i++) assert_near(parts[i], whole[i], 2e-15);
}

/* Over 1e-9 rad the integral is value times length, to all digits. */
static void short_intervals_do_not_cancel(void **state) {
  (void)state;
  double integral[SIZE] = {0}, b[SIZE], from = 2.3, to = 2.3 + 1e-9, h = to - from;
  mhb_basis_integral(M, from, to, integral);
  mhb_basis(M, .5 * (from + to), b, NULL);
  for (int i = 0; i < SIZE; i++) assert_near(integral[i] / h, b[i], 1e-14);
}

/* Products over an interval by Simpson's rule, and orthogonality over the period. */
static void products_are_integrals_of_products(void **state) {
  (void)state;
  enum { P = 3, Q = 4, LD = 2 * Q + 2, STEPS = 400 };
  double integral[2 * (P + Q) + 1] = {0}, product[(2 * P + 1) * LD], from = .3, to = 2.2;
  double sum[2 * P + 1][2 * Q + 1] = {{0}}, h = (to - from) / STEPS;
  mhb_basis_integral(P + Q, from, to, integral);
  mhb_basis_product(P, Q, integral, product, LD);
  for (int s = 0; s <= STEPS; s++) {
    double b[2 * Q + 1], weight = h / 3 * (s == 0 || s == STEPS ? 1 : s % 2 ? 4 : 2);
    mhb_basis(Q, from + s * h, b, NULL);
    for (int i = 0; i <= 2 * P; i++)
      for (int j = 0; j <= 2 * Q; j++) sum[i][j] += weight * b[i] * b[j];
  }
  for (int i = 0; i <= 2 * P; i++)
    for (int j = 0; j <= 2 * Q; j++) assert_near(product[i * LD + j], sum[i][j], 1e-8);
  memset(integral, 0, sizeof integral);
  mhb_basis_integral(P + Q, 0, SHB_TWO_PI, integral);
  mhb_basis_product(P, Q, integral, product, LD);
  for (int i = 0; i <= 2 * P; i++)
    for (int j = 0; j <= 2 * Q; j++)
      assert_near(product[i * LD + j], i != j ? 0 : i ? SHB_PI : SHB_TWO_PI, 1e-14);
}

static void signals_are_the_same_everywhere(void **state) {
  (void)state;
  mhb_signals s;
  double      a[3][SIZE];
  for (int i = 0; i < 3; i++) coefficients(M, .3 + i, a[i]);
  assert_ok(mhb_signals_create(M, &s));
  mhb_signals_set(&s, (const double *const[3]){a[0], a[1], a[2]});
  assert_int_equal(s.n_grid, 64); /* 8 (7 + 1) */
  for (int g = 0; g < s.n_grid + MHB_LANES; g++) {
    double t = SHB_TWO_PI * g / s.n_grid, y[3], dy[3], ddy[3];
    mhb_signals_at(&s, t, y, dy, ddy);
    for (int i = 0; i < 3; i++) {
      assert_near(s.value[i][g], value_of(M, a[i], t, 0), 1e-13);
      assert_near(s.slope[i][g], value_of(M, a[i], t, 1), 1e-12);
      assert_near(y[i], value_of(M, a[i], t, 0), 1e-13);
      assert_near(dy[i], value_of(M, a[i], t, 1), 1e-12);
      assert_near(ddy[i], value_of(M, a[i], t, 2), 1e-11);
      for (int j = 0; j < 5; j++) assert_true(fabs(value_of(M, a[i], t, j)) <= s.bound[i][j]);
    }
  }
  mhb_lanes phase, cosine, sine, y[3], dy[3];
  for (int l = 0; l < MHB_LANES; l++) phase[l] = -7 + 2.1 * l;
  lanes_cos_sin(phase, &cosine, &sine);
  mhb_signals_at_lanes(&s, cosine, sine, y, dy);
  for (int l = 0; l < MHB_LANES; l++)
    for (int i = 0; i < 3; i++) {
      assert_near(y[i][l], value_of(M, a[i], phase[l], 0), 1e-13);
      assert_near(dy[i][l], value_of(M, a[i], phase[l], 1), 1e-12);
    }
  mhb_signals_destroy(&s);
}

/* The grid follows the highest harmonic in use, and comes back to its size. */
static void grid_follows_the_harmonics(void **state) {
  (void)state;
  enum { HIGH = 40 };
  const int   top[] = {40, 0, 3, 8, 15, 16, 40}, points[] = {512, 64, 64, 128, 128, 256, 512};
  mhb_signals s;
  assert_ok(mhb_signals_create(HIGH, &s));
  for (int i = 0; i < 7; i++) {
    double a[2 * HIGH + 1] = {.5}, zero[2 * HIGH + 1] = {0};
    if (top[i]) a[2 * top[i]] = .7;
    mhb_signals_set(&s, (const double *const[3]){zero, a, zero});
    assert_int_equal(s.top, top[i]);
    assert_int_equal(s.n_grid, points[i]);
    assert_near(s.value[1][5], value_of(HIGH, a, SHB_TWO_PI * 5 / s.n_grid, 0), 1e-13);
  }
  mhb_signals_destroy(&s);
}

static void cosine_and_sine_of_lanes(void **state) {
  (void)state;
  for (int i = 0; i < 2000; i++) {
    mhb_lanes x, c, s;
    for (int l = 0; l < MHB_LANES; l++) x[l] = (i - 1000) * (l < 4 ? .0371 : 93.7) + l;
    lanes_cos_sin(x, &c, &s);
    for (int l = 0; l < MHB_LANES; l++) {
      assert_near(c[l], cos(x[l]), 4e-12 * (1e-4 + fabs(x[l]) * 1e-4));
      assert_near(s[l], sin(x[l]), 4e-12 * (1e-4 + fabs(x[l]) * 1e-4));
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(real_form_is_complex_form),
      cmocka_unit_test(basis_is_cosine_and_minus_sine),
      cmocka_unit_test(integrals_are_differences_of_antiderivatives),
      cmocka_unit_test(short_intervals_do_not_cancel),
      cmocka_unit_test(products_are_integrals_of_products),
      cmocka_unit_test(signals_are_the_same_everywhere),
      cmocka_unit_test(grid_follows_the_harmonics),
      cmocka_unit_test(cosine_and_sine_of_lanes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
