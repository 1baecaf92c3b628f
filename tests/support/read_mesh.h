/* A mesh file with the usual groups, read and checked. */
#ifndef TESTS_SUPPORT_READ_MESH_H
#define TESTS_SUPPORT_READ_MESH_H

#include "mesh/core/group_checks.h"
#include "mesh/io/read.h"

/* mesh_fe_read and mesh_fe_check_groups; after an error the mesh is empty. */
static inline shb_status read_mesh(const char *path, mesh_fe *mesh) {
  SHB_TRY(mesh_fe_read(path, NULL, mesh));
  shb_status status = mesh_fe_check_groups(mesh, path);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

#endif
