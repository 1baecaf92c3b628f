#include "mesh/core/face_pairing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/face_match.h"
#include "mesh/core/triangle.h"

/* The left face, prepared for the search of the nearest point. */
typedef struct {
  const mesh_fe       *mesh;
  const mesh_topology *topology;
  const mesh_face_set *set;
  double (*ball)[4]; /* [faces] centre and radius of a ball around the nodes of a face */
} left_face;

/* A point on the left face. */
typedef struct {
  int    face;
  double at[2]; /* reference coordinates */
  double shape[MESH_FACE_NODES];
  double distance; /* m */
} contact_place;

static const int *face_nodes(const left_face *t, int face) {
  return t->set->nodes + t->topology->face_nodes * (size_t)face;
}

static void bounding_ball(const left_face *t, int face) {
  const int  n    = t->topology->face_nodes;
  const int *node = face_nodes(t, face);
  double    *ball = t->ball[face];
  memset(ball, 0, sizeof *t->ball);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) ball[d] += t->mesh->coordinates[3 * (size_t)node[i] + d] / n;
  for (int i = 0; i < n; i++)
    ball[3] = fmax(ball[3], vec3_distance(ball, t->mesh->coordinates + 3 * (size_t)node[i]));
}

/* Reference coordinates of a point of a triangle of a face, given by its barycentric weights. */
static void reference(const left_face *t, const mesh_triangle *part, const double weight[3],
                      double at[2]) {
  at[0] = at[1] = 0;
  for (int c = 0; c < 3; c++)
    for (int d = 0; d < 2; d++) at[d] += weight[c] * t->topology->face_place[part->local[c]][d];
}

/* Nearest point of the flat triangles of all faces: the start of project_to_face. */
static void nearest_triangle(const left_face *t, const double x[3], contact_place *best) {
  best->distance = INFINITY;
  for (int f = 0; f < t->set->n; f++) {
    mesh_triangle part[MESH_TRIANGLES];
    if (vec3_distance(t->ball[f], x) - t->ball[f][3] >= best->distance) continue;
    int n = mesh_triangles(t->mesh, face_nodes(t, f), part);
    for (int p = 0; p < n; p++) {
      double foot[3], weight[3];
      double here = mesh_triangle_closest(&part[p], x, foot, weight);
      if (here >= best->distance) continue;
      best->distance = here;
      best->face     = f;
      reference(t, &part[p], weight, best->at);
    }
  }
}

/* Clamp reference coordinates to the face. */
static void clamp_to_face(mesh_kind kind, double at[2]) {
  for (int d = 0; d < 2; d++) at[d] = fmin(1, fmax(0, at[d]));
  double over = at[0] + at[1] - 1;
  if (kind == MESH_HEX20 || over <= 0) return;
  at[0] = fmin(1, fmax(0, at[0] - over / 2));
  at[1] = 1 - at[0];
}

/* Offset x - X(r, s) and the derivatives X,r and X,s. */
static void offset_at(const left_face *t, const double x[3], contact_place *p, double off[3],
                      double J[2][3]) {
  double     gradient[MESH_FACE_NODES][2];
  const int *node = face_nodes(t, p->face);
  mesh_face_shape(t->mesh->kind, p->at, p->shape, gradient);
  for (int d = 0; d < 3; d++) {
    off[d]  = x[d];
    J[0][d] = J[1][d] = 0;
    for (int i = 0; i < t->topology->face_nodes; i++) {
      double there = t->mesh->coordinates[3 * (size_t)node[i] + d];
      off[d] -= p->shape[i] * there;
      J[0][d] += gradient[i][0] * there;
      J[1][d] += gradient[i][1] * there;
    }
  }
}

/* Nearest point of the curved face by the Gauss-Newton method: J^T J d = J^T (x - X). */
static void project_to_face(const left_face *t, const double x[3], contact_place *p) {
  double off[3], J[2][3];
  for (int i = 0; i < 30; i++) {
    offset_at(t, x, p, off, J);
    double a = vec3_dot(J[0], J[0]), b = vec3_dot(J[0], J[1]), c = vec3_dot(J[1], J[1]),
           det = a * c - b * b;
    double r = vec3_dot(J[0], off), s = vec3_dot(J[1], off), previous[2] = {p->at[0], p->at[1]};
    if (!(det > 0)) break;
    p->at[0] += (c * r - b * s) / det;
    p->at[1] += (a * s - b * r) / det;
    clamp_to_face(t->mesh->kind, p->at);
    if (hypot(p->at[0] - previous[0], p->at[1] - previous[1]) < 1e-14) break;
  }
  offset_at(t, x, p, off, J);
  p->distance = vec3_norm(off);
}

static double area(const mesh_fe *mesh, const mesh_face_set *set) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  double               sum      = 0;
  for (int f = 0; f < set->n; f++) {
    mesh_triangle part[MESH_TRIANGLES];
    int           n = mesh_triangles(mesh, set->nodes + topology->face_nodes * (size_t)f, part);
    for (int p = 0; p < n; p++) {
      double one[3];
      mesh_triangle_area(&part[p], one);
      sum += vec3_norm(one);
    }
  }
  return sum;
}

static void allocate(int n, int each, mesh_pairing *out) {
  const size_t nodes = (size_t)n;
  out->n             = n;
  out->right         = shb_alloc(nodes + 1, sizeof *out->right);
  out->start         = shb_alloc(nodes + 1, sizeof *out->start);
  out->left          = shb_alloc(nodes * (size_t)each + 1, sizeof *out->left);
  out->share         = shb_alloc(nodes * (size_t)each + 1, sizeof *out->share);
  for (int i = 0; i <= n; i++) out->start[i] = each * i;
}

/* Nodes of the right face, each once, ascending. */
static void take_right(const mesh_fe *mesh, mesh_pairing *out) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  const mesh_face_set *set      = &mesh->set[MESH_CONTACT_RIGHT];
  char                *marked   = shb_alloc_zeroed((size_t)mesh->n_nodes + 1, 1);
  int                  n        = 0;
  for (int i = 0; i < topology->face_nodes * set->n; i++) marked[set->nodes[i]] = 1;
  for (int i = 0; i < mesh->n_nodes; i++) n += marked[i];
  allocate(n, topology->face_nodes, out);
  n = 0;
  for (int i = 0; i < mesh->n_nodes; i++)
    if (marked[i]) out->right[n++] = i;
  free(marked);
}

static shb_status project_all(const left_face *t, mesh_axis axis, double angle, mesh_pairing *out) {
  const mesh_fe *mesh  = t->mesh;
  const int      each  = t->topology->face_nodes;
  const double   limit = MESH_PAIRING_GAP * sqrt(area(mesh, &mesh->set[MESH_CONTACT_RIGHT]));
  for (int i = 0; i < out->n; i++) {
    const double *x = mesh->coordinates + 3 * (size_t)out->right[i];
    double        back[3];
    contact_place p;
    mesh_axis_rotate(axis, -angle, x, back);
    nearest_triangle(t, back, &p);
    project_to_face(t, back, &p);
    SHB_CHECK(
        p.distance <= limit, SHB_ERR_INPUT,
        "contact faces do not match: node %ld of contact_right at (%g, %g, %g) m is %.3g m "
        "from contact_left turned by the sector angle; at most %.3g m is allowed (2 %% of the "
        "face's size)",
        mesh->node_tag[out->right[i]], x[0], x[1], x[2], p.distance, limit);
    out->gap = fmax(out->gap, p.distance);
    memcpy(out->left + (size_t)each * (size_t)i, face_nodes(t, p.face),
           (size_t)each * sizeof *out->left);
    memcpy(out->share + (size_t)each * (size_t)i, p.shape, (size_t)each * sizeof *out->share);
  }
  return SHB_OK;
}

static shb_status project(const mesh_fe *mesh, mesh_axis axis, int blades, mesh_pairing *out) {
  left_face t    = {mesh, mesh_topology_of(mesh->kind), &mesh->set[MESH_CONTACT_LEFT], NULL};
  out->projected = true;
  take_right(mesh, out);
  t.ball = shb_alloc((size_t)t.set->n + 1, sizeof *t.ball);
  for (int f = 0; f < t.set->n; f++) bounding_ball(&t, f);
  shb_status status = project_all(&t, axis, SHB_TWO_PI / blades, out);
  free(t.ball);
  return status;
}

/* Node for node. Takes right and left over and frees them. */
static void take_match(int n, int *right, int *left, mesh_pairing *out) {
  allocate(n, 1, out);
  for (int i = 0; i < n; i++) {
    out->right[i] = right[i];
    out->left[i]  = left[i];
    out->share[i] = 1;
  }
  free(right);
  free(left);
}

static shb_status pair(const mesh_fe *mesh, mesh_axis axis, int blades, mesh_pairing *out) {
  int *right = NULL, *left = NULL, n = 0;
  memset(out, 0, sizeof *out);
  shb_status status  = mesh_fe_match(mesh, axis, blades, &n, &right, &left);
  bool       missing = !mesh->set[MESH_CONTACT_RIGHT].n || !mesh->set[MESH_CONTACT_LEFT].n;
  if (status == SHB_OK) {
    take_match(n, right, left, out);
  } else if (status == SHB_ERR_INPUT && !missing) {
    status = project(mesh, axis, blades, out);
  }
  if (status != SHB_OK) mesh_pairing_free(out);
  return status;
}

/* Mean place of the nodes of a group, without its axial part. */
static void middle(const mesh_fe *mesh, mesh_set_id id, const double axial[3], double out[3]) {
  const mesh_face_set *set = &mesh->set[id];
  const int            n   = mesh_topology_of(mesh->kind)->face_nodes * set->n;
  memset(out, 0, 3 * sizeof *out);
  for (int i = 0; i < n; i++)
    for (int d = 0; d < 3; d++) out[d] += mesh->coordinates[3 * (size_t)set->nodes[i] + d] / n;
  double along = out[0] * axial[0] + out[1] * axial[1] + out[2] * axial[2];
  for (int d = 0; d < 3; d++) out[d] -= along * axial[d];
}

/* Number of blades as of the angle between the two faces; 0 if there is none. */
static int blades_of_faces(const mesh_fe *mesh, mesh_axis axis) {
  double axial[3], right[3], left[3];
  mesh_axis_vector(axis, axial);
  middle(mesh, MESH_CONTACT_RIGHT, axial, right);
  middle(mesh, MESH_CONTACT_LEFT, axial, left);
  double turn = 0, same = 0;
  for (int d = 0; d < 3; d++) {
    int b = (d + 1) % 3, c = (d + 2) % 3;
    turn += axial[d] * (left[b] * right[c] - left[c] * right[b]);
    same += left[d] * right[d];
  }
  double count = SHB_TWO_PI / fabs(atan2(turn, same));
  return count >= 2 && count < 1000 ? (int)lround(count) : 0;
}

/* Add to the message the number of blades with which the faces would match. */
static shb_status name_blades(const mesh_fe *mesh, mesh_axis axis, int blades, shb_status status) {
  char      why[512];
  const int about = blades_of_faces(mesh, axis);
  snprintf(why, sizeof why, "%s", shb_message());
  for (int i = 0; i < 3 && about > 0; i++) {
    int          n     = about + (int[]){0, -1, 1}[i];
    mesh_pairing other = {0};
    bool         fits  = n >= 2 && n != blades && pair(mesh, axis, n, &other) == SHB_OK;
    mesh_pairing_free(&other);
    if (fits)
      return shb_fail(status, __FILE__, __LINE__, "%s; with rotor.blades: %d, not %d, they match",
                      why, n, blades);
  }
  return shb_fail(status, __FILE__, __LINE__, "%s", why);
}

shb_status mesh_pairing_create(const mesh_fe *mesh, mesh_axis axis, int blades, mesh_pairing *out) {
  shb_status status = pair(mesh, axis, blades, out);
  bool       both   = mesh->set[MESH_CONTACT_RIGHT].n && mesh->set[MESH_CONTACT_LEFT].n;
  return status == SHB_ERR_INPUT && both ? name_blades(mesh, axis, blades, status) : status;
}

void mesh_pairing_free(mesh_pairing *pairing) {
  free(pairing->right);
  free(pairing->start);
  free(pairing->left);
  free(pairing->share);
  memset(pairing, 0, sizeof *pairing);
}
