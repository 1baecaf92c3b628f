/* Atomic publishing of results: write PATH.tmp.PID in the same folder, fsync, rename to PATH. */
#ifndef MESH_BASE_PUBLISH_H
#define MESH_BASE_PUBLISH_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/base/status.h"

/* Origin of a result, written into every output file. The caller owns the strings. */
typedef struct {
  const char *case_path; /* as given on the command line */
  const char *case_text; /* the case file, verbatim */
  const char *settings;  /* lines "key = value" of every key of the stage; equal text: up to date */
  const char *command;   /* e.g. "shroudhb-modal" */
} shb_provenance;

/* May a result be written to path? Told before the work: is there a folder that takes a block of
 * bytes, and no folder, link, device or pipe at path itself? Leaves nothing behind. SHB_ERR_IO. */
shb_status shb_publish_check(const char *path);
/* The same of a malloc'ed path, which is freed. */
shb_status shb_publish_check_freed(char *path);

/* Name of a temporary file beside path, malloc'ed. The file is removed when this process ends at
 * once (mesh/base/crash_guard). Those of processes that are gone are removed now, unless the run is
 * spread over several machines. */
char *shb_publish_temporary(const char *path);

/* The process whose temporary file this is; 0: it is no such name.
 *   length  out  of PATH in the name; set where the process is */
long shb_publish_owner(const char *name, size_t *length);

/* Another one whose name ends in .msh, for gmsh, which chooses the format by the ending. */
char *shb_publish_temporary_msh(const char *path);

/* Remove the temporary files of all results STEM.* whose process is gone, likewise. */
void shb_publish_clear(const char *stem);

/* fsync the temporary file, rename it to path, fsync the folder. After an error the temporary file
 * is removed. SHB_ERR_IO. */
shb_status shb_publish(const char *temporary, const char *path);

/* May a text be the name of a file, a column or a probe? Not an empty one, and none with a
 * character that does not show itself (shb_is_shown). Bytes that are not UTF-8 are left to the
 * reader of the text. */
bool shb_name_is_plain(const char *text);

/* Make a folder and those above it, where they are missing. SHB_ERR_IO, also where a part of the
 * path is a file. */
shb_status shb_make_folder(const char *path);

/* FNV-1a 64-bit hash of the contents of a file as 16 hex digits. SHB_ERR_IO if unreadable. */
shb_status shb_fingerprint(const char *path, char out[17]);

#endif
