/* Half of a symmetric matrix in blocks of columns: its places, products and updates. */
#include "fem/supernodal/lower_blocks.h"

#include "tests/support/block_grid.h"
#include "tests/support/check.h"

static const int sizes[] = {1, 2, 255, 256, 257, 300, 513};

enum { SIZES = sizeof sizes / sizeof *sizes };

static fem_lower make(int n) {
  const fem_lower Q = {malloc((fem_lower_numbers(n) + 1) * sizeof *Q.at), n, 0};
  assert_non_null(Q.at);
  return Q;
}

/* Q_ij of row i >= j, a number of both. */
static double number(int i, int j) {
  return sin(1.7 * i + 0.3 * j);
}

static void fill(const fem_lower *Q) {
  for (int j = 0; j < Q->n - Q->skip; j++)
    for (int i = j; i < Q->n - Q->skip; i++) fem_lower_column(Q, j)[i] = number(i, j);
}

/* Every entry of the lower triangle has a place of its own, and half of the memory is enough. */
static void entries_have_their_own_places(void **state) {
  (void)state;
  assert_int_equal(fem_lower_numbers(0), 0);
  for (int k = 0; k < SIZES; k++) {
    const int       n     = sizes[k];
    const size_t    all   = fem_lower_numbers(n);
    const fem_lower Q     = make(n);
    char           *taken = calloc(all, 1);
    for (int j = 0; j < n; j++)
      for (int i = j; i < n; i++) {
        const size_t at = (size_t)(&fem_lower_column(&Q, j)[i] - Q.at);
        assert_true(at < all && !taken[at]);
        taken[at] = 1;
      }
    assert_true((double)all <= 0.5 * n * (n + 256.) + 256);
    free(taken);
    free(Q.at);
  }
}

/* A view without the first rows and columns holds the same numbers. */
static void a_view_skips_rows_and_columns(void **state) {
  (void)state;
  const fem_lower Q = make(513);
  fill(&Q);
  for (int skip = 0; skip < 513; skip += 37) {
    const fem_lower view = {Q.at, Q.n, skip};
    for (int j = 0; j < Q.n - skip; j++)
      for (int i = j; i < Q.n - skip; i += 11)
        assert_ptr_equal(&fem_lower_column(&view, j)[i], &fem_lower_column(&Q, j + skip)[i + skip]);
  }
  free(Q.at);
}

/* y = Q x against the sum over all entries. */
static void products_are_those_of_the_full_matrix(void **state) {
  (void)state;
  for (int k = 0; k < SIZES; k++)
    for (int skip = 0; skip < sizes[k]; skip += 1 + sizes[k] / 2) {
      fem_lower Q = make(sizes[k]);
      Q.skip      = skip;
      const int n = Q.n - skip, count = 3;
      uint64_t  seed = 5;
      double   *x = malloc((size_t)(n * count) * 8), *y = malloc((size_t)(n * count) * 8);
      fill(&Q);
      for (int i = 0; i < n * count; i++) x[i] = block_random(&seed);
      fem_lower_multiply(&Q, count, x, y);
      for (int i = 0; i < n; i++)
        for (int c = 0; c < count; c++) {
          double sum = 0;
          for (int j = 0; j < n; j++)
            sum += number(i > j ? i : j, i > j ? j : i) * x[j * count + c];
          assert_near(y[i * count + c], sum, 1e-12);
        }
      free(x);
      free(y);
      free(Q.at);
    }
}

static void check_update(int size, int skip, int k) {
  fem_lower Q    = make(size);
  Q.skip         = skip;
  const int n    = size - skip;
  uint64_t  seed = 19;
  double   *E = malloc((size_t)(k * n) * 8), *Z = malloc((size_t)(k * n) * 8), worst = 0;
  for (int i = 0; i < k * n; i++) {
    E[i] = block_random(&seed);
    Z[i] = block_random(&seed);
  }
  fill(&Q);
  fem_lower_add_products(&Q, k, E, Z);
  for (int j = 0; j < n; j++)
    for (int i = j; i < n; i++) {
      double sum = number(i, j);
      for (int r = 0; r < k; r++)
        sum += (E[r * n + i] * Z[r * n + j] + Z[r * n + i] * E[r * n + j]) / 2;
      worst = fmax(worst, fabs(fem_lower_column(&Q, j)[i] - sum));
    }
  print_message("%d of %d rows, %d products: %.1e\n", n, size, k, worst);
  assert_below(worst, 1e-13);
  free(E);
  free(Z);
  free(Q.at);
}

/* Q += (E^T Z + Z^T E)/2. */
static void updates_are_symmetric_products(void **state) {
  (void)state;
  check_update(1, 0, 5);
  check_update(257, 0, 7);
  check_update(513, 0, 4);
  check_update(513, 200, 4);
  check_update(513, 300, 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(entries_have_their_own_places),
      cmocka_unit_test(a_view_skips_rows_and_columns),
      cmocka_unit_test(products_are_those_of_the_full_matrix),
      cmocka_unit_test(updates_are_symmetric_products),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
