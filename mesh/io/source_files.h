/* The files that a mesh file consists of: itself and what it includes. */
#ifndef MESH_IO_SOURCE_FILES_H
#define MESH_IO_SOURCE_FILES_H

#include "mesh/base/status.h"

/* Fingerprint (shb_fingerprint) of a mesh file and of all files that it includes, at any depth.
 *
 * A .geo file includes every file whose name stands in it in quotes (mesh/gmsh/script_files), a
 * deck (.inp) those of its cards *INCLUDE. Names are taken from the folder of the file that has
 * them. A file that includes nothing has its own fingerprint.
 * Errors: SHB_ERR_IO unreadable; SHB_ERR_INPUT more than 256 files. */
shb_status mesh_source_fingerprint(const char *path, char out[17]);

#endif
