/* Results are published whole: write PATH.tmp.PID in the same folder, fsync, rename over PATH. */
#ifndef MESH_BASE_PUBLISH_H
#define MESH_BASE_PUBLISH_H

#include "mesh/base/status.h"

/* Where a stage came from; written into every output file. Plain strings, owned by the caller. */
typedef struct {
  const char *case_path; /* as given on the command line */
  const char *case_text; /* the case file, verbatim */
  const char
      *settings; /* "key = value" lines in SI of every key the stage depends on; equal text means
                            the stage need not run again */
  const char *command; /* e.g. "shroudhb-modal" */
} shb_provenance;

/* Temporary name beside path; malloc'ed (NULL when out of memory). */
char *shb_publish_temporary(const char *path);

/* Remove the temporary files that are not published yet; for a signal handler that ends the process. */
void shb_publish_abandon(void);

/* fsync temporary, rename it to path, fsync the folder. On failure removes temporary. SHB_ERR_IO. */
shb_status shb_publish(const char *temporary, const char *path);

/* FNV-1a 64-bit hash of a file's contents as 16 hex digits; SHB_ERR_IO if unreadable. */
shb_status shb_fingerprint(const char *path, char out[17]);

#endif
