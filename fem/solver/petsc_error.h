/* Faults raised inside PETSc, SLEPc and MUMPS, turned into one status and one line of text. */
#ifndef FEM_SOLVER_PETSC_ERROR_H
#define FEM_SOLVER_PETSC_ERROR_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/base/status.h"

/* Error handler for PetscPushErrorHandler: records the first text (shb_message), prints nothing, returns.
 * context: a bool set to true when a fault was raised (so that a distributed run can abort the other ranks),
 * or NULL. */
PetscErrorCode fem_petsc_error_handler(MPI_Comm comm, int line, const char *function,
                                       const char *file, PetscErrorCode code, PetscErrorType type,
                                       const char *text, void *context);

/* SHB_OK for 0; PETSC_ERR_USER_INPUT is SHB_ERR_INPUT, PETSC_ERR_NOT_CONVERGED SHB_NOT_CONVERGED, all else
 * (memory first of all) SHB_ERR_IO. The text was recorded by the handler. */
shb_status fem_petsc_status(PetscErrorCode code);

/* A PETSc call inside a function that returns shb_status. */
#define FEM_PETSC(call)                                     \
  do {                                                      \
    PetscErrorCode fem_code_ = (call);                      \
    if (fem_code_ != 0) return fem_petsc_status(fem_code_); \
  } while (0)

#endif
