#include "mesh/blade/section_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Half thickness of the section in the plane (u, y), |y| <= 4 u (1 - u). It is sharp at both ends
 * like the airfoil; w = y / (4 u (1 - u)). */
static double lens(double u) {
  return 4 * u * (1 - u);
}

/* A block of n x m cells: quadratic nodes on a lattice of half cells, -1 in the middle of cells. */
typedef struct {
  int  n, m;
  int *node; /* [2 m + 1][2 n + 1] */
} sheet;

/* Nodes made so far and their coordinates. */
typedef struct {
  mesh_planar *plan;
  double (*uy)[2];
  int capacity;
} drawing;

/* Node at (u, y), found or made, so that blocks share their sides. */
static int node_at(drawing *d, double u, double y) {
  for (int i = d->plan->n_nodes - 1; i >= 0; i--)
    if (fabs(d->uy[i][0] - u) < 1e-10 && fabs(d->uy[i][1] - y) < 1e-10) return i;
  int i       = d->plan->n_nodes++;
  d->uy[i][0] = u;
  d->uy[i][1] = y;
  return i;
}

/* Add the cells of a block, anticlockwise. */
static void add_cells(mesh_planar *plan, int n, int m, const int *node) {
  static const int step[8][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}};
  for (int j = 0; j < m; j++)
    for (int i = 0; i < n; i++) {
      int *quad = plan->quad[plan->n_quads++];
      for (int c = 0; c < 8; c++)
        quad[c] = node[(2 * j + step[c][1]) * (2 * n + 1) + 2 * i + step[c][0]];
    }
}

/* Point on the side from a to b: on the lens (along 1 upper, -1 lower) or straight (0). */
static void side_at(const double a[2], const double b[2], int along, double s, double at[2]) {
  at[0] = a[0] + s * (b[0] - a[0]);
  at[1] = along ? along * lens(at[0]) : a[1] + s * (b[1] - a[1]);
}

/* Add a block of n x m cells with corners p[0..3] anticlockwise, by transfinite interpolation. Side
 * i begins at p[i] and lies on the upper (1) or lower (-1) side of the lens, or is straight (0), by
 * along[i]. */
static void add_block(drawing *d, int n, int m, double p[4][2], const int along[4], int *node) {
  for (int j = 0; j <= 2 * m; j++)
    for (int i = 0; i <= 2 * n; i++) {
      double s = (double)i / (2 * n), t = (double)j / (2 * m), side[4][2], at[2];
      if (i % 2 && j % 2) continue;
      side_at(p[0], p[1], along[0], s, side[0]);
      side_at(p[1], p[2], along[1], t, side[1]);
      side_at(p[3], p[2], along[2], s, side[2]);
      side_at(p[0], p[3], along[3], t, side[3]);
      for (int x = 0; x < 2; x++)
        at[x] = (1 - t) * side[0][x] + s * side[1][x] + t * side[2][x] + (1 - s) * side[3][x] -
                (1 - s) * (1 - t) * p[0][x] - s * (1 - t) * p[1][x] - s * t * p[2][x] -
                (1 - s) * t * p[3][x];
      node[j * (2 * n + 1) + i] = node_at(d, at[0], at[1]);
    }
  add_cells(d->plan, n, m, node);
}

/* Add three blocks at the edge u = 0, or mirrored at u = 1; the tip takes a share of u. */
static void add_tip(drawing *d, int k, double share, int mirror, int *node) {
  const double half = .5 * share, middle = .55 * share;
  double       edge[2] = {0, 0}, centre[2] = {middle, 0}, cross[2] = {share, 0};
  double       up[2] = {half, lens(half)}, low[2] = {half, -lens(half)};
  double       top[2] = {share, lens(share)}, bottom[2] = {share, -lens(share)};
  double      *block[3][4] = {
           {edge, low, centre, up}, {low, bottom, cross, centre}, {centre, cross, top, up}};
  int along[3][4] = {{-1, 0, 0, 1}, {-1, 0, 0, 0}, {0, 0, 1, 0}};
  for (int b = 0; b < 3; b++) {
    double p[4][2];
    int    curved[4];
    for (int c = 0; c < 4; c++) { /* mirrored: corners and sides in reverse order */
      const double *from = block[b][mirror ? (4 - c) % 4 : c];
      p[c][0]            = mirror ? 1 - from[0] : from[0];
      p[c][1]            = from[1];
      curved[c]          = along[b][mirror ? 3 - c : c];
    }
    add_block(d, k, k, p, curved, node);
  }
}

static void add_middle(drawing *d, const mesh_section_grid *grid, int *node) {
  double first = grid->tip[0], last = 1 - grid->tip[1];
  int    n = grid->chord, m = 2 * grid->half;
  for (int j = 0; j <= 2 * m; j++)
    for (int i = 0; i <= 2 * n; i++) {
      if (i % 2 && j % 2) continue;
      double u                  = first + (last - first) * i / (2 * n);
      node[j * (2 * n + 1) + i] = node_at(d, u, ((double)j / m - 1) * lens(u));
    }
  add_cells(d->plan, n, m, node);
}

static int by_key(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* Nodes on the lens: upper side by rising u, then lower side by falling u. */
static void find_contour(drawing *d, double (*key)[2]) {
  mesh_planar *plan = d->plan;
  plan->n_contour   = 0;
  for (int i = 0; i < plan->n_nodes; i++) {
    double u = d->uy[i][0], y = d->uy[i][1];
    if (fabs(fabs(y) - lens(u)) > 1e-9) continue;
    key[plan->n_contour][0]   = y > -1e-12 && u < 1 ? u : 2 - u;
    key[plan->n_contour++][1] = i;
  }
  qsort(key, (size_t)plan->n_contour, sizeof *key, by_key);
  for (int i = 0; i < plan->n_contour; i++) plan->contour[i] = (int)key[i][1];
}

static void draw(const mesh_section_grid *grid, drawing *d, int *node, double (*key)[2],
                 mesh_section_place *place) {
  mesh_planar *plan = d->plan;
  add_tip(d, grid->half, grid->tip[0], 0, node);
  add_middle(d, grid, node);
  add_tip(d, grid->half, grid->tip[1], 1, node);
  find_contour(d, key);
  plan->n_section_nodes = plan->n_nodes;
  plan->n_section_quads = plan->n_quads;
  for (int i = 0; i < plan->n_nodes; i++) {
    double u = d->uy[i][0], most = lens(u);
    place[i] = (mesh_section_place){u, most > 1e-9 ? d->uy[i][1] / most : 0};
    if (fabs(fabs(place[i].w) - 1) < 1e-8) place[i].w = place[i].w > 0 ? 1 : -1;
  }
}

void mesh_section_mesh_create(const mesh_section_grid *grid, mesh_planar *plan,
                              mesh_section_place **place) {
  const int k = grid->half, n = grid->chord;
  const int quads = 6 * k * k + 2 * k * n, most = 8 * quads + 1;
  double(*key)[2] = shb_alloc((size_t)most, sizeof *key);
  int    *node    = shb_alloc((size_t)(4 * k + 1) * (size_t)(2 * (n + k) + 1), sizeof *node);
  drawing d       = {.plan = plan, .capacity = most};
  memset(plan, 0, sizeof *plan);
  d.uy          = shb_alloc((size_t)most, sizeof *d.uy);
  plan->at      = shb_alloc_zeroed((size_t)most, sizeof *plan->at);
  plan->quad    = shb_alloc((size_t)quads, sizeof *plan->quad);
  plan->contour = shb_alloc((size_t)most, sizeof *plan->contour);
  *place        = shb_alloc((size_t)most, sizeof **place);
  draw(grid, &d, node, key, *place);
  free(key);
  free(node);
  free(d.uy);
}

void mesh_section_mesh_orient(mesh_planar *section) {
  static const int back[8] = {0, 3, 2, 1, 7, 6, 5, 4};
  double           area    = 0;
  for (int q = 0; q < section->n_quads; q++)
    for (int c = 0; c < 4; c++) {
      const double *p = section->at[section->quad[q][c]];
      const double *r = section->at[section->quad[q][(c + 1) % 4]];
      area += p[0] * r[1] - p[1] * r[0];
    }
  for (int q = 0; q < section->n_quads && area < 0; q++) {
    int old[8];
    memcpy(old, section->quad[q], sizeof old);
    for (int c = 0; c < 8; c++) section->quad[q][c] = old[back[c]];
  }
}

void mesh_planar_free(mesh_planar *plan) {
  free(plan->at);
  free(plan->quad);
  free(plan->contour);
  memset(plan, 0, sizeof *plan);
}
