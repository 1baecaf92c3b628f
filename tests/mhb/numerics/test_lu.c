/* LU factors of small systems: in place and by LAPACK, with row exchanges, singular. */
#include <complex.h>

#include "mhb/numerics/lu.h"
#include "tests/support/check.h"

enum { MOST = 9, COLUMNS = 3 };

static unsigned long long seed = 11;

static double uniform(void) {
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(seed >> 11) / 4503599627370496. - 1;
}

/* A zero diagonal needs row exchanges. */
static void complex_systems_are_solved(void **state) {
  (void)state;
  double worst = 0;
  for (int n = 2; n <= MOST; n++) {
    double complex A[MOST * MOST], LU[MOST * MOST], b[COLUMNS * MOST], x[COLUMNS * MOST];
    int            pivot[MOST];
    for (int i = 0; i < n * n; i++) LU[i] = A[i] = i % (n + 1) ? uniform() + I * uniform() : 0;
    for (int i = 0; i < COLUMNS * n; i++) x[i] = b[i] = uniform() + I * uniform();
    assert_true(mhb_factor_complex(n, LU, pivot));
    assert_true(mhb_solve_complex(n, LU, pivot, COLUMNS, x));
    for (int c = 0; c < COLUMNS; c++)
      for (int i = 0; i < n; i++) {
        double complex sum = -b[c * n + i]; /* A is column-major */
        for (int j = 0; j < n; j++) sum += A[j * n + i] * x[c * n + j];
        worst = fmax(worst, cabs(sum));
      }
  }
  print_message("residual %.1e\n", worst);
  assert_true(worst < 1e-13);
}

static void real_systems_are_solved(void **state) {
  (void)state;
  double worst = 0;
  for (int n = 2; n <= MOST; n++) {
    double A[MOST * MOST], LU[MOST * MOST], b[MOST], x[MOST];
    int    pivot[MOST];
    for (int i = 0; i < n * n; i++) LU[i] = A[i] = i % (n + 1) ? uniform() : 0;
    for (int i = 0; i < n; i++) x[i] = b[i] = uniform();
    assert_true(mhb_factor_real(n, LU, pivot));
    mhb_solve_real(n, LU, pivot, x);
    for (int i = 0; i < n; i++) {
      double sum = -b[i]; /* A is row-major */
      for (int j = 0; j < n; j++) sum += A[i * n + j] * x[j];
      worst = fmax(worst, fabs(sum));
    }
  }
  print_message("residual %.1e\n", worst);
  assert_true(worst < 1e-13);
}

/* 2 x = 3 j, and [1 2; 3 4] x = (5, 6). */
static void by_hand(void **state) {
  (void)state;
  double complex one = 2, x = 3 * I;
  int            pivot[2];
  assert_true(mhb_factor_complex(1, &one, pivot));
  assert_true(mhb_solve_complex(1, &one, pivot, 1, &x));
  assert_near(cimag(x), 1.5, 0);
  double A[4] = {1, 2, 3, 4}, b[2] = {5, 6};
  assert_true(mhb_factor_real(2, A, pivot));
  mhb_solve_real(2, A, pivot, b);
  assert_near(b[0], -4, 1e-14);
  assert_near(b[1], 4.5, 1e-14);
}

static void singular_matrices_are_refused(void **state) {
  (void)state;
  for (int n = 2; n <= MOST; n++) {
    double complex C[MOST * MOST] = {0};
    double         R[MOST * MOST] = {0};
    int            pivot[MOST];
    for (int i = 1; i < n; i++) C[i * n + i] = R[i * n + i] = 1;
    assert_false(mhb_factor_complex(n, C, pivot));
    assert_false(mhb_factor_real(n, R, pivot));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(complex_systems_are_solved),
      cmocka_unit_test(real_systems_are_solved),
      cmocka_unit_test(by_hand),
      cmocka_unit_test(singular_matrices_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
