#include "mesh/core/jacobian.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mesh/core/inversion.h"

enum { POINTS = 43 };

/* Gradients of the shape functions at the points where J is checked. */
typedef struct {
  int    n;
  double gradient[POINTS][MESH_NODES][3];
} sample_points;

static void add(mesh_kind kind, const double at[3], sample_points *p) {
  double shape[MESH_NODES];
  mesh_shape(kind, at, shape, p->gradient[p->n++]);
}

static void add_gauss(int n, const double *point, sample_points *p) {
  for (int i = 0; i < n * n * n; i++) {
    const double at[3] = {point[i % n], point[i / n % n], point[i / (n * n)]};
    add(MESH_HEX20, at, p);
  }
}

static void make_points(mesh_kind kind, sample_points *p) {
  const mesh_topology *topology = mesh_topology_of(kind);
  p->n                          = 0;
  for (int c = 0; c < topology->corners; c++) add(kind, topology->place[c], p);
  if (kind == MESH_HEX20) {
    const double two = .5 / sqrt(3), three = .5 * sqrt(.6);
    add_gauss(2, (const double[]){.5 - two, .5 + two}, p);
    add_gauss(3, (const double[]){.5 - three, .5, .5 + three}, p);
    return;
  }
  const double near = (5 - sqrt(5)) / 20;
  for (int i = 0; i < 4; i++) {
    double at[3] = {near, near, near};
    if (i > 0) at[i - 1] = 1 - 3 * near;
    add(kind, at, p);
  }
}

/* J = dx/d(r, s, t) of an element at a point; returns its determinant. */
static double jacobian_at(const mesh_fe *mesh, int element, const sample_points *p, int q,
                          double J[3][3]) {
  const int  nodes = mesh_topology_of(mesh->kind)->nodes;
  const int *node  = mesh->connectivity + nodes * (size_t)element;
  memset(J, 0, 9 * sizeof(double));
  for (int n = 0; n < nodes; n++) {
    const double *x = mesh->coordinates + 3 * (size_t)node[n];
    for (int i = 0; i < 3; i++)
      for (int d = 0; d < 3; d++) J[i][d] += x[i] * p->gradient[q][n][d];
  }
  return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
         J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
         J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

static double smallest(const mesh_fe *mesh, int element, const sample_points *p) {
  double J[3][3], minimum = INFINITY;
  for (int q = 0; q < p->n; q++) {
    double det = jacobian_at(mesh, element, p, q, J);
    if (!(det >= minimum)) minimum = det;
  }
  return minimum;
}

double mesh_jacobian_worst_corner(const mesh_fe *mesh, double x[3]) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  sample_points        p;
  double               J[3][3], smallest_sine = INFINITY;
  make_points(mesh->kind, &p);
  for (int e = 0; e < mesh->n_elements; e++)
    for (int c = 0; c < topology->corners; c++) {
      double sine = jacobian_at(mesh, e, &p, c, J);
      for (int d = 0; d < 3; d++)
        sine /= sqrt(J[0][d] * J[0][d] + J[1][d] * J[1][d] + J[2][d] * J[2][d]);
      if (!(sine < smallest_sine)) continue;
      smallest_sine  = sine;
      const int node = mesh->connectivity[topology->nodes * (size_t)e + (size_t)c];
      memcpy(x, mesh->coordinates + 3 * (size_t)node, 3 * sizeof *x);
    }
  return smallest_sine;
}

double mesh_jacobian_least(const mesh_fe *mesh, int element) {
  sample_points p;
  make_points(mesh->kind, &p);
  return smallest(mesh, element, &p);
}

int mesh_jacobian_inverted(const mesh_fe *mesh) {
  sample_points p;
  int           bad = 0;
  make_points(mesh->kind, &p);
  for (int e = 0; e < mesh->n_elements; e++) bad += !(smallest(mesh, e, &p) > 0);
  return bad;
}

/* Straighten the edges of an element. Returns the number of nodes that moved. */
static int straighten_edges(mesh_fe *mesh, int element, char *moved) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int           *node     = mesh->connectivity + topology->nodes * (size_t)element;
  int                  n        = 0;
  for (int e = 0; e < topology->edges; e++) {
    const int     middle = node[topology->corners + e];
    const double *a      = mesh->coordinates + 3 * (size_t)node[topology->edge[e][0]];
    const double *b      = mesh->coordinates + 3 * (size_t)node[topology->edge[e][1]];
    if (moved[middle]) continue;
    for (int d = 0; d < 3; d++) mesh->coordinates[3 * (size_t)middle + d] = (a[d] + b[d]) / 2;
    moved[middle] = 1;
    n++;
  }
  return n;
}

void mesh_jacobian_straighten(mesh_fe *mesh, char *moved) {
  sample_points p;
  make_points(mesh->kind, &p);
  for (int straightened = 1; straightened;) {
    straightened = 0;
    for (int e = 0; e < mesh->n_elements; e++)
      if (!(smallest(mesh, e, &p) > 0)) straightened += straighten_edges(mesh, e, moved);
  }
}

/* The place of an element: the mean of its corners. */
static void middle_of(const mesh_fe *mesh, int element, double at[3]) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const int           *node     = mesh->connectivity + topology->nodes * (size_t)element;
  for (int d = 0; d < 3; d++) {
    at[d] = 0;
    for (int c = 0; c < topology->corners; c++)
      at[d] += mesh->coordinates[3 * (size_t)node[c] + d] / topology->corners;
  }
}

/* The inverted elements by cause. */
typedef struct {
  int  bad, n[MESH_N_INVERSIONS], first[MESH_N_INVERSIONS];
  char tags[160];
} inverted;

static inverted find_inverted(const mesh_fe *mesh) {
  inverted      found = {.bad = 0};
  size_t        used  = 0;
  sample_points p;
  make_points(mesh->kind, &p);
  for (int e = 0; e < mesh->n_elements; e++) {
    if (smallest(mesh, e, &p) > 0) continue;
    const mesh_inversion cause = mesh_inversion_of(mesh, e);
    if (found.n[cause]++ == 0) found.first[cause] = e;
    if (found.bad++ < 5)
      used += (size_t)snprintf(found.tags + used, sizeof found.tags - used, "%s%ld",
                               used ? ", " : "", mesh->element_tag[e]);
  }
  return found;
}

shb_status mesh_jacobian_check(const mesh_fe *mesh, const char *name) {
  const inverted found = find_inverted(mesh);
  if (found.bad == 0) return SHB_OK;
  char   why[MESH_INVERSION_TEXT];
  double at[3];
  int    most = 0;
  for (int cause = 1; cause < MESH_N_INVERSIONS; cause++)
    if (found.n[cause] > found.n[most]) most = cause;
  const int example = found.first[most];
  middle_of(mesh, example, at);
  SHB_FAIL(
      SHB_ERR_INPUT,
      "%s: %d of %d elements inverted (det J <= 0): element%s %s%s; %d of them as element %ld, "
      "about (%.4g, %.4g, %.4g): %s",
      name, found.bad, mesh->n_elements, found.bad > 1 ? "s" : "", found.tags,
      found.bad > 5 ? ", ..." : "", found.n[most], mesh->element_tag[example], at[0], at[1], at[2],
      mesh_inversion_describe(mesh, example, why));
}
