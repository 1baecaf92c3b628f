/* Start and end of MPI, PETSc and SLEPc, without stack traces for the user. */
#ifndef MODAL_COMMON_SESSION_H
#define MODAL_COMMON_SESSION_H

#include <petscsys.h>
#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  int  rank, n_ranks;
  bool fault; /* a PETSc call failed on this rank */
} modal_session;

/* Start. argv holds the program's name and options for PETSc. The session must outlive
 * modal_session_end. BLAS gets one thread: more threads slow MUMPS down on few cores. */
shb_status modal_session_start(int *argc, char ***argv, modal_session *session);

/* End. status is the result of this rank. After a PETSc failure in a distributed run the other
 * ranks may wait forever: then the last message is printed and all ranks are aborted. */
void modal_session_end(modal_session *session, shb_status status);

/* The worst status of all ranks. Collective. */
shb_status modal_agree(MPI_Comm comm, shb_status status);

#endif
