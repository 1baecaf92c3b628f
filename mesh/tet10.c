#include "mesh/tet10.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 8 };

const int mesh_tet10_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
const int mesh_tet10_face[4][6] = {
    {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {0, 3, 2, 7, 8, 6}, {1, 2, 3, 5, 8, 9}};

/* Gradients of the ten shape functions at barycentric point L; N_i = L_i (2 L_i - 1), N_ab = 4 L_a L_b. */
static void gradients(const double L[4], double dN[10][3]) {
  static const double dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int d = 0; d < 3; d++) {
    for (int i = 0; i < 4; i++) dN[i][d] = (4 * L[i] - 1) * dL[i][d];
    for (int e = 0; e < 6; e++) {
      int a = mesh_tet10_edge[e][0], b = mesh_tet10_edge[e][1];
      dN[4 + e][d] = 4 * (L[a] * dL[b][d] + L[b] * dL[a][d]);
    }
  }
}

/* Corners, then the points of the four-point rule exact to degree 2 (a = (5 - sqrt 5)/20). */
static void points(double dN[POINTS][10][3]) {
  const double a = (5 - sqrt(5)) / 20;
  for (int p = 0; p < POINTS; p++) {
    double L[4];
    for (int i = 0; i < 4; i++) L[i] = p < 4 ? i == p : (i == p - 4 ? 1 - 3 * a : a);
    gradients(L, dN[p]);
  }
}

static double least(const mesh_fe *mesh, int element, double dN[POINTS][10][3]) {
  const int *node    = mesh->connectivity + 10 * (size_t)element;
  double     minimum = INFINITY;
  for (int p = 0; p < POINTS; p++) {
    double J[3][3] = {{0}};
    for (int n = 0; n < 10; n++) {
      const double *x = mesh->coordinates + 3 * (size_t)node[n];
      for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++) J[i][d] += x[i] * dN[p][n][d];
    }
    double det = J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
                 J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                 J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
    if (!(det >= minimum)) minimum = det;
  }
  return minimum;
}

double mesh_tet10_jacobian(const mesh_fe *mesh, int element) {
  double dN[POINTS][10][3];
  points(dN);
  return least(mesh, element, dN);
}

int mesh_tet10_inverted(const mesh_fe *mesh) {
  double dN[POINTS][10][3];
  int    bad = 0;
  points(dN);
  for (int e = 0; e < mesh->n_elements; e++) bad += !(least(mesh, e, dN) > 0);
  return bad;
}

/* Straighten the six edges of an element; number of nodes that moved. */
static int straighten_edges(mesh_fe *mesh, int element, char *moved) {
  const int *node = mesh->connectivity + 10 * (size_t)element;
  int        n    = 0;
  for (int e = 0; e < 6; e++) {
    const double *a = mesh->coordinates + 3 * (size_t)node[mesh_tet10_edge[e][0]];
    const double *b = mesh->coordinates + 3 * (size_t)node[mesh_tet10_edge[e][1]];
    double       *m = mesh->coordinates + 3 * (size_t)node[4 + e];
    if (moved[node[4 + e]]) continue;
    for (int d = 0; d < 3; d++) m[d] = (a[d] + b[d]) / 2;
    moved[node[4 + e]] = 1;
    n++;
  }
  return n;
}

void mesh_tet10_straighten(mesh_fe *mesh, char *moved) {
  double dN[POINTS][10][3];
  points(dN);
  for (int again = 1; again;) {
    again = 0;
    for (int e = 0; e < mesh->n_elements; e++)
      if (!(least(mesh, e, dN) > 0)) again += straighten_edges(mesh, e, moved);
  }
}

shb_status mesh_tet10_check(const mesh_fe *mesh, const char *name) {
  double dN[POINTS][10][3];
  points(dN);
  char   tags[160] = "";
  size_t used      = 0;
  int    bad       = 0;
  for (int e = 0; e < mesh->n_elements; e++) {
    if (least(mesh, e, dN) > 0) continue;
    if (bad++ < 5)
      used += (size_t)snprintf(tags + used, sizeof tags - used, "%s%ld", used ? ", " : "",
                               mesh->element_tag[e]);
  }
  SHB_CHECK(bad == 0, SHB_ERR_INPUT,
            "%s: %d of %d elements inverted (det J <= 0): element%s %s%s; mesh finer or straighten "
            "the curved edges there",
            name, bad, mesh->n_elements, bad > 1 ? "s" : "", tags, bad > 5 ? ", ..." : "");
  return SHB_OK;
}
