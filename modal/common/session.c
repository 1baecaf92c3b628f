#include "modal/common/session.h"

#include <malloc.h>
#include <math.h>
#include <slepcsys.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "fem/solver/petsc_error.h"
#include "fem/supernodal/large_pages.h"
#include "mesh/base/memory.h"

/* OpenBLAS's own declaration: its header clashes with PETSc's declarations of LAPACK. */
extern void openblas_set_num_threads(int);

enum { SHARES = 4 }; /* of the free memory; one is prepared for the heap */

static bool is_limited(int resource) {
  struct rlimit limit;
  return getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

/* Let malloc take memory from one heap, in pages of 2 MB. It is extended at once by a share of the
 * free memory. This costs addresses only, unless the system counts those too
 * (vm.overcommit_memory = 2). Where they are limited (ulimit -v, -d) nothing changes. Freed memory
 * is kept for later work; shb_memory_available counts it. */
static void prepare_heap(int n_ranks) {
  enum { MOST_MAPPED = 65536, TRIM = 1 << 17 }; /* of glibc itself */
  const double available = shb_memory_available();
  if (is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA) || !isfinite(available)) return;
  const size_t room = (size_t)(available / (SHARES * n_ranks));
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  void *memory = malloc(room);
  if (!memory) {
    mallopt(M_MMAP_MAX, MOST_MAPPED);
    mallopt(M_TRIM_THRESHOLD, TRIM);
  }
  fem_prefer_large_pages(memory, room);
  free(memory);
}

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
  prepare_heap(session->n_ranks);
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
