/* Starting and ending MPI, PETSc and SLEPc so that no fault of theirs reaches the user as a stack trace. */
#ifndef MODAL_COMMON_SESSION_H
#define MODAL_COMMON_SESSION_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  int  rank, n_ranks;
  bool fault; /* something failed inside PETSc, on this rank */
} modal_session;

/* argv: the program's name and the options meant for PETSc. The session must outlive modal_session_end.
 * Sets one BLAS thread: more only slow MUMPS down on few cores. */
shb_status modal_session_start(int *argc, char ***argv, modal_session *session);

/* status: how the work ended on this rank. After a fault inside PETSc in a distributed run the other ranks may
 * wait forever: then print the last text and abort them. Otherwise finalise. */
void modal_session_end(modal_session *session, shb_status status);

/* The worst status of all ranks. Collective. */
shb_status modal_agree(MPI_Comm comm, shb_status status);

#endif
