#include "mesh/blade/section_smoothing.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mesh/base/arena.h"

/* Quadrangles around each node: quad[start[node]] .. quad[start[node + 1] - 1]. */
typedef struct {
  mesh_planar *plan;
  int         *start, *quad;
  char        *fixed; /* [n_nodes] the node must not move */
} adjacency;

/* Sine of the angle at corner c between the tangents of its curved sides. */
static double corner_sine(const mesh_planar *plan, const int *quad, int c) {
  const double *at = plan->at[quad[c]], *next = plan->at[quad[(c + 1) % 4]],
               *last  = plan->at[quad[(c + 3) % 4]];
  const double *after = plan->at[quad[4 + c]], *before = plan->at[quad[4 + (c + 3) % 4]];
  const bool    bent[2] = {quad[4 + c] < plan->n_section_nodes,
                           quad[4 + (c + 3) % 4] < plan->n_section_nodes};
  double        a[2], b[2];
  for (int x = 0; x < 2; x++) { /* tangents of the quadratic sides */
    a[x] = bent[0] ? 4 * after[x] - 3 * at[x] - next[x] : next[x] - at[x];
    b[x] = bent[1] ? 4 * before[x] - 3 * at[x] - last[x] : last[x] - at[x];
  }
  return (a[0] * b[1] - a[1] * b[0]) / (hypot(a[0], a[1]) * hypot(b[0], b[1]) + 1e-300);
}

/* Smallest sine of the quadrangles around a node. */
static double least_sine_at(const adjacency *r, int node) {
  double worst = 1;
  for (int i = r->start[node]; i < r->start[node + 1]; i++)
    for (int c = 0; c < 4; c++)
      worst = fmin(worst, corner_sine(r->plan, r->plan->quad[r->quad[i]], c));
  return worst;
}

static void mean_of(const adjacency *r, int node, double mean[2]) {
  int count = 0;
  mean[0] = mean[1] = 0;
  for (int i = r->start[node]; i < r->start[node + 1]; i++) {
    const int *quad = r->plan->quad[r->quad[i]];
    for (int c = 0; c < 4; c++) {
      if (quad[c] != node) continue;
      const int near[2] = {quad[(c + 1) % 4], quad[(c + 3) % 4]};
      for (int k = 0; k < 2; k++)
        for (int x = 0; x < 2; x++) mean[x] += r->plan->at[near[k]][x];
      count += 2;
    }
  }
  for (int x = 0; x < 2; x++) mean[x] /= count;
}

/* Try the mean of the neighbours, fractions of the way to it, and steps aside; use the best. */
static void move(const adjacency *r, int node) {
  static const double step[8][2] = {{1, 0},   {.5, 0},   {.25, 0}, {.1, 0},
                                    {.3, .3}, {.3, -.3}, {0, .2},  {0, -.2}};
  double *at = r->plan->at[node], from[2] = {at[0], at[1]}, best_place[2] = {at[0], at[1]}, mean[2];
  double  best = least_sine_at(r, node);
  mean_of(r, node, mean);
  const double along[2] = {mean[0] - from[0], mean[1] - from[1]};
  for (int k = 0; k < 8; k++) {
    at[0]        = from[0] + step[k][0] * along[0] - step[k][1] * along[1];
    at[1]        = from[1] + step[k][0] * along[1] + step[k][1] * along[0];
    double worst = least_sine_at(r, node);
    if (worst <= best) continue;
    best = worst;
    memcpy(best_place, at, sizeof best_place);
  }
  memcpy(at, best_place, sizeof best_place);
}

/* Fix the nodes of the section and the ends of edges with one quadrangle only. */
static void find_fixed(const adjacency *r, int *uses) {
  const mesh_planar *plan = r->plan;
  memset(uses, 0, (size_t)plan->n_nodes * sizeof *uses);
  for (int q = 0; q < plan->n_quads; q++)
    for (int c = 4; c < 8; c++) uses[plan->quad[q][c]]++;
  for (int i = 0; i < plan->n_nodes; i++) r->fixed[i] = i < plan->n_section_nodes;
  for (int q = 0; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++)
      if (uses[plan->quad[q][4 + c]] == 1)
        r->fixed[plan->quad[q][c]] = r->fixed[plan->quad[q][(c + 1) % 4]] = 1;
}

static void find_quads(adjacency *r, int *next) {
  const mesh_planar *plan = r->plan;
  memset(r->start, 0, ((size_t)plan->n_nodes + 1) * sizeof *r->start);
  for (int q = 0; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++) r->start[plan->quad[q][c] + 1]++;
  for (int i = 0; i < plan->n_nodes; i++) r->start[i + 1] += r->start[i];
  memcpy(next, r->start, (size_t)plan->n_nodes * sizeof *next);
  for (int q = 0; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++) r->quad[next[plan->quad[q][c]]++] = q;
}

static void set_middles(mesh_planar *plan) {
  for (int q = plan->n_section_quads; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++) {
      const int *quad = plan->quad[q];
      if (quad[4 + c] < plan->n_section_nodes) continue;
      for (int x = 0; x < 2; x++)
        plan->at[quad[4 + c]][x] = (plan->at[quad[c]][x] + plan->at[quad[(c + 1) % 4]][x]) / 2;
    }
}

void mesh_planar_smooth(mesh_planar *plan) {
  enum { PASSES = 30 };
  const size_t n     = (size_t)plan->n_nodes;
  shb_arena    arena = {0};
  adjacency    r     = {.plan  = plan,
                        .start = shb_arena_take(&arena, n + 1, sizeof(int)),
                        .quad  = shb_arena_take(&arena, 4 * (size_t)plan->n_quads, sizeof(int)),
                        .fixed = shb_arena_take(&arena, n, 1)};
  int         *work  = shb_arena_take(&arena, n, sizeof *work);
  find_fixed(&r, work);
  find_quads(&r, work);
  for (int pass = 0; pass < PASSES; pass++)
    for (int i = 0; i < plan->n_nodes; i++)
      if (!r.fixed[i] && r.start[i] < r.start[i + 1]) move(&r, i);
  set_middles(plan);
  shb_arena_free(&arena);
}

double mesh_planar_least_sine(const mesh_planar *plan) {
  double worst = 1;
  int    met   = 0;
  for (int q = plan->n_section_quads; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++) {
      worst = fmin(worst, corner_sine(plan, plan->quad[q], c));
      met += plan->quad[q][4 + c] < plan->n_section_nodes;
    }
  return met == plan->n_contour / 2 ? worst : -1;
}
