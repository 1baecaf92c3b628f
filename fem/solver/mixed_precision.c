#include "fem/solver/mixed_precision.h"

#include <math.h>
#include <smumps_c.h>
#include <stdlib.h>
#include <string.h>

#include "fem/solver/sbaij_blocks.h"

/* Columns that share the passes over the factor; iterations at most. MUMPS's jobs and error codes. */
enum {
  COLUMNS        = 8,
  MOST           = 100,
  START          = -1,
  FINISH         = -2,
  ANALYSE        = 1,
  FACTORISE      = 2,
  SOLVE          = 3,
  NOT_DEFINITE   = -40,
  OUT_OF_MEMORY  = -13,
  SPACE_TOO_TINY = -9
};

static const double wanted = 1e-13, enough = 1e-10;

struct fem_single {
  SMUMPS_STRUC_C mumps;
  Mat            A; /* of the last update */
  size_t         n; /* unknowns */
  Vec            in, out;
  float         *rhs;               /* [columns][n] */
  double        *x, *r, *z, *p, *q; /* [columns][n] */
};

/* MUMPS counts from 1. */
#define ICNTL(i) icntl[(i)-1]
#define INFOG(i) infog[(i)-1]

static void run(fem_single *f, int job) {
  f->mumps.job = job;
  smumps_c(&f->mumps);
}

/* The upper triangle by entries; value: with the numbers too. */
static bool list_entries(fem_single *f, const fem_blocks *b, bool value) {
  const size_t    count = 9 * (size_t)b->start[b->n] - 3 * (size_t)b->n;
  SMUMPS_STRUC_C *m     = &f->mumps;
  size_t          at    = 0;
  m->nnz                = (MUMPS_INT8)count;
  m->irn                = malloc(count * sizeof *m->irn);
  m->jcn                = malloc(count * sizeof *m->jcn);
  m->a                  = value ? malloc(count * sizeof *m->a) : NULL;
  if (!m->irn || !m->jcn || (value && !m->a)) return false;
  for (PetscInt r = 0; r < b->n; r++)
    for (PetscInt q = b->start[r]; q < b->start[r + 1]; q++)
      for (int d = 0; d < 3; d++)
        for (int e = b->column[q] == r ? d : 0; e < 3; e++, at++) {
          m->irn[at] = 3 * r + d + 1;
          m->jcn[at] = 3 * b->column[q] + e + 1;
          if (value) m->a[at] = (float)b->value[9 * q + d + 3 * e];
        }
  return true;
}

static void free_entries(fem_single *f) {
  free(f->mumps.irn);
  free(f->mumps.jcn);
  free(f->mumps.a);
  f->mumps.irn = f->mumps.jcn = NULL;
  f->mumps.a                  = NULL;
}

/* One of MUMPS's jobs on the entries of A. */
static PetscErrorCode work_on(fem_single *f, Mat A, int job) {
  fem_blocks b;
  PetscFunctionBeginUser;
  PetscCall(fem_blocks_borrow(A, &b));
  f->n            = 3 * (size_t)b.n;
  f->mumps.n      = (MUMPS_INT)f->n;
  const bool room = list_entries(f, &b, job == FACTORISE);
  PetscCall(fem_blocks_give_back(A, &b));
  if (room) run(f, job);
  free_entries(f);
  PetscCheck(room, PETSC_COMM_SELF, PETSC_ERR_MEM, "SMUMPS");
  PetscFunctionReturn(0);
}

PetscErrorCode fem_single_create(Mat A, fem_single **out) {
  fem_single *f = calloc(1, sizeof *f);

  PetscFunctionBeginUser;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_MEM, "SMUMPS");
  *out                  = f;
  f->mumps.par          = 1;
  f->mumps.sym          = 1;
  f->mumps.comm_fortran = (MUMPS_INT)MPI_Comm_c2f(PETSC_COMM_SELF);
  run(f, START);
  for (int i = 1; i <= 3; i++) f->mumps.ICNTL(i) = -1; /* it prints nothing */
  f->mumps.ICNTL(4)  = 0;
  f->mumps.ICNTL(14) = 5; /* per cent more room than foreseen: there is no pivoting */
  PetscCall(work_on(f, A, ANALYSE));
  PetscCheck(f->mumps.INFOG(1) >= 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "SMUMPS: %d",
             f->mumps.INFOG(1));
  PetscFunctionReturn(0);
}

double fem_single_foreseen(const fem_single *f) {
  const double entries = sizeof(float) + 2 * sizeof(MUMPS_INT);
  return 1e6 * f->mumps.INFOG(17) + entries * (double)f->mumps.nnz;
}

static PetscErrorCode make_room(fem_single *f) {
  const size_t all = COLUMNS * f->n;
  PetscFunctionBeginUser;
  if (f->rhs) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(f->A, &f->in, &f->out));
  f->rhs = malloc(all * sizeof *f->rhs);
  f->x   = malloc(5 * all * sizeof *f->x);
  PetscCheck(f->rhs && f->x, PETSC_COMM_SELF, PETSC_ERR_MEM, "conjugate gradients");
  f->r = f->x + all;
  f->z = f->r + all;
  f->p = f->z + all;
  f->q = f->p + all;
  PetscFunctionReturn(0);
}

PetscErrorCode fem_single_update(fem_single *f, Mat A, bool *definite) {
  PetscFunctionBeginUser;
  PetscCall(PetscObjectReference((PetscObject)A));
  PetscCall(MatDestroy(&f->A));
  f->A = A;
  PetscCall(work_on(f, A, FACTORISE));
  const int error = f->mumps.INFOG(1);
  PetscCheck(error != OUT_OF_MEMORY && error != SPACE_TOO_TINY, PETSC_COMM_SELF, PETSC_ERR_MEM,
             "SMUMPS");
  PetscCheck(error >= 0 || error == NOT_DEFINITE || error == -10, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "SMUMPS: %d", error);
  *definite = error >= 0 && f->mumps.INFOG(12) == 0;
  PetscCall(make_room(f));
  PetscFunctionReturn(0);
}

/* ---- conjugate gradients, column by column, with one pass over the factor for all ---- */

/* z = (L L^T)^-1 r; every column scaled to unit size, for single precision has a small range. */
static PetscErrorCode precondition(fem_single *f, int count) {
  double size[COLUMNS];
  PetscFunctionBeginUser;
  for (int c = 0; c < count; c++) {
    const double *r = f->r + (size_t)c * f->n;
    size[c]         = 0;
    for (size_t i = 0; i < f->n; i++) size[c] = fmax(size[c], fabs(r[i]));
    if (size[c] == 0) size[c] = 1;
    for (size_t i = 0; i < f->n; i++) f->rhs[(size_t)c * f->n + i] = (float)(r[i] / size[c]);
  }
  f->mumps.rhs  = f->rhs;
  f->mumps.nrhs = count;
  f->mumps.lrhs = (MUMPS_INT)f->n;
  run(f, SOLVE);
  PetscCheck(f->mumps.INFOG(1) >= 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "SMUMPS: %d",
             f->mumps.INFOG(1));
  for (int c = 0; c < count; c++)
    for (size_t i = 0; i < f->n; i++)
      f->z[(size_t)c * f->n + i] = size[c] * (double)f->rhs[(size_t)c * f->n + i];
  PetscFunctionReturn(0);
}

static double dot(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* q = A p of one column */
static PetscErrorCode multiply(fem_single *f, const double *p, double *q) {
  PetscFunctionBeginUser;
  PetscCall(VecPlaceArray(f->in, p));
  PetscCall(VecPlaceArray(f->out, q));
  PetscCall(MatMult(f->A, f->in, f->out));
  PetscCall(VecResetArray(f->out));
  PetscCall(VecResetArray(f->in));
  PetscFunctionReturn(0);
}

/* x += alpha p, r -= alpha A p with z = ... of the iteration before in rho. False: A is not definite along p. */
static PetscErrorCode step(fem_single *f, int c, double rho, bool *definite) {
  const size_t at = (size_t)c * f->n;
  double      *x = f->x + at, *r = f->r + at, *p = f->p + at, *q = f->q + at;
  PetscFunctionBeginUser;
  PetscCall(multiply(f, p, q));
  const double curvature = dot(f->n, p, q), alpha = rho / curvature;
  *definite = curvature > 0;
  for (size_t i = 0; *definite && i < f->n; i++) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
  }
  PetscFunctionReturn(0);
}

/* p = z + (rho/before) p */
static void turn(fem_single *f, int c, double ratio) {
  const size_t at = (size_t)c * f->n;
  for (size_t i = 0; i < f->n; i++) f->p[at + i] = f->z[at + i] + ratio * f->p[at + i];
}

/* Columns whose residual is small, or small and no longer falling, are done. */
static bool is_done(double rho, double before, double first) {
  const double fallen = first > 0 ? rho / first : 0;
  return !(fallen > wanted * wanted) || (fallen < enough * enough && rho > .25 * before);
}

static PetscErrorCode iterate(fem_single *f, int count) {
  double rho[COLUMNS], first[COLUMNS], before[COLUMNS];
  bool   done[COLUMNS] = {false}, definite = true;
  int    left = count;
  PetscFunctionBeginUser;
  memset(f->x, 0, (size_t)count * f->n * sizeof *f->x);
  memset(f->p, 0, (size_t)count * f->n * sizeof *f->p);
  for (int i = 0; left > 0; i++) {
    PetscCheck(i < MOST && definite, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED,
               "conjugate gradients with a factor in single precision: the matrix is %s",
               definite ? "too far from its rounded factor" : "not positive definite");
    PetscCall(precondition(f, count));
    for (int c = 0; c < count && definite; c++) {
      if (done[c]) continue;
      const double now = dot(f->n, f->r + (size_t)c * f->n, f->z + (size_t)c * f->n);
      before[c]        = i == 0 ? INFINITY : rho[c];
      first[c]         = i == 0 ? now : first[c];
      rho[c]           = now;
      done[c]          = is_done(now, before[c], first[c]);
      left -= done[c];
      if (done[c]) continue;
      turn(f, c, i == 0 ? 0 : rho[c] / before[c]);
      PetscCall(step(f, c, rho[c], &definite));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode fem_single_solve(fem_single *f, int count, const double *b, size_t ldb, double *x,
                                size_t ldx) {
  PetscFunctionBeginUser;
  for (int first = 0; first < count; first += COLUMNS) {
    const int some = PetscMin(COLUMNS, count - first);
    for (int c = 0; c < some; c++)
      memcpy(f->r + (size_t)c * f->n, b + (size_t)(first + c) * ldb, f->n * sizeof *b);
    PetscCall(iterate(f, some));
    for (int c = 0; c < some; c++)
      memcpy(x + (size_t)(first + c) * ldx, f->x + (size_t)c * f->n, f->n * sizeof *x);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode fem_single_destroy(fem_single **factor) {
  fem_single *f = *factor;
  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(0);
  run(f, FINISH);
  PetscCall(MatDestroy(&f->A));
  PetscCall(VecDestroy(&f->in));
  PetscCall(VecDestroy(&f->out));
  free(f->rhs);
  free(f->x);
  free(f);
  *factor = NULL;
  PetscFunctionReturn(0);
}
