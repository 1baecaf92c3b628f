/* Where a result file came from, read from its root attributes. */
#ifndef POSTPROC_ANALYSIS_FILE_ORIGIN_H
#define POSTPROC_ANALYSIS_FILE_ORIGIN_H

#include <hdf5.h>

#include "mesh/base/status.h"

/* malloc'ed texts; "" where the file does not say. */
typedef struct {
  char *format, *revision, *command, *created, *case_path, *case_text, *settings;
  int   version; /* 0: not said */
} post_origin;

/* at: an open file. Errors: SHB_ERR_IO (no memory, cannot be read). */
shb_status post_origin_read(hid_t file, post_origin *source);
/* The same for a file by name. Errors: as h5_open. */
shb_status post_origin_open(const char *path, post_origin *source);
void       post_origin_free(post_origin *source);

#endif
