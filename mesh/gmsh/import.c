#include "mesh/gmsh/import.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/core/faces.h"
#include "mesh/core/regions.h"
#include "mesh/core/tagged_nodes.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/volumes.h"

enum { GMSH_TET4 = 4, GMSH_HEX8 = 5, GMSH_HEX27 = 12 };

/* Nodes of gmsh's model; tag and xyz are freed with gmshFree. */
static shb_status take_tags(const char *name, size_t **tag, double **xyz,
                            mesh_tagged_nodes *table) {
  double *unused = NULL;
  size_t  n = 0, n_xyz = 0, n_unused = 0;
  GMSH_TRY(name,
           gmshModelMeshGetNodes(tag, &n, xyz, &n_xyz, &unused, &n_unused, -1, -1, 0, 0, &ierr));
  gmshFree(unused);
  SHB_CHECK(n > 0 && n_xyz == 3 * n, SHB_ERR_INPUT, "%s: no nodes", name);
  return mesh_tagged_nodes_create(name, n, *tag, *xyz, table);
}

static shb_status find_types(const char *name, bool has[2], int *odd) {
  int   *types = NULL;
  size_t n     = 0;
  GMSH_TRY(name, gmshModelMeshGetElementTypes(&types, &n, 3, -1, &ierr));
  for (size_t i = 0; i < n; i++)
    if (types[i] == mesh_topology_of(MESH_TET10)->gmsh)
      has[MESH_TET10] = true;
    else if (types[i] == mesh_topology_of(MESH_HEX20)->gmsh)
      has[MESH_HEX20] = true;
    else
      *odd = types[i];
  gmshFree(types);
  return SHB_OK;
}

static shb_status check_types(const char *name, mesh_kind *kind) {
  bool has[2] = {false, false};
  int  odd    = 0;
  SHB_TRY(find_types(name, has, &odd));
  SHB_CHECK(odd != GMSH_TET4 && odd != GMSH_HEX8, SHB_ERR_INPUT,
            "%s: linear (%s-node) %s; second order is needed (%s)", name,
            odd == GMSH_TET4 ? "four" : "eight", odd == GMSH_TET4 ? "tetrahedra" : "hexahedra",
            odd == GMSH_TET4
                ? "ten nodes: gmsh -order 2"
                : "twenty nodes: gmsh -order 2 -setnumber Mesh.SecondOrderIncomplete 1");
  SHB_CHECK(odd != GMSH_HEX27, SHB_ERR_INPUT,
            "%s: hexahedra of 27 nodes; twenty are needed (gmsh -setnumber "
            "Mesh.SecondOrderIncomplete 1)",
            name);
  SHB_CHECK(odd == 0, SHB_ERR_INPUT,
            "%s: volume elements of gmsh type %d; only ten-node tetrahedra (type 11) and "
            "twenty-node hexahedra (type 17) are supported",
            name, odd);
  SHB_CHECK(has[MESH_TET10] || has[MESH_HEX20], SHB_ERR_INPUT,
            "%s: no volume elements; a mesh of ten-node tetrahedra or of twenty-node hexahedra is "
            "needed (with physical groups, the body must be in one too)",
            name);
  SHB_CHECK(!has[MESH_TET10] || !has[MESH_HEX20], SHB_ERR_INPUT,
            "%s: tetrahedra and hexahedra in one mesh; all elements must be of one kind", name);
  *kind = has[MESH_HEX20] ? MESH_HEX20 : MESH_TET10;
  return SHB_OK;
}

static shb_status take_volume(const char *name, mesh_tagged_nodes *table, mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  size_t              *tags = NULL, *nodes = NULL, n = 0, n_nodes = 0;
  GMSH_TRY(name, gmshModelMeshGetElementsByType(topology->gmsh, &tags, &n, &nodes, &n_nodes, -1, 0,
                                                1, &ierr));
  const mesh_tagged_elements elements = {n, tags, nodes};
  shb_status                 status   = SHB_ERR_INPUT;
  if (n_nodes == (size_t)topology->nodes * n)
    status = mesh_tagged_take_volume(name, &elements, table, mesh);
  else
    shb_fail(status, __FILE__, __LINE__, "%s: %zu elements are too many", name, n);
  gmshFree(tags);
  gmshFree(nodes);
  return status;
}

static shb_status take_surface(const char *name, const mesh_tagged_nodes *table, int entity,
                               mesh_fe *mesh, int id) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  int                 *types    = NULL;
  size_t               n_types  = 0;
  int                  odd      = 0;
  GMSH_TRY(name, gmshModelMeshGetElementTypes(&types, &n_types, 2, entity, &ierr));
  for (size_t i = 0; i < n_types; i++)
    if (types[i] != topology->gmsh_face) odd = types[i];
  gmshFree(types);
  SHB_CHECK(odd == 0, SHB_ERR_INPUT,
            "%s: group %s holds faces of gmsh type %d; only %ss (type %d) lie on a %s", name,
            mesh_fe_set_name(mesh, id), odd, topology->face_name, topology->gmsh_face,
            topology->name);
  if (n_types == 0) return SHB_OK;
  size_t *tags = NULL, *nodes = NULL, n = 0, n_nodes = 0;
  GMSH_TRY(name, gmshModelMeshGetElementsByType(topology->gmsh_face, &tags, &n, &nodes, &n_nodes,
                                                entity, 0, 1, &ierr));
  const mesh_tagged_elements faces  = {n, tags, nodes};
  shb_status                 status = mesh_tagged_append_faces(name, table, &faces, id, mesh);
  gmshFree(tags);
  gmshFree(nodes);
  return status;
}

/* Set that a physical surface belongs to; -1: none. */
static shb_status which_set(const char *name, const mesh_names *names, mesh_fe *mesh, int group,
                            int *id) {
  char *label = NULL;
  GMSH_TRY(name, gmshModelGetPhysicalName(2, group, &label, &ierr));
  *id = mesh_fe_take_group(mesh, names, label ? label : "");
  gmshFree(label);
  return SHB_OK;
}

static shb_status take_group(const char *name, const mesh_names *names,
                             const mesh_tagged_nodes *table, int group, mesh_fe *mesh) {
  int id = MESH_ROOT;
  SHB_TRY(which_set(name, names, mesh, group, &id));
  if (id < 0) return SHB_OK;
  int   *entities = NULL;
  size_t n        = 0;
  GMSH_TRY(name, gmshModelGetEntitiesForPhysicalGroup(2, group, &entities, &n, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i < n && status == SHB_OK; i++)
    status = take_surface(name, table, entities[i], mesh, id);
  gmshFree(entities);
  return status;
}

static shb_status take_groups(const char *name, const mesh_names *names,
                              const mesh_tagged_nodes *table, mesh_fe *mesh) {
  int   *groups = NULL;
  size_t n      = 0;
  GMSH_TRY(name, gmshModelGetPhysicalGroups(&groups, &n, 2, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i + 1 < n && status == SHB_OK; i += 2)
    status = take_group(name, names, table, groups[i + 1], mesh);
  gmshFree(groups);
  return status;
}

shb_status mesh_import(const char *name, const mesh_names *names, mesh_fe *mesh) {
  memset(mesh, 0, sizeof *mesh);
  mesh_regions_name(names, mesh);
  size_t           *tag    = NULL;
  double           *xyz    = NULL;
  mesh_tagged_nodes table  = {0};
  shb_status        status = check_types(name, &mesh->kind);
  if (status == SHB_OK) status = take_tags(name, &tag, &xyz, &table);
  if (status == SHB_OK) status = take_volume(name, &table, mesh);
  if (status == SHB_OK) status = take_groups(name, names, &table, mesh);
  if (status == SHB_OK) status = mesh_faces_orient(mesh, name);
  if (status == SHB_OK && names && names->n_volumes)
    status = mesh_volumes_assign(name, names, mesh);
  mesh_tagged_nodes_free(&table);
  gmshFree(tag);
  gmshFree(xyz);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}
