#include "mesh/core/tagged_nodes.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

static int by_first(const void *a, const void *b) {
  size_t p = *(const size_t *)a, q = *(const size_t *)b;
  return (p > q) - (p < q);
}

shb_status mesh_tagged_nodes_create(const char *name, size_t n, const size_t *tag,
                                    const double *xyz, mesh_tagged_nodes *out) {
  *out = (mesh_tagged_nodes){.n = n, .tag = tag, .xyz = xyz};
  SHB_CHECK(n > 0, SHB_ERR_INPUT, "%s: no nodes", name);
  SHB_CHECK(n < INT_MAX / MESH_NODES, SHB_ERR_INPUT, "%s: %zu nodes are too many", name, n);
  out->by_tag = shb_alloc(2 * n, sizeof *out->by_tag);
  out->index  = shb_alloc(n, sizeof *out->index);
  bool sorted = true;
  for (size_t i = 0; i < n; i++) {
    out->by_tag[2 * i]     = tag[i];
    out->by_tag[2 * i + 1] = i;
    out->index[i]          = -1;
    sorted                 = sorted && (i == 0 || tag[i - 1] < tag[i]);
  }
  if (!sorted) qsort(out->by_tag, n, 2 * sizeof *out->by_tag, by_first);
  return SHB_OK;
}

bool mesh_tagged_nodes_repeat(const mesh_tagged_nodes *nodes) {
  for (size_t i = 1; i < nodes->n; i++)
    if (nodes->by_tag[2 * i] == nodes->by_tag[2 * i - 2]) return true;
  return false;
}

void mesh_tagged_nodes_free(mesh_tagged_nodes *nodes) {
  free(nodes->by_tag);
  free(nodes->index);
  memset(nodes, 0, sizeof *nodes);
}

/* Index of a tag in the table, or n. */
static size_t find(const mesh_tagged_nodes *nodes, size_t tag) {
  const size_t *found = bsearch(&tag, nodes->by_tag, nodes->n, 2 * sizeof *nodes->by_tag, by_first);
  return found ? found[1] : nodes->n;
}

/* Set connectivity[i] to the index in the table, for take_nodes to replace; mark the nodes used. */
static shb_status take_connectivity(const char *name, const mesh_tagged_elements *elements,
                                    mesh_tagged_nodes *nodes, mesh_fe *mesh) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  for (size_t i = 0; i < each * elements->n; i++) {
    size_t place = find(nodes, elements->nodes[i]);
    SHB_CHECK(place < nodes->n, SHB_ERR_INPUT, "%s: element %zu uses node %zu, which is absent",
              name, elements->tag[i / each], elements->nodes[i]);
    mesh->connectivity[i] = (int)place;
    nodes->index[place]   = 0;
  }
  for (size_t e = 0; e < elements->n; e++) mesh->element_tag[e] = (long)elements->tag[e];
  return SHB_OK;
}

/* Number the used nodes by ascending tag and copy them. */
static void take_nodes(mesh_tagged_nodes *nodes, mesh_fe *mesh) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes;
  mesh->n_nodes     = 0;
  for (size_t i = 0; i < nodes->n; i++) {
    size_t place = nodes->by_tag[2 * i + 1];
    if (nodes->index[place] >= 0) nodes->index[place] = mesh->n_nodes++;
  }
  mesh->coordinates = shb_alloc(3 * (size_t)mesh->n_nodes, sizeof *mesh->coordinates);
  mesh->node_tag    = shb_alloc((size_t)mesh->n_nodes, sizeof *mesh->node_tag);
  for (size_t i = 0; i < nodes->n; i++) {
    int at = nodes->index[i];
    if (at < 0) continue;
    memcpy(mesh->coordinates + 3 * (size_t)at, nodes->xyz + 3 * i, 3 * sizeof(double));
    mesh->node_tag[at] = (long)nodes->tag[i];
  }
  for (size_t i = 0; i < each * (size_t)mesh->n_elements; i++)
    mesh->connectivity[i] = nodes->index[mesh->connectivity[i]];
}

shb_status mesh_tagged_take_volume(const char *name, const mesh_tagged_elements *elements,
                                   mesh_tagged_nodes *nodes, mesh_fe *mesh) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->nodes, n = elements->n;
  SHB_CHECK(n < INT_MAX / each, SHB_ERR_INPUT, "%s: %zu elements are too many", name, n);
  mesh->n_elements   = (int)n;
  mesh->connectivity = shb_alloc(each * n, sizeof *mesh->connectivity);
  mesh->element_tag  = shb_alloc(n, sizeof *mesh->element_tag);
  SHB_TRY(take_connectivity(name, elements, nodes, mesh));
  take_nodes(nodes, mesh);
  return SHB_OK;
}

shb_status mesh_tagged_append_faces(const char *name, const mesh_tagged_nodes *nodes,
                                    const mesh_tagged_elements *faces, int set, mesh_fe *mesh) {
  const size_t   each = (size_t)mesh_topology_of(mesh->kind)->face_nodes, n = faces->n;
  mesh_face_set *to   = &mesh->set[set];
  int           *grow = shb_realloc(to->nodes, each * ((size_t)to->n + n + 1), sizeof *grow);
  to->nodes           = grow;
  for (size_t i = 0; i < each * n; i++) {
    size_t place = find(nodes, faces->nodes[i]);
    SHB_CHECK(place < nodes->n && nodes->index[place] >= 0, SHB_ERR_INPUT,
              "%s: group %s: node %zu belongs to no element", name, mesh_fe_set_name(mesh, set),
              faces->nodes[i]);
    grow[each * (size_t)to->n + i] = nodes->index[place];
  }
  to->n += (int)n;
  return SHB_OK;
}
