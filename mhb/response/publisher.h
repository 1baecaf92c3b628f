/* Guard of what the threads of a stage share, and of its response file. There is one lock. The file
 * is written from time to time. The first failure of any thread is kept with its text. */
#ifndef MHB_RESPONSE_PUBLISHER_H
#define MHB_RESPONSE_PUBLISHER_H

#include <omp.h>
#include <stdbool.h>

#include "mhb/response/response.h"

typedef struct {
  omp_lock_t            mutex;
  const char           *path; /* NULL: no file is written */
  const shb_provenance *provenance;
  double                written; /* s, when the file was written last, or the start */
  double                cost;    /* s, that it took; -INFINITY before the first */
  shb_status            status;  /* of the first failure */
  char                  text[512];
} mhb_publisher;

/* path NULL: no file. Path and provenance must outlive the publisher. */
void mhb_publisher_start(mhb_publisher *publisher, const char *path,
                         const shb_provenance *provenance);
void mhb_publisher_stop(mhb_publisher *publisher);

/* Take or release the lock. The functions below are called with the lock held. */
void mhb_publisher_lock(mhb_publisher *publisher, bool locked);

/* Keep a failure of this thread, if it is the first: messages are per thread. */
void mhb_publisher_note(mhb_publisher *publisher, shb_status status);

/* Whether the file should be written now: not in this many seconds, and nothing has failed. */
bool mhb_publisher_is_due(const mhb_publisher *publisher, double seconds);

/* The least time between two writes, s: as asked for, or longer, so that a large file takes a
 * twentieth of the time at most. */
double mhb_publisher_pause(const mhb_publisher *publisher, double seconds);

/* Write the response to the file, if there is one. Errors: as mhb_response_write. */
shb_status mhb_publisher_write(mhb_publisher *publisher, const mhb_response *response);

/* SHB_OK, or the first failure with its text as this thread's message. */
shb_status mhb_publisher_status(const mhb_publisher *publisher);

#endif
