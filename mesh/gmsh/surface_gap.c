#include "mesh/gmsh/surface_gap.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/faces.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"
#include "mesh/gmsh/solid_volume.h"

/* Elements on curved faces that are measured: with three points each, 1.3 s on splines. */
enum { MEASURED = 1000, POINTS = 4 };

/* Points and weights of a rule of second degree on a face of the mesh. */
typedef struct {
  int    n;
  double at[POINTS][2], weight;
} rule;

static rule rule_of(mesh_kind kind) {
  static const double low = 0.5 - 0.28867513459481287, high = 0.5 + 0.28867513459481287;
  if (kind == MESH_HEX20)
    return (rule){4, {{low, low}, {high, low}, {high, high}, {low, high}}, 1. / 4};
  return (rule){3, {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}, 1. / 6};
}

/* What is collected over the faces of a solid, in the unit of the file. */
typedef struct {
  const char    *path;
  const mesh_fe *mesh;
  rule           rule;
  size_t         step; /* every step-th element of a curved face is measured */
  double         cone; /* three times the signed volume within the faces */
  double         farthest, at[3];
} sums;

/* A face of the solid in the mesh. */
typedef struct {
  int     tag, sign; /* of gmsh; sign -1: its elements look inwards */
  bool    curved;
  size_t  n;    /* elements */
  size_t *node; /* [n][face_nodes] gmsh's tags */
} face;

static int by_tag(const void *a, const void *b) {
  long p = *(const long *)a, q = *(const long *)b;
  return (p > q) - (p < q);
}

/* Indices of the nodes of an element on a face. False: a node is not in the mesh. */
static bool find_nodes(const mesh_fe *mesh, const size_t *tags, int n, int *node) {
  for (int i = 0; i < n; i++) {
    const long  tag   = (long)tags[i];
    const long *found = bsearch(&tag, mesh->node_tag, (size_t)mesh->n_nodes, sizeof tag, by_tag);
    if (!found) return false;
    node[i] = (int)(found - mesh->node_tag);
  }
  return true;
}

/* Their coordinates. */
static bool find_places(const mesh_fe *mesh, const size_t *tags, int n, double (*x)[3]) {
  int node[MESH_FACE_NODES];
  if (!find_nodes(mesh, tags, n, node)) return false;
  for (int i = 0; i < n; i++) memcpy(x[i], mesh->coordinates + 3 * node[i], sizeof x[i]);
  return true;
}

/* Points of the rule on an element, and area vectors with the rule's weight. */
static void place_points(const sums *s, const double (*x)[3], int nodes, double (*point)[3],
                         double (*area)[3]) {
  for (int q = 0; q < s->rule.n; q++) {
    double shape[MESH_FACE_NODES], gradient[MESH_FACE_NODES][2], along[2][3] = {{0}};
    mesh_face_shape(s->mesh->kind, s->rule.at[q], shape, gradient);
    for (int d = 0; d < 3; d++) {
      point[q][d] = 0;
      for (int i = 0; i < nodes; i++) {
        point[q][d] += shape[i] * x[i][d];
        for (int r = 0; r < 2; r++) along[r][d] += gradient[i][r] * x[i][d];
      }
    }
    vec3_cross(along[0], along[1], area[q]);
    for (int d = 0; d < 3; d++) area[q][d] *= s->rule.weight;
  }
}

/* Nearest points of the solid's face to n points of the mesh.
 *   point  in  [n][3] */
static shb_status measure(sums *s, const face *f, size_t n, double (*point)[3]) {
  double *nearest = NULL, *unused = NULL;
  size_t  n_nearest = 0, n_unused = 0;
  if (n == 0) return SHB_OK;
  GMSH_TRY(s->path, gmshModelGetClosestPoint(2, f->tag, point[0], 3 * n, &nearest, &n_nearest,
                                             &unused, &n_unused, &ierr));
  for (size_t i = 0; i < n && n_nearest == 3 * n; i++) {
    const double distance = vec3_distance(nearest + 3 * i, point[i]);
    if (!(distance > s->farthest)) continue;
    s->farthest = distance;
    memcpy(s->at, point[i], sizeof s->at);
  }
  gmshFree(nearest);
  gmshFree(unused);
  return SHB_OK;
}

static shb_status add_face(sums *s, const face *f) {
  const int    nodes = mesh_topology_of(s->mesh->kind)->face_nodes, each = s->rule.n;
  const size_t most = (f->n / s->step + 2) * (size_t)each; /* with one to come */
  double(*point)[3] = shb_alloc(most, sizeof *point), (*area)[3] = shb_alloc(most, sizeof *area);
  size_t kept = 0;
  for (size_t e = 0; e < f->n; e++) {
    double x[MESH_FACE_NODES][3];
    if (!find_places(s->mesh, f->node + e * (size_t)nodes, nodes, x)) continue;
    place_points(s, (const double(*)[3])x, nodes, point + kept, area + kept);
    for (int q = 0; q < each; q++)
      s->cone += f->sign * vec3_dot(point[kept + (size_t)q], area[kept + (size_t)q]);
    if (f->curved && e % s->step == 0) kept += (size_t)each;
  }
  const shb_status status = measure(s, f, kept, point);
  free(point);
  free(area);
  return status;
}

/* The elements of a face; node is freed with gmshFree. */
static shb_status take_face(const sums *s, int signed_tag, face *f) {
  char   *type = NULL;
  size_t *tags = NULL, n_nodes = 0;
  *f = (face){.tag = abs(signed_tag), .sign = signed_tag < 0 ? -1 : 1};
  GMSH_TRY(s->path, gmshModelGetType(2, f->tag, &type, &ierr));
  f->curved = strcmp(type, "Plane") != 0;
  gmshFree(type);
  GMSH_TRY(s->path,
           gmshModelMeshGetElementsByType(mesh_topology_of(s->mesh->kind)->gmsh_face, &tags, &f->n,
                                          &f->node, &n_nodes, f->tag, 0, 1, &ierr));
  gmshFree(tags);
  return SHB_OK;
}

/* 1: the corners follow each other as in an outward face, -1: the other way round, 0: others. */
static int same_sense(int n, const int *outward, const int *corner) {
  for (int first = 0; first < n; first++)
    for (int sense = -1; sense <= 1; sense += 2) {
      int same = 0;
      while (same < n && outward[(first + sense * same + n) % n] == corner[same]) same++;
      if (same == n) return sense;
    }
  return 0;
}

/* Whether the elements of each face look outwards, by the volume elements. gmsh's own sense is
 * another one on faces that a script made before their solid. Between two solids it is kept. */
static void orient(const mesh_fe *mesh, int n, face *faces) {
  const mesh_topology *t        = mesh_topology_of(mesh->kind);
  char                *marked   = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  int(*corner)[MESH_FACE_NODES] = shb_alloc_zeroed((size_t)n + 1, sizeof *corner);
  mesh_face_set set             = {0};
  for (int i = 0; i < n; i++) {
    if (faces[i].n == 0 || !find_nodes(mesh, faces[i].node, t->face_nodes, corner[i])) continue;
    for (int c = 0; c < t->face_nodes; c++) marked[corner[i][c]] = 1;
  }
  mesh_faces_outer(mesh, marked, &set);
  for (int i = 0; i < n; i++)
    for (int e = 0, sense = 0; e < set.n && sense == 0 && faces[i].n > 0; e++) {
      sense = same_sense(t->face_corners, set.nodes + (size_t)e * (size_t)t->face_nodes, corner[i]);
      if (sense != 0) faces[i].sign = sense;
    }
  free(set.nodes);
  free(corner);
  free(marked);
}

/* tag  out  [n] gmsh's tags, below 0 where the elements look inwards */
static shb_status add_faces(sums *s, const int *tags, int n, int *tag) {
  face      *faces  = shb_alloc_zeroed((size_t)n + 1, sizeof *faces);
  size_t     curved = 0;
  shb_status status = SHB_OK;
  for (int i = 0; i < n && status == SHB_OK; i++) {
    status = take_face(s, tags[2 * i + 1], &faces[i]);
    curved += faces[i].curved ? faces[i].n : 0;
  }
  s->step = 1 + curved / MEASURED;
  if (status == SHB_OK) orient(s->mesh, n, faces);
  for (int i = 0; i < n && status == SHB_OK; i++) status = add_face(s, &faces[i]);
  for (int i = 0; i < n; i++) tag[i] = faces[i].sign * faces[i].tag;
  for (int i = 0; i < n; i++) gmshFree(faces[i].node);
  free(faces);
  return status;
}

shb_status mesh_surface_gap_of(const mesh_source *source, const mesh_fe *mesh, int solid,
                               mesh_surface_gap *gap) {
  sums   s      = {.path = source->path, .mesh = mesh, .rule = rule_of(mesh->kind), .step = 1};
  int    one[2] = {3, solid}, *tags = NULL;
  size_t n = 0;
  *gap     = (mesh_surface_gap){.volume = 0};
  GMSH_TRY(source->path, gmshModelGetBoundary(one, 2, &tags, &n, 0, 1, 0, &ierr));
  const int         n_faces = (int)(n / 2);
  int              *signs   = shb_alloc((size_t)n_faces + 1, sizeof *signs);
  mesh_solid_volume exact;
  shb_status        status = add_faces(&s, tags, n_faces, signs);
  if (status == SHB_OK)
    status = mesh_solid_volume_of(source->path, mesh->kind, solid, n_faces, signs, &exact);
  free(signs);
  gmshFree(tags);
  SHB_TRY(status);
  const double unit = source->unit, cubic = unit * unit * unit;
  gap->volume   = cubic * fabs(s.cone) / 3;
  gap->missing  = cubic * (exact.volume - fabs(s.cone) / 3);
  gap->error    = cubic * exact.error;
  gap->farthest = unit * s.farthest;
  for (int d = 0; d < 3; d++) gap->at[d] = unit * s.at[d];
  return SHB_OK;
}
