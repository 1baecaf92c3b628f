#include "mesh/faces.h"

#include <stdlib.h>
#include <string.h>

/* One face of one set, known by its corners. */
typedef struct {
  int corner[4]; /* ascending; the first is -1 in a triangle */
  int set, face;
  int hits; /* elements found behind it */
} face_key;

/* Corners of a face, ascending; a triangle's fourth is -1, which comes first. */
static void take_corners(const int *nodes, int n, int corner[4]) {
  for (int i = 0; i < 4; i++) corner[i] = i < n ? nodes[i] : -1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3 - i; j++)
      if (corner[j] > corner[j + 1]) {
        int swap      = corner[j];
        corner[j]     = corner[j + 1];
        corner[j + 1] = swap;
      }
}

static int by_corner(const void *a, const void *b) {
  const face_key *p = a, *q = b;
  for (int i = 0; i < 4; i++)
    if (p->corner[i] != q->corner[i]) return p->corner[i] < q->corner[i] ? -1 : 1;
  return 0;
}

/* Keys of all sets, sorted; flag marks their corner nodes. */
static int fill_keys(const mesh_fe *mesh, face_key *keys, char *flag) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  int                  n        = 0;
  for (int s = 0; s < MESH_N_SETS; s++)
    for (int f = 0; f < mesh->set[s].n; f++) {
      face_key  *key  = &keys[n++];
      const int *face = mesh->set[s].nodes + topology->face_nodes * f;
      for (int i = 0; i < topology->face_corners; i++) flag[face[i]] = 1;
      take_corners(face, topology->face_corners, key->corner);
      key->set  = s;
      key->face = f;
      key->hits = 0;
    }
  qsort(keys, (size_t)n, sizeof *keys, by_corner);
  return n;
}

/* Hand an element's face (its nodes, outward) to every set that holds it. */
static void hand_over(mesh_fe *mesh, face_key *keys, int n, const int *face) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         size     = (size_t)topology->face_nodes;
  face_key             wanted;
  take_corners(face, topology->face_corners, wanted.corner);
  face_key *key = bsearch(&wanted, keys, (size_t)n, sizeof *keys, by_corner);
  if (!key) return;
  while (key > keys && by_corner(key - 1, &wanted) == 0) key--;
  for (; key < keys + n && by_corner(key, &wanted) == 0; key++) {
    key->hits++;
    memcpy(mesh->set[key->set].nodes + size * (size_t)key->face, face, size * sizeof *face);
  }
}

static shb_status check_hits(const mesh_fe *mesh, const face_key *keys, int n, const char *name) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int i = 0; i < n; i++) {
    const long *tag = mesh->node_tag;
    const int  *c   = keys[i].corner + 4 - topology->face_corners;
    SHB_CHECK(
        keys[i].hits == 1, SHB_ERR_INPUT,
        "%s: group %s: the face on nodes %ld, %ld, %ld %s; a group must lie on the surface of "
        "the body",
        name, mesh_set_name((mesh_set_id)keys[i].set), tag[c[0]], tag[c[1]], tag[c[2]],
        keys[i].hits ? "is inside the body" : "is on no element");
  }
  return SHB_OK;
}

/* Every face all of whose corners belong to some set. */
static void visit_elements(mesh_fe *mesh, face_key *keys, int n, const char *flag) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *element = mesh->connectivity + topology->nodes * (size_t)e;
    for (int f = 0; f < topology->faces; f++) {
      int nodes[MESH_FACE_NODES], all = 1;
      for (int i = 0; i < topology->face_nodes; i++) nodes[i] = element[topology->face[f][i]];
      for (int i = 0; i < topology->face_corners; i++) all = all && flag[nodes[i]];
      if (all) hand_over(mesh, keys, n, nodes);
    }
  }
}

shb_status mesh_faces_orient(mesh_fe *mesh, const char *name) {
  size_t total = 0;
  for (int s = 0; s < MESH_N_SETS; s++) total += (size_t)mesh->set[s].n;
  face_key  *keys   = malloc((total + 1) * sizeof *keys);
  char      *flag   = calloc((size_t)mesh->n_nodes + 1, 1);
  shb_status status = SHB_OK;
  if (keys && flag) {
    int n = fill_keys(mesh, keys, flag);
    visit_elements(mesh, keys, n, flag);
    status = check_hits(mesh, keys, n, name);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: no memory for its groups", name);
  }
  free(keys);
  free(flag);
  return status;
}
