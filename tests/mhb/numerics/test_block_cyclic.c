/* The block-cyclic solver against a dense one, with and without a border. */
#include <lapacke.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/numerics/block_cyclic.h"
#include "mhb/numerics/random.h"
#include "tests/support/check.h"

enum { MOST = 3 * 45 + 1 };

/* Random blocks; the dense matrix A[n][n] column-major of the same system. */
static void fill(mhb_block_cyclic *f, int borders, unsigned long long seed, double *A) {
  const int    N = f->blocks, s = f->size, n = N * s + borders;
  const double diagonal = s > 4 ? s : 2;
  memset(A, 0, sizeof *A * (size_t)(n * n));
  mhb_block_cyclic_clear(f);
  for (int b = 0; b < N; b++) {
    const int column[] = {(b + N - 1) % N, b, (b + 1) % N};
    for (int which = 0; which < 3; which++) {
      const mhb_cyclic_block block = mhb_block_cyclic_at(f, (mhb_block_place)which, b);
      for (int j = 0; j < s; j++)
        for (int i = 0; i < s; i++) {
          const double x = mhb_random(&seed) + (which == 1 && i == j ? diagonal : 0);
          block.at[i * block.stride + j] += x;
          A[(column[which] * s + j) * n + b * s + i] += x;
        }
    }
  }
  for (int i = 0; i < N * s && borders; i++) {
    f->column[i] = A[(n - 1) * n + i] = mhb_random(&seed);
    f->row[i] = A[i * n + n - 1] = mhb_random(&seed);
  }
  if (borders) f->corner = A[n * n - 1] = 0.3;
}

/* x[n] <- the dense solution; returns the sign of the determinant. */
static int solve_dense(int n, double *A, double *x) {
  int pivot[MOST], sign = 1;
  assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, A, n, pivot, x, n), 0);
  for (int i = 0; i < n; i++) {
    if (A[i * n + i] < 0) sign = -sign;
    if (pivot[i] != i + 1) sign = -sign;
  }
  return sign;
}

static void compare(int N, int s, int borders, unsigned long long seed) {
  mhb_block_cyclic *f = mhb_block_cyclic_create(N, s);
  double            A[MOST * MOST], x[MOST], y[MOST];
  const int         n = N * s + borders;
  fill(f, borders, seed, A);
  for (int i = 0; i < n; i++) x[i] = y[i] = mhb_random(&seed);
  assert_true(mhb_block_cyclic_factor(f, borders));
  mhb_block_cyclic_solve(f, x);
  assert_int_equal(f->sign, solve_dense(n, A, y));
  for (int i = 0; i < n; i++) assert_near(x[i], y[i], 1e-11);
  mhb_block_cyclic_destroy(f);
}

static void is_the_dense_solution(void **state) {
  (void)state;
  for (unsigned long long seed = 1; seed <= 5; seed++)
    for (int borders = 0; borders < 2; borders++) {
      compare(1, 4, borders, 7 * seed);
      compare(2, 3, borders, seed);
      compare(3, 4, borders, 31 * seed);
      compare(7, 4, borders, 57 * seed);
      compare(7, 1, borders, 91 * seed);
      compare(4, 17, borders, 11 * seed);
      compare(3, 45, borders, 5 * seed);
    }
}

/* To the diagonal of a block. */
static void add(mhb_block_cyclic *f, mhb_block_place which, int b, int i, double x) {
  const mhb_cyclic_block block = mhb_block_cyclic_at(f, which, b);
  block.at[i * (block.stride + 1)] += x;
}

/* Every row of blocks sums to 0: constant vectors solve it, as at a fold. */
static void border_makes_it_regular(void **state) {
  enum { N = 6, S = 2 };
  mhb_block_cyclic *f;
  double            x[N * S + 1];
  (void)state;
  f = mhb_block_cyclic_create(N, S);
  for (int b = 0; b < N; b++)
    for (int i = 0; i < S; i++) {
      add(f, MHB_BLOCK_OWN, b, i, 2);
      add(f, MHB_BLOCK_BEFORE, b, i, -1);
      add(f, MHB_BLOCK_AFTER, b, i, i ? -0.5 : -1);
    }
  for (int b = 0; b < N; b++) f->column[b * S] = f->row[b * S] = 1;
  memset(x, 0, sizeof x);
  x[N * S] = 3; /* the sum of the singular part */
  assert_true(mhb_block_cyclic_factor(f, 1));
  mhb_block_cyclic_solve(f, x);
  for (int b = 0; b < N; b++) {
    assert_near(x[b * S], 0.5, 1e-14);
    assert_near(x[b * S + 1], 0, 1e-14);
  }
  assert_near(x[N * S], 0, 1e-14);
  mhb_block_cyclic_destroy(f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(is_the_dense_solution),
                                     cmocka_unit_test(border_makes_it_regular)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
