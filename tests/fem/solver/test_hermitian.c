/* The complex Hermitian factor: solutions of a banded matrix, several factors of one analysis, a
 * matrix that is not positive definite. */
#include "fem/solver/hermitian.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/support/check.h"

enum { N = 40, BAND = 5, ORDER = 3 * N, MOST = 9 };

/* A matrix of N block rows, each coupled to the BAND next ones. */
typedef struct {
  int            start[N + 1], column[N * (BAND + 1)];
  double complex value[N * (BAND + 1)][9];
} matrix;

static double complex random_number(uint64_t *state) {
  double part[2];
  for (int i = 0; i < 2; i++) {
    *state  = *state * 6364136223846793005u + 1442695040888963407u;
    part[i] = (double)(*state >> 11) * 0x1p-52 - 1;
  }
  return CMPLX(part[0], part[1]);
}

/* Random and Hermitian; the diagonal makes it positive definite where it is above about 30. */
static void make(double diagonal, uint64_t seed, matrix *A) {
  int n = 0;
  for (int r = 0; r < N; r++) {
    A->start[r] = n;
    for (int c = r; c < N && c <= r + BAND; c++, n++) {
      A->column[n] = c;
      for (int i = 0; i < 9; i++) A->value[n][i] = random_number(&seed);
      for (int d = 0; d < 3 && c == r; d++)
        for (int e = 0; e <= d; e++)
          A->value[n][d + 3 * e] = d == e ? diagonal : conj(A->value[n][e + 3 * d]);
    }
  }
  A->start[N] = n;
}

/* y = A x */
static void multiply(const matrix *A, const double complex *x, double complex *y) {
  for (int i = 0; i < ORDER; i++) y[i] = 0;
  for (int r = 0; r < N; r++)
    for (int q = A->start[r]; q < A->start[r + 1]; q++)
      for (int i = 0; i < 9; i++) {
        const int            row = 3 * r + i % 3, column = 3 * A->column[q] + i / 3;
        const double complex a = A->value[q][i];
        y[row] += a * x[column];
        if (A->column[q] != r) y[column] += conj(a) * x[row];
      }
}

/* Greatest |A x - b| of count columns. */
static double residual(const matrix *A, fem_hermitian *factor, int count) {
  static double complex b[MOST * ORDER], x[MOST * ORDER], y[ORDER];
  uint64_t              seed  = 3;
  double                worst = 0;
  for (int i = 0; i < count * ORDER; i++) b[i] = random_number(&seed);
  fem_hermitian_solve(factor, count, b, x);
  for (int c = 0; c < count; c++) {
    multiply(A, x + (size_t)c * ORDER, y);
    for (int i = 0; i < ORDER; i++) worst = fmax(worst, cabs(y[i] - b[c * ORDER + i]));
  }
  return worst;
}

/* All blocks are complex ones. */
static fem_hermitian_matrix any_blocks(const matrix *A) {
  static const double none[N * (BAND + 1)][9];
  static int          coupled[N * (BAND + 1)];
  static signed char  exponent[N * (BAND + 1)];
  for (int q = 0; q < A->start[N]; q++) {
    coupled[q]  = q;
    exponent[q] = FEM_ANY_BLOCK;
  }
  return (fem_hermitian_matrix){{N, A->start, A->column}, none[0], A->start[N], coupled, exponent};
}

static const double complex turn = 0.8 + 0.6 * I;

static void solutions_of_one_analysis(void **state) {
  (void)state;
  static matrix        A[2];
  fem_hermitian_order *order;
  fem_hermitian       *factor[2];
  make(40, 1, &A[0]);
  make(57, 2, &A[1]);
  const fem_hermitian_matrix any = any_blocks(&A[0]);
  assert_ok(fem_hermitian_analyse(&any, &order));
  assert_true(fem_hermitian_bytes(order) > 16. * ORDER);
  for (int k = 0; k < 2; k++) {
    factor[k] = fem_hermitian_create(order, turn, A[k].value);
    assert_non_null(factor[k]);
  }
  for (int k = 0; k < 2; k++)
    for (int count = 1; count <= MOST; count += 2)
      assert_near(residual(&A[k], factor[k], count), 0, 1e-13);
  fem_hermitian_free(factor[0]);
  fem_hermitian_free(factor[1]);
  fem_hermitian_order_free(order);
}

static void a_solution_in_place(void **state) {
  (void)state;
  static matrix         A;
  static double complex b[ORDER], x[ORDER];
  fem_hermitian_order  *order;
  uint64_t              seed = 8;
  make(40, 5, &A);
  const fem_hermitian_matrix any = any_blocks(&A);
  assert_ok(fem_hermitian_analyse(&any, &order));
  fem_hermitian *factor = fem_hermitian_create(order, turn, A.value);
  for (int i = 0; i < ORDER; i++) b[i] = random_number(&seed);
  fem_hermitian_solve(factor, 1, b, x);
  fem_hermitian_solve(factor, 1, b, b);
  for (int i = 0; i < ORDER; i++) assert_true(b[i] == x[i]);
  fem_hermitian_free(factor);
  fem_hermitian_order_free(order);
}

static void an_indefinite_matrix(void **state) {
  (void)state;
  static matrix        A;
  fem_hermitian_order *order;
  make(2, 1, &A);
  const fem_hermitian_matrix any = any_blocks(&A);
  assert_ok(fem_hermitian_analyse(&any, &order));
  assert_null(fem_hermitian_create(order, turn, A.value));
  fem_hermitian_order_free(order);
  fem_hermitian_free(NULL);
  fem_hermitian_order_free(NULL);
}

/* ------------------------------------------------------------------ blocks with phases */

/* A real matrix some of whose blocks carry phases. */
typedef struct {
  matrix      A;
  double      real[N * (BAND + 1)][9];
  int         coupled[N * (BAND + 1)], n;
  signed char exponent[N * (BAND + 1)];
} links;

/* Blocks from below node cut to cut and beyond carry e^(j theta e). Those from below node other
 * carry e^(-j theta e), where other > 0. */
static void make_links(int cut, int e, int other, links *l) {
  make(40, 11, &l->A);
  l->n = 0;
  for (int r = 0; r < N; r++)
    for (int q = l->A.start[r]; q < l->A.start[r + 1]; q++) {
      const int c = l->A.column[q], first = r < cut && c >= cut, second = r < other && c >= other;
      for (int i = 0; i < 9; i++) l->real[q][i] = creal(l->A.value[q][i]);
      for (int d = 0; d < 3 && c == r; d++)
        for (int k = 0; k < d; k++) l->real[q][d + 3 * k] = l->real[q][k + 3 * d];
      if (!first && !second) continue;
      l->coupled[l->n]    = q;
      l->exponent[l->n++] = (signed char)(e * (first - second));
    }
}

static void set_phases(links *l, double complex at, double complex (*value)[9]) {
  int k = 0;
  for (int q = 0; q < l->A.start[N]; q++) {
    const bool           linked = k < l->n && l->coupled[k] == q;
    const int            e      = linked ? l->exponent[k] : 0;
    const double complex by     = e == 0 ? 1 : e > 0 ? at : conj(at);
    for (int i = 0; i < 9; i++) l->A.value[q][i] = by * l->real[q][i];
    if (linked) memcpy(value[k++], l->A.value[q], sizeof *value);
  }
}

/* Solutions at several theta of one analysis.
 *   returns bytes of a factor */
static double check_links(links *l) {
  static double complex      value[N * (BAND + 1)][9];
  const fem_hermitian_matrix A = {
      {N, l->A.start, l->A.column}, l->real[0], l->n, l->coupled, l->exponent};
  fem_hermitian_order *order;
  assert_ok(fem_hermitian_analyse(&A, &order));
  for (int k = 0; k < 4; k++) {
    const double complex at = cexp(I * 1.1 * k);
    set_phases(l, at, value);
    fem_hermitian *factor = fem_hermitian_create(order, at, (const double complex(*)[9])value);
    assert_non_null(factor);
    for (int count = 1; count <= MOST; count += 2)
      assert_near(residual(&l->A, factor, count), 0, 1e-13);
    fem_hermitian_free(factor);
  }
  const double bytes = fem_hermitian_bytes(order);
  fem_hermitian_order_free(order);
  return bytes;
}

/* A chain of nodes closes no loop: phases only turn the shapes, and all panels are real. */
static void phases_along_a_chain_are_free(void **state) {
  (void)state;
  static links l;
  make_links(17, 0, 0, &l);
  const double none = check_links(&l);
  make_links(17, 1, 0, &l);
  assert_near(check_links(&l), none, 0);
  make_links(23, -1, 11, &l);
  assert_near(check_links(&l), none, 0);
}

/* One block with another phase than its neighbours closes loops: panels above it are complex. */
static void a_loop_with_a_phase_is_complex(void **state) {
  (void)state;
  static links l;
  make_links(17, 0, 0, &l);
  const double none = check_links(&l);
  make_links(17, 1, 0, &l);
  for (int k = 1; k < l.n; k += 2) l.exponent[k] = 0;
  const double some = check_links(&l);
  assert_true(some > none);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solutions_of_one_analysis), cmocka_unit_test(a_solution_in_place),
      cmocka_unit_test(an_indefinite_matrix), cmocka_unit_test(phases_along_a_chain_are_free),
      cmocka_unit_test(a_loop_with_a_phase_is_complex)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
