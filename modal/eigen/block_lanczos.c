#include "modal/eigen/block_lanczos.h"

#include <math.h>
#include <petscblaslapack.h>
#include <slepc/private/epsimpl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "modal/eigen/block_basis.h"

typedef struct {
  PetscInt          size, limit; /* columns per block; columns of the basis, at most */
  modal_block_basis basis;       /* of the last run */
} method;

static const PetscScalar one = 1, zero = 0;

/* ------------------------------------------------------------------ steps */

/* One Lanczos step: compute D and B of the last block; W becomes the next one. */
static PetscErrorCode step(modal_block_basis *b, bool *good) {
  const size_t at = (size_t)(b->n - 1) * (size_t)(b->p * b->p);
  PetscFunctionBeginUser;
  PetscCall(KSPMatSolve(b->ksp, b->MW, b->W));
  PetscCall(modal_block_basis_orthonormalise(b, b->D + at, b->B + at, good));
  PetscFunctionReturn(0);
}

/* Ritz values, and vectors in H. residual[i]: relative residual of the wanted pairs, largest first.
 * *converged: number of leading pairs that have converged. */
static PetscErrorCode find_pairs(const modal_block_basis *b, int wanted, double tolerance,
                                 PetscReal *residual, int *converged) {
  const PetscBLASInt m    = b->p * b->n;
  const double      *B    = b->B + (size_t)(b->n - 1) * (size_t)(b->p * b->p);
  PetscBLASInt       size = 8 * m, info;
  double            *work;

  PetscFunctionBeginUser;
  modal_block_basis_projection((int)b->p, b->n, b->D, b->B, b->H);
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

/* X = Q times the leading eigenvectors of H, largest Ritz value first. */
static PetscErrorCode form_vectors(const modal_block_basis *b, Mat X) {
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

/* First block of the basis. */
static PetscErrorCode start_basis(modal_block_basis *b, bool *good) {
  double *unused;
  PetscFunctionBeginUser;
  PetscCall(modal_block_basis_randomise(b, 0));
  PetscCall(PetscCalloc1((size_t)(b->p * b->p), &unused));
  PetscCall(modal_block_basis_orthonormalise(b, NULL, unused, good));
  PetscCall(PetscFree(unused));
  PetscFunctionReturn(0);
}

/* Extend the basis until the stopping test succeeds or the memory is used up. */
static PetscErrorCode extend_basis(EPS eps, modal_block_basis *b) {
  const int wanted    = (int)eps->nev;
  int       converged = 0;
  bool      good      = true;

  PetscFunctionBeginUser;
  PetscCall(start_basis(b, &good));
  while (good && eps->reason == EPS_CONVERGED_ITERATING) {
    PetscCall(modal_block_basis_append(b));
    PetscCall(step(b, &good));
    eps->its++;
    if (good && b->n * b->p >= wanted)
      PetscCall(find_pairs(b, wanted, eps->tol, eps->errest, &converged));
    eps->nconv = converged;
    PetscCall(EPSMonitor(eps, eps->its, converged, eps->eigr, eps->eigi, eps->errest, wanted));
    PetscCall((*eps->stopping)(eps, eps->its, b->capacity, converged, wanted, &eps->reason,
                               eps->stoppingctx));
    if (eps->reason == EPS_CONVERGED_ITERATING && b->n == b->capacity)
      eps->reason = EPS_DIVERGED_ITS;
  }
  if (!good && eps->reason == EPS_CONVERGED_ITERATING) eps->reason = EPS_DIVERGED_BREAKDOWN;
  PetscFunctionReturn(0);
}

static PetscErrorCode solve(EPS eps) {
  method            *own = eps->data;
  modal_block_basis *b   = &own->basis;
  Mat                X, M;
  KSP                ksp;
  PetscFunctionBeginUser;
  PetscCall(STGetMatrix(eps->st, 1, &M));
  PetscCall(STGetKSP(eps->st, &ksp));
  PetscCall(modal_block_basis_destroy(b));
  PetscCall(modal_block_basis_create(M, ksp, (int)own->size, (int)(own->limit / own->size), b));
  PetscCall(extend_basis(eps, b));
  if (eps->nconv > 0) {
    PetscCall(BVSetActiveColumns(eps->V, 0, eps->nev));
    PetscCall(BVGetMat(eps->V, &X));
    PetscCall(form_vectors(b, X));
    PetscCall(BVRestoreMat(eps->V, &X));
    for (int i = 0; i < eps->nev; i++) eps->eigr[i] = b->theta[b->n * b->p - 1 - i];
  }
  PetscFunctionReturn(0);
}

/* eps->V gets memory for the modes only; the solver owns its basis. */
static PetscErrorCode set_up(EPS eps) {
  method   *own = eps->data;
  PetscBool inverts;
  PetscFunctionBeginUser;
  PetscCheck(eps->ishermitian && (!eps->isgeneralized || eps->ispositive),
             PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "block Lanczos needs symmetric matrices and a positive definite mass matrix");
  PetscCall(PetscObjectTypeCompare((PetscObject)eps->st, STSINVERT, &inverts));
  PetscCheck(inverts, PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "block Lanczos needs the spectral transform sinvert");
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

static PetscErrorCode set_from_options(EPS eps, PetscOptionItems *PetscOptionsObject) {
  method *own = eps->data;
  PetscFunctionBeginUser;
  PetscOptionsHeadBegin(PetscOptionsObject, "block Lanczos");
  PetscCall(PetscOptionsInt("-eps_block_size", "columns a block", "modal_block_lanczos_set_size",
                            own->size, &own->size, NULL));
  PetscOptionsHeadEnd();
  PetscFunctionReturn(0);
}

static PetscErrorCode reset(EPS eps) {
  PetscFunctionBeginUser;
  PetscCall(modal_block_lanczos_release(eps));
  PetscFunctionReturn(0);
}

static PetscErrorCode destroy(EPS eps) {
  PetscFunctionBeginUser;
  PetscCall(modal_block_lanczos_release(eps));
  PetscCall(PetscFree(eps->data));
  PetscFunctionReturn(0);
}

static PetscErrorCode create(EPS eps) {
  method *own;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&own));
  own->size                = 4;
  eps->data                = own;
  eps->categ               = EPS_CATEGORY_KRYLOV;
  eps->ops->solve          = solve;
  eps->ops->setup          = set_up;
  eps->ops->setupsort      = set_up_sort;
  eps->ops->setfromoptions = set_from_options;
  eps->ops->reset          = reset;
  eps->ops->destroy        = destroy;
  eps->ops->backtransform  = transform_back;
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

PetscErrorCode modal_block_lanczos_get_size(EPS eps, PetscInt *size) {
  PetscFunctionBeginUser;
  *size = ((method *)eps->data)->size;
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_lanczos_basis(EPS eps, const modal_block_basis **basis) {
  PetscFunctionBeginUser;
  *basis = &((method *)eps->data)->basis;
  PetscFunctionReturn(0);
}

PetscErrorCode modal_block_lanczos_release(EPS eps) {
  PetscFunctionBeginUser;
  PetscCall(modal_block_basis_destroy(&((method *)eps->data)->basis));
  PetscFunctionReturn(0);
}
