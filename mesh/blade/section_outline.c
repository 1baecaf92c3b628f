#include "mesh/blade/section_outline.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/blade/section_smoothing.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

enum { GMSH_TRIANGLE = 2, GMSH_QUADRANGLE = 3 };

/* gmsh's coarse mesh: polygons of 3 or 4 corners. */
typedef struct {
  int n_nodes;
  double (*at)[2];
  int n_cells;
  int (*cell)[4]; /* the last is -1 in a triangle */
} coarse;

/* The refined mesh: corners first; a hash table gives the middle of an edge by its ends. */
typedef struct {
  mesh_planar *plan;
  int          capacity, n_slots;
  int (*slot)[3]; /* lower end, upper end, middle; -1: free */
} builder;

/* ------------------------------------------------------------------ middles of edges */

static int *find_slot(builder *b, int p, int q) {
  int    low = p < q ? p : q, high = p < q ? q : p;
  size_t i = ((size_t)low * 2654435761u + (size_t)high * 40503u) % (size_t)b->n_slots;
  while (b->slot[i][2] >= 0 && (b->slot[i][0] != low || b->slot[i][1] != high))
    i = (i + 1) % (size_t)b->n_slots;
  b->slot[i][0] = low;
  b->slot[i][1] = high;
  return &b->slot[i][2];
}

/* Middle of an edge, made half way if there is none yet. */
static int middle_of(builder *b, int p, int q) {
  mesh_planar *plan   = b->plan;
  int         *middle = find_slot(b, p, q);
  if (*middle < 0) {
    *middle = plan->n_nodes++;
    for (int x = 0; x < 2; x++) plan->at[*middle][x] = (plan->at[p][x] + plan->at[q][x]) / 2;
  }
  return *middle;
}

/* Insert the edges of the section; pairs of edges of its contour also count as one coarse edge. */
static void insert_section_edges(builder *b) {
  mesh_planar *plan = b->plan;
  for (int q = 0; q < plan->n_section_quads; q++)
    for (int c = 0; c < 4; c++)
      *find_slot(b, plan->quad[q][c], plan->quad[q][(c + 1) % 4]) = plan->quad[q][4 + c];
  for (int i = 0; i < plan->n_contour; i += 4)
    *find_slot(b, plan->contour[i], plan->contour[(i + 4) % plan->n_contour]) =
        plan->contour[i + 2];
}

/* ------------------------------------------------------------------ gmsh's coarse mesh */

static shb_status add_point(const double at[2], double size, int *point) {
  GMSH_TRY("mesh.blade.size", *point = gmshModelGeoAddPoint(at[0], at[1], 0, size, -1, &ierr));
  return SHB_OK;
}

static shb_status add_line(int from, int to, int parts, int *line) {
  GMSH_TRY("mesh.blade.size", *line = gmshModelGeoAddLine(from, to, -1, &ierr));
  GMSH_TRY("mesh.blade.size",
           gmshModelGeoMeshSetTransfiniteCurve(*line, parts + 1, "Progression", 1, &ierr));
  return SHB_OK;
}

static shb_status add_curve_loop(int n, int *line, int *loop) {
  GMSH_TRY("mesh.blade.size", *loop = gmshModelGeoAddCurveLoop(line, (size_t)n, -1, 0, &ierr));
  return SHB_OK;
}

/* Add a loop of straight lines through n points. */
static shb_status add_loop(int n, const double (*at)[2], const int *parts, double size, int *loop) {
  int *point = shb_alloc((size_t)n, sizeof *point), *line = shb_alloc((size_t)n, sizeof *line);
  shb_status status = SHB_OK;
  for (int i = 0; i < n && status == SHB_OK; i++) status = add_point(at[i], size, &point[i]);
  for (int i = 0; i < n && status == SHB_OK; i++)
    status = add_line(point[i], point[(i + 1) % n], parts ? parts[i] : 1, &line[i]);
  if (status == SHB_OK) status = add_curve_loop(n, line, loop);
  free(point);
  free(line);
  return status;
}

static shb_status set_plan_options(bool plan) {
  const double on = plan;
  GMSH_TRY("mesh.blade", gmshOptionSetNumber("Mesh.MeshSizeExtendFromBoundary", on, &ierr));
  GMSH_TRY("mesh.blade", gmshOptionSetNumber("Mesh.MeshSizeFromPoints", on, &ierr));
  GMSH_TRY("mesh.blade", gmshOptionSetNumber("Mesh.RecombinationAlgorithm", 1, &ierr));
  return SHB_OK;
}

static shb_status mesh_region(const mesh_planar *section, int n_corners, const double corner[][2],
                              const int *parts, double size, bool recombine, const char *what) {
  const int n        = section->n_contour / 4;
  int       loops[2] = {0, 0}, half[16], surface = 0;
  double(*hole)[2] = shb_alloc((size_t)n, sizeof *hole);
  for (int i = 0; i < n; i++)
    memcpy(hole[i], section->at[section->contour[4 * (size_t)i]], sizeof *hole);
  for (int i = 0; i < n_corners; i++) half[i] = parts[i] / 2;
  shb_status status = add_loop(n_corners, corner, half, 2 * size, &loops[0]);
  if (status == SHB_OK) status = add_loop(n, (const double(*)[2])hole, NULL, 2 * size, &loops[1]);
  free(hole);
  SHB_TRY(status);
  GMSH_TRY(what, surface = gmshModelGeoAddPlaneSurface(loops, 2, -1, &ierr));
  GMSH_TRY(what, gmshModelGeoSynchronize(&ierr));
  if (recombine) GMSH_TRY(what, gmshModelMeshSetRecombine(2, surface, &ierr));
  GMSH_TRY(what, gmshModelMeshGenerate(2, &ierr));
  return SHB_OK;
}

static shb_status take_cells(const int *index, int type, int corners, coarse *mesh) {
  size_t *tags = NULL, *nodes = NULL, n = 0, n_nodes = 0;
  GMSH_TRY("mesh.blade.size",
           gmshModelMeshGetElementsByType(type, &tags, &n, &nodes, &n_nodes, -1, 0, 1, &ierr));
  mesh->cell = shb_realloc(mesh->cell, (size_t)mesh->n_cells + n + 1, sizeof *mesh->cell);
  for (size_t e = 0; e < n; e++) {
    int *cell = mesh->cell[mesh->n_cells++];
    cell[3]   = -1;
    for (int c = 0; c < corners; c++) cell[c] = index[nodes[(size_t)corners * e + (size_t)c]];
  }
  gmshFree(tags);
  gmshFree(nodes);
  return SHB_OK;
}

/* Node of the section at a point of its contour, or -1. */
static int on_contour(const mesh_planar *section, const double *at) {
  for (int i = 0; i < section->n_contour; i += 4) {
    const double *c = section->at[section->contour[i]];
    if (hypot(c[0] - at[0], c[1] - at[1]) < 1e-9) return section->contour[i];
  }
  return -1;
}

/* Number the nodes after those of the section; nodes on its contour keep their numbers. */
static shb_status take_coarse(const mesh_planar *section, coarse *mesh) {
  size_t *tags = NULL, n = 0, n_xyz = 0, n_unused = 0, top = 0;
  double *xyz = NULL, *unused = NULL;
  GMSH_TRY("mesh.blade.size",
           gmshModelMeshGetNodes(&tags, &n, &xyz, &n_xyz, &unused, &n_unused, -1, -1, 0, 0, &ierr));
  gmshFree(unused);
  for (size_t i = 0; i < n; i++) top = tags[i] > top ? tags[i] : top;
  int *index = shb_alloc(top + 1, sizeof *index);
  mesh->at   = shb_alloc(n + 1, sizeof *mesh->at);
  for (size_t i = 0; i < n; i++) {
    int known      = on_contour(section, xyz + 3 * i);
    index[tags[i]] = known >= 0 ? known : section->n_nodes + mesh->n_nodes;
    if (known >= 0) continue;
    memcpy(mesh->at[mesh->n_nodes++], xyz + 3 * i, 2 * sizeof(double));
  }
  shb_status status = take_cells(index, GMSH_TRIANGLE, 3, mesh);
  if (status == SHB_OK) status = take_cells(index, GMSH_QUADRANGLE, 4, mesh);
  gmshFree(tags);
  gmshFree(xyz);
  free(index);
  return status;
}

/* ------------------------------------------------------------------ the fine plan */

static void allocate(const mesh_planar *section, const coarse *mesh, builder *b) {
  mesh_planar *plan  = b->plan;
  const size_t quads = (size_t)section->n_quads + 6 * (size_t)mesh->n_cells;
  const size_t nodes = (size_t)section->n_nodes + 24 * (size_t)mesh->n_cells + 64;
  b->n_slots         = (int)(8 * quads + 64);
  b->slot            = shb_alloc((size_t)b->n_slots, sizeof *b->slot);
  plan->at           = shb_alloc(nodes, sizeof *plan->at);
  plan->quad         = shb_alloc(quads, sizeof *plan->quad);
  plan->contour      = shb_alloc((size_t)section->n_contour, sizeof *plan->contour);
  memset(b->slot, -1, (size_t)b->n_slots * sizeof *b->slot);
  plan->n_nodes = plan->n_section_nodes = section->n_nodes;
  plan->n_quads = plan->n_section_quads = section->n_quads;
  plan->n_contour                       = section->n_contour;
  memcpy(plan->at, section->at, (size_t)section->n_nodes * sizeof *plan->at);
  memcpy(plan->quad, section->quad, (size_t)section->n_quads * sizeof *plan->quad);
  memcpy(plan->contour, section->contour, (size_t)section->n_contour * sizeof *plan->contour);
}

/* Split a polygon into quadrangles: one at each corner, with the middles of its two sides and the
 * centre. */
static void split_polygon(builder *b, const int *corner, int n) {
  mesh_planar *plan   = b->plan;
  const int    centre = plan->n_nodes++;
  double      *middle = plan->at[centre];
  middle[0] = middle[1] = 0;
  for (int c = 0; c < n; c++)
    for (int x = 0; x < 2; x++) middle[x] += plan->at[corner[c]][x] / n;
  for (int c = 0; c < n; c++) {
    int *quad = plan->quad[plan->n_quads++];
    quad[0]   = corner[c];
    quad[1]   = middle_of(b, corner[c], corner[(c + 1) % n]);
    quad[2]   = centre;
    quad[3]   = middle_of(b, corner[c], corner[(c + n - 1) % n]);
  }
}

/* Sine of the angle at p between q and r, positive if p, q, r run anticlockwise. */
static double sine(const double *p, const double *q, const double *r) {
  double a[2] = {q[0] - p[0], q[1] - p[1]}, b[2] = {r[0] - p[0], r[1] - p[1]};
  return (a[0] * b[1] - a[1] * b[0]) / (hypot(a[0], a[1]) * hypot(b[0], b[1]) + 1e-300);
}

static double least_sine(const mesh_planar *plan, const int *corner, int n) {
  double least = 1;
  for (int c = 0; c < n; c++)
    least = fmin(least, sine(plan->at[corner[c]], plan->at[corner[(c + 1) % n]],
                             plan->at[corner[(c + n - 1) % n]]));
  return least;
}

/* gmsh's quadrangles can be concave next to a sharp edge. Those are first cut into two
 * triangles. */
static void split_cell(builder *b, const int *cell) {
  const double limit = .1;
  if (cell[3] < 0 || least_sine(b->plan, cell, 4) > limit) {
    split_polygon(b, cell, cell[3] < 0 ? 3 : 4);
    return;
  }
  double best  = -2;
  int    start = 0;
  for (int c = 0; c < 2; c++) {
    const int half[2][3] = {{cell[c], cell[c + 1], cell[c + 2]},
                            {cell[c], cell[c + 2], cell[(c + 3) % 4]}};
    double    worst      = fmin(least_sine(b->plan, half[0], 3), least_sine(b->plan, half[1], 3));
    if (worst <= best) continue;
    best  = worst;
    start = c;
  }
  const int half[2][3] = {{cell[start], cell[start + 1], cell[start + 2]},
                          {cell[start], cell[start + 2], cell[(start + 3) % 4]}};
  for (int k = 0; k < 2; k++) split_polygon(b, half[k], 3);
}

static void refine(const mesh_planar *section, const coarse *mesh, mesh_planar *plan) {
  builder b = {.plan = plan};
  memset(plan, 0, sizeof *plan);
  allocate(section, mesh, &b);
  memcpy(plan->at + section->n_nodes, mesh->at, (size_t)mesh->n_nodes * sizeof *mesh->at);
  plan->n_nodes += mesh->n_nodes;
  insert_section_edges(&b);
  for (int e = 0; e < mesh->n_cells; e++) split_cell(&b, mesh->cell[e]);
  for (int q = plan->n_section_quads; q < plan->n_quads; q++)
    for (int c = 0; c < 4; c++)
      plan->quad[q][4 + c] = middle_of(&b, plan->quad[q][c], plan->quad[q][(c + 1) % 4]);
  mesh_planar_smooth(plan);
  free(b.slot);
}

static shb_status create_in_model(const mesh_planar *section, int n_corners,
                                  const double corner[][2], const int *parts, double size,
                                  bool recombine, const char *what, mesh_planar *plan) {
  coarse     mesh   = {0};
  shb_status status = set_plan_options(true);
  if (status == SHB_OK)
    status = mesh_region(section, n_corners, corner, parts, size, recombine, what);
  if (status == SHB_OK) status = take_coarse(section, &mesh);
  if (status == SHB_OK) refine(section, &mesh, plan);
  free(mesh.at);
  free(mesh.cell);
  if (status == SHB_OK) status = set_plan_options(false);
  return status;
}

shb_status mesh_section_outline_create(const mesh_planar *section, int n_corners,
                                       const double corner[][2], const int *parts, double size,
                                       bool recombine, const char *what, mesh_planar *plan) {
  char *current = NULL;
  GMSH_TRY(what, gmshModelGetCurrent(&current, &ierr));
  int ierr = 0;
  gmshModelAdd("plan", &ierr);
  shb_status status =
      create_in_model(section, n_corners, corner, parts, size, recombine, what, plan);
  gmshModelRemove(&ierr);
  gmshModelSetCurrent(current, &ierr);
  gmshFree(current);
  return status;
}
