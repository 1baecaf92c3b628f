#include "mesh/gmsh/solid_volume.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

/* Both rules of a triangle: three points of degree 2, then six of degree 4. */
enum { FIRST = 3, SECOND = 6, POINTS = FIRST + SECOND, DEEPEST = 8 };

/* What the two rules may differ by, of the volume. */
static const double agree = 2e-5;

/* A node of a face. */
typedef struct {
  size_t tag;
  double at[2]; /* u, v */
} place;

/* A face of the solid and what is collected over all faces. */
typedef struct {
  const char *path;
  mesh_kind   kind;
  int         tag, sign; /* of gmsh; sign -1: its elements look inwards */
  size_t      n_places;
  place      *places; /* ascending tags */
  double      low[2], high[2];
  bool        closed[2];  /* the face meets itself where a parameter ends */
  bool        pole[2][2]; /* it is a point at the lower or upper end of a parameter */
  double      centre[3], extent;
  double      tolerance; /* of an element */
  double      flux[2];   /* three times the volume: with straight edges, with parabolas */
  double      left;      /* by which the rules differ, of the same */
  double      normal[3]; /* integral of n dA */
} face_sum;

/* ---------------------------------------------------------------- rules */

/* Dunavant, Int. J. Numer. Meth. Engng 21 (1985), 1129-1148. */
static void rule_point(int q, double at[3], double *weight) {
  static const double near[3] = {1. / 6, 0.445948490915965, 0.091576213509771};
  static const double each[3] = {1. / 3, 0.223381589678011, 0.109951743655322};
  const double        a       = near[q / 3];
  for (int i = 0; i < 3; i++) at[i] = i == q % 3 ? 1 - 2 * a : a;
  *weight = each[q / 3] / 2;
}

/* ---------------------------------------------------------------- patches */

/* An element: parameters of its nodes. */
typedef struct {
  int    nodes, corners;
  double at[MESH_FACE_NODES][2];
} element;

/* A part of an element in its reference coordinates. */
typedef struct {
  double corner[3][2];
} piece;

/* What a part adds: the flux by both rules, and the area by the second. */
typedef struct {
  double flux[2], normal[3];
} amount;

/* The determinant of (u, v) by the coordinates of the part, and (u, v). */
static double map(const face_sum *f, const element *e, const piece *p, const double l[3],
                  double uv[2]) {
  double shape[MESH_FACE_NODES], gradient[MESH_FACE_NODES][2], at[2], J[2][2] = {{0}}, side[2][2];
  for (int d = 0; d < 2; d++) {
    at[d]      = l[0] * p->corner[0][d] + l[1] * p->corner[1][d] + l[2] * p->corner[2][d];
    side[0][d] = p->corner[1][d] - p->corner[0][d];
    side[1][d] = p->corner[2][d] - p->corner[0][d];
    uv[d]      = 0;
  }
  mesh_face_shape(f->kind, at, shape, gradient);
  for (int i = 0; i < e->nodes; i++)
    for (int d = 0; d < 2; d++) {
      uv[d] += shape[i] * e->at[i][d];
      for (int r = 0; r < 2; r++) J[r][d] += gradient[i][r] * e->at[i][d];
    }
  return (J[0][0] * J[1][1] - J[0][1] * J[1][0]) *
         (side[0][0] * side[1][1] - side[0][1] * side[1][0]);
}

static shb_status add_part(const face_sum *f, const element *e, const piece *p, amount *sum) {
  double uv[POINTS][2], weight[POINTS], *x = NULL, *by = NULL;
  size_t n = 0, n_by = 0;
  int    ierr = 0;
  *sum        = (amount){{0}, {0}};
  for (int q = 0; q < POINTS; q++) {
    double l[3], w;
    rule_point(q, l, &w);
    weight[q] = w * map(f, e, p, l, uv[q]);
  }
  gmshModelGetValue(2, f->tag, uv[0], (size_t)2 * POINTS, &x, &n, &ierr);
  if (ierr == 0) gmshModelGetDerivative(2, f->tag, uv[0], (size_t)2 * POINTS, &by, &n_by, &ierr);
  for (int q = 0; q < POINTS && ierr == 0; q++) {
    double normal[3], from[3];
    vec3_cross(by + 6 * (size_t)q, by + 6 * (size_t)q + 3, normal);
    vec3_minus(x + 3 * (size_t)q, f->centre, from);
    sum->flux[q >= FIRST] += weight[q] * vec3_dot(from, normal);
    for (int d = 0; d < 3 && q >= FIRST; d++) sum->normal[d] += weight[q] * normal[d];
  }
  gmshFree(x);
  gmshFree(by);
  return ierr ? mesh_session_fail(SHB_ERR_INPUT, __FILE__, __LINE__, f->path) : SHB_OK;
}

/* Parts of a part: at the corners and in the middle. */
static void divide(const piece *p, piece small[4]) {
  double middle[3][2]; /* opposite a corner */
  for (int i = 0; i < 3; i++)
    for (int d = 0; d < 2; d++)
      middle[i][d] = (p->corner[(i + 1) % 3][d] + p->corner[(i + 2) % 3][d]) / 2;
  for (int i = 0; i < 3; i++) {
    memcpy(small[i].corner[i], p->corner[i], sizeof middle[i]);
    memcpy(small[i].corner[(i + 1) % 3], middle[(i + 2) % 3], sizeof middle[i]);
    memcpy(small[i].corner[(i + 2) % 3], middle[(i + 1) % 3], sizeof middle[i]);
  }
  memcpy(small[3].corner, middle, sizeof middle);
}

/* which: 0 straight edges, 1 parabolas. */
static shb_status integrate(face_sum *f, const element *e, const piece *p, int which, int depth) {
  amount sum;
  SHB_TRY(add_part(f, e, p, &sum));
  const double left = fabs(sum.flux[1] - sum.flux[0]);
  if (left > f->tolerance && depth < DEEPEST) {
    piece small[4];
    divide(p, small);
    for (int i = 0; i < 4; i++) SHB_TRY(integrate(f, e, &small[i], which, depth + 1));
    return SHB_OK;
  }
  f->flux[which] += f->sign * sum.flux[1];
  if (which == 0) return SHB_OK;
  f->left += left;
  for (int d = 0; d < 3; d++) f->normal[d] += f->sign * sum.normal[d];
  return SHB_OK;
}

/* ---------------------------------------------------------------- elements */

static int by_tag(const void *a, const void *b) {
  const size_t p = ((const place *)a)->tag, q = ((const place *)b)->tag;
  return (p > q) - (p < q);
}

/* The parameter d at whose end a node is a pole of the face; -1: it is none. */
static int pole_of(const face_sum *f, const double at[2]) {
  for (int d = 0; d < 2; d++) {
    const double near = 1e-6 * (f->high[d] - f->low[d]);
    if (f->pole[d][0] && fabs(at[d] - f->low[d]) < near) return d;
    if (f->pole[d][1] && fabs(at[d] - f->high[d]) < near) return d;
  }
  return -1;
}

/* A node where a closed face meets itself has two parameters: the one on the element's side. */
static void choose_side(const face_sum *f, element *e) {
  for (int d = 0; d < 2; d++) {
    const double range = f->high[d] - f->low[d], near = 1e-6 * range;
    double       mean = 0;
    int          n    = 0;
    bool         ends[MESH_FACE_NODES];
    if (!f->closed[d]) continue;
    for (int i = 0; i < e->nodes; i++) {
      ends[i] = fabs(e->at[i][d] - f->low[d]) < near || fabs(e->at[i][d] - f->high[d]) < near;
      if (ends[i] || pole_of(f, e->at[i]) >= 0) continue;
      mean += e->at[i][d];
      n++;
    }
    for (int i = 0; i < e->nodes && n > 0; i++)
      if (ends[i]) e->at[i][d] = mean / n < f->low[d] + range / 2 ? f->low[d] : f->high[d];
  }
}

/* Parameters of an element's nodes. False: a node is not there. */
static bool take(const face_sum *f, const size_t *tags, element *e) {
  const mesh_topology *t = mesh_topology_of(f->kind);
  e->nodes               = t->face_nodes;
  e->corners             = t->face_corners;
  for (int i = 0; i < e->nodes; i++) {
    const place  wanted = {.tag = tags[i]};
    const place *found  = bsearch(&wanted, f->places, f->n_places, sizeof wanted, by_tag);
    if (!found) return false;
    memcpy(e->at[i], found->at, sizeof e->at[i]);
  }
  choose_side(f, e);
  return true;
}

static void straighten(const element *e, element *straight) {
  *straight = *e;
  for (int i = e->corners; i < e->nodes; i++)
    for (int d = 0; d < 2; d++)
      straight->at[i][d] =
          (e->at[i - e->corners][d] + e->at[(i - e->corners + 1) % e->corners][d]) / 2;
}

/* Both with parabolas and with straight edges. */
static shb_status add_whole(face_sum *f, const element *e) {
  static const piece half[2] = {{{{0, 0}, {1, 0}, {0, 1}}}, {{{1, 1}, {0, 1}, {1, 0}}}};
  element            straight;
  straighten(e, &straight);
  for (int i = 0; i < (e->corners == 4 ? 2 : 1); i++) {
    SHB_TRY(integrate(f, e, &half[i], 1, 0));
    SHB_TRY(integrate(f, &straight, &half[i], 0, 0));
  }
  return SHB_OK;
}

/* A triangle a, b, pole is a quadrangle in (u, v), whose fourth side is the pole: two triangles.
 *   p  in  corner at the pole
 *   d  in  the parameter that ends there */
static shb_status add_at_pole(face_sum *f, const element *e, int p, int d) {
  const int a = (p + 1) % 3, b = (p + 2) % 3;
  element   part[2] = {*e, *e};
  double    end[2][2]; /* the pole as the end of the sides from a and from b */
  for (int i = 0; i < 2; i++) {
    end[i][d]     = e->at[p][d];
    end[i][1 - d] = e->at[i ? b : a][1 - d];
  }
  const double *corner[2][3] = {{e->at[a], e->at[b], end[1]}, {e->at[a], end[1], end[0]}};
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < 3; i++) memcpy(part[k].at[i], corner[k][i], sizeof end[0]);
    element straight;
    straighten(&part[k], &straight);
    part[k] = straight;
  }
  memcpy(part[0].at[3], e->at[3 + a],
         sizeof end[0]); /* the middle of a side is behind its corner */
  memcpy(part[0].at[4], e->at[3 + b], sizeof end[0]);
  memcpy(part[1].at[5], e->at[3 + p], sizeof end[0]);
  SHB_TRY(add_whole(f, &part[0]));
  return add_whole(f, &part[1]);
}

static shb_status add_element(face_sum *f, const size_t *tags) {
  element e;
  if (!take(f, tags, &e)) return SHB_OK; /* the net area tells */
  for (int i = 0; i < 3 && e.corners == 3; i++) {
    const int d = pole_of(f, e.at[i]);
    if (d >= 0) return add_at_pole(f, &e, i, d);
  }
  return add_whole(f, &e);
}

/* ---------------------------------------------------------------- faces */

/* Whether all points are one within round-off, each with the one `apart` places on. */
static bool coincide(const face_sum *f, double (*uv)[2], int n, int apart) {
  double *x    = NULL;
  size_t  size = 0;
  int     ierr = 0;
  gmshModelGetValue(2, f->tag, uv[0], 2 * (size_t)n, &x, &size, &ierr);
  bool same = ierr == 0 && size == 3 * (size_t)n;
  for (int i = 0; i + apart < n && same; i++)
    same = vec3_distance(x + 3 * i, x + 3 * (i + apart)) < 1e-6 * f->extent;
  gmshFree(x);
  return same;
}

/* Seen at three places along the other parameter. */
static void find_ends(face_sum *f, int d) {
  double uv[6][2];
  for (int i = 0; i < 6; i++) {
    uv[i][d]     = i < 3 ? f->low[d] : f->high[d];
    uv[i][1 - d] = f->low[1 - d] + (0.2 + 0.3 * (i % 3)) * (f->high[1 - d] - f->low[1 - d]);
  }
  f->closed[d]  = coincide(f, uv, 6, 3);
  f->pole[d][0] = coincide(f, uv, 3, 1);
  f->pole[d][1] = coincide(f, uv + 3, 3, 1);
}

/* The places of a face's nodes. *known: it has parameters. */
static shb_status read_places(face_sum *f, bool *known) {
  size_t *tags = NULL, n_xyz = 0, n_at = 0;
  double *xyz = NULL, *at = NULL, *low = NULL, *high = NULL;
  size_t  n_low = 0, n_high = 0;
  GMSH_TRY(f->path, gmshModelMeshGetNodes(&tags, &f->n_places, &xyz, &n_xyz, &at, &n_at, 2, f->tag,
                                          1, 1, &ierr));
  GMSH_TRY(f->path,
           gmshModelGetParametrizationBounds(2, f->tag, &low, &n_low, &high, &n_high, &ierr));
  *known    = n_at == 2 * f->n_places && n_low == 2 && n_high == 2;
  f->places = *known ? shb_alloc(f->n_places + 1, sizeof *f->places) : NULL;
  if (*known) {
    for (size_t i = 0; i < f->n_places; i++)
      f->places[i] = (place){tags[i], {at[2 * i], at[2 * i + 1]}};
    qsort(f->places, f->n_places, sizeof *f->places, by_tag);
    memcpy(f->low, low, sizeof f->low);
    memcpy(f->high, high, sizeof f->high);
  }
  gmshFree(tags);
  gmshFree(xyz);
  gmshFree(at);
  gmshFree(low);
  gmshFree(high);
  return SHB_OK;
}

static shb_status add_face(face_sum *f, bool *known) {
  const mesh_topology *t    = mesh_topology_of(f->kind);
  size_t              *tags = NULL, *node = NULL, n = 0, n_nodes = 0;
  SHB_TRY(read_places(f, known));
  if (!*known) return SHB_OK;
  for (int d = 0; d < 2; d++) find_ends(f, d);
  GMSH_TRY(f->path, gmshModelMeshGetElementsByType(t->gmsh_face, &tags, &n, &node, &n_nodes, f->tag,
                                                   0, 1, &ierr));
  shb_status status = SHB_OK;
  for (size_t i = 0; i < n && status == SHB_OK; i++)
    status = add_element(f, node + i * (size_t)t->face_nodes);
  gmshFree(tags);
  gmshFree(node);
  return status;
}

static size_t count_elements(const face_sum *f, int n, const int *face) {
  size_t all = 0;
  for (int i = 0; i < n; i++) {
    size_t *ids = NULL, *node = NULL, here = 0, n_nodes = 0;
    int     ierr = 0;
    gmshModelMeshGetElementsByType(mesh_topology_of(f->kind)->gmsh_face, &ids, &here, &node,
                                   &n_nodes, abs(face[i]), 0, 1, &ierr);
    all += here;
    gmshFree(ids);
    gmshFree(node);
  }
  return all;
}

static shb_status add_faces(face_sum *f, int n, const int *face, bool *known) {
  *known = true;
  for (int i = 0; i < n && *known; i++) {
    f->tag                  = abs(face[i]);
    f->sign                 = face[i] < 0 ? -1 : 1;
    const shb_status status = add_face(f, known);
    free(f->places);
    f->places = NULL;
    SHB_TRY(status);
  }
  return SHB_OK;
}

shb_status mesh_solid_volume_of(const char *path, mesh_kind kind, int solid, int n, const int *face,
                                mesh_solid_volume *out) {
  face_sum f = {.path = path, .kind = kind};
  double   low[3], high[3];
  bool     known = true;
  *out           = (mesh_solid_volume){NAN, NAN};
  GMSH_TRY(path, gmshModelGetBoundingBox(3, solid, &low[0], &low[1], &low[2], &high[0], &high[1],
                                         &high[2], &ierr));
  for (int d = 0; d < 3; d++) f.centre[d] = (low[d] + high[d]) / 2;
  f.extent          = vec3_distance(low, high) / 2;
  f.tolerance       = INFINITY; /* a first volume, of which the tolerance is a part */
  shb_status status = add_faces(&f, n, face, &known);
  if (status == SHB_OK && known) {
    f.tolerance = agree * fabs(f.flux[1]) / (double)(count_elements(&f, n, face) + 1);
    f.flux[0] = f.flux[1] = f.left = 0;
    memset(f.normal, 0, sizeof f.normal);
    status = add_faces(&f, n, face, &known);
  }
  if (status != SHB_OK || !known) return status;
  out->volume = fabs(f.flux[1]) / 3;
  out->error  = (f.left + fabs(f.flux[1] - f.flux[0]) / 2 + vec3_norm(f.normal) * f.extent) / 3;
  return SHB_OK;
}
