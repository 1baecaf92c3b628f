#include "fem/solver/factor.h"

#include <math.h>
#include <stdlib.h>

#include "fem/solver/cholesky.h"
#include "mesh/base/memory.h"

struct fem_factor {
  MPI_Comm      comm;
  fem_cholesky *cholesky; /* NULL where MUMPS factorises */
  Mat           mumps;    /* NULL where CHOLMOD does */
  double        bytes;    /* bytes, all ranks */
};

static const double giga = 1e9;

PetscErrorCode fem_factor_mumps_asked(bool *yes) {
  char      name[32] = "";
  PetscBool given, is_mumps;
  PetscFunctionBeginUser;
  PetscCall(
      PetscOptionsGetString(NULL, "st_", "-pc_factor_mat_solver_type", name, sizeof name, &given));
  PetscCall(PetscStrcmp(name, MATSOLVERMUMPS, &is_mumps));
  *yes = is_mumps;
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ memory */

/* Bytes needed and available on the machine with the smallest margin. Ranks of a machine share its
 * memory.
 *   mine  in  bytes that this rank needs */
static PetscErrorCode compare(MPI_Comm comm, double mine, double *needed, double *available) {
  MPI_Comm machine;
  struct {
    double margin;
    int    rank;
  } own, worst;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Allreduce(&mine, needed, 1, MPI_DOUBLE, MPI_SUM, machine));
  *available = shb_memory_available();
  PetscCallMPI(MPI_Comm_free(&machine));
  own.margin = *available - *needed;
  PetscCallMPI(MPI_Comm_rank(comm, &own.rank));
  PetscCallMPI(MPI_Allreduce(&own, &worst, 1, MPI_DOUBLE_INT, MPI_MINLOC, comm));
  double both[2] = {*needed, *available};
  PetscCallMPI(MPI_Bcast(both, 2, MPI_DOUBLE, worst.rank, comm));
  *needed    = both[0];
  *available = both[1];
  PetscFunctionReturn(0);
}

/* Number of nodes that fit, to two digits: on blades memory grows as nodes^1.4. */
static double nodes_that_fit(double nodes, double share) {
  const double fit = nodes * pow(share, 1 / 1.4);
  const double by  = pow(10, fmax(floor(log10(fmax(fit, 1))) - 1, 0));
  return floor(fit / by) * by;
}

static PetscErrorCode check_memory(Mat A, double needed, double available) {
  PetscInt order;
  PetscFunctionBeginUser;
  PetscCall(MatGetSize(A, &order, NULL));
  PetscCheck(needed <= available, PetscObjectComm((PetscObject)A), PETSC_ERR_USER_INPUT,
             "the modes of this mesh (%d free nodes) need %.3g GB more memory, and %.3g GB are "
             "left; make a coarser mesh (about %.0f nodes fit), or use more machines (mpiexec)",
             (int)(order / 3), needed / giga, available / giga,
             nodes_that_fit((double)order / 3, available / needed));
  PetscFunctionReturn(0);
}

/* ------------------------------------------------------------------ analysis */

static PetscErrorCode analyse_mumps(fem_factor *factor, Mat A, double *mine) {
  MatFactorInfo info;
  PetscInt      megabytes;
  PetscFunctionBeginUser;
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor->mumps));
  PetscCall(MatSetOptionsPrefix(factor->mumps, "st_"));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatCholeskyFactorSymbolic(factor->mumps, A, NULL, &info));
  PetscCall(MatMumpsGetInfo(factor->mumps, 15, &megabytes));
  *mine = 1e6 * megabytes;
  PetscFunctionReturn(0);
}

static PetscErrorCode analyse(fem_factor *factor, Mat A, double *mine) {
  bool   mumps = false;
  int    n_ranks;
  double own, workspace;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(factor->comm, &n_ranks));
  PetscCall(fem_factor_mumps_asked(&mumps));
  mumps = mumps || n_ranks > 1;
  if (!mumps) {
    PetscCall(fem_cholesky_create(A, &factor->cholesky));
    mumps = !factor->cholesky;
  }
  if (mumps) {
    PetscCall(analyse_mumps(factor, A, mine));
    PetscFunctionReturn(0);
  }
  fem_cholesky_bytes(factor->cholesky, &own, &workspace);
  *mine = own + workspace;
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_create(Mat A, double beside, fem_factor **out) {
  double mine, needed, available;
  int    n_ranks;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(out));
  (*out)->comm = PetscObjectComm((PetscObject)A);
  PetscCallMPI(MPI_Comm_size((*out)->comm, &n_ranks));
  PetscCall(analyse(*out, A, &mine));
  PetscCall(compare((*out)->comm, mine + beside / n_ranks, &needed, &available));
  PetscCallMPI(MPI_Allreduce(&mine, &(*out)->bytes, 1, MPI_DOUBLE, MPI_SUM, (*out)->comm));
  PetscCall(check_memory(A, needed, available));
  PetscFunctionReturn(0);
}

double fem_factor_bytes(const fem_factor *factor) {
  return factor->bytes;
}

const char *fem_factor_program(const fem_factor *factor) {
  return factor->cholesky ? "CHOLMOD" : "MUMPS";
}

bool fem_factor_needs_matrix(const fem_factor *factor) {
  return factor->mumps != NULL;
}

/* ------------------------------------------------------------------ factor and solves */

/* definite: MUMPS met no negative pivots. On several ranks its dense root is not counted, but must
 * be positive definite as well. */
static PetscErrorCode update_mumps(Mat mumps, Mat A, bool *definite) {
  MatFactorInfo  info;
  MatFactorError error;
  PetscInt       negative;
  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatCholeskyFactorNumeric(mumps, A, &info));
  PetscCall(MatFactorGetError(mumps, &error));
  PetscCheck(error != MAT_FACTOR_OUTMEMORY, PetscObjectComm((PetscObject)A), PETSC_ERR_MEM,
             "MUMPS");
  PetscCall(MatMumpsGetInfog(mumps, 12, &negative));
  *definite = error == MAT_FACTOR_NOERROR && negative == 0;
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_update(fem_factor *factor, Mat A, bool *definite) {
  PetscFunctionBeginUser;
  if (factor->cholesky)
    PetscCall(fem_cholesky_update(factor->cholesky, A, definite));
  else
    PetscCall(update_mumps(factor->mumps, A, definite));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_solve(fem_factor *factor, Vec b, Vec x) {
  const double *from;
  double       *to;
  PetscInt      n;

  PetscFunctionBeginUser;
  if (factor->mumps) {
    PetscCall(MatSolve(factor->mumps, b, x));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetLocalSize(b, &n));
  PetscCall(VecGetArrayRead(b, &from));
  PetscCall(VecGetArrayWrite(x, &to));
  fem_cholesky_solve(factor->cholesky, 1, from, (size_t)n, to, (size_t)n);
  PetscCall(VecRestoreArrayWrite(x, &to));
  PetscCall(VecRestoreArrayRead(b, &from));
  PetscFunctionReturn(0);
}

/* node NULL: all rows are wanted. */
static PetscErrorCode solve_columns(fem_factor *factor, const bool *node, Mat B, Mat X) {
  const double *from;
  double       *to;
  PetscInt      count, ldb, ldx;

  PetscFunctionBeginUser;
  if (factor->mumps) {
    PetscCall(MatMatSolve(factor->mumps, B, X));
    PetscFunctionReturn(0);
  }
  PetscCall(MatGetSize(B, NULL, &count));
  PetscCall(MatDenseGetLDA(B, &ldb));
  PetscCall(MatDenseGetLDA(X, &ldx));
  PetscCall(MatDenseGetArrayRead(B, &from));
  PetscCall(MatDenseGetArrayWrite(X, &to));
  if (node)
    fem_cholesky_solve_at(factor->cholesky, node, (int)count, from, (size_t)ldb, to, (size_t)ldx);
  else
    fem_cholesky_solve(factor->cholesky, (int)count, from, (size_t)ldb, to, (size_t)ldx);
  PetscCall(MatDenseRestoreArrayWrite(X, &to));
  PetscCall(MatDenseRestoreArrayRead(B, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_solve_many(fem_factor *factor, Mat B, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(solve_columns(factor, NULL, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_solve_at(fem_factor *factor, const bool *node, Mat B, Mat X) {
  PetscFunctionBeginUser;
  PetscCall(solve_columns(factor, node, B, X));
  PetscFunctionReturn(0);
}

bool fem_factor_tree(const fem_factor *factor, fem_tree *tree) {
  if (factor->cholesky) *tree = fem_cholesky_tree(factor->cholesky);
  return factor->cholesky != NULL;
}

static PetscErrorCode apply(PC pc, Vec b, Vec x) {
  void *factor;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(fem_factor_solve(factor, b, x));
  PetscFunctionReturn(0);
}

static PetscErrorCode apply_many(PC pc, Mat B, Mat X) {
  void *factor;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &factor));
  PetscCall(fem_factor_solve_many(factor, B, X));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_set_pc(fem_factor *factor, PC pc) {
  PetscFunctionBeginUser;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, factor));
  PetscCall(PCShellSetApply(pc, apply));
  PetscCall(PCShellSetMatApply(pc, apply_many));
  PetscCall(PCShellSetName(pc, fem_factor_program(factor)));
  PetscFunctionReturn(0);
}

PetscErrorCode fem_factor_destroy(fem_factor **factor) {
  PetscFunctionBeginUser;
  if (!*factor) PetscFunctionReturn(0);
  fem_cholesky_destroy((*factor)->cholesky);
  PetscCall(MatDestroy(&(*factor)->mumps));
  PetscCall(PetscFree(*factor));
  PetscFunctionReturn(0);
}
