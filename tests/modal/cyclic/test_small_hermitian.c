/* Eigenvalues and Cholesky factors of small Hermitian matrices: their definitions. */
#include "modal/cyclic/small_hermitian.h"

#include "tests/support/check.h"
#include "tests/support/small_wave.h"

/* A random Hermitian matrix [n][n] by columns, diagonal added. */
static double complex *make(int n, double diagonal) {
  double complex *A = random_complex((size_t)(n * n), 9);
  for (int c = 0; c < n; c++)
    for (int r = c; r < n; r++)
      A[r * n + c] = r == c ? creal(A[r * n + c]) + diagonal : conj(A[c * n + r]);
  return A;
}

/* A = [2, -j; j, 2] has the eigenvalues 1 and 3. */
static void a_closed_form(void **state) {
  (void)state;
  double complex A[4] = {2, I, -I, 2};
  double         value[2];
  assert_true(small_hermitian_eigen(2, A, value, true));
  assert_near(value[0], 1, 1e-15);
  assert_near(value[1], 3, 1e-15);
  for (int k = 0; k < 2; k++) /* (A - lambda) v = 0 of columns v */
    assert_small(cabs((2 - value[k]) * A[2 * k] - I * A[2 * k + 1]), 1e-15);
}

static void eigenvectors_diagonalise(void **state) {
  (void)state;
  for (int n = 1; n <= 9; n += 2) {
    double complex *A = make(n, 0), *V = make(n, 0);
    double          value[9], again[9], trace = 0;
    for (int c = 0; c < n; c++) /* the upper triangle is not read */
      for (int r = 0; r < c; r++) V[c * n + r] = 1e9;
    assert_true(small_hermitian_eigen(n, V, value, true));
    for (int k = 0; k < n; k++) {
      assert_true(k == 0 || value[k] >= value[k - 1]);
      trace += value[k] - creal(A[k * (n + 1)]);
      for (int r = 0; r < n; r++) {
        double complex sum = -value[k] * V[k * n + r];
        for (int c = 0; c < n; c++) sum += A[c * n + r] * V[k * n + c];
        assert_small(cabs(sum), 1e-13);
      }
    }
    assert_small(trace, 1e-13);
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        double complex sum = -(i == j);
        for (int r = 0; r < n; r++) sum += conj(V[i * n + r]) * V[j * n + r];
        assert_small(cabs(sum), 1e-13);
      }
    assert_true(small_hermitian_eigen(n, A, again, false));
    for (int k = 0; k < n; k++) assert_near(again[k], value[k], 1e-13);
    free(A);
    free(V);
  }
}

static void the_factor_gives_the_matrix_back(void **state) {
  (void)state;
  for (int n = 1; n <= 9; n++) {
    double complex *A = make(n, 12), *R = make(n, 12);
    assert_true(small_hermitian_cholesky(n, R));
    for (int c = 0; c < n; c++) {
      assert_true(creal(R[c * (n + 1)]) > 0);
      for (int r = 0; r <= c; r++) {
        double complex sum = -A[c * n + r];
        for (int i = 0; i <= r; i++) sum += conj(R[r * n + i]) * R[c * n + i];
        assert_small(cabs(sum), 1e-14);
      }
    }
    free(A);
    free(R);
  }
}

static void an_indefinite_matrix_has_no_factor(void **state) {
  (void)state;
  for (int n = 1; n <= 5; n += 2) {
    double complex *A = make(n, 8);
    A[n * n - 1]      = -0.01;
    assert_false(small_hermitian_cholesky(n, A));
    free(A);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_closed_form),
      cmocka_unit_test(eigenvectors_diagonalise),
      cmocka_unit_test(the_factor_gives_the_matrix_back),
      cmocka_unit_test(an_indefinite_matrix_has_no_factor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
