#include "mesh/core/element_topology.h"

static const int tet_edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};

static const int tet_face[4][MESH_FACE_NODES] = {
    {0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {0, 3, 2, 7, 8, 6}, {1, 2, 3, 5, 8, 9}};

/* gmsh ends with the middles of edges 23, 13; VTK with 13, 23. */
static const int tet_vtk[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

static const double tet_place[10][3] = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},  {0, 0, 1},
                                        {.5, 0, 0},  {.5, .5, 0}, {0, .5, 0}, {0, 0, .5},
                                        {0, .5, .5}, {.5, 0, .5}};

static const double triangle_place[6][2] = {{0, 0}, {1, 0}, {0, 1}, {.5, 0}, {.5, .5}, {0, .5}};

/* gmsh orders the edges by their lower corner, VTK ring by ring. */
static const int hex_edge[12][2] = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3},
                                    {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};

static const int hex_face[6][MESH_FACE_NODES] = {
    {0, 3, 2, 1, 9, 13, 11, 8},   {0, 1, 5, 4, 8, 12, 16, 10},  {0, 4, 7, 3, 10, 17, 15, 9},
    {1, 2, 6, 5, 11, 14, 18, 12}, {2, 3, 7, 6, 13, 15, 19, 14}, {4, 5, 6, 7, 16, 18, 19, 17}};

static const int hex_vtk[20] = {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                13, 9, 16, 18, 19, 17, 10, 12, 14, 15};

static const double hex_place[20][3] = {{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},  {0, 0, 1},
                                        {1, 0, 1},  {1, 1, 1},  {0, 1, 1},  {.5, 0, 0}, {0, .5, 0},
                                        {0, 0, .5}, {1, .5, 0}, {1, 0, .5}, {.5, 1, 0}, {1, 1, .5},
                                        {0, 1, .5}, {.5, 0, 1}, {0, .5, 1}, {1, .5, 1}, {.5, 1, 1}};

static const double quadrangle_place[8][2] = {{0, 0},  {1, 0},  {1, 1},  {0, 1},
                                              {.5, 0}, {1, .5}, {.5, 1}, {0, .5}};

static const mesh_topology tet10 = {.name         = "ten-node tetrahedron",
                                    .face_name    = "six-node triangle",
                                    .nodes        = 10,
                                    .corners      = 4,
                                    .edges        = 6,
                                    .faces        = 4,
                                    .face_nodes   = 6,
                                    .face_corners = 3,
                                    .gmsh         = 11,
                                    .gmsh_face    = 9,
                                    .vtk          = 24,
                                    .along        = {1, 2, 3},
                                    .edge         = tet_edge,
                                    .face         = tet_face,
                                    .vtk_order    = tet_vtk,
                                    .place        = tet_place,
                                    .face_place   = triangle_place};

static const mesh_topology hex20 = {.name         = "twenty-node hexahedron",
                                    .face_name    = "eight-node quadrangle",
                                    .nodes        = 20,
                                    .corners      = 8,
                                    .edges        = 12,
                                    .faces        = 6,
                                    .face_nodes   = 8,
                                    .face_corners = 4,
                                    .gmsh         = 17,
                                    .gmsh_face    = 16,
                                    .vtk          = 25,
                                    .along        = {1, 3, 4},
                                    .edge         = hex_edge,
                                    .face         = hex_face,
                                    .vtk_order    = hex_vtk,
                                    .place        = hex_place,
                                    .face_place   = quadrangle_place};

const mesh_topology *mesh_topology_of(mesh_kind kind) {
  return kind == MESH_HEX20 ? &hex20 : &tet10;
}

/* Quadratic simplex in d dimensions in barycentric coordinates L. Corners: L(2L - 1). Mid-sides:
 * 4 La Lb. dL/dx is constant.
 *   gradient  out  [nodes][d] */
static void simplex(int d, const double *at, double *shape, double *gradient) {
  double barycentric[4] = {1}, slope[4][3] = {{0}};
  for (int x = 0; x < d; x++) {
    barycentric[0] -= at[x];
    barycentric[x + 1] = at[x];
    slope[0][x]        = -1;
    slope[x + 1][x]    = 1;
  }
  for (int c = 0; c <= d; c++) {
    double L = barycentric[c];
    shape[c] = L * (2 * L - 1);
    for (int x = 0; x < d; x++) gradient[c * d + x] = (4 * L - 1) * slope[c][x];
  }
  for (int e = 0; e < d * (d + 1) / 2; e++) {
    int a = tet_edge[e][0], b = tet_edge[e][1], node = d + 1 + e;
    shape[node] = 4 * barycentric[a] * barycentric[b];
    for (int x = 0; x < d; x++)
      gradient[node * d + x] = 4 * (barycentric[a] * slope[b][x] + barycentric[b] * slope[a][x]);
  }
}

/* Serendipity element in d dimensions. The node has coordinates c_x = +-1 in [-1, 1]; c_x = 0 along
 * the edge of a mid-side node. With p_x = 1 + c_x y_x the shape functions are
 *   corners    prod p (sum c_x y_x - (d - 1)) / 2^d
 *   mid-sides  (1 - y^2) prod p / 2^(d-1) */
static void serendipity(int d, const double *at, const double *place, double *value,
                        double *slope) {
  double factor[3], derivative[3], sum = 1 - d, c[3], y[3];
  int    middle = 0;
  for (int x = 0; x < d; x++) {
    c[x]          = 2 * place[x] - 1;
    y[x]          = 2 * at[x] - 1;
    factor[x]     = c[x] == 0 ? 1 - y[x] * y[x] : (1 + c[x] * y[x]) / 2;
    derivative[x] = c[x] == 0 ? -4 * y[x] : c[x]; /* by at; twice the derivative by y */
    middle        = middle || c[x] == 0;
    sum += c[x] * y[x];
  }
  if (middle) sum = 1;
  *value = sum;
  for (int x = 0; x < d; x++) *value *= factor[x];
  for (int x = 0; x < d; x++) {
    double others = 1;
    for (int z = 0; z < d; z++)
      if (z != x) others *= factor[z];
    slope[x] = others * (sum * derivative[x] + (middle ? 0 : 2 * c[x] * factor[x]));
  }
}

void mesh_shape(mesh_kind kind, const double at[3], double *shape, double (*gradient)[3]) {
  if (kind == MESH_TET10) {
    simplex(3, at, shape, &gradient[0][0]);
    return;
  }
  for (int i = 0; i < 20; i++) serendipity(3, at, hex_place[i], &shape[i], gradient[i]);
}

void mesh_face_shape(mesh_kind kind, const double at[2], double *shape, double (*gradient)[2]) {
  if (kind == MESH_TET10) {
    simplex(2, at, shape, &gradient[0][0]);
    return;
  }
  for (int i = 0; i < 8; i++) serendipity(2, at, quadrangle_place[i], &shape[i], gradient[i]);
}
