/* Products of tall blocks: plain sums, remainders of rows and columns, any number of threads. */
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "modal/common/random_vector.h"
#include "modal/eigen/block_products.h"
#include "tests/support/fem.h"

enum { MOST_ROWS = 9001, MOST_COLUMNS = 9, MOST_BLOCKS = 3 };

static double Q[MOST_BLOCKS][MOST_ROWS * MOST_COLUMNS], Y[MOST_ROWS * MOST_COLUMNS];
static double W[MOST_ROWS * MOST_COLUMNS], first_w[MOST_ROWS * MOST_COLUMNS];
static double C[MOST_BLOCKS * MOST_COLUMNS * MOST_COLUMNS];
static double first_c[MOST_BLOCKS * MOST_COLUMNS * MOST_COLUMNS];

static void fill(double *x, size_t n, uint64_t seed) {
  for (size_t i = 0; i < n; i++) x[i] = modal_random(seed * 1000003 + i);
}

/* Largest difference of C from plain sums, per sum of rows. */
static double inner_error(size_t rows, size_t p, size_t n) {
  double worst = 0;
  for (size_t k = 0; k < n; k++)
    for (size_t c = 0; c < p; c++)
      for (size_t a = 0; a < p; a++) {
        double sum = 0;
        for (size_t i = 0; i < rows; i++) sum += Q[k][a * rows + i] * Y[c * rows + i];
        worst = fmax(worst, fabs(sum - C[(k * p + c) * p + a]) / (double)(rows + 1));
      }
  return worst;
}

/* Largest difference of W from Y - sum of Q_k C_k. */
static double subtract_error(size_t rows, size_t p, size_t n) {
  double worst = 0;
  for (size_t c = 0; c < p; c++)
    for (size_t i = 0; i < rows; i++) {
      double w = Y[c * rows + i], size = fabs(w);
      for (size_t k = 0; k < n; k++)
        for (size_t a = 0; a < p; a++) {
          w -= Q[k][a * rows + i] * C[(k * p + c) * p + a];
          size += fabs(Q[k][a * rows + i] * C[(k * p + c) * p + a]);
        }
      worst = fmax(worst, fabs(w - W[c * rows + i]) / size);
    }
  return worst;
}

static void check_case(size_t rows, size_t p, size_t n) {
  double *blocks[MOST_BLOCKS] = {Q[0], Q[1], Q[2]};
  for (size_t k = 0; k < n; k++) fill(Q[k], rows * p, k + 1);
  fill(Y, rows * p, 9);
  for (int threads = 1; threads <= 3; threads++) {
    omp_set_num_threads(threads);
    memcpy(W, Y, rows * p * sizeof *W);
    modal_block_inner(rows, p, n, blocks, Y, C);
    modal_block_subtract(rows, p, n, blocks, C, W);
    if (threads == 1) {
      memcpy(first_c, C, n * p * p * sizeof *C);
      memcpy(first_w, W, rows * p * sizeof *W);
      check_below(inner_error(rows, p, n), 1e-15, "inner products");
      check_below(subtract_error(rows, p, n), 1e-14, "differences");
    } else if (rows * n > 0) {
      assert_memory_equal(first_c, C, n * p * p * sizeof *C);
      assert_memory_equal(first_w, W, rows * p * sizeof *W);
    }
  }
}

static void products_are_sums(void **state) {
  (void)state;
  const int    most   = omp_get_max_threads();
  const size_t rows[] = {0, 1, 7, 256, 261, MOST_ROWS};
  for (size_t r = 0; r < 6; r++)
    for (size_t p = 1; p <= MOST_COLUMNS; p += p < 5 ? 1 : 4)
      for (size_t n = 0; n <= MOST_BLOCKS; n++) check_case(rows[r], p, n);
  omp_set_num_threads(most);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(products_are_sums)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
