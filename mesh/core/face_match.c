#include "mesh/core/face_match.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"

static const double tolerance = 1e-9; /* m */

typedef struct {
  double at[3]; /* m, rotated onto the right face */
  double key;   /* coordinate along a direction that lies in no plane of symmetry of the mesh */
  int    node;
} left_node;

static int by_node(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

static int by_key(const void *a, const void *b) {
  double p = ((const left_node *)a)->key, q = ((const left_node *)b)->key;
  return (p > q) - (p < q);
}

/* Nodes of a set, each once, ascending. */
static int *unique_nodes(const mesh_fe *mesh, const mesh_face_set *set, int *n) {
  const int count = mesh_topology_of(mesh->kind)->face_nodes * set->n;
  int      *nodes = shb_alloc((size_t)count + 1, sizeof *nodes);
  for (int i = 0; i < count; i++) nodes[i] = set->nodes[i];
  qsort(nodes, (size_t)count, sizeof *nodes, by_node);
  *n = 0;
  for (int i = 0; i < count; i++)
    if (i == 0 || nodes[i] != nodes[*n - 1]) nodes[(*n)++] = nodes[i];
  return nodes;
}

static double sort_key(const double at[3]) {
  return 0.5773 * at[0] + 0.6180 * at[1] + 0.5337 * at[2];
}

static left_node *rotated_left(const mesh_fe *mesh, const int *nodes, int n, mesh_axis axis,
                               double angle) {
  left_node *places = shb_alloc((size_t)n + 1, sizeof *places);
  for (int i = 0; i < n; i++) {
    mesh_axis_rotate(axis, angle, mesh->coordinates + 3 * (size_t)nodes[i], places[i].at);
    places[i].key  = sort_key(places[i].at);
    places[i].node = nodes[i];
  }
  qsort(places, (size_t)n, sizeof *places, by_key);
  return places;
}

/* Node nearest to at among first .. last - 1. */
static const left_node *nearest(const left_node *places, int first, int last, const double at[3]) {
  const left_node *best = NULL;
  for (int i = first; i < last; i++)
    if (!best || vec3_distance(places[i].at, at) < vec3_distance(best->at, at)) best = &places[i];
  return best;
}

/* Left node at point at, or -1; gap is then the distance to the nearest. */
static int find_left(const left_node *places, int n, const double at[3], double *gap) {
  double key = sort_key(at);
  int    low = 0, high = n;
  while (low < high) { /* first node within the tolerance in key */
    int middle = (low + high) / 2;
    if (places[middle].key < key - 2 * tolerance) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  while (high < n && places[high].key <= key + 2 * tolerance) high++;
  const left_node *best = nearest(places, low, high, at);
  if (best && vec3_distance(best->at, at) <= tolerance) return best->node;
  best = nearest(places, 0, n, at);
  *gap = vec3_distance(best->at, at);
  return -1;
}

static shb_status pair_up(const mesh_fe *mesh, const left_node *places, int n, const int *right,
                          int *left) {
  for (int i = 0; i < n; i++) {
    const double *at  = mesh->coordinates + 3 * (size_t)right[i];
    double        gap = 0;
    left[i]           = find_left(places, n, at, &gap);
    SHB_CHECK(left[i] >= 0, SHB_ERR_INPUT,
              "contact faces do not match: node %ld of contact_right at (%g, %g, %g) m is %.3g m "
              "from the nearest node of contact_left turned by the sector angle; at most %g m is "
              "allowed (mesh one face as a periodic copy of the other)",
              mesh->node_tag[right[i]], at[0], at[1], at[2], gap, tolerance);
  }
  return SHB_OK;
}

shb_status mesh_fe_match(const mesh_fe *mesh, mesh_axis axis, int blades, int *n_pairs,
                         int **right_nodes, int **left_nodes) {
  const mesh_face_set *sr = &mesh->set[MESH_CONTACT_RIGHT], *sl = &mesh->set[MESH_CONTACT_LEFT];
  char                 found[MESH_FOUND + 40];
  SHB_CHECK(sr->n && sl->n, SHB_ERR_INPUT,
            "group %s is absent or empty; contact to the neighbour needs both contact faces; %s",
            sr->n ? "contact_left" : "contact_right", mesh_fe_found(mesh, found));
  int        nr = 0, nl = 0;
  int       *right  = unique_nodes(mesh, sr, &nr);
  int       *left   = unique_nodes(mesh, sl, &nl);
  left_node *places = rotated_left(mesh, left, nl, axis, SHB_TWO_PI / blades);
  shb_status status = SHB_OK;
  if (nr != nl) {
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__,
                      "contact faces do not match: contact_right has %d nodes, contact_left %d; "
                      "mesh one face as a periodic copy of the other",
                      nr, nl);
  } else {
    status = pair_up(mesh, places, nr, right, left);
  }
  free(places);
  if (status != SHB_OK) {
    free(right);
    free(left);
    return status;
  }
  *n_pairs     = nr;
  *right_nodes = right;
  *left_nodes  = left;
  return SHB_OK;
}
