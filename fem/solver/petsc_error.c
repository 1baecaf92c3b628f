#include "fem/solver/petsc_error.h"

#include <string.h>

PetscErrorCode fem_petsc_error_handler(MPI_Comm comm, int line, const char *function,
                                       const char *file, PetscErrorCode code, PetscErrorType type,
                                       const char *text, void *context) {
  (void)comm;
  if (type != PETSC_ERROR_INITIAL) return code;
  if (context) *(bool *)context = true;
  shb_status  status = fem_petsc_status(code);
  const char *end    = text ? strchr(text, '\n') : NULL; /* one line */
  int         length = text ? (end ? (int)(end - text) : (int)strlen(text)) : 0;
  if (code == PETSC_ERR_MEM)
    shb_fail(status, file, line, "out of memory (in %s)", function);
  else if (code == PETSC_ERR_USER_INPUT || code == PETSC_ERR_NOT_CONVERGED)
    shb_fail(status, file, line, "%.*s", length, text ? text : "");
  else
    shb_fail(status, file, line, "the equation solver failed in %s: %.*s", function, length,
             text ? text : "");
  return code;
}

shb_status fem_petsc_status(PetscErrorCode code) {
  if (code == 0) return SHB_OK;
  if (code == PETSC_ERR_USER_INPUT) return SHB_ERR_INPUT;
  if (code == PETSC_ERR_NOT_CONVERGED) return SHB_NOT_CONVERGED;
  return SHB_ERR_IO;
}
