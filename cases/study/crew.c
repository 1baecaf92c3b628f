#include "cases/study/crew.h"

#include <limits.h>
#include <mpi.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

#include "mesh/base/memory.h"

enum { TAG_WORK, TAG_STOP, TAG_DONE };

/* Between two looks for a message. A job takes 100 ms and more. */
static const struct timespec PAUSE = {.tv_nsec = 1000000};

static int n_ranks(void) {
  int n;
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  return n;
}

int crew_workers(void) {
  int n = n_ranks();
  return n > 1 ? n - 1 : 1;
}

int crew_sharing(void) {
  MPI_Comm here;
  int      rank, computes, n;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  computes = rank > 0 || n_ranks() == 1;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  MPI_Allreduce(&computes, &n, 1, MPI_INT, MPI_SUM, here);
  MPI_Comm_free(&here);
  return n > 1 ? n : 1;
}

void crew_dismiss(void) {
  for (int rank = 1; rank < n_ranks(); rank++)
    MPI_Send(NULL, 0, MPI_DOUBLE, rank, TAG_STOP, MPI_COMM_WORLD);
}

/* One rank: the manager computes. */
static shb_status work_alone(const crew_work *w, const crew_computer *computer) {
  const double *value;
  for (int job; (job = w->next(w->context, &value)) >= 0;) {
    char      *bytes  = NULL;
    size_t     size   = 0;
    shb_status status = computer->compute(computer->context, value, &bytes, &size);
    if (status == SHB_OK) status = w->done(w->context, job, bytes, size);
    if (status == SHB_OK) status = w->tick(w->context);
    free(bytes);
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* Take a result, if one has come. Returns the rank that sent it, 0 if none has. */
static int take_result(const crew_work *w, const int *at_work, shb_status *status) {
  MPI_Status message;
  int        there, size;
  MPI_Iprobe(MPI_ANY_SOURCE, TAG_DONE, MPI_COMM_WORLD, &there, &message);
  if (!there) return 0;
  MPI_Get_count(&message, MPI_CHAR, &size);
  char *bytes = shb_alloc((size_t)size + 1, 1);
  int   rank  = message.MPI_SOURCE;
  MPI_Recv(bytes, size, MPI_CHAR, rank, TAG_DONE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  *status = w->done(w->context, at_work[rank], bytes, (size_t)size);
  free(bytes);
  return rank;
}

static shb_status manage(const crew_work *w, int n_request, int *at_work) {
  int        n = n_ranks(), busy = 0;
  shb_status status = SHB_OK;
  for (int rank = 1; rank < n; rank++) at_work[rank] = -1;
  for (bool more = true; busy > 0 || more;) {
    more = false;
    for (int rank = 1; rank < n && status == SHB_OK; rank++) {
      const double *value;
      if (at_work[rank] >= 0) continue;
      int job = w->next(w->context, &value);
      if (job < 0) break;
      MPI_Send(value, n_request, MPI_DOUBLE, rank, TAG_WORK, MPI_COMM_WORLD);
      at_work[rank] = job;
      busy++;
    }
    int rank = busy > 0 ? take_result(w, at_work, &status) : 0;
    if (rank > 0) {
      at_work[rank] = -1;
      busy--;
      more = true;
    } else if (busy > 0) {
      nanosleep(&PAUSE, NULL);
    }
    if (status == SHB_OK) status = w->tick(w->context);
    if (status != SHB_OK) break;
  }
  return status;
}

shb_status crew_manage(const crew_work *w, const crew_computer *computer) {
  if (n_ranks() == 1) return work_alone(w, computer);
  int             *at_work = shb_alloc((size_t)n_ranks(), sizeof *at_work);
  const shb_status status  = manage(w, computer->n_request, at_work);
  free(at_work);
  crew_dismiss();
  return status;
}

/* Wait for a message of the manager; its tag. */
static int await(void) {
  MPI_Status message;
  for (int there = 0;;) {
    MPI_Iprobe(0, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &message);
    if (there) return message.MPI_TAG;
    nanosleep(&PAUSE, NULL);
  }
}

shb_status crew_serve(const crew_computer *computer) {
  double    *value  = shb_alloc((size_t)computer->n_request + 1, sizeof *value);
  shb_status status = SHB_OK;
  while (await() == TAG_WORK) {
    char  *bytes = NULL;
    size_t size  = 0;
    MPI_Recv(value, computer->n_request, MPI_DOUBLE, 0, TAG_WORK, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    status = computer->compute(computer->context, value, &bytes, &size);
    /* without an answer the manager would wait for ever */
    if (status != SHB_OK || size > INT_MAX) MPI_Abort(MPI_COMM_WORLD, SHB_ERR_IO);
    MPI_Send(bytes, (int)size, MPI_CHAR, 0, TAG_DONE, MPI_COMM_WORLD);
    free(bytes);
  }
  free(value);
  return status;
}
