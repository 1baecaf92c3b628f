#include "modal/block_lanczos.h"

#include <math.h>
#include <petscblaslapack.h>
#include <slepc/private/epsimpl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "modal/noise.h"

typedef struct {
  PetscInt size, limit; /* columns a block; of the basis at most */
} method;

/* The basis and T projected on it: diagonal blocks D_k and blocks B_k below them, T Q_k = Q_k-1 B_k-1^T + Q_k D_k + Q_k+1 B_k. */
typedef struct {
  MPI_Comm     comm;
  PetscBLASInt rows, p;  /* own rows; columns a block */
  int          n, room;  /* blocks */
  Mat          M, W, MW; /* the block in the making, and M times it: [rows][p] */
  KSP          ksp;
  double     **Q;     /* [n] blocks [p][rows] */
  double      *D, *B; /* [room] blocks, each [p][p] by columns */
  double      *H;     /* [p n][p n], later its eigenvectors */
  double      *theta; /* [p n], ascending */
} basis;

static const PetscScalar one = 1, minus = -1, zero = 0;

/* ------------------------------------------------------------------ blocks */

static PetscErrorCode multiply_mass(const basis *b) {
  PetscFunctionBeginUser;
  for (int c = 0; c < b->p; c++) {
    Vec w, mw;
    PetscCall(MatDenseGetColumnVecRead(b->W, c, &w));
    PetscCall(MatDenseGetColumnVecWrite(b->MW, c, &mw));
    PetscCall(MatMult(b->M, w, mw));
    PetscCall(MatDenseRestoreColumnVecWrite(b->MW, c, &mw));
    PetscCall(MatDenseRestoreColumnVecRead(b->W, c, &w));
  }
  PetscFunctionReturn(0);
}

/* out = X^T Y, [p][p], summed over the ranks. */
static PetscErrorCode inner(const basis *b, const double *X, const double *Y, double *out) {
  PetscFunctionBeginUser;
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &b->p, &b->p, &b->rows, &one, X, &b->rows, Y,
                                      &b->rows, &zero, out, &b->p));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, out, b->p * b->p, MPI_DOUBLE, MPI_SUM, b->comm));
  PetscFunctionReturn(0);
}

/* W -= Q_k C */
static PetscErrorCode subtract(const basis *b, int k, const double *C, double *W) {
  PetscFunctionBeginUser;
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &b->rows, &b->p, &b->p, &minus, b->Q[k], &b->rows,
                                      C, &b->p, &one, W, &b->rows));
  PetscFunctionReturn(0);
}

/* MW = M W, W -= Q Q^T M W; what the last block took of it is added to last. */
static PetscErrorCode remove_basis(const basis *b, double *last) {
  double       *W, *C;
  const double *MW;
  PetscFunctionBeginUser;
  PetscCall(multiply_mass(b));
  PetscCall(PetscMalloc1((size_t)(b->p * b->p), &C));
  PetscCall(MatDenseGetArray(b->W, &W));
  PetscCall(MatDenseGetArrayRead(b->MW, &MW));
  for (int k = 0; k < b->n; k++) {
    PetscCall(inner(b, b->Q[k], MW, C));
    PetscCall(subtract(b, k, C, W));
  }
  for (int i = 0; b->n > 0 && i < b->p * b->p; i++) last[i] += C[i];
  PetscCall(MatDenseRestoreArrayRead(b->MW, &MW));
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscCall(PetscFree(C));
  PetscFunctionReturn(0);
}

/* P = R P, R upper triangular, by columns. */
static void multiply_triangle(int p, const double *R, double *P) {
  for (int c = 0; c < p; c++)
    for (int r = 0; r < p; r++) {
      double sum = 0;
      for (int i = r; i < p; i++) sum += R[i * p + r] * P[c * p + i];
      P[c * p + r] = sum;
    }
}

/* W = W' R, W'^T M W' = 1, MW with it; product = R product. *good false: W has not full rank. */
static PetscErrorCode scale_block(const basis *b, double *product, bool *good) {
  double      *W, *MW, *R;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)(b->p * b->p), &R));
  PetscCall(MatDenseGetArray(b->W, &W));
  PetscCall(MatDenseGetArray(b->MW, &MW));
  PetscCall(inner(b, W, MW, R));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("U", &b->p, R, &b->p, &info));
  *good = info == 0;
  if (*good) {
    PetscCallBLAS("BLAStrsm",
                  BLAStrsm_("R", "U", "N", "N", &b->rows, &b->p, &one, R, &b->p, W, &b->rows));
    PetscCallBLAS("BLAStrsm",
                  BLAStrsm_("R", "U", "N", "N", &b->rows, &b->p, &one, R, &b->p, MW, &b->rows));
    multiply_triangle((int)b->p, R, product);
  }
  PetscCall(MatDenseRestoreArray(b->MW, &MW));
  PetscCall(MatDenseRestoreArray(b->W, &W));
  PetscCall(PetscFree(R));
  PetscFunctionReturn(0);
}

/* Make W orthonormal to the basis and in itself; D: what the last block takes of it is added, W = Q.. + W' R. What the
 * second pass takes out is rounding, and MW need not follow; what a single one does would grow from step to step. */
static PetscErrorCode orthonormalise(const basis *b, double *D, double *R, bool *good) {
  PetscFunctionBeginUser;
  *good = true;
  for (int i = 0; i < b->p * b->p; i++) R[i] = i % (b->p + 1) == 0;
  for (int pass = 0; pass < (b->n > 0 ? 2 : 1); pass++) PetscCall(remove_basis(b, D));
  for (int pass = 0; pass < 2 && *good; pass++) PetscCall(scale_block(b, R, good));
  PetscFunctionReturn(0);
}

/* Keep W as the next block. */
static PetscErrorCode append(basis *b) {
  const double *W;
  const size_t  size = (size_t)b->rows * (size_t)b->p;
  PetscFunctionBeginUser;
  b->Q[b->n] = malloc((size + 1) * sizeof(double));
  PetscCheck(b->Q[b->n], PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the Lanczos basis");
  PetscCall(MatDenseGetArrayRead(b->W, &W));
  memcpy(b->Q[b->n++], W, size * sizeof *W);
  PetscCall(MatDenseRestoreArrayRead(b->W, &W));
  PetscFunctionReturn(0);
}

static PetscErrorCode fill_noise(const basis *b) {
  double  *W;
  PetscInt first;
  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(b->W, &first, NULL));
  PetscCall(MatDenseGetArrayWrite(b->W, &W));
  for (size_t c = 0; c < (size_t)b->p; c++)
    for (size_t i = 0; i < (size_t)b->rows; i++)
      W[c * (size_t)b->rows + i] =
          modal_noise(((uint64_t)first + i) * (uint64_t)b->p + (uint64_t)c);
  PetscCall(MatDenseRestoreArrayWrite(b->W, &W));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ steps */

/* One block more: D and B of the last block, W the next. */
static PetscErrorCode step(basis *b, bool *good) {
  const size_t at = (size_t)(b->n - 1) * (size_t)(b->p * b->p);
  PetscFunctionBeginUser;
  PetscCall(KSPMatSolve(b->ksp, b->MW, b->W));
  PetscCall(orthonormalise(b, b->D + at, b->B + at, good));
  PetscFunctionReturn(0);
}

/* H from its blocks, lower triangle. */
static void assemble_projection(const basis *b) {
  const size_t p = (size_t)b->p, m = p * (size_t)b->n;
  memset(b->H, 0, m * m * sizeof *b->H);
  for (size_t k = 0; k < (size_t)b->n; k++)
    for (size_t c = 0; c < p; c++)
      for (size_t r = 0; r < p; r++) {
        const double *D = b->D + k * p * p, *B = b->B + k * p * p;
        double       *column = b->H + (k * p + c) * m + k * p;
        column[r]            = (D[c * p + r] + D[r * p + c]) / 2;
        if (k + 1 < (size_t)b->n) column[p + r] = B[c * p + r];
      }
}

/* Ritz values and, in H, vectors; *converged: how many from the greatest on; residual[i] of the wanted ones, relative. */
static PetscErrorCode find_pairs(const basis *b, int wanted, double tolerance, PetscReal *residual,
                                 int *converged) {
  const PetscBLASInt m    = b->p * b->n;
  const double      *B    = b->B + (size_t)(b->n - 1) * (size_t)(b->p * b->p);
  PetscBLASInt       size = 8 * m, info;
  double            *work;

  PetscFunctionBeginUser;
  assemble_projection(b);
  PetscCall(PetscMalloc1((size_t)size, &work));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "L", &m, b->H, &m, b->theta, work, &size, &info));
  PetscCall(PetscFree(work));
  PetscCheck(info == 0, b->comm, PETSC_ERR_LIB, "syev: %d", (int)info);
  bool unbroken = true;
  *converged    = 0;
  for (int i = 0; i < wanted && i < m; i++) {
    const double *last   = b->H + (size_t)(m - 1 - i) * (size_t)m + (m - b->p);
    double        square = 0;
    for (int r = 0; r < b->p; r++) {
      double sum = 0;
      for (int c = r; c < b->p; c++) sum += B[c * b->p + r] * last[c];
      square += sum * sum;
    }
    residual[i] = sqrt(square) / fabs(b->theta[m - 1 - i]);
    unbroken    = unbroken && residual[i] <= tolerance;
    if (unbroken) *converged = i + 1;
  }
  PetscFunctionReturn(0);
}

/* X = Q times the vectors of H that belong to the greatest values, greatest first. */
static PetscErrorCode combine(const basis *b, Mat X) {
  const PetscBLASInt m = b->p * b->n;
  PetscInt           count, lda;
  double            *x, *S;
  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &count));
  PetscCall(MatDenseGetLDA(X, &lda));
  PetscCall(PetscMalloc1((size_t)b->p * (size_t)count, &S));
  PetscCall(MatDenseGetArrayWrite(X, &x));
  const PetscBLASInt columns = (PetscBLASInt)count, ldx = (PetscBLASInt)PetscMax(lda, 1);
  for (int k = 0; k < b->n; k++) {
    for (int i = 0; i < count; i++)
      memcpy(S + i * b->p, b->H + (size_t)(m - 1 - i) * (size_t)m + k * b->p,
             (size_t)b->p * sizeof *S);
    PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &b->rows, &columns, &b->p, &one, b->Q[k],
                                        &b->rows, S, &b->p, k == 0 ? &zero : &one, x, &ldx));
  }
  PetscCall(MatDenseRestoreArrayWrite(X, &x));
  PetscCall(PetscFree(S));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ the solver */

static PetscErrorCode create_basis(EPS eps, basis *b) {
  const method *own = eps->data;
  PetscInt      rows;
  PetscFunctionBeginUser;
  memset(b, 0, sizeof *b);
  b->p    = (PetscBLASInt)own->size;
  b->room = (int)(own->limit / own->size);
  b->comm = PetscObjectComm((PetscObject)eps);
  PetscCall(STGetMatrix(eps->st, 1, &b->M));
  PetscCall(STGetKSP(eps->st, &b->ksp));
  PetscCall(MatGetLocalSize(b->M, &rows, NULL));
  b->rows = (PetscBLASInt)rows;
  PetscCall(MatCreateDense(b->comm, rows, PETSC_DECIDE, eps->n, b->p, NULL, &b->W));
  PetscCall(MatCreateDense(b->comm, rows, PETSC_DECIDE, eps->n, b->p, NULL, &b->MW));
  const size_t m = (size_t)b->p * (size_t)b->room, each = (size_t)(b->p * b->p);
  PetscCall(PetscCalloc5((size_t)b->room, &b->Q, (size_t)b->room * each, &b->D,
                         (size_t)b->room * each, &b->B, m * m, &b->H, m, &b->theta));
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy_basis(basis *b) {
  PetscFunctionBeginUser;
  for (int k = 0; k < b->n; k++) free(b->Q[k]);
  PetscCall(PetscFree5(b->Q, b->D, b->B, b->H, b->theta));
  PetscCall(MatDestroy(&b->W));
  PetscCall(MatDestroy(&b->MW));
  PetscFunctionReturn(0);
}

/* Grow until the stopping test says so, or there is no more room. */
static PetscErrorCode grow(EPS eps, basis *b) {
  const int wanted    = (int)eps->nev;
  int       converged = 0;
  bool      good      = true;
  double   *unused;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1((size_t)(b->p * b->p), &unused));
  PetscCall(fill_noise(b));
  PetscCall(orthonormalise(b, NULL, unused, &good));
  PetscCall(PetscFree(unused));
  while (good && eps->reason == EPS_CONVERGED_ITERATING) {
    PetscCall(append(b));
    PetscCall(step(b, &good));
    eps->its++;
    if (good && b->n * b->p >= wanted)
      PetscCall(find_pairs(b, wanted, eps->tol, eps->errest, &converged));
    eps->nconv = converged;
    PetscCall(EPSMonitor(eps, eps->its, converged, eps->eigr, eps->eigi, eps->errest, wanted));
    PetscCall((*eps->stopping)(eps, eps->its, b->room, converged, wanted, &eps->reason,
                               eps->stoppingctx));
    if (eps->reason == EPS_CONVERGED_ITERATING && b->n == b->room) eps->reason = EPS_DIVERGED_ITS;
  }
  if (!good && eps->reason == EPS_CONVERGED_ITERATING) eps->reason = EPS_DIVERGED_BREAKDOWN;
  PetscFunctionReturn(0);
}

static PetscErrorCode solve(EPS eps) {
  basis b;
  Mat   X;
  PetscFunctionBeginUser;
  PetscCall(create_basis(eps, &b));
  PetscCall(grow(eps, &b));
  if (eps->nconv > 0) {
    PetscCall(BVSetActiveColumns(eps->V, 0, eps->nev));
    PetscCall(BVGetMat(eps->V, &X));
    PetscCall(combine(&b, X));
    PetscCall(BVRestoreMat(eps->V, &X));
    for (int i = 0; i < eps->nev; i++) eps->eigr[i] = b.theta[b.n * b.p - 1 - i];
  }
  PetscCall(destroy_basis(&b));
  PetscFunctionReturn(0);
}

/* Room for the modes alone is taken in eps->V; the basis is the solver's own. */
static PetscErrorCode set_up(EPS eps) {
  method     *own = eps->data;
  const char *prefix;
  PetscFunctionBeginUser;
  EPSCheckHermitianDefinite(eps);
  EPSCheckSinvert(eps);
  PetscCall(EPSGetOptionsPrefix(eps, &prefix));
  PetscCall(PetscOptionsGetInt(NULL, prefix, "-eps_block_size", &own->size, NULL));
  PetscCheck(own->size >= 1 && own->size <= eps->n, PetscObjectComm((PetscObject)eps),
             PETSC_ERR_USER_INPUT, "-eps_block_size %d: one or more", (int)own->size);
  own->limit  = eps->ncv > eps->nev ? eps->ncv : 8 * eps->nev + 30 * own->size;
  own->limit  = PetscMin(own->limit, eps->n) / own->size * own->size;
  eps->ncv    = eps->nev;
  eps->mpd    = eps->nev;
  eps->max_it = own->limit / own->size;
  PetscCall(EPSAllocateSolution(eps, 0));
  PetscCall(EPS_SetInnerProduct(eps));
  PetscFunctionReturn(0);
}

static PetscErrorCode set_up_sort(EPS eps) {
  PetscFunctionBeginUser;
  eps->sc->comparison    = SlepcCompareTargetMagnitude;
  eps->sc->comparisonctx = &eps->target;
  eps->sc->map           = NULL;
  eps->sc->mapobj        = NULL;
  PetscFunctionReturn(0);
}

static PetscErrorCode transform_back(EPS eps) {
  PetscFunctionBeginUser;
  PetscCall(STBackTransform(eps->st, eps->nconv, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy(EPS eps) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(eps->data));
  PetscFunctionReturn(0);
}

static PetscErrorCode create(EPS eps) {
  method *own;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&own));
  own->size               = 4;
  eps->data               = own;
  eps->categ              = EPS_CATEGORY_KRYLOV;
  eps->ops->solve         = solve;
  eps->ops->setup         = set_up;
  eps->ops->setupsort     = set_up_sort;
  eps->ops->destroy       = destroy;
  eps->ops->backtransform = transform_back;
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_lanczos_register(void) {
  PetscFunctionBeginUser;
  PetscCall(EPSRegister(MODAL_BLOCK_LANCZOS, create));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_lanczos_set_size(EPS eps, PetscInt size) {
  PetscFunctionBeginUser;
  ((method *)eps->data)->size = size;
  PetscFunctionReturn(0);
}
