#include "mesh/core/group_checks.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Number of faces of set a all nodes of which are in set b, and the first of them.
 *   marked  scratch  [n_nodes] */
static int count(const mesh_fe *mesh, int a, int b, char *marked, int *first) {
  const mesh_face_set *inner = &mesh->set[a], *outer = &mesh->set[b];
  const int            each = mesh_topology_of(mesh->kind)->face_nodes;
  int                  n    = 0;
  memset(marked, 0, (size_t)mesh->n_nodes);
  for (int i = 0; i < each * outer->n; i++) marked[outer->nodes[i]] = 1;
  for (int f = inner->n - 1; f >= 0; f--) {
    int inside = 0;
    for (int i = 0; i < each; i++) inside += marked[inner->nodes[each * f + i]];
    if (inside < each) continue;
    *first = f;
    n++;
  }
  return n;
}

static void centre(const mesh_fe *mesh, int id, int face, double at[3]) {
  const mesh_topology *t    = mesh_topology_of(mesh->kind);
  const int           *node = mesh->set[id].nodes + t->face_nodes * (size_t)face;
  for (int d = 0; d < 3; d++) {
    at[d] = 0;
    for (int c = 0; c < t->face_corners; c++)
      at[d] += mesh->coordinates[3 * (size_t)node[c] + d] / t->face_corners;
  }
}

static shb_status refuse(const mesh_fe *mesh, const char *name, int a, int b, int n, int first) {
  double at[3];
  centre(mesh, a, first, at);
  SHB_FAIL(SHB_ERR_INPUT,
           "%s: groups %s and %s share %d of %d faces, one at (%.4g, %.4g, %.4g) m; %s: leave them "
           "out of one of the two",
           name, mesh_fe_set_name(mesh, a), mesh_fe_set_name(mesh, b), n, mesh->set[a].n, at[0],
           at[1], at[2],
           b == MESH_ROOT           ? "what is clamped does not move"
           : b >= MESH_CYCLIC_RIGHT ? "a cyclic side lies inside the disc"
                                    : "a face meets one neighbour");
}

static shb_status check_pair(const mesh_fe *mesh, const char *name, int a, int b, char *marked) {
  const bool contact = a == MESH_CONTACT_RIGHT || a == MESH_CONTACT_LEFT || b >= MESH_CYCLIC_RIGHT;
  int        first = 0, n = count(mesh, a, b, marked, &first);
  if (n > 0 && (contact || n == mesh->set[a].n)) return refuse(mesh, name, a, b, n, first);
  return SHB_OK;
}

static shb_status check_overlap(const mesh_fe *mesh, const char *name) {
  char      *marked = shb_alloc((size_t)mesh->n_nodes + 1, 1);
  shb_status status = SHB_OK;
  for (int s = MESH_ROOT + 1; s < mesh_fe_sets(mesh) && status == SHB_OK; s++)
    status = check_pair(mesh, name, s, MESH_ROOT, marked);
  if (status == SHB_OK)
    status = check_pair(mesh, name, MESH_CONTACT_RIGHT, MESH_CONTACT_LEFT, marked);
  for (int a = MESH_CONTACT_RIGHT; a <= MESH_LOAD && status == SHB_OK; a++)
    for (int b = MESH_CYCLIC_RIGHT; b <= MESH_CYCLIC_LEFT && status == SHB_OK; b++)
      if (mesh->set[b].n > 0) status = check_pair(mesh, name, a, b, marked);
  free(marked);
  return status;
}

shb_status mesh_fe_check_groups(const mesh_fe *mesh, const char *name) {
  char found[MESH_FOUND + 40];
  SHB_CHECK(mesh->set[MESH_ROOT].n > 0, SHB_ERR_INPUT,
            "%s: group root is absent or empty; a physical surface (in .inp a *SURFACE or *NSET) "
            "of that name, or a rule in mesh.groups, says which faces are clamped; %s",
            name, mesh_fe_found(mesh, found));
  for (int s = MESH_N_SETS; s < mesh_fe_sets(mesh); s++)
    SHB_CHECK(mesh->set[s].n > 0, SHB_ERR_INPUT,
              "%s: group %s is absent or empty; a physical surface (in .inp a *SURFACE or *NSET) "
              "of that name, or a rule in mesh.groups, says which faces it is; %s",
              name, mesh_fe_set_name(mesh, s), mesh_fe_found(mesh, found));
  return check_overlap(mesh, name);
}
