#include "fem/body/mass_product.h"

#include <stddef.h>
#include <stdlib.h>

#include "fem/supernodal/hot.h"
#include "mesh/base/memory.h"

enum { TOGETHER = 4, ROWS = 256 }; /* columns that one pass over M serves; rows at a time */

/* One number of each column. */
typedef double lanes __attribute__((vector_size(8 * TOGETHER)));

/* x[dof] = the numbers of count columns. */
static void interleave(const fem_mass_rows *m, int count, const double *X, size_t ldx, lanes *x) {
#pragma omp parallel for schedule(static)
  for (size_t i = 0; i < 3 * (size_t)m->n; i++)
    for (int c = 0; c < TOGETHER; c++) x[i][c] = c < count ? X[(size_t)c * ldx + i] : 0;
}

/* Sum of m_rc x_c for the three dofs of node r. */
FEM_KERNEL void multiply_row(const fem_mass_rows *m, PetscInt r, int count, const lanes *x,
                             double *y, size_t ldy) {
  lanes sum[3] = {{0}};
  for (PetscInt k = m->start[r]; k < m->start[r + 1]; k++) {
    const lanes *from  = x + 3 * (size_t)m->column[k];
    const double value = m->value[k];
    sum[0] += value * from[0];
    sum[1] += value * from[1];
    sum[2] += value * from[2];
  }
  for (int c = 0; c < count; c++)
    for (size_t d = 0; d < 3; d++) y[(size_t)c * ldy + 3 * (size_t)r + d] = sum[d][c];
}

FEM_HOT static void multiply_some(const fem_mass_rows *m, PetscInt begin, PetscInt end, int count,
                                  const lanes *x, double *y, size_t ldy) {
  for (PetscInt r = begin; r < end; r++) multiply_row(m, r, count, x, y, ldy);
}

static void multiply_rows(const fem_mass_rows *m, int count, const lanes *x, double *y,
                          size_t ldy) {
#pragma omp parallel for schedule(static)
  for (PetscInt r = 0; r < m->n; r += ROWS)
    multiply_some(m, r, PetscMin(r + ROWS, m->n), count, x, y, ldy);
}

PetscErrorCode fem_mass_borrow(Mat M, bool *by_nodes, fem_mass_rows *rows) {
  Mat       nodes;
  PetscBool yes;
  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)M, MATSEQMAIJ, &yes));
  *by_nodes = yes;
  if (!yes) PetscFunctionReturn(0);
  PetscCall(MatMAIJGetAIJ(M, &nodes));
  PetscCall(
      MatGetRowIJ(nodes, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->start, &rows->column, &yes));
  PetscCheck(yes, PETSC_COMM_SELF, PETSC_ERR_SUP, "no rows");
  PetscCall(MatSeqAIJGetArrayRead(nodes, &rows->value));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_mass_give_back(Mat M, fem_mass_rows *rows) {
  Mat       nodes;
  PetscBool done;
  PetscFunctionBeginUser;
  PetscCall(MatMAIJGetAIJ(M, &nodes));
  PetscCall(MatSeqAIJRestoreArrayRead(nodes, &rows->value));
  PetscCall(MatRestoreRowIJ(nodes, 0, PETSC_FALSE, PETSC_FALSE, &rows->n, &rows->start,
                            &rows->column, &done));
  PetscFunctionReturn(0);
}

static PetscErrorCode multiply_by_nodes(const fem_mass_rows *m, Mat X, Mat Y) {
  const double *x;
  double       *y;
  lanes        *work;
  PetscInt      columns, ldx, ldy;
  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &columns));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetLDA(Y, &ldy));
  PetscCall(MatDenseGetArrayRead(X, &x));
  PetscCall(MatDenseGetArrayWrite(Y, &y));
  work = shb_alloc_aligned(sizeof *work, 3 * (size_t)m->n + 1, sizeof *work);
  for (PetscInt c = 0; c < columns; c += TOGETHER) {
    const int count = (int)PetscMin(TOGETHER, columns - c);
    interleave(m, count, x + (size_t)c * (size_t)ldx, (size_t)ldx, work);
    multiply_rows(m, count, work, y + (size_t)c * (size_t)ldy, (size_t)ldy);
  }
  free(work);
  PetscCall(MatDenseRestoreArrayWrite(Y, &y));
  PetscCall(MatDenseRestoreArrayRead(X, &x));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_mass_multiply(Mat M, Mat X, Mat Y) {
  fem_mass_rows rows;
  bool          by_nodes;
  PetscInt      n;
  PetscFunctionBeginUser;
  PetscCall(fem_mass_borrow(M, &by_nodes, &rows));
  if (by_nodes) {
    PetscCall(multiply_by_nodes(&rows, X, Y));
    PetscCall(fem_mass_give_back(M, &rows));
    PetscFunctionReturn(0);
  }
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt c = 0; c < n; c++) {
    Vec x, y;
    PetscCall(MatDenseGetColumnVecRead(X, c, &x));
    PetscCall(MatDenseGetColumnVecWrite(Y, c, &y));
    PetscCall(MatMult(M, x, y));
    PetscCall(MatDenseRestoreColumnVecWrite(Y, c, &y));
    PetscCall(MatDenseRestoreColumnVecRead(X, c, &x));
  }
  PetscFunctionReturn(0);
}
