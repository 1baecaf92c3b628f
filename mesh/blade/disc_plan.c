#include "mesh/blade/disc_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/blade/disc.h"

static const double HAIR = 1e-9; /* m */

/* The strip at one side of the block. */
typedef struct {
  const mesh_blade *blade;
  mesh_planar      *plan;
  double            side; /* tangential place of the block's side, m */
  int               columns;
  int              *corner; /* [root nodes] first of a corner's 2 columns new nodes, -1: none yet */
  int              *middle; /* [root nodes] first of a middle's columns new nodes, -1: none yet */
} strip;

/* A node beside one of the block, a share of the way to the side of the sector. */
static void place(const strip *s, int node, int from, double share) {
  const double half = copysign(SHB_PI / s->blade->blades, s->side);
  double      *at   = s->plan->at[node];
  at[0]             = share == 1 ? half : (1 - share) * s->plan->at[from][0] + share * half;
  at[1]             = s->plan->at[from][1];
}

/* Node of a corner of the block after that many half columns. */
static int corner_node(strip *s, int from, int halves) {
  if (halves == 0) return from;
  if (s->corner[from] < 0) {
    s->corner[from] = s->plan->n_nodes;
    s->plan->n_nodes += 2 * s->columns;
    for (int i = 1; i <= 2 * s->columns; i++)
      place(s, s->corner[from] + i - 1, from, (double)i / (2 * s->columns));
  }
  return s->corner[from] + halves - 1;
}

static int middle_node(strip *s, int from, int column) {
  if (column == 0) return from;
  if (s->middle[from] < 0) {
    s->middle[from] = s->plan->n_nodes;
    s->plan->n_nodes += s->columns;
    for (int i = 1; i <= s->columns; i++)
      place(s, s->middle[from] + i - 1, from, (double)i / s->columns);
  }
  return s->middle[from] + column - 1;
}

/* The quadrangles beside the edge from a to b, which runs anticlockwise around the block. */
static void add_row(strip *s, int a, int b, int middle) {
  for (int j = 0; j < s->columns; j++) {
    int *quad = s->plan->quad[s->plan->n_quads++];
    quad[0]   = corner_node(s, a, 2 * j);
    quad[1]   = corner_node(s, a, 2 * j + 2);
    quad[2]   = corner_node(s, b, 2 * j + 2);
    quad[3]   = corner_node(s, b, 2 * j);
    quad[4]   = corner_node(s, a, 2 * j + 1);
    quad[5]   = middle_node(s, middle, j + 1);
    quad[6]   = corner_node(s, b, 2 * j + 1);
    quad[7]   = middle_node(s, middle, j);
  }
}

static bool on_side(const mesh_planar *root, int node, double side) {
  return fabs(root->at[node][0] - side) < HAIR;
}

/* Edges of the block on a side. */
static int count_edges(const mesh_planar *root, double side) {
  int n = 0;
  for (int q = 0; q < root->n_quads; q++)
    for (int c = 0; c < 4; c++)
      n += on_side(root, root->quad[q][c], side) && on_side(root, root->quad[q][(c + 1) % 4], side);
  return n;
}

static void add_strip(strip *s, const mesh_planar *root) {
  for (int i = 0; i < root->n_nodes; i++) s->corner[i] = s->middle[i] = -1;
  for (int q = 0; q < root->n_quads; q++)
    for (int c = 0; c < 4; c++) {
      const int *quad = root->quad[q], a = quad[c], b = quad[(c + 1) % 4];
      if (on_side(root, a, s->side) && on_side(root, b, s->side)) add_row(s, a, b, quad[4 + c]);
    }
}

void mesh_disc_plan_create(const mesh_blade *blade, const mesh_planar *root, mesh_planar *plan) {
  const double w = blade->root_width / 2, beside = mesh_disc_angle(blade, w);
  double       radius[4];
  mesh_disc_radii(blade, radius);
  const double gap     = (SHB_PI / blade->blades - beside) * radius[3];
  const int    columns = (int)fmax(1, round(gap / blade->size));
  const size_t rows    = (size_t)count_edges(root, w) + (size_t)count_edges(root, -w);
  const size_t nodes = (size_t)root->n_nodes, more = (5 * rows + 8) * (size_t)columns;
  const size_t quads = (size_t)root->n_quads + rows * (size_t)columns;
  int         *work  = shb_alloc(2 * nodes, sizeof *work);
  *plan              = *root;
  plan->contour      = NULL;
  plan->n_contour    = 0;
  plan->at           = shb_alloc(nodes + more, sizeof *plan->at);
  plan->quad         = shb_alloc(quads, sizeof *plan->quad);
  memcpy(plan->quad, root->quad, (size_t)root->n_quads * sizeof *plan->quad);
  for (size_t i = 0; i < nodes; i++) {
    plan->at[i][0] = mesh_disc_angle(blade, root->at[i][0]);
    plan->at[i][1] = root->at[i][1];
  }
  for (int k = 0; k < 2; k++)
    add_strip(&(strip){blade, plan, k ? -w : w, columns, work, work + nodes}, root);
  free(work);
}
