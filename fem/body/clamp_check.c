#include "fem/body/clamp_check.h"

#include <stdbool.h>
#include <stdlib.h>

#include "mesh/base/memory.h"

/* Root of a node in the union-find forest, with path halving. */
static int find(int *parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i         = parent[i];
  }
  return i;
}

static void join(int *parent, const int *nodes, int n) {
  int head = find(parent, nodes[0]);
  for (int i = 1; i < n; i++) parent[find(parent, nodes[i])] = head;
}

/* Trees of the forest that have an element. */
static int count_bodies(const mesh_fe *mesh, int nodes, int *parent) {
  char *seen = shb_alloc_zeroed((size_t)mesh->n_nodes, 1);
  int   n    = 0;
  for (int e = 0; e < mesh->n_elements; e++) {
    char *here = &seen[find(parent, mesh->connectivity[nodes * (size_t)e])];
    n += !*here;
    *here = 1;
  }
  free(seen);
  return n;
}

shb_status fem_clamp_check(const mesh_fe *mesh, int *bodies) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int            nodes    = topology->nodes;
  const mesh_face_set *root     = &mesh->set[MESH_ROOT];
  int                 *parent   = shb_alloc((size_t)mesh->n_nodes, sizeof *parent);
  for (int i = 0; i < mesh->n_nodes; i++) parent[i] = i;
  for (int e = 0; e < mesh->n_elements; e++)
    join(parent, mesh->connectivity + nodes * (size_t)e, nodes);
  *bodies = count_bodies(mesh, nodes, parent);
  for (int f = 1; f < root->n; f++) {
    int ends[2] = {root->nodes[0], root->nodes[topology->face_nodes * (size_t)f]};
    join(parent, ends, 2);
  }
  int floating = 0, first = -1;
  for (int e = 0; e < mesh->n_elements; e++) {
    bool held = root->n > 0 &&
                find(parent, mesh->connectivity[nodes * (size_t)e]) == find(parent, root->nodes[0]);
    if (held) continue;
    if (floating++ == 0) first = e;
  }
  free(parent);
  SHB_CHECK(floating == 0, SHB_ERR_INPUT,
            "%d elements (the first has tag %ld) are not connected to group root: they would float",
            floating, mesh->element_tag[first]);
  return SHB_OK;
}
