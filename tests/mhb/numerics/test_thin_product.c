/* Products of a matrix with a few columns: against sums, all remainders of rows and groups. */
#include <string.h>

#include "mhb/numerics/thin_product.h"
#include "tests/support/check.h"

enum { MOST = 27, MOST_COLUMNS = 29, ROOM = MOST * 2 * MHB_THIN_COLUMNS_SINGLE };

static unsigned long long seed = 5;

static double uniform(void) {
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(seed >> 11) / 4503599627370496. - 1;
}

static size_t place(int n, int width, int i, int j) {
  return (size_t)(j / width * n + i) * (size_t)width + (size_t)(j % width);
}

/* Largest error of a product of both precisions; b[n][columns]. */
static void compare(int n, int columns, double worst[2]) {
  static double A[MOST * MOST], b[MOST * MOST_COLUMNS], x[ROOM], y[ROOM];
  static float  single[MOST * MOST], x_single[ROOM], y_single[ROOM];
  const int     wide = MHB_THIN_COLUMNS, wider = MHB_THIN_COLUMNS_SINGLE;
  for (int i = 0; i < n * n; i++) single[i] = (float)(A[i] = uniform());
  memset(x, 0, sizeof x);
  memset(x_single, 0, sizeof x_single);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) {
      b[i * columns + j]              = uniform();
      x[place(n, wide, i, j)]         = b[i * columns + j];
      x_single[place(n, wider, i, j)] = (float)b[i * columns + j];
    }
  mhb_thin_product(n, mhb_thin_groups(columns, wide), A, x, y);
  mhb_thin_product_single(n, mhb_thin_groups(columns, wider), single, x_single, y_single);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < columns; j++) {
      double sum = 0;
      for (int l = 0; l < n; l++) sum += A[i * n + l] * b[l * columns + j];
      worst[0] = fmax(worst[0], fabs(y[place(n, wide, i, j)] - sum));
      worst[1] = fmax(worst[1], fabs(y_single[place(n, wider, i, j)] - sum));
    }
}

static void products_are_sums(void **state) {
  (void)state;
  static const int columns[] = {1, 3, 8, 15, 16, 17, 29};
  double           worst[2]  = {0};
  for (int n = 1; n <= MOST; n++)
    for (int c = 0; c < 7; c++) compare(n, columns[c], worst);
  print_message("error %.1e, single precision %.1e\n", worst[0], worst[1]);
  assert_true(worst[0] < 1e-14);
  assert_true(worst[1] < 1e-5);
  assert_true(worst[1] > 1e-9); /* it is single precision */
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(products_are_sums)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
