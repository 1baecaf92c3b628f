/* The numbers of a supernodal factor against CHOLMOD's own, on a grid in three dimensions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/panels.h"
#include "modal/noise.h"

enum { SIDE = 9, ORDER = SIDE * SIDE * SIDE };

static int near(int i, int d) {
  static const int stride[3] = {1, SIDE, SIDE * SIDE};
  return i / stride[d] % SIDE + 1 < SIDE ? i + stride[d] : -1;
}

/* Lower triangle: neighbours -1 +- .2, diagonal 7, but for one that is given. */
static cholmod_sparse *grid(uint64_t seed, int odd, double value, cholmod_common *common) {
  cholmod_triplet *T = cholmod_allocate_triplet(ORDER, ORDER, 4 * ORDER, -1, CHOLMOD_REAL, common);
  int             *row = T->i, *column = T->j, n = 0;
  double          *x = T->x;
  for (int i = 0; i < ORDER; i++) {
    row[n] = column[n] = i;
    x[n++]             = i == odd ? value : 7;
    for (int d = 0; d < 3; d++) {
      if (near(i, d) < 0) continue;
      row[n]    = near(i, d);
      column[n] = i;
      x[n++]    = -1 + .2 * modal_noise(seed + 3 * (uint64_t)i + (uint64_t)d);
    }
  }
  T->nnz            = (size_t)n;
  cholmod_sparse *A = cholmod_triplet_to_sparse(T, (size_t)n, common);
  cholmod_free_triplet(&T, common);
  return A;
}

/* In its own order, so that A needs no permutation. */
static cholmod_factor *analyse(cholmod_sparse *A, cholmod_common *common) {
  common->nmethods           = 1;
  common->method[0].ordering = CHOLMOD_NATURAL;
  common->postorder          = 0;
  common->supernodal         = CHOLMOD_SUPERNODAL;
  cholmod_factor *L          = cholmod_analyze(A, common);
  assert_non_null(L);
  assert_true(L->is_super);
  return L;
}

/* Greatest difference of the numbers on and below the diagonal, to the greatest. */
static double difference(const cholmod_factor *a, const cholmod_factor *b) {
  const int *super = a->super, *pi = a->pi, *px = a->px;
  double     worst = 0, greatest = 0;
  for (size_t s = 0; s < a->nsuper; s++) {
    const int columns = super[s + 1] - super[s], rows = pi[s + 1] - pi[s];
    for (int c = 0; c < columns; c++)
      for (int r = c; r < rows; r++) {
        const int at = px[s] + c * rows + r;
        worst        = fmax(worst, fabs(((double *)a->x)[at] - ((double *)b->x)[at]));
        greatest     = fmax(greatest, fabs(((double *)b->x)[at]));
      }
  }
  return worst / greatest;
}

/* Filled, and filled again with other values of the same pattern, also after a matrix that had no factor. */
static void numbers_are_cholmods(void **state) {
  (void)state;
  cholmod_common common;
  bool           definite;
  cholmod_start(&common);
  common.print          = 0;
  cholmod_sparse *first = grid(1, -1, 0, &common), *bad = grid(2, ORDER - 40, -3, &common);
  cholmod_sparse *second = grid(3, -1, 0, &common);
  cholmod_factor *own = analyse(first, &common), *theirs = analyse(first, &common);
  assert_true(own->nsuper > 20);
  assert_true(fem_panels_fill(own, first, &definite, &common) && definite);
  assert_true(cholmod_factorize(first, theirs, &common));
  assert_true(difference(own, theirs) < 1e-14);
  assert_true(fem_panels_fill(own, bad, &definite, &common));
  assert_false(definite);
  assert_true(fem_panels_fill(own, second, &definite, &common) && definite);
  assert_true(difference(own, theirs) > 1e-3);
  assert_true(cholmod_factorize(second, theirs, &common));
  assert_true(difference(own, theirs) < 1e-14);
  cholmod_free_factor(&own, &common);
  cholmod_free_factor(&theirs, &common);
  cholmod_free_sparse(&first, &common);
  cholmod_free_sparse(&bad, &common);
  cholmod_free_sparse(&second, &common);
  cholmod_finish(&common);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_cholmods)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
