/* Eigenvalues by QR steps: against LAPACK, defective and graded matrices, all sizes of panels. */
#include "mhb/floquet/hessenberg_qr.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/check.h"

static double uniform(void) {
  return (double)rand() / RAND_MAX - 0.5;
}

/* Largest distance of a value[n] from the nearest of wanted[n], each taken once. */
static double farthest(int n, const double complex *value, double complex *wanted) {
  double worst = 0;
  for (int i = 0; i < n; i++) {
    int best = i;
    for (int k = i; k < n; k++)
      if (cabs(value[i] - wanted[k]) < cabs(value[i] - wanted[best])) best = k;
    double complex swap = wanted[i];
    wanted[i]           = wanted[best];
    wanted[best]        = swap;
    worst               = fmax(worst, cabs(value[i] - wanted[i]));
  }
  return worst;
}

static void lapack_agrees(void **state) {
  (void)state;
  srand(7);
  for (int n = 1; n <= 75; n += n < 14 ? 1 : 23) {
    mhb_hessenberg_qr qr;
    double complex    A[75 * 75], copy[75 * 75], own[75], wanted[75];
    mhb_hessenberg_qr_create(n, &qr);
    for (int i = 0; i < n * n; i++) copy[i] = A[i] = uniform() + I * uniform();
    assert_true(mhb_hessenberg_qr_eigenvalues(&qr, n, copy, own));
    assert_int_equal(LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'N', n, A, n, wanted, NULL, 1, NULL, 1),
                     0);
    double error = farthest(n, own, wanted);
    print_message("%d: %.1e\n", n, error);
    assert_true(error < 1e-13 * n);
    mhb_hessenberg_qr_destroy(&qr);
  }
}

/* A cyclic shift, which a QR step without exceptional shifts leaves as it is: roots of 1. */
static void roots_of_one_are_found(void **state) {
  (void)state;
  for (int n = 2; n <= 12; n++) {
    mhb_hessenberg_qr qr;
    double complex    A[144] = {0}, own[12];
    mhb_hessenberg_qr_create(n, &qr);
    for (int i = 0; i < n; i++) A[i * n + (i + 1) % n] = 1;
    assert_true(mhb_hessenberg_qr_eigenvalues(&qr, n, A, own));
    for (int i = 0; i < n; i++) assert_near(cabs(cpow(own[i], n) - 1), 0, 1e-12);
    mhb_hessenberg_qr_destroy(&qr);
  }
}

/* Entries of very different size, as of displacements in m beside forces in N. */
static void units_do_not_matter(void **state) {
  (void)state;
  enum { N = 17 };
  mhb_hessenberg_qr qr;
  double complex    A[N * N], scaled[N * N], own[N], wanted[N];
  srand(3);
  mhb_hessenberg_qr_create(N, &qr);
  for (int i = 0; i < N * N; i++) {
    double ratio = pow(10, i % N % 3 * 4 - i / N % 3 * 4);
    A[i]         = uniform() + I * uniform();
    scaled[i]    = A[i] * ratio;
  }
  assert_true(mhb_hessenberg_qr_eigenvalues(&qr, N, A, wanted));
  assert_true(mhb_hessenberg_qr_eigenvalues(&qr, N, scaled, own));
  assert_near(farthest(N, own, wanted), 0, 1e-12);
  mhb_hessenberg_qr_destroy(&qr);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lapack_agrees),
                                     cmocka_unit_test(roots_of_one_are_found),
                                     cmocka_unit_test(units_do_not_matter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
