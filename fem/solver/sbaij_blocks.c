#include "fem/solver/sbaij_blocks.h"

PetscErrorCode fem_blocks_borrow(Mat A, fem_blocks *b) {
  PetscBool done;
  double   *value;
  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &b->n, &b->start, &b->column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "no rows");
  PetscCall(MatSeqSBAIJGetArray(A, &value));
  b->value = value;
  PetscFunctionReturn(0);
}

PetscErrorCode fem_blocks_give_back(Mat A, fem_blocks *b) {
  PetscBool done;
  double   *value = (double *)b->value;
  PetscFunctionBeginUser;
  PetscCall(MatSeqSBAIJRestoreArray(A, &value));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &b->n, &b->start, &b->column, &done));
  PetscFunctionReturn(0);
}
