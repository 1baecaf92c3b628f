/* Files that gmsh reads, alone. gmsh's own open and merge run a file FILE.opt beside FILE as a
 * script, system commands included. Such a file is in no digest, and is not run here. */
#ifndef MESH_GMSH_READING_H
#define MESH_GMSH_READING_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/gmsh/session.h"

/* Read a solid into a model of its own, between mesh_session_log_start and mesh_session_log_check.
 * A script (.geo) is refused, unread, if such a file lies beside it or beside a file that it names.
 * Errors: SHB_ERR_INPUT; SHB_ERR_IO. */
shb_status mesh_reading_solid(const char *path);

/* Read a mesh file (.msh) into the current model.
 * Errors: SHB_ERR_IO it cannot be opened; SHB_ERR_INPUT. */
shb_status mesh_reading_msh(const char *path);

/* Is there a file of options beside a file that gmsh reads?
 *   beside  out  its path, of at most size characters */
bool mesh_reading_has_options(const char *path, char *beside, size_t size);

#endif
