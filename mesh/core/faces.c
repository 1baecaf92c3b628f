#include "mesh/core/faces.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* A face, identified by its corners. */
typedef struct {
  int corner[4]; /* ascending; the first is -1 in a triangle */
  int set, face;
  int hits; /* number of elements with this face */
} face_key;

/* Corners of a face, ascending. The fourth of a triangle is -1, which comes first. */
static void sort_corners(const int *nodes, int n, int corner[4]) {
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

/* Keys of the faces of all sets, sorted. flag marks their corner nodes. */
static int list_set_faces(const mesh_fe *mesh, face_key *keys, char *flag) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  int                  n        = 0;
  for (int s = 0; s < mesh_fe_sets(mesh); s++)
    for (int f = 0; f < mesh->set[s].n; f++) {
      face_key  *key  = &keys[n++];
      const int *face = mesh->set[s].nodes + topology->face_nodes * (size_t)f;
      for (int i = 0; i < topology->face_corners; i++) flag[face[i]] = 1;
      sort_corners(face, topology->face_corners, key->corner);
      key->set  = s;
      key->face = f;
      key->hits = 0;
    }
  qsort(keys, (size_t)n, sizeof *keys, by_corner);
  return n;
}

/* Copy the nodes of an element's face, ordered outward, to every set that contains it. */
static void copy_to_sets(mesh_fe *mesh, face_key *keys, int n, const int *face) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const size_t         size     = (size_t)topology->face_nodes;
  face_key             wanted;
  sort_corners(face, topology->face_corners, wanted.corner);
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
        name, mesh_fe_set_name(mesh, keys[i].set), tag[c[0]], tag[c[1]], tag[c[2]],
        keys[i].hits ? "is inside the body" : "is on no element");
  }
  return SHB_OK;
}

/* Visit every face all corners of which belong to some set. */
static void visit_elements(mesh_fe *mesh, face_key *keys, int n, const char *flag) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *element = mesh->connectivity + topology->nodes * (size_t)e;
    for (int f = 0; f < topology->faces; f++) {
      int nodes[MESH_FACE_NODES], all = 1;
      for (int i = 0; i < topology->face_nodes; i++) nodes[i] = element[topology->face[f][i]];
      for (int i = 0; i < topology->face_corners; i++) all = all && flag[nodes[i]];
      if (all) copy_to_sets(mesh, keys, n, nodes);
    }
  }
}

shb_status mesh_faces_orient(mesh_fe *mesh, const char *name) {
  size_t total = 0;
  for (int s = 0; s < mesh_fe_sets(mesh); s++) total += (size_t)mesh->set[s].n;
  face_key *keys = shb_alloc(total + 1, sizeof *keys);
  char     *flag = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  const int n    = list_set_faces(mesh, keys, flag);
  visit_elements(mesh, keys, n, flag);
  shb_status status = check_hits(mesh, keys, n, name);
  free(keys);
  free(flag);
  return status;
}

/* Nodes of face f of element e. False if one is not marked; marked NULL: all are. */
static bool marked_face(const mesh_fe *mesh, const char *marked, int e, int f, int *nodes) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  bool                 all      = true;
  for (int i = 0; i < topology->face_nodes; i++) {
    nodes[i] = mesh->connectivity[topology->nodes * (size_t)e + (size_t)topology->face[f][i]];
    all      = all && (!marked || marked[nodes[i]]);
  }
  return all;
}

/* Count the faces with all nodes marked; unless keys is NULL, list them sorted by corners. A key
 * holds the element in set and the local face in face. */
static int list_candidates(const mesh_fe *mesh, const char *marked, face_key *keys) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  int                  n        = 0, nodes[MESH_FACE_NODES];
  for (int e = 0; e < mesh->n_elements; e++)
    for (int f = 0; f < topology->faces; f++) {
      if (!marked_face(mesh, marked, e, f, nodes)) continue;
      if (keys) {
        keys[n] = (face_key){.set = e, .face = f};
        sort_corners(nodes, topology->face_corners, keys[n].corner);
      }
      n++;
    }
  if (keys) qsort(keys, (size_t)n, sizeof *keys, by_corner);
  return n;
}

static int by_element(const void *a, const void *b) {
  const face_key *p = a, *q = b;
  return p->set != q->set ? (p->set > q->set) - (p->set < q->set) : p->face - q->face;
}

/* Remove the keys that occur twice; sort the others by element. Returns their number. */
static int remove_pairs(face_key *keys, int n) {
  int kept = 0;
  for (int i = 0, next; i < n; i = next) {
    for (next = i + 1; next < n && by_corner(&keys[i], &keys[next]) == 0;) next++;
    if (next == i + 1) keys[kept++] = keys[i];
  }
  qsort(keys, (size_t)kept, sizeof *keys, by_element);
  return kept;
}

void mesh_faces_outer(const mesh_fe *mesh, const char *marked, mesh_face_set *set) {
  const size_t each = (size_t)mesh_topology_of(mesh->kind)->face_nodes;
  int          n    = list_candidates(mesh, marked, NULL);
  face_key    *keys = shb_alloc((size_t)n + 1, sizeof *keys);
  list_candidates(mesh, marked, keys);
  set->n     = remove_pairs(keys, n);
  set->nodes = shb_alloc(each * (size_t)set->n + 1, sizeof *set->nodes);
  for (int f = 0; f < set->n; f++)
    marked_face(mesh, NULL, keys[f].set, keys[f].face, set->nodes + each * (size_t)f);
  free(keys);
}
