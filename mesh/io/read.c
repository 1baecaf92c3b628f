#define _GNU_SOURCE /* memmem */
#include "mesh/io/read.h"

#include <errno.h>
#include <gmshc.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/crash_guard.h"
#include "mesh/core/file_format.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/import.h"
#include "mesh/gmsh/session.h"
#include "mesh/io/inp_read.h"

/* Check the head: $MeshFormat, possibly after comments, then version 2.2 or 4.1. gmsh takes any
 * other file for a script, so it must not open a file that fails here. */
static shb_status check_head(FILE *file, const char *path) {
  char line[256] = "";
  bool comment   = false;
  while (fgets(line, sizeof line, file)) {
    if (strncmp(line, "$Comments", 9) == 0) comment = true;
    if (!comment && strspn(line, " \t\r\n") != strlen(line)) break;
    if (strncmp(line, "$EndComments", 12) == 0) comment = false;
  }
  double version = 0;
  SHB_CHECK(strncmp(line, "$MeshFormat", 11) == 0 && fgets(line, sizeof line, file) &&
                sscanf(line, "%lf", &version) == 1,
            SHB_ERR_INPUT, "%s: not a gmsh mesh file (it does not begin with $MeshFormat)", path);
  SHB_CHECK(version == 2.2 || version == 4.1, SHB_ERR_INPUT,
            "%s: mesh format %g; 2.2 or 4.1 is needed (gmsh -format msh41)", path, version);
  return SHB_OK;
}

/* Does the file contain mark? Blocks overlap by the length of mark. */
static bool holds(FILE *file, const char *mark) {
  enum { BLOCK = 1 << 18 };
  size_t length = strlen(mark), kept = 0;
  char  *buffer = malloc(BLOCK + 64);
  bool   found  = false;
  rewind(file);
  for (size_t n; buffer && !found && (n = fread(buffer + kept, 1, BLOCK, file)) > 0;) {
    n += kept;
    found = memmem(buffer, n, mark, length) != NULL;
    kept  = n < length ? n : length;
    memmove(buffer, buffer + n - kept, kept);
  }
  free(buffer);
  return found;
}

static shb_status check_file(const char *path) {
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  shb_status status = check_head(file, path);
  if (status == SHB_OK && !holds(file, "$EndNodes"))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "%s: cut short or without nodes (no $EndNodes)", path);
  if (status == SHB_OK && !holds(file, "$EndElements"))
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "%s: cut short or without elements (no $EndElements)", path);
  fclose(file);
  return status;
}

static shb_status read_msh(const char *path, const mesh_names *names, mesh_fe *mesh) {
  SHB_TRY(check_file(path));
  mesh_session session;
  SHB_TRY(mesh_session_open(&session));
  int ierr = 0;
  mesh_session_log_start(path);
  shb_guard_begin(path, "is damaged: gmsh crashed while it was read; mesh or copy it again", true);
  gmshMerge(path, &ierr);
  shb_status logged =
      mesh_session_log_check(path); /* gmsh continues where an element lacks nodes */
  shb_status status = ierr ? mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, path)
                      : logged != SHB_OK ? logged
                                         : mesh_import(path, names, mesh);
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
