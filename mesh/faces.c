#include "mesh/faces.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/tet10.h"

/* One face of one set, known by its corners. */
typedef struct {
  int corner[3]; /* ascending */
  int set, face;
  int hits; /* elements found behind it */
} face_key;

static void sort_three(int v[3]) {
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2 - i; j++)
      if (v[j] > v[j + 1]) {
        int swap = v[j];
        v[j]     = v[j + 1];
        v[j + 1] = swap;
      }
}

static int by_corner(const void *a, const void *b) {
  const face_key *p = a, *q = b;
  for (int i = 0; i < 3; i++)
    if (p->corner[i] != q->corner[i]) return p->corner[i] < q->corner[i] ? -1 : 1;
  return 0;
}

/* Keys of all sets, sorted; flag marks their corner nodes. */
static int fill_keys(const mesh_fe *mesh, face_key *keys, char *flag) {
  int n = 0;
  for (int s = 0; s < MESH_N_SETS; s++)
    for (int f = 0; f < mesh->set[s].n; f++) {
      face_key *key = &keys[n++];
      for (int i = 0; i < 3; i++) {
        key->corner[i]       = mesh->set[s].nodes[6 * f + i];
        flag[key->corner[i]] = 1;
      }
      sort_three(key->corner);
      key->set  = s;
      key->face = f;
      key->hits = 0;
    }
  qsort(keys, (size_t)n, sizeof *keys, by_corner);
  return n;
}

/* Hand element face local[6] to every set that holds it. */
static void hand_over(mesh_fe *mesh, face_key *keys, int n, const int *element, const int *local) {
  face_key wanted = {.corner = {element[local[0]], element[local[1]], element[local[2]]}};
  sort_three(wanted.corner);
  face_key *key = bsearch(&wanted, keys, (size_t)n, sizeof *keys, by_corner);
  if (!key) return;
  while (key > keys && by_corner(key - 1, &wanted) == 0) key--;
  for (; key < keys + n && by_corner(key, &wanted) == 0; key++) {
    key->hits++;
    for (int i = 0; i < 6; i++) mesh->set[key->set].nodes[6 * key->face + i] = element[local[i]];
  }
}

static shb_status check_hits(const mesh_fe *mesh, const face_key *keys, int n, const char *name) {
  for (int i = 0; i < n; i++) {
    const long *tag = mesh->node_tag;
    const int  *c   = keys[i].corner;
    SHB_CHECK(
        keys[i].hits == 1, SHB_ERR_INPUT,
        "%s: group %s: the face on nodes %ld, %ld, %ld %s; a group must lie on the surface of "
        "the body",
        name, mesh_set_name((mesh_set_id)keys[i].set), tag[c[0]], tag[c[1]], tag[c[2]],
        keys[i].hits ? "is inside the body" : "is on no tetrahedron");
  }
  return SHB_OK;
}

shb_status mesh_faces_orient(mesh_fe *mesh, const char *name) {
  size_t total = 0;
  for (int s = 0; s < MESH_N_SETS; s++) total += (size_t)mesh->set[s].n;
  face_key  *keys   = malloc((total + 1) * sizeof *keys);
  char      *flag   = calloc((size_t)mesh->n_nodes + 1, 1);
  shb_status status = SHB_OK;
  if (keys && flag) {
    int n = fill_keys(mesh, keys, flag);
    for (int e = 0; e < mesh->n_elements; e++) {
      const int *element = mesh->connectivity + 10 * (size_t)e;
      for (int f = 0; f < 4; f++) {
        const int *local = mesh_tet10_face[f];
        if (flag[element[local[0]]] && flag[element[local[1]]] && flag[element[local[2]]])
          hand_over(mesh, keys, n, element, local);
      }
    }
    status = check_hits(mesh, keys, n, name);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: no memory for its groups", name);
  }
  free(keys);
  free(flag);
  return status;
}
