#include "modal/common/session.h"

#include <slepcsys.h>
#include <stdio.h>

#include "fem/solver/petsc_error.h"

/* OpenBLAS's own declaration: its header clashes with PETSc's declarations of LAPACK. */
extern void openblas_set_num_threads(int);

shb_status modal_session_start(int *argc, char ***argv, modal_session *session) {
  openblas_set_num_threads(1);
  session->rank    = 0;
  session->n_ranks = 1;
  session->fault   = false;
  SHB_CHECK(SlepcInitialize(argc, argv, NULL, NULL) == 0, SHB_ERR_IO, "PETSc did not start");
  PetscPopSignalHandler();
  PetscPushErrorHandler(fem_petsc_error_handler, &session->fault);
  MPI_Comm_rank(PETSC_COMM_WORLD, &session->rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &session->n_ranks);
  return SHB_OK;
}

void modal_session_end(modal_session *session, shb_status status) {
  if (session->fault && session->n_ranks > 1 && status != SHB_ERR_INPUT &&
      status != SHB_NOT_CONVERGED) {
    fprintf(stderr, "shroudhb: error: %s\n", shb_message());
    MPI_Abort(PETSC_COMM_WORLD, (int)status);
  }
  PetscPopErrorHandler();
  SlepcFinalize();
}

shb_status modal_agree(MPI_Comm comm, shb_status status) {
  int mine = status, worst = status;
  MPI_Allreduce(&mine, &worst, 1, MPI_INT, MPI_MAX, comm);
  if (worst != SHB_OK && mine == SHB_OK) SHB_FAIL((shb_status)worst, "another rank failed");
  return (shb_status)worst;
}
