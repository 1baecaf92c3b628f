#include "mesh/gmsh/import.h"

#include <gmshc.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/core/faces.h"
#include "mesh/core/regions.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/volumes.h"

enum { GMSH_TET4 = 4, GMSH_HEX8 = 5, GMSH_HEX27 = 12 };

/* gmsh's nodes, sorted by tag. */
typedef struct {
  size_t  n;
  size_t *tag;    /* [n] */
  double *xyz;    /* [n][3] m */
  size_t *by_tag; /* [n][2] tag, index in tag[]; ascending */
  int    *index;  /* [n] index in the mesh, -1: unused */
} node_table;

static int by_first(const void *a, const void *b) {
  size_t p = *(const size_t *)a, q = *(const size_t *)b;
  return (p > q) - (p < q);
}

static void table_free(node_table *table) {
  gmshFree(table->tag);
  gmshFree(table->xyz);
  free(table->by_tag);
  free(table->index);
}

static shb_status table_fill(const char *name, node_table *table) {
  double *unused = NULL;
  size_t  n_xyz = 0, n_unused = 0;
  GMSH_TRY(name, gmshModelMeshGetNodes(&table->tag, &table->n, &table->xyz, &n_xyz, &unused,
                                       &n_unused, -1, -1, 0, 0, &ierr));
  gmshFree(unused);
  SHB_CHECK(table->n > 0 && n_xyz == 3 * table->n, SHB_ERR_INPUT, "%s: no nodes", name);
  SHB_CHECK(table->n < INT_MAX / MESH_NODES, SHB_ERR_INPUT, "%s: %zu nodes are too many", name,
            table->n);
  table->by_tag = malloc(2 * table->n * sizeof *table->by_tag);
  table->index  = malloc(table->n * sizeof *table->index);
  SHB_CHECK(table->by_tag && table->index, SHB_ERR_IO, "%s: no memory for its nodes", name);
  for (size_t i = 0; i < table->n; i++) {
    table->by_tag[2 * i]     = table->tag[i];
    table->by_tag[2 * i + 1] = i;
    table->index[i]          = -1;
  }
  qsort(table->by_tag, table->n, 2 * sizeof *table->by_tag, by_first);
  return SHB_OK;
}

/* Index of a tag in the table, or n. */
static size_t table_find(const node_table *table, size_t tag) {
  const size_t *found = bsearch(&tag, table->by_tag, table->n, 2 * sizeof *table->by_tag, by_first);
  return found ? found[1] : table->n;
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

/* Set connectivity[i] to the index in the table, for take_nodes to replace; mark the nodes used. */
static shb_status take_connectivity(const char *name, node_table *table, const size_t *tags,
                                    const size_t *nodes, mesh_fe *mesh) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  for (size_t i = 0; i < each * (size_t)mesh->n_elements; i++) {
    size_t place = table_find(table, nodes[i]);
    SHB_CHECK(place < table->n, SHB_ERR_INPUT, "%s: element %zu uses node %zu, which is absent",
              name, tags[i / each], nodes[i]);
    mesh->connectivity[i] = (int)place;
    table->index[place]   = 0;
  }
  for (int e = 0; e < mesh->n_elements; e++) mesh->element_tag[e] = (long)tags[e];
  return SHB_OK;
}

/* Number the used nodes by ascending tag and copy them. */
static shb_status take_nodes(const char *name, node_table *table, mesh_fe *mesh) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  mesh->n_nodes     = 0;
  for (size_t i = 0; i < table->n; i++) {
    size_t place = table->by_tag[2 * i + 1];
    if (table->index[place] >= 0) table->index[place] = mesh->n_nodes++;
  }
  mesh->coordinates = malloc(3 * (size_t)mesh->n_nodes * sizeof *mesh->coordinates);
  mesh->node_tag    = malloc((size_t)mesh->n_nodes * sizeof *mesh->node_tag);
  SHB_CHECK(mesh->coordinates && mesh->node_tag, SHB_ERR_IO, "%s: no memory for its nodes", name);
  for (size_t i = 0; i < table->n; i++) {
    int at = table->index[i];
    if (at < 0) continue;
    memcpy(mesh->coordinates + 3 * (size_t)at, table->xyz + 3 * i, 3 * sizeof(double));
    mesh->node_tag[at] = (long)table->tag[i];
  }
  for (size_t i = 0; i < each * (size_t)mesh->n_elements; i++)
    mesh->connectivity[i] = table->index[mesh->connectivity[i]];
  return SHB_OK;
}

static shb_status take_volume(const char *name, node_table *table, mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         each     = (size_t)topology->nodes;
  size_t              *tags = NULL, *nodes = NULL, n = 0, n_nodes = 0;
  GMSH_TRY(name, gmshModelMeshGetElementsByType(topology->gmsh, &tags, &n, &nodes, &n_nodes, -1, 0,
                                                1, &ierr));
  shb_status status = SHB_OK;
  if (n < INT_MAX / each && n_nodes == each * n) {
    mesh->n_elements   = (int)n;
    mesh->connectivity = malloc(each * n * sizeof *mesh->connectivity);
    mesh->element_tag  = malloc(n * sizeof *mesh->element_tag);
    if (mesh->connectivity && mesh->element_tag) {
      status = take_connectivity(name, table, tags, nodes, mesh);
    } else {
      status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: no memory for its elements", name);
    }
  } else {
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s: %zu elements are too many", name, n);
  }
  gmshFree(tags);
  gmshFree(nodes);
  if (status == SHB_OK) status = take_nodes(name, table, mesh);
  return status;
}

/* Append n faces to a set.
 *   nodes  in  [n][face_nodes] tags */
static shb_status append_faces(const char *name, const node_table *table, const size_t *nodes,
                               size_t n, mesh_fe *mesh, int id) {
  const size_t   each = (size_t)mesh_topology_of(mesh->kind)->face_nodes;
  mesh_face_set *set  = &mesh->set[id];
  int           *grow = realloc(set->nodes, each * ((size_t)set->n + n + 1) * sizeof *grow);
  SHB_CHECK(grow, SHB_ERR_IO, "%s: no memory for its groups", name);
  set->nodes = grow;
  for (size_t i = 0; i < each * n; i++) {
    size_t place = table_find(table, nodes[i]);
    SHB_CHECK(place < table->n && table->index[place] >= 0, SHB_ERR_INPUT,
              "%s: group %s: node %zu belongs to no element", name, mesh_fe_set_name(mesh, id),
              nodes[i]);
    grow[each * (size_t)set->n + i] = table->index[place];
  }
  set->n += (int)n;
  return SHB_OK;
}

static shb_status take_surface(const char *name, const node_table *table, int entity, mesh_fe *mesh,
                               int id) {
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
  shb_status status = append_faces(name, table, nodes, n, mesh, id);
  gmshFree(tags);
  gmshFree(nodes);
  return status;
}

/* Set that a physical surface belongs to; mesh_fe_sets(mesh) if none. */
static shb_status which_set(const char *name, const mesh_names *names, mesh_fe *mesh, int group,
                            int *id) {
  char *label = NULL;
  GMSH_TRY(name, gmshModelGetPhysicalName(2, group, &label, &ierr));
  for (*id = 0; *id < mesh_fe_sets(mesh); ++*id)
    if (label && strcmp(label, mesh_names_set(names, *id)) == 0) break;
  if (label && *label) mesh_fe_note_group(mesh, label);
  gmshFree(label);
  return SHB_OK;
}

static shb_status take_group(const char *name, const mesh_names *names, const node_table *table,
                             int group, mesh_fe *mesh) {
  int id = MESH_ROOT;
  SHB_TRY(which_set(name, names, mesh, group, &id));
  if (id == mesh_fe_sets(mesh)) return SHB_OK;
  int   *entities = NULL;
  size_t n        = 0;
  GMSH_TRY(name, gmshModelGetEntitiesForPhysicalGroup(2, group, &entities, &n, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i < n && status == SHB_OK; i++)
    status = take_surface(name, table, entities[i], mesh, id);
  gmshFree(entities);
  return status;
}

static shb_status take_groups(const char *name, const mesh_names *names, const node_table *table,
                              mesh_fe *mesh) {
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
  node_table table  = {0};
  shb_status status = check_types(name, &mesh->kind);
  if (status == SHB_OK) status = table_fill(name, &table);
  if (status == SHB_OK) status = take_volume(name, &table, mesh);
  if (status == SHB_OK) status = take_groups(name, names, &table, mesh);
  if (status == SHB_OK) status = mesh_faces_orient(mesh, name);
  if (status == SHB_OK && names && names->n_volumes)
    status = mesh_volumes_assign(name, names, mesh);
  table_free(&table);
  if (status != SHB_OK) mesh_fe_free(mesh);
  return status;
}
