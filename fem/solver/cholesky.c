#include "fem/solver/cholesky.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fem/supernodal/block_order.h"
#include "fem/supernodal/large_pages.h"
#include "fem/supernodal/supernodal_factor.h"
#include "fem/supernodal/supernodal_solve.h"
#include "mesh/base/memory.h"

/* MANY: right-hand sides from which BLAS is faster. BLOCK: most columns that a thread solves at
 * once. */
enum { MANY = 12, BLOCK = 40 };

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
  int            n;       /* block rows */
  int           *place;   /* [n] index of a block row in the factor */
  int            threads; /* for which few_work has room */
  fem_supernodes panels;
  double        *value;    /* [n_values] the factor */
  fem_lanes     *few;      /* [n_extended] right-hand sides in the factor's order */
  fem_lanes     *few_work; /* [threads][most_rows] */
  int            n_blocks; /* that there is room for */
  size_t         width;    /* columns of each */
  double       **block;    /* [n_blocks][3 n + most_rows][width] columns in the factor's order, and
                              [most_rows] ints */
  cholmod_common common;
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

/* ------------------------------------------------------------------ analysis */

/* Returns false where the factor is too large for CHOLMOD's indices. */
static bool analyse(const block_rows *b, fem_cholesky *factor) {
  const fem_blocks pattern = pattern_of(b);
  cholmod_factor  *L       = fem_block_analyse(&pattern, &factor->common, factor->place);
  const bool       fits    = L != NULL;
  if (fits) fem_supernodes_create(L, &factor->panels);
  cholmod_free_factor(&L, &factor->common);
  return fits;
}

PetscErrorCode fem_cholesky_create(Mat A, fem_cholesky **out) {
  block_rows    b;
  fem_cholesky *factor = shb_alloc_zeroed(1, sizeof *factor);

  PetscFunctionBeginUser;
  fem_cholmod_start(&factor->common);
  PetscCall(borrow_blocks(A, &b));
  factor->n     = (int)b.n;
  factor->place = shb_alloc((size_t)b.n, sizeof *factor->place);
  *out          = analyse(&b, factor) ? factor : NULL;
  PetscCall(give_back_blocks(A, &b));
  if (!*out) fem_cholesky_destroy(factor);
  PetscFunctionReturn(0);
}

void fem_cholesky_bytes(const fem_cholesky *factor, double *factor_bytes, double *workspace) {
  const fem_supernodes *s = &factor->panels;
  *factor_bytes           = 8. * (double)s->n_values + 4. * (double)s->n_rows;
  *workspace              = fem_supernodal_workspace(s, omp_get_max_threads()) +
               8 * factor->common.anz; /* two indices a block */
}

/* ------------------------------------------------------------------ numbers */

PetscErrorCode fem_cholesky_update(fem_cholesky *factor, Mat A, bool *definite) {
  block_rows        b;
  fem_lower_pattern lower;

  PetscFunctionBeginUser;
  if (!factor->value)
    factor->value = fem_large_alloc(factor->panels.n_values + 1, sizeof *factor->value);
  PetscCall(borrow_blocks(A, &b));
  const fem_blocks pattern = pattern_of(&b);
  fem_lower_pattern_create(&pattern, factor->place, &lower);
  *definite = fem_supernodal_factorise(&factor->panels, &lower, b.value, NULL, factor->value);
  fem_lower_pattern_free(&lower);
  PetscCall(give_back_blocks(A, &b));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ solves */

static void free_blocks(fem_cholesky *factor) {
  for (int i = 0; i < factor->n_blocks; i++) free(factor->block[i]);
  factor->n_blocks = 0;
}

/* Room for so many blocks of columns, kept between solves. glibc does not always use freed memory
 * of an alignment again: the heap would grow. */
static void make_block_room(fem_cholesky *factor, int blocks, size_t width) {
  const size_t most = (size_t)factor->panels.most_rows, rows = 3 * (size_t)factor->n + most;
  if (factor->width < width) {
    free_blocks(factor);
    factor->width = width;
  }
  if (factor->n_blocks >= blocks) return;
  factor->block = shb_realloc(factor->block, (size_t)blocks, sizeof *factor->block);
  for (; factor->n_blocks < blocks; factor->n_blocks++)
    factor->block[factor->n_blocks] =
        fem_large_alloc(rows * factor->width * sizeof(double) + most * sizeof(int), 1);
}

/* Solve for one block of columns by BLAS; own: that of the thread. */
static void solve_block(const fem_cholesky *factor, double *own, const bool *needed, size_t count,
                        const double *b, size_t ldb, double *x, size_t ldx) {
  const size_t n = 3 * (size_t)factor->n, work = (size_t)factor->panels.most_rows * count;
  for (size_t i = 0; i < n; i++) {
    double *at = own + (3 * (size_t)factor->place[i / 3] + i % 3) * count;
    for (size_t c = 0; c < count; c++) at[c] = b[c * ldb + i];
  }
  fem_supernodal_solve_block(&factor->panels, factor->value, needed, (int)count, own,
                             own + n * count, (int *)(own + n * count + work));
  for (size_t i = 0; i < n; i++) {
    const double *at = own + (3 * (size_t)factor->place[i / 3] + i % 3) * count;
    for (size_t c = 0; c < count; c++) x[c * ldx + i] = at[c];
  }
}

/* Two threads share even few columns. The blocks do not depend on the number of threads, and so the
 * numbers do not. */
static void solve_many(fem_cholesky *factor, const bool *needed, size_t count, const double *b,
                       size_t ldb, double *x, size_t ldx) {
  const size_t half = (count + 1) / 2, width = half < BLOCK ? half : BLOCK;
  const int    all = (int)((count + width - 1) / width), most = omp_get_max_threads();
  const int    threads = all < most ? all : most;
  make_block_room(factor, threads, width);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (size_t c = 0; c < count; c += width) {
    const size_t here = count - c < width ? count - c : width;
    solve_block(factor, factor->block[omp_get_thread_num()], needed, here, b + c * ldb, ldb,
                x + c * ldx, ldx);
  }
}

/* Workspace for few right-hand sides, kept between solves. */
static void make_room(fem_cholesky *factor) {
  const size_t alignment = 64;
  const int    threads   = omp_get_max_threads();
  if (factor->few && factor->threads == threads) return;
  const fem_supernodes *s    = &factor->panels;
  const size_t          rows = (size_t)s->most_rows * (size_t)threads;
  free(factor->few);
  free(factor->few_work);
  factor->threads  = threads;
  factor->few      = shb_alloc_aligned(alignment, (size_t)s->n_extended, sizeof(fem_lanes));
  factor->few_work = shb_alloc_aligned(alignment, rows, sizeof(fem_lanes));
}

/* Solve for count <= FEM_LANES columns; unused lanes are zero. */
static void solve_few(fem_cholesky *factor, size_t count, const double *b, size_t ldb, double *x,
                      size_t ldx) {
  const size_t n = (size_t)factor->n;
  make_room(factor);
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      fem_lanes *at = factor->few + 3 * (size_t)factor->place[i] + d;
      for (size_t c = 0; c < FEM_LANES; c++) (*at)[c] = c < count ? b[c * ldb + 3 * i + d] : 0;
    }
  fem_supernodal_solve(&factor->panels, factor->value, factor->threads, factor->few,
                       factor->few_work);
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < n; i++)
    for (size_t d = 0; d < 3; d++) {
      const fem_lanes *at = factor->few + 3 * (size_t)factor->place[i] + d;
      for (size_t c = 0; c < count; c++) x[c * ldx + 3 * i + d] = (*at)[c];
    }
}

void fem_cholesky_solve(fem_cholesky *factor, int count, const double *b, size_t ldb, double *x,
                        size_t ldx) {
  const size_t all = (size_t)count;
  if (all >= MANY) {
    solve_many(factor, NULL, all, b, ldb, x, ldx);
    return;
  }
  for (size_t c = 0; c < all; c += FEM_LANES) {
    size_t here = all - c < FEM_LANES ? all - c : FEM_LANES;
    solve_few(factor, here, b + c * ldb, ldb, x + c * ldx, ldx);
  }
}

fem_tree fem_cholesky_tree(const fem_cholesky *factor) {
  return (fem_tree){&factor->panels, factor->value, factor->place};
}

void fem_cholesky_solve_at(fem_cholesky *factor, const bool *node, int count, const double *b,
                           size_t ldb, double *x, size_t ldx) {
  bool *row    = shb_alloc((size_t)factor->panels.n, sizeof *row);
  bool *needed = shb_alloc((size_t)factor->panels.n_panels, sizeof *needed);
  for (int i = 0; i < factor->n; i++)
    for (int d = 0; d < 3; d++) row[3 * factor->place[i] + d] = node[i];
  fem_supernodes_needed(&factor->panels, row, needed);
  solve_many(factor, needed, (size_t)count, b, ldb, x, ldx);
  free(row);
  free(needed);
}

void fem_cholesky_destroy(fem_cholesky *factor) {
  if (!factor) return;
  fem_supernodes_free(&factor->panels);
  cholmod_finish(&factor->common);
  free(factor->value);
  free(factor->few);
  free(factor->few_work);
  free_blocks(factor);
  free(factor->block);
  free(factor->place);
  free(factor);
}
