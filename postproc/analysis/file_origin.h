/* Origin of a result file, from its root attributes. */
#ifndef POSTPROC_ANALYSIS_FILE_ORIGIN_H
#define POSTPROC_ANALYSIS_FILE_ORIGIN_H

#include <hdf5.h>

#include "mesh/base/status.h"

/* malloc'ed texts; "" if the file has none. */
typedef struct {
  char *format, *revision, *command, *created, *case_path, *case_text, *settings;
  int   version; /* 0: none */
} post_origin;

/* Read it from an open file. Errors: SHB_ERR_IO no memory, unreadable. */
shb_status post_origin_read(hid_t file, post_origin *source);
/* The same for a file by name. Errors: as h5_open. */
shb_status post_origin_open(const char *path, post_origin *source);
void       post_origin_free(post_origin *source);

#endif
