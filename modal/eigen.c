#include "modal/eigen.h"

#include <math.h>
#include <petscblaslapack.h>
#include <string.h>

typedef struct {
  shb_progress *progress;
  MPI_Comm      comm;
} watch;

static PetscErrorCode monitor(EPS eps, PetscInt iteration, PetscInt n_converged, PetscScalar *re,
                              PetscScalar *im, PetscReal *error, PetscInt n_error, void *context) {
  PetscInt wanted;
  (void)re, (void)im, (void)error, (void)n_error;
  PetscFunctionBeginUser;
  PetscCall(EPSGetDimensions(eps, &wanted, NULL, NULL));
  if (n_converged > wanted) n_converged = wanted;
  shb_progress_show(((watch *)context)->progress, 30 + 50. * n_converged / wanted,
                    "eigensolve: %d of %d modes, iteration %d", (int)n_converged, (int)wanted,
                    (int)iteration);
  PetscFunctionReturn(0);
}

/* SLEPc's own test, and an interrupt on any rank. */
static PetscErrorCode stop(EPS eps, PetscInt iteration, PetscInt max_iterations,
                           PetscInt n_converged, PetscInt wanted, EPSConvergedReason *reason,
                           void *context) {
  int interrupted = shb_interrupted();
  PetscFunctionBeginUser;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, &interrupted, 1, MPI_INT, MPI_MAX, ((watch *)context)->comm));
  PetscCall(EPSStoppingBasic(eps, iteration, max_iterations, n_converged, wanted, reason, NULL));
  if (interrupted) *reason = EPS_CONVERGED_USER;
  PetscFunctionReturn(0);
}

static PetscErrorCode configure(const fem_system *system, const modal_eigen_settings *settings,
                                watch *context, EPS eps) {
  const PetscInt order = 3 * system->n_free, n = settings->modes;
  PetscInt       ncv = PetscMin(order, PetscMax(2 * n, n + 15));
  ST             st;
  KSP            ksp;
  PC             pc;

  PetscFunctionBeginUser;
  PetscCall(EPSSetOperators(eps, system->K, system->M));
  PetscCall(EPSSetProblemType(eps, EPS_GHEP));
  PetscCall(EPSSetType(eps, EPSKRYLOVSCHUR));
  PetscCall(EPSSetDimensions(eps, n, ncv, PETSC_DEFAULT));
  PetscCall(EPSSetTolerances(eps, settings->tolerance > 0 ? settings->tolerance : 1e-10, 1000));
  PetscCall(EPSSetTarget(eps, settings->shift));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSMonitorSet(eps, monitor, context, NULL));
  PetscCall(EPSSetStoppingTestFunction(eps, stop, context, NULL));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STSetMatStructure(st, SAME_NONZERO_PATTERN));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(EPSSetFromOptions(eps));
  PetscFunctionReturn(0);
}

/* Negative pivots that MUMPS met (on one rank all of them; on more, its dense root is not counted but must be
 * positive definite too); 0 from another solver. */
static PetscErrorCode count_negative(Mat factor, PetscInt *n) {
  MatSolverType type;
  PetscBool     is_mumps;
  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(MatFactorGetSolverType(factor, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &is_mumps));
  if (is_mumps) PetscCall(MatMumpsGetInfog(factor, 12, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode factorise(EPS eps, Mat *factor) {
  ST             st;
  KSP            ksp;
  PC             pc;
  MatFactorError error;
  PetscInt       negative;
  PetscScalar    shift;

  PetscFunctionBeginUser;
  PetscCall(EPSSetUp(eps));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCFactorGetMatrix(pc, factor));
  PetscCall(MatFactorGetError(*factor, &error));
  PetscCheck(error != MAT_FACTOR_OUTMEMORY, PetscObjectComm((PetscObject)eps), PETSC_ERR_MEM,
             "MUMPS");
  PetscCheck(error == MAT_FACTOR_NOERROR, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             "the stiffness matrix is not positive definite: the clamp on group root does not hold "
             "the body, or the material is not physical");
  PetscCall(STGetShift(st, &shift));
  PetscCall(count_negative(*factor, &negative));
  PetscCheck(negative == 0 || shift > 0, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             "the stiffness matrix is not positive definite (%d negative pivots): the material is "
             "not physical, or the equilibrium at rotor.speed is not stable",
             (int)negative);
  PetscFunctionReturn(0);
}

PetscErrorCode modal_dense_create(const fem_system *system, int n, Mat *X) {
  const PetscInt n_own = 3 * (system->last - system->first);
  PetscFunctionBeginUser;
  PetscCall(MatCreateDense(system->comm, n_own, PETSC_DECIDE, 3 * system->n_free, n, NULL, X));
  PetscCall(MatAssemblyBegin(*X, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*X, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_inverse(const modal_eigen *eigen, Mat B, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(MatMatSolve(eigen->factor, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_mass_multiply(const fem_system *system, Mat X, Mat Y) {
  PetscInt n;
  Vec      x, y;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &n));
  for (PetscInt c = 0; c < n; c++) {
    PetscCall(MatDenseGetColumnVecRead(X, c, &x));
    PetscCall(MatDenseGetColumnVecWrite(Y, c, &y));
    PetscCall(MatMult(system->M, x, y));
    PetscCall(MatDenseRestoreColumnVecWrite(Y, c, &y));
    PetscCall(MatDenseRestoreColumnVecRead(X, c, &x));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_remove(const fem_system *system, const modal_eigen *eigen, Mat X) {
  const PetscScalar *phi, *m_phi;
  PetscScalar       *x, *coefficient, one = 1, minus = -1, zero = 0;
  PetscBLASInt       rows, lda, ldx, n = eigen->n, columns;
  PetscInt           size;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &size));
  columns = (PetscBLASInt)size;
  PetscCall(MatDenseGetLDA(eigen->phi, &size));
  lda = (PetscBLASInt)PetscMax(size, 1);
  PetscCall(MatDenseGetLDA(X, &size));
  ldx  = (PetscBLASInt)PetscMax(size, 1);
  rows = (PetscBLASInt)(3 * (system->last - system->first));
  PetscCall(PetscMalloc1((size_t)n * (size_t)columns, &coefficient));
  PetscCall(MatDenseGetArrayRead(eigen->phi, &phi));
  PetscCall(MatDenseGetArrayRead(eigen->m_phi, &m_phi));
  PetscCall(MatDenseGetArray(X, &x));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &n, &columns, &rows, &one, m_phi, &lda, x, &ldx,
                                      &zero, coefficient, &n));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, coefficient, n * columns, MPI_DOUBLE, MPI_SUM, system->comm));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &rows, &columns, &n, &minus, phi, &lda, coefficient,
                                      &n, &one, x, &ldx));
  PetscCall(MatDenseRestoreArray(X, &x));
  PetscCall(MatDenseRestoreArrayRead(eigen->m_phi, &m_phi));
  PetscCall(MatDenseRestoreArrayRead(eigen->phi, &phi));
  PetscCall(PetscFree(coefficient));
  PetscFunctionReturn(0);
}

/* A fixed number in [-1, 1) for each dof of the mesh (splitmix64's finaliser): no symmetric mode cancels. */
static double noise(uint64_t key) {
  uint64_t z = (key + 1) * 0x9e3779b97f4a7c15u;
  z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z          = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/* +1 or -1 so that the sum of the mode's dofs times noise comes out positive, on any number of ranks. */
static PetscErrorCode sign_of(const fem_system *system, Vec phi, double *sign) {
  const PetscScalar *x;
  double             sum = 0;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(phi, &x));
  for (int i = 0; i < system->n_nodes; i++) {
    PetscInt row = system->row[i];
    if (row < system->first || row >= system->last) continue;
    for (int d = 0; d < 3; d++)
      sum += noise(3 * (uint64_t)i + (uint64_t)d) * x[3 * (row - system->first) + d];
  }
  PetscCall(VecRestoreArrayRead(phi, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, system->comm));
  *sign = sum < 0 ? -1 : 1;
  PetscFunctionReturn(0);
}

/* Copy the converged pairs, mass-normalised and with their sign. */
static PetscErrorCode collect(const fem_system *system, modal_eigen *eigen) {
  Vec    phi, m_phi;
  double norm, sign;

  PetscFunctionBeginUser;
  PetscCall(modal_dense_create(system, eigen->n, &eigen->phi));
  PetscCall(modal_dense_create(system, eigen->n, &eigen->m_phi));
  for (int i = 0; i < eigen->n; i++) {
    PetscCall(MatDenseGetColumnVecWrite(eigen->phi, i, &phi));
    PetscCall(MatDenseGetColumnVecWrite(eigen->m_phi, i, &m_phi));
    PetscCall(EPSGetEigenpair(eigen->eps, i, eigen->lambda + i, NULL, phi, NULL));
    PetscCall(MatMult(system->M, phi, m_phi));
    PetscCall(VecDot(phi, m_phi, &norm));
    PetscCall(sign_of(system, phi, &sign));
    PetscCall(VecScale(phi, sign / sqrt(norm)));
    PetscCall(VecScale(m_phi, sign / sqrt(norm)));
    PetscCall(MatDenseRestoreColumnVecWrite(eigen->m_phi, i, &m_phi));
    PetscCall(MatDenseRestoreColumnVecWrite(eigen->phi, i, &phi));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode find_residuals(const fem_system *system, double shift, modal_eigen *eigen) {
  Mat    inverse;
  Vec    phi, x, work;
  double square;

  PetscFunctionBeginUser;
  PetscCall(modal_dense_create(system, eigen->n, &inverse));
  PetscCall(modal_eigen_inverse(eigen, eigen->m_phi, inverse));
  PetscCall(MatCreateVecs(system->M, NULL, &work));
  for (int i = 0; i < eigen->n; i++) {
    PetscCall(MatDenseGetColumnVecRead(eigen->phi, i, &phi));
    PetscCall(MatDenseGetColumnVec(inverse, i, &x));
    PetscCall(VecAYPX(x, -(eigen->lambda[i] - shift), phi));
    PetscCall(MatMult(system->M, x, work));
    PetscCall(VecDot(x, work, &square));
    eigen->residual[i] = sqrt(PetscMax(square, 0));
    PetscCall(MatDenseRestoreColumnVec(inverse, i, &x));
    PetscCall(MatDenseRestoreColumnVecRead(eigen->phi, i, &phi));
  }
  PetscCall(VecDestroy(&work));
  PetscCall(MatDestroy(&inverse));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_solve(const fem_system *system, const modal_eigen_settings *settings,
                                 modal_eigen *eigen) {
  watch              context = {settings->progress, system->comm};
  EPSConvergedReason reason;
  PetscInt           n_converged;
  double             started = shb_seconds();

  PetscFunctionBeginUser;
  memset(eigen, 0, sizeof *eigen);
  PetscCheck(settings->modes <= 3 * system->n_free, system->comm, PETSC_ERR_USER_INPUT,
             "modal.modes: %d modes asked of a mesh with %d free dofs", settings->modes,
             (int)(3 * system->n_free));
  PetscCall(EPSCreate(system->comm, &eigen->eps));
  PetscCall(configure(system, settings, &context, eigen->eps));
  shb_progress_show(settings->progress, 15, "factorising %d dofs", (int)(3 * system->n_free));
  PetscCall(factorise(eigen->eps, &eigen->factor));
  shb_progress_note(settings->progress, "factorised in %.2f s", shb_seconds() - started);
  started = shb_seconds();
  PetscCall(EPSSolve(eigen->eps));
  PetscCall(EPSGetConvergedReason(eigen->eps, &reason));
  PetscCall(EPSGetConverged(eigen->eps, &n_converged));
  if (reason == EPS_CONVERGED_USER && n_converged < settings->modes) PetscFunctionReturn(0);
  PetscCheck(n_converged >= settings->modes, system->comm, PETSC_ERR_NOT_CONVERGED,
             "modal: only %d of %d modes converged; try -eps_ncv or -eps_max_it", (int)n_converged,
             settings->modes);
  eigen->n = settings->modes;
  PetscCall(PetscMalloc2(eigen->n, &eigen->lambda, eigen->n, &eigen->residual));
  PetscCall(collect(system, eigen));
  PetscCall(find_residuals(system, settings->shift, eigen));
  shb_progress_note(settings->progress, "%d modes in %.2f s", eigen->n, shb_seconds() - started);
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_destroy(modal_eigen *eigen) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(eigen->lambda, eigen->residual));
  PetscCall(MatDestroy(&eigen->phi));
  PetscCall(MatDestroy(&eigen->m_phi));
  PetscCall(EPSDestroy(&eigen->eps));
  memset(eigen, 0, sizeof *eigen);
  PetscFunctionReturn(0);
}
