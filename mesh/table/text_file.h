/* A whole text file in memory. */
#ifndef MESH_TABLE_TEXT_FILE_H
#define MESH_TABLE_TEXT_FILE_H

#include <stddef.h>

#include "mesh/base/status.h"

/* Is it a pipe or a device? Opening one could wait for its other end. SHB_ERR_IO. */
shb_status mesh_file_kind(const char *path);

/* Read a file into malloc'ed memory. A NUL follows the length bytes.
 *
 *   most   in   size that it may have, MiB
 *   what   in   what such a file is, for messages: "a table is text"
 *
 * Errors: SHB_ERR_IO unreadable, with its errno; SHB_ERR_INPUT larger, or with NUL bytes, as UTF-16
 * has. */
shb_status mesh_text_read(const char *path, size_t most, const char *what, char **text,
                          size_t *length);

#endif
