/* Provenance in a $Comments section at the end of a gmsh file. */
#ifndef MESH_GMSH_PROVENANCE_H
#define MESH_GMSH_PROVENANCE_H

#include "mesh/base/publish.h"
#include "mesh/base/status.h"

/* Append revision, command, case path, settings and case text. Every line is indented, so that no
 * line of the case can end the section. NULL strings are left out. SHB_ERR_IO. */
shb_status mesh_provenance_append(const char *path, const shb_provenance *provenance);

/* Settings text that mesh_provenance_append wrote, malloc'ed; "" if the file has none. SHB_ERR_IO
 * if the file cannot be read. */
shb_status mesh_settings_read(const char *path, char **settings);

#endif
