/* Errors raised in PETSc, SLEPc and MUMPS, converted to a status and one line of text. */
#ifndef FEM_SOLVER_PETSC_ERROR_H
#define FEM_SOLVER_PETSC_ERROR_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/base/status.h"

/* Handler for PetscPushErrorHandler: records the first message (shb_message), prints nothing,
 * returns.
 *   context  a bool set to true on an error, so that a distributed run can abort; or NULL */
PetscErrorCode fem_petsc_error_handler(MPI_Comm comm, int line, const char *function,
                                       const char *file, PetscErrorCode code, PetscErrorType type,
                                       const char *text, void *context);

/* Status of a PETSc code; the handler has recorded the message. PETSC_ERR_USER_INPUT is
 * SHB_ERR_INPUT, PETSC_ERR_NOT_CONVERGED is SHB_NOT_CONVERGED, any other error SHB_ERR_IO. */
shb_status fem_petsc_status(PetscErrorCode code);

/* Call PETSc in a function that returns shb_status. */
#define FEM_PETSC(call)                                     \
  do {                                                      \
    PetscErrorCode fem_code_ = (call);                      \
    if (fem_code_ != 0) return fem_petsc_status(fem_code_); \
  } while (0)

#endif
