#include "mesh/io/read.h"

#include <stdbool.h>
#include <string.h>

#include "mesh/base/crash_guard.h"
#include "mesh/core/file_format.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/import.h"
#include "mesh/gmsh/reading.h"
#include "mesh/gmsh/session.h"
#include "mesh/io/inp_read.h"
#include "mesh/io/msh_check.h"
#include "mesh/io/msh_read.h"

static shb_status read_msh(const char *path, const mesh_names *names, mesh_fe *mesh) {
  SHB_TRY(mesh_msh_check(path));
  if (mesh_msh_read(path, names, mesh)) return SHB_OK;
  mesh_session session;
  SHB_TRY(mesh_session_open(&session));
  mesh_session_log_start(path);
  shb_guard_begin(path, "is damaged: gmsh crashed while it was read; mesh or copy it again", true);
  shb_status       status = mesh_reading_msh(path);
  const shb_status logged = mesh_session_log_check(path); /* also ends the log */
  if (status == SHB_OK) status = logged;
  if (status == SHB_OK) status = mesh_import(path, names, mesh);
  shb_guard_end();
  mesh_session_close(&session);
  return status;
}

shb_status mesh_fe_read(const char *path, const mesh_names *names, mesh_fe *mesh) {
  memset(mesh, 0, sizeof *mesh);
  bool msh = mesh_format_of(path) == MESH_FORMAT_MSH;
  SHB_CHECK(msh || mesh_format_of(path) == MESH_FORMAT_INP, SHB_ERR_INPUT,
            "%s: not a mesh file; its name must end in .msh (gmsh) or .inp (Abaqus, CalculiX)",
            path);
  SHB_TRY(msh ? read_msh(path, names, mesh) : mesh_inp_read(path, names, mesh));
  shb_status status = mesh_jacobian_check(mesh, path);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}
