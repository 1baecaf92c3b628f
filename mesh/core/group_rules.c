#include "mesh/core/group_rules.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/vec3.h"
#include "mesh/core/faces.h"
#include "mesh/core/triangle.h"

mesh_names mesh_rules_names(const mesh_rules *rules, double unit) {
  mesh_names names = {.n_more = rules->n_more, .n_volumes = rules->n_volumes};
  for (int s = 0; s < MESH_N_SETS; s++)
    names.set[s] = rules->usual[s].kind == MESH_RULE_NAME ? rules->usual[s].name : NULL;
  for (int i = 0; i < rules->n_more; i++) {
    const mesh_named_rule *more = &rules->more[i];
    names.more[i].label         = more->name;
    names.more[i].name          = more->rule.kind == MESH_RULE_NAME ? more->rule.name : more->name;
  }
  for (int i = 0; i < rules->n_volumes; i++) {
    const mesh_named_rule *volume = &rules->volume[i];
    names.volume[i].label         = volume->name;
    names.volume[i].name = volume->rule.kind == MESH_RULE_NAME ? volume->rule.name : volume->name;
    names.volume[i].near = volume->rule.kind == MESH_RULE_NEAREST;
    for (int d = 0; d < 3; d++) names.volume[i].at[d] = volume->rule.at[d] / unit;
  }
  return names;
}

mesh_names mesh_rules_labels(const mesh_rules *rules) {
  mesh_names names = {.n_more = rules->n_more, .n_volumes = rules->n_volumes};
  for (int i = 0; i < rules->n_more; i++)
    names.more[i].label = names.more[i].name = rules->more[i].name;
  for (int i = 0; i < rules->n_volumes; i++)
    names.volume[i].label = names.volume[i].name = rules->volume[i].name;
  return names;
}

/* The surface of the body, on which rules select faces. */
typedef struct {
  const mesh_fe       *mesh;
  const mesh_topology *topology;
  const char          *file;
  mesh_axis            axis;
  mesh_face_set        outer;
  double               extent; /* m, diagonal of the body's box */
} surface;

static const double *node_at(const surface *s, int node) {
  return s->mesh->coordinates + 3 * (size_t)node;
}

static const int *face_nodes(const surface *s, int face) {
  return s->outer.nodes + s->topology->face_nodes * (size_t)face;
}

/* Distance of a point from the plane or the radius of a rule, m. */
static double deviation(const surface *s, const mesh_rule *rule, const double x[3]) {
  if (rule->kind == MESH_RULE_PLANE) {
    double from[3];
    vec3_minus(x, rule->at, from);
    return fabs(vec3_dot(rule->normal, from)) / vec3_norm(rule->normal);
  }
  double axial[3], across[3];
  mesh_axis_vector(s->axis, axial);
  const double along = vec3_dot(axial, x);
  for (int d = 0; d < 3; d++) across[d] = x[d] - along * axial[d];
  return fabs(vec3_norm(across) - rule->radius);
}

/* taken[face] = 1 where all nodes are within the tolerance. Returns the number of these faces.
 *   least  out  deviation of the face that fits best, m */
static int take_fitting(const surface *s, const mesh_rule *rule, char *taken, double *least) {
  int n  = 0;
  *least = INFINITY;
  for (int f = 0; f < s->outer.n; f++) {
    double worst = 0;
    for (int i = 0; i < s->topology->face_nodes; i++)
      worst = fmax(worst, deviation(s, rule, node_at(s, face_nodes(s, f)[i])));
    taken[f] = worst <= rule->tolerance;
    n += taken[f];
    *least = fmin(*least, worst);
  }
  return n;
}

/* Distance from a point to a face, cut into flat triangles. */
static double face_distance(const surface *s, int face, const double at[3]) {
  mesh_triangle part[MESH_TRIANGLES];
  double        least = INFINITY, foot[3];
  int           n     = mesh_triangles(s->mesh, face_nodes(s, face), part);
  for (int i = 0; i < n; i++) least = fmin(least, mesh_triangle_closest(&part[i], at, foot, NULL));
  return least;
}

/* Edge of a face by its two corners. */
typedef struct {
  int low, high, face;
} edge;

static int by_corners(const void *a, const void *b) {
  const edge *p = a, *q = b;
  return p->low != q->low ? (p->low > q->low) - (p->low < q->low)
                          : (p->high > q->high) - (p->high < q->high);
}

static void face_normal(const surface *s, int face, double normal[3]) {
  mesh_triangle part[MESH_TRIANGLES];
  int           n = mesh_triangles(s->mesh, face_nodes(s, face), part);
  memset(normal, 0, 3 * sizeof *normal);
  for (int i = 0; i < n; i++) {
    double one[3];
    mesh_triangle_area(&part[i], one);
    for (int d = 0; d < 3; d++) normal[d] += one[d];
  }
  double size = vec3_norm(normal);
  for (int d = 0; d < 3; d++) normal[d] /= size;
}

/* Do the two faces meet without an edge (MESH_RULE_EDGE)? */
static bool is_smooth(const surface *s, int a, int b) {
  double p[3], q[3];
  face_normal(s, a, p);
  face_normal(s, b, q);
  return vec3_dot(p, q) > cos(MESH_RULE_EDGE);
}

/* Edges of all faces, sorted, so that the two faces of an edge are neighbours. */
static edge *list_edges(const surface *s) {
  const int n    = s->topology->face_corners;
  edge     *list = shb_alloc((size_t)n * (size_t)s->outer.n + 1, sizeof *list);
  for (int f = 0; f < s->outer.n; f++)
    for (int i = 0; i < n; i++) {
      int a = face_nodes(s, f)[i], b = face_nodes(s, f)[(i + 1) % n];
      list[n * f + i] = (edge){a < b ? a : b, a < b ? b : a, f};
    }
  qsort(list, (size_t)n * (size_t)s->outer.n, sizeof *list, by_corners);
  return list;
}

/* Take face first and all faces reached from it across smooth edges.
 *   queue  scratch  [faces] */
static void flood_fill(const surface *s, const edge *list, int first, int *queue, char *taken) {
  const int corners = s->topology->face_corners;
  const int total   = corners * s->outer.n;
  int       n       = 1;
  queue[0]          = first;
  taken[first]      = 1;
  for (int at = 0; at < n; at++)
    for (int i = 0; i < corners; i++) {
      int  a = face_nodes(s, queue[at])[i], b = face_nodes(s, queue[at])[(i + 1) % corners];
      edge key = {a < b ? a : b, a < b ? b : a, 0}, *found;
      found    = bsearch(&key, list, (size_t)total, sizeof *list, by_corners);
      while (found > list && by_corners(found - 1, &key) == 0) found--;
      for (; found < list + total && by_corners(found, &key) == 0; found++) {
        if (taken[found->face] || !is_smooth(s, queue[at], found->face)) continue;
        taken[found->face] = 1;
        queue[n++]         = found->face;
      }
    }
}

static shb_status take_nearest(const surface *s, const mesh_rule *rule, int id, char *taken) {
  int    first = 0;
  double least = INFINITY;
  for (int f = 0; f < s->outer.n; f++) {
    double distance = face_distance(s, f, rule->at);
    if (distance < least) first = f;
    least = fmin(least, distance);
  }
  SHB_CHECK(least <= MESH_RULE_MAX_DISTANCE * s->extent, SHB_ERR_INPUT,
            "mesh.groups.%s.nearest: (%g, %g, %g) m is %.3g m off the body of %s, which measures "
            "%.3g m; name a point on the face that is meant, in mesh axes%s",
            mesh_fe_set_name(s->mesh, id), rule->at[0], rule->at[1], rule->at[2], least, s->file,
            s->extent, mesh_unit_hint(s->extent, s->mesh->unit_given));
  edge *list  = list_edges(s);
  int  *queue = shb_alloc((size_t)s->outer.n + 1, sizeof *queue);
  flood_fill(s, list, first, queue, taken);
  free(list);
  free(queue);
  return SHB_OK;
}

static shb_status refuse_empty(const surface *s, const mesh_rule *rule, int id, double least) {
  if (rule->kind == MESH_RULE_PLANE)
    SHB_FAIL(SHB_ERR_INPUT,
             "mesh.groups.%s: %s has no face in the plane through (%g, %g, %g) m; the nearest is "
             "%.3g m off, %.3g m are allowed (tolerance)",
             mesh_fe_set_name(s->mesh, id), s->file, rule->at[0], rule->at[1], rule->at[2], least,
             rule->tolerance);
  SHB_FAIL(SHB_ERR_INPUT,
           "mesh.groups.%s: %s has no face at radius %g m; the nearest is %.3g m off, %.3g m are "
           "allowed (tolerance)",
           mesh_fe_set_name(s->mesh, id), s->file, rule->radius, least, rule->tolerance);
}

static void copy_taken(const surface *s, const char *taken, mesh_face_set *set) {
  const size_t each  = (size_t)s->topology->face_nodes;
  int         *nodes = shb_alloc(each * (size_t)s->outer.n + 1, sizeof *nodes);
  free(set->nodes);
  *set = (mesh_face_set){0, nodes};
  for (int f = 0; f < s->outer.n; f++)
    if (taken[f]) memcpy(nodes + each * (size_t)set->n++, face_nodes(s, f), each * sizeof *nodes);
}

static shb_status apply_one(const surface *s, const mesh_rule *rule, int id, mesh_fe *mesh,
                            char *taken) {
  memset(taken, 0, (size_t)s->outer.n);
  if (rule->kind == MESH_RULE_NEAREST) {
    SHB_TRY(take_nearest(s, rule, id, taken));
  } else {
    double least;
    SHB_CHECK(rule->kind != MESH_RULE_PLANE || vec3_norm(rule->normal) > 0, SHB_ERR_INPUT,
              "mesh.groups.%s.normal: has no direction", mesh_fe_set_name(s->mesh, id));
    SHB_CHECK(rule->tolerance <= MESH_RULE_MAX_TOLERANCE * s->extent, SHB_ERR_INPUT,
              "mesh.groups.%s.tolerance: %g m is too wide for the body of %s, which measures %.3g "
              "m: other faces would be taken too; give at most %.2g m%s",
              mesh_fe_set_name(s->mesh, id), rule->tolerance, s->file, s->extent,
              MESH_RULE_MAX_TOLERANCE * s->extent, mesh_unit_hint(s->extent, s->mesh->unit_given));
    if (take_fitting(s, rule, taken, &least) == 0) return refuse_empty(s, rule, id, least);
  }
  copy_taken(s, taken, &mesh->set[id]);
  return SHB_OK;
}

static const mesh_rule *rule_of(const mesh_rules *rules, int set) {
  return set < MESH_N_SETS ? &rules->usual[set] : &rules->more[set - MESH_N_SETS].rule;
}

static bool has_rule(const mesh_rule *rule) {
  return rule->kind != MESH_RULE_NONE && rule->kind != MESH_RULE_NAME;
}

shb_status mesh_rules_apply(const mesh_rules *rules, mesh_axis axis, const char *file,
                            mesh_fe *mesh) {
  surface s = {.mesh = mesh, .topology = mesh_topology_of(mesh->kind), .file = file, .axis = axis};
  bool    any = false;
  for (int id = 0; id < mesh_fe_sets(mesh); id++) any = any || has_rule(rule_of(rules, id));
  if (!any) return SHB_OK;
  mesh_faces_outer(mesh, NULL, &s.outer);
  s.extent          = mesh_fe_extent(mesh);
  char      *taken  = shb_alloc((size_t)s.outer.n + 1, 1);
  shb_status status = SHB_OK;
  for (int id = 0; id < mesh_fe_sets(mesh) && status == SHB_OK; id++)
    if (has_rule(rule_of(rules, id))) status = apply_one(&s, rule_of(rules, id), id, mesh, taken);
  free(taken);
  free(s.outer.nodes);
  return status;
}
