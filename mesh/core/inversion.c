#include "mesh/core/inversion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/base/vec3.h"

/* Relative to the longest edge, and to its cube: round-off of coordinates of ten digits. */
static const double same_place = 1e-9, same_plane = 1e-9;

typedef struct {
  const mesh_topology *topology;
  const int           *node;
  double               x[MESH_NODES][3];
  double               longest; /* edge between corners */
} shape;

static void middle_of(const shape *s, int edge, double at[3]) {
  const int *end = s->topology->edge[edge];
  for (int d = 0; d < 3; d++) at[d] = (s->x[end[0]][d] + s->x[end[1]][d]) / 2;
}

static shape shape_of(const mesh_fe *mesh, int element) {
  shape s = {.topology = mesh_topology_of(mesh->kind)};
  s.node  = mesh->connectivity + s.topology->nodes * (size_t)element;
  for (int i = 0; i < s.topology->nodes; i++)
    memcpy(s.x[i], mesh->coordinates + 3 * (size_t)s.node[i], sizeof s.x[i]);
  for (int e = 0; e < s.topology->edges; e++) {
    const int *end = s.topology->edge[e];
    s.longest      = fmax(s.longest, vec3_distance(s.x[end[0]], s.x[end[1]]));
  }
  return s;
}

/* Do two nodes lie at one place? */
static bool find_repeated(const shape *s, int *a, int *b) {
  for (*a = 0; *a < s->topology->nodes; (*a)++)
    for (*b = 0; *b < *a; (*b)++)
      if (s->node[*a] == s->node[*b] ||
          vec3_distance(s->x[*a], s->x[*b]) <= same_place * s->longest)
        return true;
  return false;
}

/* det J at a corner of the element with straight edges. */
static double straight_det(const shape *s, int corner) {
  double N[MESH_NODES], gradient[MESH_NODES][3], J[3][3] = {{0}}, normal[3];
  mesh_shape(s->topology->nodes == 20 ? MESH_HEX20 : MESH_TET10, s->topology->place[corner], N,
             gradient);
  for (int i = 0; i < s->topology->nodes; i++) {
    double x[3];
    memcpy(x, s->x[i], sizeof x);
    if (i >= s->topology->corners) middle_of(s, i - s->topology->corners, x);
    for (int c = 0; c < 3; c++)
      for (int d = 0; d < 3; d++) J[c][d] += gradient[i][c] * x[d];
  }
  vec3_cross(J[0], J[1], normal);
  return vec3_dot(normal, J[2]);
}

/* Edge of whose middle a middle node is nearest. */
static int nearest_edge(const shape *s, int edge) {
  int    best  = edge;
  double least = INFINITY;
  for (int e = 0; e < s->topology->edges; e++) {
    double at[3];
    middle_of(s, e, at);
    const double distance = vec3_distance(at, s->x[s->topology->corners + edge]);
    if (distance < least) best = e;
    least = fmin(least, distance);
  }
  return best;
}

/* Middle nodes are in another order if each is nearest to another edge: a permutation.
 *   first  out  an edge whose middle node is another one */
static bool is_permuted(const shape *s, int *first) {
  int taken[MESH_NODES] = {0};
  *first                = -1;
  for (int e = 0; e < s->topology->edges; e++) {
    const int at = nearest_edge(s, e);
    if (taken[at]++) return false;
    if (at != e && *first < 0) *first = e;
  }
  return *first >= 0;
}

static mesh_inversion inversion_of(const shape *s) {
  const double flat  = same_plane * s->longest * s->longest * s->longest;
  double       least = INFINITY, most = -INFINITY;
  int          a, b;
  if (find_repeated(s, &a, &b)) return MESH_REPEATED;
  for (int c = 0; c < s->topology->corners; c++) {
    const double det = straight_det(s, c);
    least            = fmin(least, det);
    most             = fmax(most, det);
  }
  if (fmax(fabs(least), fabs(most)) <= flat) return MESH_FLAT;
  if (most < 0) return MESH_MIRRORED;
  if (least <= flat) return MESH_FOLDED;
  return is_permuted(s, &a) ? MESH_MIDDLE_ORDER : MESH_CURVED;
}

mesh_inversion mesh_inversion_of(const mesh_fe *mesh, int element) {
  const shape s = shape_of(mesh, element);
  return inversion_of(&s);
}

const char *mesh_inversion_describe(const mesh_fe *mesh, int element,
                                    char text[MESH_INVERSION_TEXT]) {
  static const char *const fixed[MESH_N_INVERSIONS] = {
      [MESH_FLAT] = "its corners lie in one plane; remove it, or mesh anew there",
      [MESH_MIRRORED] =
          "its corners go round the other way; exchange them, or mirror mesh and elements",
      [MESH_FOLDED] = "its corners are in another order, or it is folded",
      [MESH_CURVED] = "its edges are too curved; mesh finer or straighten them there"};
  const shape          s    = shape_of(mesh, element);
  const mesh_inversion kind = inversion_of(&s);
  const long          *tag  = mesh->node_tag;
  int                  a, b;
  if (kind == MESH_REPEATED && find_repeated(&s, &a, &b)) {
    snprintf(text, MESH_INVERSION_TEXT,
             tag[s.node[a]] == tag[s.node[b]]
                 ? "it has node %ld twice; every node of an element must be another one"
                 : "its nodes %ld and %ld are at one place; every node needs its own",
             tag[s.node[a]], tag[s.node[b]]);
  } else if (kind == MESH_MIDDLE_ORDER && is_permuted(&s, &a)) {
    const int *own = s.topology->edge[a], *at = s.topology->edge[nearest_edge(&s, a)];
    snprintf(text, MESH_INVERSION_TEXT,
             "its middle nodes are in another order: node %ld should lie between nodes %ld and "
             "%ld, and lies between %ld and %ld; .inp files have the order of Abaqus, .msh files "
             "that of gmsh",
             tag[s.node[s.topology->corners + a]], tag[s.node[own[0]]], tag[s.node[own[1]]],
             tag[s.node[at[0]]], tag[s.node[at[1]]]);
  } else {
    snprintf(text, MESH_INVERSION_TEXT, "%s", fixed[kind]);
  }
  return text;
}
