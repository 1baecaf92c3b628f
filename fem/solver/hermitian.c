#include "fem/solver/hermitian.h"

#include <stdlib.h>
#include <string.h>

struct fem_hermitian_order {
  fem_blocks      pattern;
  int            *place; /* [n] index of a block row in the factor */
  cholmod_factor *L;     /* symbolic */
  cholmod_common  common;
};

struct fem_hermitian {
  const fem_hermitian_order *order;
  cholmod_factor            *L;
  cholmod_dense             *x, *work; /* right-hand sides in the factor's order, of x->ncol */
  cholmod_common             common;
};

/* The permuted lower triangle: its rows below each column start, and its values by CHOLMOD's
 * column. */
typedef struct {
  int            *start, *row;
  double complex *value; /* NULL: the pattern alone */
} triangle;

static void put_diagonal(const double complex *B, int c, const triangle *t) {
  for (int d = 0; d < 3; d++)
    for (int e = d; e < 3; e++) {
      const int at = t->start[3 * c + d] + e - d;
      t->row[at]   = 3 * c + e;
      if (t->value) t->value[at] = conj(B[d + 3 * e]);
    }
}

/* Put a block of rows low and columns high, or its conjugate transpose, as the slot-th block below
 * the diagonal of column low. */
static void put_block(const double complex *B, bool turned, int low, int high, int slot,
                      const triangle *t) {
  for (int d = 0; d < 3; d++) {
    const int at = t->start[3 * low + d] + 3 - d + 3 * slot;
    for (int e = 0; e < 3; e++) {
      t->row[at + e] = 3 * high + e;
      if (t->value) t->value[at + e] = turned ? B[e + 3 * d] : conj(B[d + 3 * e]);
    }
  }
}

/* The permuted lower triangle; NULL when out of memory.
 *   value  in  [block][9]; NULL: the pattern alone */
static cholmod_sparse *permute(const fem_blocks *b, const int *place, const double complex *value,
                               cholmod_common *common) {
  static const double complex none[9];
  const size_t                n = (size_t)b->n, entries = 9 * (size_t)b->start[n] - 3 * n;
  cholmod_sparse             *A    = cholmod_allocate_sparse(3 * n, 3 * n, entries, 0, 1, -1,
                                              value ? CHOLMOD_COMPLEX : CHOLMOD_PATTERN, common);
  int                        *next = calloc(n + 1, sizeof *next);
  if (A && next) {
    const triangle t = {A->p, A->i, value ? A->x : NULL};
    fem_block_starts(b, place, next, t.start);
    for (int r = 0; r < b->n; r++)
      for (int q = b->start[r]; q < b->start[r + 1]; q++) {
        const int             here = place[r], there = place[b->column[q]];
        const double complex *block = value ? value + 9 * (size_t)q : none;
        if (here == there)
          put_diagonal(block, here, &t);
        else if (here < there)
          put_block(block, false, here, there, next[here]++, &t);
        else
          put_block(block, true, there, here, next[there]++, &t);
      }
  } else
    cholmod_free_sparse(&A, common);
  free(next);
  return A;
}

shb_status fem_hermitian_analyse(const fem_blocks *pattern, fem_hermitian_order **out) {
  fem_hermitian_order *order = calloc(1, sizeof *order);
  *out                       = order;
  SHB_CHECK(order, SHB_ERR_IO, "out of memory for a factor");
  fem_cholmod_start(&order->common);
  order->pattern = *pattern;
  order->place   = malloc(((size_t)pattern->n + 1) * sizeof *order->place);
  if (order->place && fem_block_order(pattern, &order->common, order->place)) {
    cholmod_sparse *A = permute(pattern, order->place, NULL, &order->common);
    if (A) order->L = fem_cholmod_analyse(A, &order->common);
    cholmod_free_sparse(&A, &order->common);
  }
  if (order->L) return SHB_OK;
  const bool too_large = order->common.status == CHOLMOD_TOO_LARGE;
  fem_hermitian_order_free(order);
  *out = NULL;
  SHB_CHECK(!too_large, SHB_ERR_INPUT,
            "the factor of %d nodes has 2^31 entries or more; make a coarser mesh", pattern->n);
  SHB_FAIL(SHB_ERR_IO, "out of memory for the factor of %d nodes", pattern->n);
}

void fem_hermitian_order_free(fem_hermitian_order *order) {
  if (!order) return;
  cholmod_free_factor(&order->L, &order->common);
  cholmod_finish(&order->common);
  free(order->place);
  free(order);
}

double fem_hermitian_bytes(const fem_hermitian_order *order) {
  const cholmod_factor *L = order->L;
  return 16. * (double)L->xsize + 4. * (double)L->ssize + 16. * (double)L->maxcsize +
         20. * 9. * (double)order->pattern.start[order->pattern.n];
}

static shb_status factorise(fem_hermitian *factor, const double complex *value, bool *definite) {
  cholmod_common *common = &factor->common;
  factor->L              = cholmod_copy_factor(factor->order->L, common);
  cholmod_sparse *A =
      factor->L ? permute(&factor->order->pattern, factor->order->place, value, common) : NULL;
  SHB_CHECK(A, SHB_ERR_IO, "out of memory for the factor of %d nodes", factor->order->pattern.n);
  fem_cholmod_factorise(A, factor->L, common);
  cholmod_free_sparse(&A, common);
  SHB_CHECK(common->status >= CHOLMOD_OK, SHB_ERR_IO, "out of memory for the factor of %d nodes",
            factor->order->pattern.n);
  *definite = common->status != CHOLMOD_NOT_POSDEF;
  return SHB_OK;
}

shb_status fem_hermitian_create(const fem_hermitian_order *order, const double complex *value,
                                bool *definite, fem_hermitian **out) {
  fem_hermitian *factor = calloc(1, sizeof *factor);
  *out                  = NULL;
  *definite             = false;
  SHB_CHECK(factor, SHB_ERR_IO, "out of memory for a factor");
  factor->order = order;
  fem_cholmod_start(&factor->common);
  shb_status status = factorise(factor, value, definite);
  if (status == SHB_OK && *definite)
    *out = factor;
  else
    fem_hermitian_free(factor);
  return status;
}

/* Workspace for count right-hand sides, kept between solves. */
static bool make_room(fem_hermitian *factor, size_t count) {
  cholmod_common *common = &factor->common;
  if (factor->x && factor->x->ncol == count) return true;
  cholmod_free_dense(&factor->x, common);
  cholmod_free_dense(&factor->work, common);
  const size_t n = 3 * (size_t)factor->order->pattern.n, rows = factor->L->maxesize;
  factor->x    = cholmod_allocate_dense(n, count, n, CHOLMOD_COMPLEX, common);
  factor->work = cholmod_allocate_dense(rows, count, rows, CHOLMOD_COMPLEX, common);
  return factor->x && factor->work;
}

shb_status fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                               double complex *x) {
  const size_t n     = (size_t)factor->order->pattern.n;
  const int   *place = factor->order->place;
  SHB_CHECK(make_room(factor, (size_t)count), SHB_ERR_IO, "out of memory for %d solutions", count);
  double complex *own = factor->x->x;
  for (size_t c = 0; c < (size_t)count; c++)
    for (size_t i = 0; i < n; i++)
      memcpy(own + 3 * (c * n + (size_t)place[i]), b + 3 * (c * n + i), 3 * sizeof *x);
  const bool good = cholmod_super_lsolve(factor->L, factor->x, factor->work, &factor->common) &&
                    cholmod_super_ltsolve(factor->L, factor->x, factor->work, &factor->common);
  SHB_CHECK(good, SHB_ERR_IO, "CHOLMOD: no solution");
  for (size_t c = 0; c < (size_t)count; c++)
    for (size_t i = 0; i < n; i++)
      memcpy(x + 3 * (c * n + i), own + 3 * (c * n + (size_t)place[i]), 3 * sizeof *x);
  return SHB_OK;
}

void fem_hermitian_free(fem_hermitian *factor) {
  if (!factor) return;
  cholmod_free_factor(&factor->L, &factor->common);
  cholmod_free_dense(&factor->x, &factor->common);
  cholmod_free_dense(&factor->work, &factor->common);
  cholmod_finish(&factor->common);
  free(factor);
}
