#include "modal/eigen/eigen.h"

#include <math.h>
#include <petscblaslapack.h>
#include <string.h>

#include "modal/common/phases.h"
#include "modal/common/random_vector.h"
#include "modal/eigen/block_lanczos.h"
#include "modal/eigen/inertia_count.h"
#include "modal/eigen/missed_modes.h"

typedef struct {
  shb_progress *progress;
  MPI_Comm      comm;
} monitor_context;

static PetscErrorCode monitor(EPS eps, PetscInt iteration, PetscInt n_converged, PetscScalar *re,
                              PetscScalar *im, PetscReal *error, PetscInt n_error, void *context) {
  PetscInt wanted;
  (void)re, (void)im, (void)error, (void)n_error;
  PetscFunctionBeginUser;
  PetscCall(EPSGetDimensions(eps, &wanted, NULL, NULL));
  if (n_converged > wanted) n_converged = wanted;
  shb_progress_show(((monitor_context *)context)->progress, 30 + 50. * n_converged / wanted,
                    "eigensolve: %d of %d modes, iteration %d", (int)n_converged, (int)wanted,
                    (int)iteration);
  PetscFunctionReturn(0);
}

/* SLEPc's own stopping test, and an interrupt on any rank. */
static PetscErrorCode stop(EPS eps, PetscInt iteration, PetscInt max_iterations,
                           PetscInt n_converged, PetscInt wanted, EPSConvergedReason *reason,
                           void *context) {
  int interrupted = shb_interrupted();
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &interrupted, 1, MPI_INT, MPI_MAX,
                             ((monitor_context *)context)->comm));
  PetscCall(EPSStoppingBasic(eps, iteration, max_iterations, n_converged, wanted, reason, NULL));
  if (interrupted) *reason = EPS_CONVERGED_USER;
  PetscFunctionReturn(0);
}

/* Choose block Lanczos; Krylov-Schur for meshes too small for its basis. */
static PetscErrorCode choose_method(const fem_system *system, int n, EPS eps) {
  const PetscInt order = 3 * system->n_free;
  PetscFunctionBeginUser;
  PetscCall(modal_block_lanczos_register());
  if (order >= 20 * (n + 10)) {
    PetscCall(EPSSetType(eps, MODAL_BLOCK_LANCZOS));
    PetscCall(EPSSetDimensions(eps, n, PETSC_DEFAULT, PETSC_DEFAULT));
  } else {
    PetscCall(EPSSetType(eps, EPSKRYLOVSCHUR));
    PetscCall(EPSSetDimensions(eps, n, PetscMin(order, PetscMax(2 * n, n + 15)), PETSC_DEFAULT));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode configure(const fem_system *system, const modal_eigen_settings *settings,
                                monitor_context *context, modal_eigen *eigen) {
  const PetscInt order = 3 * system->n_free, n_own = 3 * (system->last - system->first);
  EPS            eps = eigen->eps;
  Mat            K   = system->K;
  ST             st;
  KSP            ksp;
  PC             pc;

  PetscFunctionBeginUser;
  if (settings->spare) /* one without numbers: the factor has them */
    PetscCall(MatCreateShell(system->comm, n_own, n_own, order, order, NULL, &K));
  else
    PetscCall(PetscObjectReference((PetscObject)K));
  PetscCall(EPSSetOperators(eps, K, system->M));
  PetscCall(MatDestroy(&K));
  PetscCall(EPSSetProblemType(eps, EPS_GHEP));
  PetscCall(choose_method(system, settings->modes, eps));
  PetscCall(EPSSetPurify(eps, PETSC_FALSE)); /* M is not singular */
  PetscCall(EPSSetTolerances(eps, settings->tolerance > 0 ? settings->tolerance : 1e-10, 1000));
  PetscCall(EPSSetTarget(eps, settings->shift));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSMonitorSet(eps, monitor, context, NULL));
  PetscCall(EPSSetStoppingTestFunction(eps, stop, context, NULL));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STSetMatMode(st, ST_MATMODE_SHELL)); /* the factor holds K - shift M */
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(fem_factor_set_pc(eigen->factor, pc));
  PetscCall(EPSSetFromOptions(eps));
  PetscFunctionReturn(0);
}

/* K - shift M; K itself if the shift is 0. */
static PetscErrorCode create_shifted(const fem_system *system, double shift, Mat *A) {
  PetscFunctionBeginUser;
  if (shift == 0) {
    PetscCall(PetscObjectReference((PetscObject)system->K));
    *A = system->K;
    PetscFunctionReturn(0);
  }
  PetscCall(fem_system_shifted(system, shift, A));
  PetscFunctionReturn(0);
}

/* Memory of the basis, of the modes and of later work, bytes. */
static double extra_memory(const fem_system *system, int modes) {
  return 8. * 3. * (double)system->n_free * (8. * modes + 60.);
}

PetscErrorCode modal_eigen_analyse(const fem_system *system, int modes, fem_factor **factor) {
  PetscFunctionBeginUser;
  PetscCall(fem_factor_create(system->K, extra_memory(system, modes), factor));
  PetscFunctionReturn(0);
}

static PetscErrorCode factorise(const fem_system *system, const modal_eigen_settings *settings,
                                modal_eigen *eigen) {
  bool definite = false;
  Mat  A;

  PetscFunctionBeginUser;
  PetscCall(create_shifted(system, settings->shift, &A));
  if (settings->factor && *settings->factor) {
    eigen->factor     = *settings->factor;
    *settings->factor = NULL;
  } else
    PetscCall(fem_factor_create(A, extra_memory(system, settings->modes), &eigen->factor));
  modal_phase(system->comm, settings->progress, "analysis", "%s, %.3g GB foreseen",
              fem_factor_program(eigen->factor), 1e-9 * fem_factor_bytes(eigen->factor));
  PetscCall(fem_factor_update(eigen->factor, A, &definite));
  PetscCall(MatDestroy(&A));
  if (settings->spare && !fem_factor_needs_matrix(eigen->factor))
    PetscCall(MatDestroy(&settings->spare->system->K));
  PetscCheck(definite, system->comm, PETSC_ERR_USER_INPUT,
             "the stiffness matrix is not positive definite: the clamp on group root does not hold "
             "the body, the material is not physical, or the equilibrium at rotor.speed is not "
             "stable");
  modal_phase(system->comm, settings->progress, "factor", "%d dofs", (int)(3 * system->n_free));
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
  PetscCall(fem_factor_solve_many(eigen->factor, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_inverse_at(const modal_eigen *eigen, const bool *node, Mat B, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(fem_factor_solve_at(eigen->factor, node, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_project_out(const fem_system *system, const modal_eigen *eigen, Mat X) {
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

/* Sign that makes the mode's sum of dofs times random numbers positive, on any number of ranks. */
static PetscErrorCode find_sign(const fem_system *system, Vec phi, double *sign) {
  const PetscScalar *x;
  double             sum = 0;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(phi, &x));
  for (int i = 0; i < system->n_nodes; i++) {
    PetscInt row = system->row[i];
    if (row < system->first || row >= system->last) continue;
    for (int d = 0; d < 3; d++)
      sum += modal_random(3 * (uint64_t)i + (uint64_t)d) * x[3 * (row - system->first) + d];
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
    PetscCall(find_sign(system, phi, &sign));
    PetscCall(VecScale(phi, sign / sqrt(norm)));
    PetscCall(VecScale(m_phi, sign / sqrt(norm)));
    PetscCall(MatDenseRestoreColumnVecWrite(eigen->m_phi, i, &m_phi));
    PetscCall(MatDenseRestoreColumnVecWrite(eigen->phi, i, &phi));
  }
  PetscFunctionReturn(0);
}

/* Residuals of the modes from first on, one for each column of X [order][count]. */
static PetscErrorCode find_some_residuals(const fem_system *system, double shift, int first, Mat X,
                                          Vec work, modal_eigen *eigen) {
  Mat      m_phi;
  PetscInt count;
  double   square;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(X, NULL, &count));
  PetscCall(
      MatDenseGetSubMatrix(eigen->m_phi, PETSC_DECIDE, PETSC_DECIDE, first, first + count, &m_phi));
  PetscCall(fem_factor_solve_many(eigen->factor, m_phi, X));
  PetscCall(MatDenseRestoreSubMatrix(eigen->m_phi, &m_phi));
  for (int i = 0; i < count; i++) {
    Vec phi, x;
    PetscCall(MatDenseGetColumnVecRead(eigen->phi, first + i, &phi));
    PetscCall(MatDenseGetColumnVec(X, i, &x));
    PetscCall(VecAYPX(x, -(eigen->lambda[first + i] - shift), phi));
    PetscCall(MatMult(system->M, x, work));
    PetscCall(VecDot(x, work, &square));
    eigen->eigen_residual[first + i] = sqrt(PetscMax(square, 0));
    PetscCall(MatDenseRestoreColumnVec(X, i, &x));
    PetscCall(MatDenseRestoreColumnVecRead(eigen->phi, first + i, &phi));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode find_residuals(const fem_system *system, double shift, modal_eigen *eigen) {
  enum { BATCH = 20 }; /* columns of which the solver reads its factor once */
  Vec work;
  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(system->M, NULL, &work));
  for (int first = 0; first < eigen->n; first += BATCH) {
    Mat X;
    PetscCall(modal_dense_create(system, PetscMin(BATCH, eigen->n - first), &X));
    PetscCall(find_some_residuals(system, shift, first, X, work, eigen));
    PetscCall(MatDestroy(&X));
  }
  PetscCall(VecDestroy(&work));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ missing modes */

/* Number of eigenvalues found below limit. */
static PetscErrorCode count_found(EPS eps, int modes, double limit, int *count) {
  PetscFunctionBeginUser;
  *count = 0;
  for (int i = 0; i < modes; i++) {
    double lambda;
    PetscCall(EPSGetEigenvalue(eps, i, &lambda, NULL));
    *count += lambda < limit;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode check_by_inertia(const fem_system *system, const modal_spare_stiffness *spare,
                                       modal_check *check, modal_verdict *verdict) {
  const int  found = check->count;
  const bool gone  = spare && !system->K;
  PetscFunctionBeginUser;
  if (gone) PetscCall(fem_system_restore(&spare->source, spare->system));
  PetscCall(modal_inertia_count(system, check->limit, &check->count));
  if (gone) PetscCall(MatDestroy(&spare->system->K));
  check->method      = "inertia";
  check->probability = 0;
  *verdict           = check->count == found ? MODAL_VERDICT_COMPLETE : MODAL_VERDICT_MISSING;
  PetscFunctionReturn(0);
}

/* Check by search in the complement of the block Lanczos basis; undecided without such a basis. */
static PetscErrorCode check_by_restart(EPS eps, double shift, modal_check *check,
                                       modal_verdict *verdict) {
  const modal_block_basis *basis;
  modal_missed_modes       rest;
  PetscBool                block;
  PetscFunctionBeginUser;
  *verdict = MODAL_VERDICT_UNDECIDED;
  PetscCall(PetscObjectTypeCompare((PetscObject)eps, MODAL_BLOCK_LANCZOS, &block));
  if (!block) PetscFunctionReturn(0);
  PetscCall(modal_block_lanczos_basis(eps, &basis));
  PetscCall(modal_missed_modes_search(basis, 1 / (check->limit - shift), &rest));
  if (rest.count == check->count) *verdict = rest.verdict;
  check->method      = "restart";
  check->probability = rest.probability;
  PetscFunctionReturn(0);
}

static PetscErrorCode check_modes(const fem_system *system, const modal_eigen_settings *settings,
                                  EPS eps, modal_check *check, modal_verdict *verdict) {
  double last, margin;

  PetscFunctionBeginUser;
  PetscCall(EPSGetTolerances(eps, &margin, NULL));
  PetscCall(EPSGetEigenvalue(eps, settings->modes - 1, &last, NULL));
  margin   = PetscMax(margin, 1e-6); /* above the error of an eigenvalue */
  *verdict = MODAL_VERDICT_COMPLETE;
  *check   = (modal_check){
        .method = "no", .limit = last - margin * (last - settings->shift), .probability = 1};
  PetscCall(count_found(eps, settings->modes, check->limit, &check->count));
  if (settings->check == MODAL_CHECK_NEVER) PetscFunctionReturn(0);
  *verdict = MODAL_VERDICT_UNDECIDED;
  if (settings->check == MODAL_CHECK_AUTO)
    PetscCall(check_by_restart(eps, settings->shift, check, verdict));
  if (*verdict == MODAL_VERDICT_UNDECIDED)
    PetscCall(check_by_inertia(system, settings->spare, check, verdict));
  modal_phase(system->comm, settings->progress, "check", "%s, %d below %.6g Hz by %s",
              *verdict == MODAL_VERDICT_COMPLETE ? "no mode is missing" : "a mode is missing",
              check->count, modal_check_frequency(check), check->method);
  PetscFunctionReturn(0);
}

/* Double the block size, up to 32 columns. */
static PetscErrorCode double_block_size(const fem_system *system, const modal_eigen *eigen,
                                        PetscInt *size) {
  enum { MOST = 32 };
  PetscBool block;
  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)eigen->eps, MODAL_BLOCK_LANCZOS, &block));
  *size = MOST;
  if (block) PetscCall(modal_block_lanczos_get_size(eigen->eps, size));
  *size *= 2;
  PetscCheck(*size <= MOST && *size <= 3 * system->n_free, system->comm, PETSC_ERR_NOT_CONVERGED,
             "modal: the eigensolver missed a mode below %.6g Hz (checked by %s); ask for more or "
             "fewer modes, or try -eps_ncv",
             modal_check_frequency(&eigen->check), eigen->check.method);
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ together */

/* One solve. size: columns per block, 0 for the default. *found: all modes converged; false after
 * an interrupt. */
static PetscErrorCode run(const fem_system *system, const modal_eigen_settings *settings,
                          PetscInt size, modal_eigen *eigen, bool *found) {
  monitor_context    context = {settings->progress, system->comm};
  EPSConvergedReason reason;
  PetscInt           n_converged;

  PetscFunctionBeginUser;
  PetscCall(EPSDestroy(&eigen->eps));
  PetscCall(EPSCreate(system->comm, &eigen->eps));
  PetscCall(configure(system, settings, &context, eigen));
  if (size > 0) PetscCall(modal_block_lanczos_set_size(eigen->eps, size));
  PetscCall(EPSSolve(eigen->eps));
  PetscCall(EPSMonitorCancel(eigen->eps)); /* context ends here */
  PetscCall(EPSGetConvergedReason(eigen->eps, &reason));
  PetscCall(EPSGetConverged(eigen->eps, &n_converged));
  *found = n_converged >= settings->modes;
  if (reason == EPS_CONVERGED_USER && !*found) PetscFunctionReturn(0);
  PetscCheck(*found, system->comm, PETSC_ERR_NOT_CONVERGED,
             "modal: only %d of %d modes converged; try -eps_ncv or -eps_max_it", (int)n_converged,
             settings->modes);
  modal_phase(system->comm, settings->progress, "modes", "%d", settings->modes);
  PetscFunctionReturn(0);
}

/* Solve until the check finds no mode missing. *found is false after an interrupt. */
static PetscErrorCode run_checked(const fem_system *system, const modal_eigen_settings *settings,
                                  modal_eigen *eigen, bool *found) {
  modal_verdict verdict = MODAL_VERDICT_MISSING;
  PetscInt      size    = 0;
  PetscBool     block;
  PetscFunctionBeginUser;
  while (verdict == MODAL_VERDICT_MISSING) {
    PetscCall(run(system, settings, size, eigen, found));
    if (!*found) PetscFunctionReturn(0);
    PetscCall(check_modes(system, settings, eigen->eps, &eigen->check, &verdict));
    if (verdict == MODAL_VERDICT_MISSING) PetscCall(double_block_size(system, eigen, &size));
  }
  PetscCall(PetscObjectTypeCompare((PetscObject)eigen->eps, MODAL_BLOCK_LANCZOS, &block));
  if (block) PetscCall(modal_block_lanczos_release(eigen->eps));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_solve(const fem_system *system, const modal_eigen_settings *settings,
                                 modal_eigen *eigen) {
  bool found = false;

  PetscFunctionBeginUser;
  memset(eigen, 0, sizeof *eigen);
  PetscCheck(settings->modes <= 3 * system->n_free, system->comm, PETSC_ERR_USER_INPUT,
             "modal.modes: %d modes asked of a mesh with %d free dofs", settings->modes,
             (int)(3 * system->n_free));
  shb_progress_show(settings->progress, 15, "factorising %d dofs", (int)(3 * system->n_free));
  PetscCall(factorise(system, settings, eigen));
  PetscCall(run_checked(system, settings, eigen, &found));
  if (!found) PetscFunctionReturn(0);
  eigen->n = settings->modes;
  PetscCall(PetscMalloc2(eigen->n, &eigen->lambda, eigen->n, &eigen->eigen_residual));
  PetscCall(collect(system, eigen));
  PetscCall(find_residuals(system, settings->shift, eigen));
  modal_phase(system->comm, settings->progress, "mode residuals", "%d", eigen->n);
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_drop_factor(modal_eigen *eigen) {
  PetscFunctionBeginUser;
  PetscCall(EPSDestroy(&eigen->eps));
  PetscCall(fem_factor_destroy(&eigen->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_eigen_destroy(modal_eigen *eigen) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(eigen->lambda, eigen->eigen_residual));
  PetscCall(MatDestroy(&eigen->phi));
  PetscCall(MatDestroy(&eigen->m_phi));
  PetscCall(modal_eigen_drop_factor(eigen));
  memset(eigen, 0, sizeof *eigen);
  PetscFunctionReturn(0);
}
