#include "fem/element/hourglass.h"

#include <stdbool.h>
#include <stdlib.h>

#include "mesh/base/memory.h"

enum { FACES = 6, CORNERS = 4 };

/* Opposite faces of the hexahedron of mesh_topology. */
static const int opposite[3][2] = {{0, 5}, {1, 4}, {2, 3}};

typedef struct {
  int corner[CORNERS]; /* ascending */
  int face;            /* FACES * element + face; -1 for one of group root */
} face_key;

static int by_corner(const void *a, const void *b) {
  const face_key *p = a, *q = b;
  for (int i = 0; i < CORNERS; i++)
    if (p->corner[i] != q->corner[i]) return p->corner[i] < q->corner[i] ? -1 : 1;
  return 0;
}

static int by_number(const void *a, const void *b) {
  return *(const int *)a - *(const int *)b;
}

static face_key make_key(const int *nodes, const int *local, int face) {
  face_key s = {.face = face};
  for (int i = 0; i < CORNERS; i++) s.corner[i] = nodes[local ? local[i] : i];
  qsort(s.corner, CORNERS, sizeof *s.corner, by_number);
  return s;
}

/* Faces that are held by the clamp or by the next sector. */
static const mesh_set_id held[3] = {MESH_ROOT, MESH_CYCLIC_RIGHT, MESH_CYCLIC_LEFT};

/* supported[FACES * element + face] = 1 where another face, or what holds it, has the same
 * corners. */
static void find_supported(const mesh_fe *mesh, face_key *keys, char *supported) {
  size_t n = 0;
  for (int e = 0; e < mesh->n_elements; e++)
    for (int f = 0; f < FACES; f++)
      keys[n++] = make_key(mesh->connectivity + 20 * (size_t)e,
                           mesh_topology_of(MESH_HEX20)->face[f], FACES * e + f);
  for (int s = 0; s < 3; s++)
    for (int f = 0; f < mesh->set[held[s]].n; f++)
      keys[n++] = make_key(mesh->set[held[s]].nodes + 8 * (size_t)f, NULL, -1);
  qsort(keys, n, sizeof *keys, by_corner);
  for (size_t i = 0; i + 1 < n; i++) {
    if (by_corner(&keys[i], &keys[i + 1]) != 0) continue;
    for (size_t k = i; k <= i + 1; k++)
      if (keys[k].face >= 0) supported[keys[k].face] = 1;
  }
}

shb_status fem_hourglass_check(const mesh_fe *mesh) {
  if (mesh->kind != MESH_HEX20) return SHB_OK;
  const size_t n    = FACES * (size_t)mesh->n_elements;
  size_t       more = 1;
  for (int s = 0; s < 3; s++) more += (size_t)mesh->set[held[s]].n;
  face_key *keys      = shb_alloc(n + more, sizeof *keys);
  char     *supported = shb_alloc_zeroed(n + 1, 1);
  int       bad = 0, first = -1;
  find_supported(mesh, keys, supported);
  for (int e = 0; e < mesh->n_elements; e++) {
    int free_pairs = 0;
    for (int d = 0; d < 3; d++)
      free_pairs +=
          !supported[FACES * e + opposite[d][0]] && !supported[FACES * e + opposite[d][1]];
    if (free_pairs >= 2 && bad++ == 0) first = e;
  }
  free(keys);
  free(supported);
  SHB_CHECK(bad == 0, SHB_ERR_INPUT,
            "%d hexahedra (the first has tag %ld) stand in a column one by one: 2x2x2 points leave "
            "them motions without energy; mesh with two elements across, or give "
            "modal.integration: full",
            bad, mesh->element_tag[first]);
  return SHB_OK;
}
