#include "mesh/io/source.h"

#include <stdbool.h>
#include <string.h>

#include "mesh/core/file_format.h"
#include "mesh/core/group_checks.h"
#include "mesh/gmsh/solid.h"
#include "mesh/io/read.h"

/* Convert to m, apply the rules of groups, check the groups. */
static shb_status finish(const mesh_source *source, mesh_fe *mesh) {
  for (size_t i = 0; source->unit != 1 && i < 3 * (size_t)mesh->n_nodes; i++)
    mesh->coordinates[i] *= source->unit;
  mesh->unit_given = source->unit_given;
  SHB_TRY(mesh_rules_apply(&source->rules, source->axis, source->path, mesh));
  return mesh_fe_check_groups(mesh, source->path);
}

static shb_status read_mesh(const mesh_source *source, mesh_fe *mesh) {
  mesh_names names = mesh_rules_names(&source->rules, source->unit);
  SHB_TRY(mesh_fe_read(source->path, &names, mesh));
  shb_status status = finish(source, mesh);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}

shb_status mesh_source_read(const mesh_source *source, shb_progress *progress, mesh_fe *mesh) {
  memset(mesh, 0, sizeof *mesh);
  if (!MESH_FORMAT_IS_SOLID(mesh_format_of(source->path))) return read_mesh(source, mesh);
  mesh_solid solid;
  SHB_TRY(mesh_solid_open(source, progress, &solid));
  shb_status status = mesh_solid_mesh(&solid, mesh);
  if (status == SHB_OK) status = finish(source, mesh);
  bool again = false;
  if (status == SHB_OK) status = mesh_solid_make_periodic(&solid, mesh, &again);
  if (status == SHB_OK && again) {
    mesh_fe_free(mesh);
    status = mesh_solid_mesh(&solid, mesh);
    if (status == SHB_OK) status = finish(source, mesh);
  }
  if (status == SHB_OK) mesh_solid_tell(source, &solid.faults, progress);
  mesh_solid_close(&solid);
  shb_progress_clear(progress);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}
