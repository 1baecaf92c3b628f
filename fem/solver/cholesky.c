#include "fem/solver/cholesky.h"

#include <stdlib.h>
#include <string.h>

#include "fem/solver/block_order.h"
#include "fem/solver/supernodal_solve.h"

enum { MANY = 12 }; /* number of right-hand sides from which calls to BLAS are faster */

/* Upper triangle of a symmetric matrix (sequential SBAIJ, block size 3) by block rows. */
typedef struct {
  PetscInt        n;
  const PetscInt *start, *column;
  const double   *value; /* [block][9], each by columns */
} block_rows;

static fem_blocks pattern_of(const block_rows *b) {
  return (fem_blocks){(int)b->n, b->start, b->column};
}

struct fem_cholesky {
  int             n;     /* block rows */
  int            *place; /* [n] index of a block row in the factor */
  cholmod_factor *L;
  fem_lanes      *few;      /* [3 n] right-hand sides in the factor's order */
  fem_lanes      *few_work; /* [largest supernode] */
  cholmod_dense  *x;        /* [3 n][columns] many right-hand sides */
  cholmod_dense  *work;     /* workspace of CHOLMOD */
  cholmod_common  common;
};

/* Access the blocks of A in place. A must not change until give_back_blocks. */
static PetscErrorCode borrow_blocks(Mat A, block_rows *b) {
  PetscBool done;
  double   *value;
  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &b->n, &b->start, &b->column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "no rows");
  PetscCall(MatSeqSBAIJGetArray(A, &value));
  b->value = value;
  PetscFunctionReturn(0);
}

static PetscErrorCode give_back_blocks(Mat A, block_rows *b) {
  PetscBool done;
  double   *value = (double *)b->value;
  PetscFunctionBeginUser;
  PetscCall(MatSeqSBAIJRestoreArray(A, &value));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &b->n, &b->start, &b->column, &done));
  PetscFunctionReturn(0);
}

static void put_diagonal(const double *B, int c, const int *start, int *row, double *value) {
  for (int d = 0; d < 3; d++)
    for (int e = d; e < 3; e++) {
      row[start[3 * c + d] + e - d]   = 3 * c + e;
      value[start[3 * c + d] + e - d] = B[d + 3 * e];
    }
}

/* Put a block of rows low and columns high, or its transpose, as the slot-th block below the
 * diagonal of column low. */
static void put_block(const double *B, bool turned, int low, int high, int slot, const int *start,
                      int *row, double *value) {
  for (int d = 0; d < 3; d++) {
    int at = start[3 * low + d] + 3 - d + 3 * slot;
    for (int e = 0; e < 3; e++) {
      row[at + e]   = 3 * high + e;
      value[at + e] = turned ? B[e + 3 * d] : B[d + 3 * e];
    }
  }
}

/* The permuted lower triangle; NULL when out of memory. */
static cholmod_sparse *permute(const block_rows *b, const int *place, cholmod_common *common) {
  const size_t    n = (size_t)b->n, entries = 9 * (size_t)b->start[n] - 3 * n;
  cholmod_sparse *A =
      cholmod_allocate_sparse(3 * n, 3 * n, entries, 0, 1, -1, CHOLMOD_REAL, common);
  int *next = calloc(n + 1, sizeof *next);
  if (A && next) {
    const fem_blocks pattern = pattern_of(b);
    int             *start   = A->p;
    fem_block_starts(&pattern, place, next, start);
    for (PetscInt r = 0; r < b->n; r++)
      for (PetscInt q = b->start[r]; q < b->start[r + 1]; q++) {
        int           here = place[r], there = place[b->column[q]];
        const double *block = b->value + 9 * (size_t)q;
        if (here == there)
          put_diagonal(block, here, start, A->i, A->x);
        else if (here < there)
          put_block(block, false, here, there, next[here]++, start, A->i, A->x);
        else
          put_block(block, true, there, here, next[there]++, start, A->i, A->x);
      }
  } else
    cholmod_free_sparse(&A, common);
  free(next);
  return A;
}

/* Symbolic factorisation of the permuted matrix. */
static void analyse(const block_rows *b, fem_cholesky *factor) {
  cholmod_common  *common = &factor->common;
  cholmod_sparse  *A;
  const fem_blocks pattern = pattern_of(b);
  if (!fem_block_order(&pattern, common, factor->place)) return;
  A = permute(b, factor->place, common);
  if (!A) return;
  factor->L = fem_cholmod_analyse(A, common);
  cholmod_free_sparse(&A, common);
}

PetscErrorCode fem_cholesky_create(Mat A, bool *fits, fem_cholesky **out) {
  block_rows    b;
  fem_cholesky *factor = calloc(1, sizeof *factor);

  PetscFunctionBeginUser;
  *out = NULL;
  PetscCheck(factor, PETSC_COMM_SELF, PETSC_ERR_MEM, "CHOLMOD");
  fem_cholmod_start(&factor->common);
  PetscCall(borrow_blocks(A, &b));
  factor->n     = (int)b.n;
  factor->place = malloc((size_t)b.n * sizeof *factor->place);
  if (factor->place) analyse(&b, factor);
  PetscCall(give_back_blocks(A, &b));
  *fits = factor->common.status != CHOLMOD_TOO_LARGE;
  if (factor->L) {
    *out = factor;
    PetscFunctionReturn(0);
  }
  fem_cholesky_destroy(factor);
  PetscCheck(!*fits, PETSC_COMM_SELF, PETSC_ERR_MEM, "CHOLMOD");
  PetscFunctionReturn(0);
}

void fem_cholesky_bytes(const fem_cholesky *factor, double *factor_bytes, double *workspace) {
  const cholmod_factor *L = factor->L;
  *factor_bytes           = 8. * (double)L->xsize + 4. * (double)L->ssize;
  *workspace              = 8. * (double)L->maxcsize + 12. * factor->common.anz;
}

PetscErrorCode fem_cholesky_update(fem_cholesky *factor, Mat A, bool *definite) {
  cholmod_common *common = &factor->common;
  block_rows      b;

  PetscFunctionBeginUser;
  PetscCall(borrow_blocks(A, &b));
  cholmod_sparse *permuted = permute(&b, factor->place, common);
  PetscCall(give_back_blocks(A, &b));
  PetscCheck(permuted, PETSC_COMM_SELF, PETSC_ERR_MEM, "CHOLMOD");
  fem_cholmod_factorise(permuted, factor->L, common);
  cholmod_free_sparse(&permuted, common);
  PetscCheck(common->status >= CHOLMOD_OK, PETSC_COMM_SELF, PETSC_ERR_MEM, "CHOLMOD");
  *definite = common->status != CHOLMOD_NOT_POSDEF;
  PetscFunctionReturn(0);
}

/* Workspace for count right-hand sides, kept between solves. */
static PetscErrorCode make_room(fem_cholesky *factor, size_t count) {
  cholmod_common *common = &factor->common;
  PetscFunctionBeginUser;
  if (factor->x && factor->x->ncol == count) PetscFunctionReturn(0);
  cholmod_free_dense(&factor->x, common);
  cholmod_free_dense(&factor->work, common);
  const size_t n = 3 * (size_t)factor->n;
  factor->x      = cholmod_allocate_dense(n, count, n, CHOLMOD_REAL, common);
  factor->work =
      cholmod_allocate_dense(factor->L->maxesize, count, factor->L->maxesize, CHOLMOD_REAL, common);
  PetscCheck(factor->x && factor->work, PETSC_COMM_SELF, PETSC_ERR_MEM, "CHOLMOD");
  PetscFunctionReturn(0);
}

static PetscErrorCode solve_many(fem_cholesky *factor, size_t count, const double *b, size_t ldb,
                                 double *x, size_t ldx) {
  const size_t n = (size_t)factor->n;
  PetscFunctionBeginUser;
  PetscCall(make_room(factor, count));
  double *own = factor->x->x;
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < n; i++)
      memcpy(own + 3 * (c * n + (size_t)factor->place[i]), b + c * ldb + 3 * i, 3 * sizeof *x);
  const bool good = cholmod_super_lsolve(factor->L, factor->x, factor->work, &factor->common) &&
                    cholmod_super_ltsolve(factor->L, factor->x, factor->work, &factor->common);
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_LIB, "CHOLMOD: no solution");
  for (size_t c = 0; c < count; c++)
    for (size_t i = 0; i < n; i++)
      memcpy(x + c * ldx + 3 * i, own + 3 * (c * n + (size_t)factor->place[i]), 3 * sizeof *x);
  PetscFunctionReturn(0);
}

static PetscErrorCode make_room_for_few(fem_cholesky *factor) {
  const size_t alignment = sizeof(fem_lanes);
  PetscFunctionBeginUser;
  if (factor->few) PetscFunctionReturn(0);
  factor->few      = aligned_alloc(alignment, 3 * (size_t)factor->n * sizeof(fem_lanes));
  factor->few_work = aligned_alloc(alignment, fem_supernodal_rows(factor->L) * sizeof(fem_lanes));
  PetscCheck(factor->few && factor->few_work, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory");
  PetscFunctionReturn(0);
}

/* Solve for count <= FEM_LANES columns; unused lanes are zero. */
static PetscErrorCode solve_few(fem_cholesky *factor, size_t count, const double *b, size_t ldb,
                                double *x, size_t ldx) {
  const size_t n = (size_t)factor->n;
  PetscFunctionBeginUser;
  PetscCall(make_room_for_few(factor));
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      fem_lanes *at = factor->few + 3 * (size_t)factor->place[i] + d;
      for (size_t c = 0; c < FEM_LANES; c++) (*at)[c] = c < count ? b[c * ldb + 3 * i + d] : 0;
    }
  fem_supernodal_solve(factor->L, factor->few, factor->few_work);
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      const fem_lanes *at = factor->few + 3 * (size_t)factor->place[i] + d;
      for (size_t c = 0; c < count; c++) x[c * ldx + 3 * i + d] = (*at)[c];
    }
  PetscFunctionReturn(0);
}

PetscErrorCode fem_cholesky_solve(fem_cholesky *factor, int count, const double *b, size_t ldb,
                                  double *x, size_t ldx) {
  const size_t all = (size_t)count;
  PetscFunctionBeginUser;
  if (all == 1 || all >= MANY) {
    PetscCall(solve_many(factor, all, b, ldb, x, ldx));
    PetscFunctionReturn(0);
  }
  for (size_t c = 0; c < all; c += FEM_LANES) {
    size_t here = all - c < FEM_LANES ? all - c : FEM_LANES;
    PetscCall(solve_few(factor, here, b + c * ldb, ldb, x + c * ldx, ldx));
  }
  PetscFunctionReturn(0);
}

void fem_cholesky_destroy(fem_cholesky *factor) {
  if (!factor) return;
  cholmod_free_factor(&factor->L, &factor->common);
  cholmod_free_dense(&factor->x, &factor->common);
  cholmod_free_dense(&factor->work, &factor->common);
  cholmod_finish(&factor->common);
  free(factor->few);
  free(factor->few_work);
  free(factor->place);
  free(factor);
}
