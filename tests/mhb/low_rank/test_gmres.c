/* GMRES on systems whose Krylov spaces are known, and against least squares. */
#include "mhb/low_rank/gmres.h"

#include <cblas.h>
#include <lapacke.h>

#include "tests/support/check.h"

enum { MOST = 24 };

/* A, [n][n] row-major, and the preconditioner: z = scale[turn mod 3] v, or by the inverse of a
 * matrix. */
typedef struct {
  int           n, calls, fails_at;
  double        a[MOST * MOST];
  const double *inverse; /* [n][n] of a preconditioner; NULL: by the scales */
  double        scale[3];
} matrix;

static int apply(void *context, const double *v, double *z, double *Az) {
  matrix      *m = context;
  const double s = m->scale[m->calls % 3];
  if (++m->calls == m->fails_at) return 0;
  for (int i = 0; i < m->n; i++) {
    z[i] = m->inverse ? 0 : s * v[i];
    for (int j = 0; m->inverse && j < m->n; j++) z[i] += m->inverse[i * m->n + j] * v[j];
  }
  cblas_dgemv(CblasRowMajor, CblasNoTrans, m->n, m->n, 1, m->a, m->n, z, 1, 0, Az, 1);
  return 1;
}

static matrix zero(int n) {
  return (matrix){.n = n, .scale = {1, 1, 1}};
}

static double random_number(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-52 - 1;
}

static matrix random_matrix(int n, double diagonal) {
  matrix   m    = zero(n);
  uint64_t seed = 11;
  for (int i = 0; i < n * n; i++) m.a[i] = random_number(&seed) + (i % (n + 1) == 0) * diagonal;
  return m;
}

/* Solve A x = b, b_i = 1 + i/3, by at most so many iterations. The residual of the recurrence must
 * be that of x. */
static int solve(matrix *m, int most, double tolerance, mhb_gmres **g, double *x) {
  double b[MOST], r[MOST];
  *g = mhb_gmres_create(MOST, most);
  for (int i = 0; i < m->n; i++) b[i] = r[i] = 1 + i / 3.;
  m->calls       = 0;
  const int done = mhb_gmres_solve(*g, m->n, apply, m, b, tolerance, x);
  cblas_dgemv(CblasRowMajor, CblasNoTrans, m->n, m->n, -1, m->a, m->n, x, 1, 1, r, 1);
  assert_near((*g)->residual, cblas_dnrm2(m->n, r, 1) / cblas_dnrm2(m->n, b, 1), 1e-12);
  return done;
}

static void the_identity_takes_one_iteration(void **state) {
  (void)state;
  matrix     m = zero(7);
  mhb_gmres *g;
  double     x[MOST];
  for (int i = 0; i < 7; i++) m.a[8 * i] = 1;
  assert_int_equal(solve(&m, 5, 1e-12, &g, x), 1);
  assert_int_equal(g->iterations, 1);
  for (int i = 0; i < 7; i++) assert_near(x[i], 1 + i / 3., 1e-15);
  mhb_gmres_destroy(g);
}

/* The shift x_i -> x_(i+1) around a ring: nothing is gained before the n-th step from a unit
 * vector, and the solution is exact then. */
static void a_shift_takes_n_iterations(void **state) {
  (void)state;
  enum { N = 9 };
  double x[N], b[N] = {2.385};
  matrix m = zero(N);
  for (int i = 0; i < N; i++) m.a[i * N + (i + N - 1) % N] = 1;
  for (int most = 1; most <= N; most++) {
    mhb_gmres *g    = mhb_gmres_create(N, most);
    const int  done = mhb_gmres_solve(g, N, apply, &m, b, 1e-12, x);
    assert_int_equal(done, most == N);
    assert_int_equal(g->iterations, most);
    assert_near(g->residual, most < N, 1e-15);
    for (int i = 0; i < N; i++) assert_near(x[i], done && i == N - 1 ? 2.385 : 0, 1e-14);
    mhb_gmres_destroy(g);
  }
}

/* As many iterations as there are different eigenvalues. */
static void few_eigenvalues_take_few_iterations(void **state) {
  (void)state;
  for (int kinds = 1; kinds <= 5; kinds++) {
    matrix     m = zero(15);
    mhb_gmres *g;
    double     x[MOST];
    for (int i = 0; i < m.n; i++) m.a[i * (m.n + 1)] = 0.7 + 1.1 * (i % kinds);
    assert_int_equal(solve(&m, 10, 1e-13, &g, x), 1);
    assert_int_equal(g->iterations, kinds);
    for (int i = 0; i < m.n; i++)
      assert_near(x[i], (1 + i / 3.) / (0.7 + 1.1 * (i % kinds)), 1e-12);
    mhb_gmres_destroy(g);
  }
}

/* At each number of iterations the residual is the least in the Krylov space. */
static void the_residual_is_the_least(void **state) {
  (void)state;
  enum { N = 12 };
  matrix m = random_matrix(N, 2);
  for (int most = 1; most < N; most++) {
    mhb_gmres *g;
    double     x[MOST], K[N * N], r[N]; /* K: columns A b, A^2 b, ..., each of unit length */
    for (int i = 0; i < N; i++) r[i] = 1 + i / 3.;
    for (int k = 0; k < most; k++) {
      const double *from = k > 0 ? K + (k - 1) * N : r;
      cblas_dgemv(CblasRowMajor, CblasNoTrans, N, N, 1, m.a, N, from, 1, 0, K + k * N, 1);
      cblas_dscal(N, 1 / cblas_dnrm2(N, K + k * N, 1), K + k * N, 1);
    }
    const double size = cblas_dnrm2(N, r, 1);
    assert_int_equal(LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', N, most, 1, K, N, r, N), 0);
    assert_int_equal(solve(&m, most, 1e-14, &g, x), 0);
    assert_int_equal(g->iterations, most);
    assert_near(g->residual, cblas_dnrm2(N - most, r + most, 1) / size, 1e-9);
    mhb_gmres_destroy(g);
  }
}

/* A full space gives the solution of LAPACK; the vectors are orthonormal, and A Z = V H. */
static void it_is_exact_in_n_steps(void **state) {
  (void)state;
  enum { N = 20 };
  matrix     m = random_matrix(N, 0.3), copy = m;
  mhb_gmres *g;
  double     x[MOST], exact[N];
  int        pivot[N];
  for (int i = 0; i < N; i++) exact[i] = 1 + i / 3.;
  assert_int_equal(LAPACKE_dgesv(LAPACK_ROW_MAJOR, N, 1, copy.a, N, pivot, exact, 1), 0);
  assert_int_equal(solve(&m, N, 1e-12, &g, x), 1);
  assert_int_equal(g->iterations, N);
  for (int i = 0; i < N; i++) assert_near(x[i], exact[i], 1e-10);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      assert_near(cblas_ddot(N, g->V + i * N, 1, g->V + j * N, 1), i == j, 1e-14);
  for (int j = 0; j < N - 1; j++)
    for (int i = 0; i < N; i++) {
      double sum = -cblas_ddot(N, m.a + i * N, 1, g->Z + j * N, 1);
      for (int k = 0; k <= j + 1; k++) sum += g->V[k * N + i] * g->H[j * (N + 1) + k];
      assert_small(sum, 1e-13);
    }
  mhb_gmres_destroy(g);
}

/* The preconditioner may change from step to step; its own inverse takes one. */
static void preconditioners_may_change(void **state) {
  (void)state;
  enum { N = 10 };
  matrix     m = random_matrix(N, 3), inverse = m;
  mhb_gmres *g;
  double     x[MOST], plain[MOST];
  int        pivot[N];
  assert_int_equal(solve(&m, N, 1e-12, &g, plain), 1);
  mhb_gmres_destroy(g);
  m.scale[0] = 0.5, m.scale[1] = -3, m.scale[2] = 40;
  assert_int_equal(solve(&m, N, 1e-12, &g, x), 1);
  for (int i = 0; i < N; i++) assert_near(x[i], plain[i], 1e-11);
  mhb_gmres_destroy(g);
  assert_int_equal(LAPACKE_dgetrf(LAPACK_ROW_MAJOR, N, N, inverse.a, N, pivot), 0);
  assert_int_equal(LAPACKE_dgetri(LAPACK_ROW_MAJOR, N, inverse.a, N, pivot), 0);
  m.inverse = inverse.a;
  assert_int_equal(solve(&m, N, 1e-12, &g, x), 1);
  assert_int_equal(g->iterations, 1);
  for (int i = 0; i < N; i++) assert_near(x[i], plain[i], 1e-11);
  mhb_gmres_destroy(g);
}

/* diag(2, 0): no x reaches the second row. The space ends, and the residual is that row's. */
static void a_singular_matrix_is_told(void **state) {
  (void)state;
  matrix     m = zero(2);
  mhb_gmres *g;
  double     x[MOST];
  m.a[0] = 2;
  assert_int_equal(solve(&m, 6, 1e-12, &g, x), 0);
  assert_int_equal(g->iterations, 2);
  assert_near(g->residual, 0.8, 1e-15); /* b = (1, 4/3) */
  assert_near(x[0], 0.5, 1e-15);
  mhb_gmres_destroy(g);
  m.a[0] = 0; /* nothing at all */
  assert_int_equal(solve(&m, 6, 1e-12, &g, x), 0);
  assert_near(g->residual, 1, 0);
  assert_true(x[0] == 0 && x[1] == 0);
  mhb_gmres_destroy(g);
}

/* Of a random matrix one row is the sum of two others, but not of b. */
static void a_dependent_row_is_told(void **state) {
  (void)state;
  matrix     m = random_matrix(9, 2);
  mhb_gmres *g;
  double     x[MOST];
  for (int j = 0; j < 9; j++) m.a[4 * 9 + j] = m.a[j] + m.a[2 * 9 + j];
  assert_int_equal(solve(&m, MOST, 1e-10, &g, x), 0);
  print_message("%d iterations, residual %.3f\n", g->iterations, g->residual);
  assert_true(g->residual > 1e-2);
  mhb_gmres_destroy(g);
}

static void special_right_hand_sides(void **state) {
  (void)state;
  matrix     m    = random_matrix(4, 3);
  mhb_gmres *g    = mhb_gmres_create(MOST, 6);
  double     x[4] = {7, 7, 7, 7}, b[4] = {0};
  assert_int_equal(mhb_gmres_solve(g, 4, apply, &m, b, 1e-12, x), 1);
  assert_int_equal(g->iterations, 0);
  assert_int_equal(m.calls, 0);
  for (int i = 0; i < 4; i++) assert_true(x[i] == 0);
  assert_int_equal(mhb_gmres_negative(g), 0);
  b[2] = NAN;
  assert_int_equal(mhb_gmres_solve(g, 4, apply, &m, b, 1e-12, x), 0);
  b[2]       = 1;
  m.fails_at = 2;
  assert_int_equal(mhb_gmres_solve(g, 4, apply, &m, b, 1e-12, x), 0);
  m.fails_at = 0;
  m.a[5]     = INFINITY;
  assert_int_equal(mhb_gmres_solve(g, 4, apply, &m, b, 1e-12, x), 0);
  mhb_gmres_destroy(g);
  mhb_gmres_destroy(NULL);
}

/* Negative eigenvalues are counted; pairs of complex ones with a negative real part are not. */
static void negative_eigenvalues_are_counted(void **state) {
  (void)state;
  for (int negative = 0; negative <= 5; negative++) {
    matrix     m = zero(8);
    mhb_gmres *g;
    double     x[MOST];
    for (int i = 0; i < 6; i++) m.a[9 * i] = (i < negative ? -1 : 1) * (1 + 0.37 * i);
    m.a[54] = m.a[63] = -1; /* -1 +- 2j */
    m.a[55] = 2, m.a[62] = -2;
    assert_int_equal(solve(&m, 8, 1e-13, &g, x), 1);
    assert_int_equal(g->iterations, 8);
    assert_int_equal(mhb_gmres_negative(g), negative);
    mhb_gmres_destroy(g);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_identity_takes_one_iteration),
      cmocka_unit_test(a_shift_takes_n_iterations),
      cmocka_unit_test(few_eigenvalues_take_few_iterations),
      cmocka_unit_test(the_residual_is_the_least),
      cmocka_unit_test(it_is_exact_in_n_steps),
      cmocka_unit_test(preconditioners_may_change),
      cmocka_unit_test(a_singular_matrix_is_told),
      cmocka_unit_test(a_dependent_row_is_told),
      cmocka_unit_test(special_right_hand_sides),
      cmocka_unit_test(negative_eigenvalues_are_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
