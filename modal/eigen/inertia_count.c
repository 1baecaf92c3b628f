#include "modal/eigen/inertia_count.h"

#include "mesh/base/memory.h"

/* MUMPS must not hand the root to ScaLAPACK, which does not report the signs of pivots. */
static PetscErrorCode analyse(Mat A, Mat *factor) {
  enum { ROOT = 13, DISCARD = 31 };
  MatFactorInfo info;
  PetscInt      megabytes;
  PetscFunctionBeginUser;
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factor));
  PetscCall(MatMumpsSetIcntl(*factor, ROOT, 1));
  PetscCall(MatMumpsSetIcntl(*factor, DISCARD, 1));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatCholeskyFactorSymbolic(*factor, A, NULL, &info));
  PetscCall(MatMumpsGetInfo(*factor, 15, &megabytes));
  PetscCheck(1e6 * (double)megabytes < shb_memory_available(), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT,
             "modal.check: counting by inertia needs %.3g GB more memory, and %.3g GB are left; "
             "leave it at auto, or give never",
             1e-3 * (double)megabytes, 1e-9 * shb_memory_available());
  PetscFunctionReturn(0);
}

static PetscErrorCode count_negative(Mat A, int *count) {
  MatFactorInfo  info;
  MatFactorError error;
  PetscInt       negative;
  Mat            factor;
  PetscFunctionBeginUser;
  PetscCall(analyse(A, &factor));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatCholeskyFactorNumeric(factor, A, &info));
  PetscCall(MatFactorGetError(factor, &error));
  PetscCheck(error != MAT_FACTOR_OUTMEMORY, PetscObjectComm((PetscObject)A), PETSC_ERR_MEM,
             "MUMPS");
  PetscCheck(error == MAT_FACTOR_NOERROR, PetscObjectComm((PetscObject)A), PETSC_ERR_LIB,
             "MUMPS cannot factorise K - sigma M");
  PetscCall(MatMumpsGetInfog(factor, 12, &negative));
  *count = (int)negative;
  PetscCall(MatDestroy(&factor));
  PetscFunctionReturn(0);
}

PetscErrorCode modal_inertia_count(const fem_system *system, double sigma, int *count) {
  Mat A;
  PetscFunctionBeginUser;
  PetscCall(fem_system_shifted(system, sigma, &A));
  PetscCall(MatSetOption(A, MAT_SPD, PETSC_FALSE));
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(count_negative(A, count));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}
