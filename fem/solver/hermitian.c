#include "fem/solver/hermitian.h"

#include <stdlib.h>
#include <string.h>

#include "fem/solver/large_pages.h"
#include "fem/solver/supernodal_hermitian.h"

struct fem_hermitian_order {
  fem_blocks      pattern;
  int            *place; /* [n] index of a block row in the factor */
  cholmod_factor *L;     /* symbolic */
  cholmod_common  common;
};

struct fem_hermitian {
  const fem_hermitian_order *order;
  cholmod_factor            *L;
  fem_complex_lanes         *x, *work; /* right-hand sides in the factor's order; a supernode */
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
  if (cholmod_change_factor(CHOLMOD_COMPLEX, 1, 1, 1, 1, factor->L, common))
    fem_prefer_large_pages(factor->L->x, factor->L->xsize * sizeof *value);
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

/* Workspace for four right-hand sides, kept between solves. */
static bool make_room(fem_hermitian *factor) {
  const size_t alignment = sizeof(fem_lanes), each = sizeof(fem_complex_lanes);
  const size_t n    = 3 * (size_t)factor->order->pattern.n,
               rows = fem_supernodal_hermitian_rows(factor->L);
  if (factor->x && factor->work) return true;
  factor->x =
      n * each < FEM_LARGE_PAGE ? aligned_alloc(alignment, n * each) : fem_large_malloc(n * each);
  factor->work = aligned_alloc(alignment, rows * each);
  return factor->x && factor->work;
}

/* Solve for count <= FEM_LANES columns; unused lanes are zero. */
static void solve_few(fem_hermitian *factor, size_t count, const double complex *b,
                      double complex *x) {
  const size_t n     = (size_t)factor->order->pattern.n;
  const int   *place = factor->order->place;
  for (size_t i = 0; i < 3 * n; i++) {
    fem_complex_lanes *at = factor->x + 3 * (size_t)place[i / 3] + i % 3;
    for (size_t c = 0; c < FEM_LANES; c++) {
      at->re[c] = c < count ? creal(b[3 * n * c + i]) : 0;
      at->im[c] = c < count ? cimag(b[3 * n * c + i]) : 0;
    }
  }
  fem_supernodal_solve_hermitian(factor->L, factor->x, factor->work);
  for (size_t i = 0; i < 3 * n; i++) {
    const fem_complex_lanes *at = factor->x + 3 * (size_t)place[i / 3] + i % 3;
    for (size_t c = 0; c < count; c++) x[3 * n * c + i] = CMPLX(at->re[c], at->im[c]);
  }
}

shb_status fem_hermitian_solve(fem_hermitian *factor, int count, const double complex *b,
                               double complex *x) {
  const size_t all = (size_t)count, order = 3 * (size_t)factor->order->pattern.n;
  SHB_CHECK(make_room(factor), SHB_ERR_IO, "out of memory for %d solutions", count);
  for (size_t c = 0; c < all; c += FEM_LANES)
    solve_few(factor, all - c < FEM_LANES ? all - c : FEM_LANES, b + c * order, x + c * order);
  return SHB_OK;
}

void fem_hermitian_free(fem_hermitian *factor) {
  if (!factor) return;
  cholmod_free_factor(&factor->L, &factor->common);
  cholmod_finish(&factor->common);
  free(factor->x);
  free(factor->work);
  free(factor);
}
