#include "mesh/core/fe_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/vec3.h"

const char *mesh_set_name(mesh_set_id id) {
  static const char *const name[MESH_N_SETS] = {"root", "contact_right", "contact_left",
                                                "load", "cyclic_right",  "cyclic_left"};
  return name[id];
}

int mesh_fe_sets(const mesh_fe *mesh) {
  return MESH_N_SETS + mesh->n_more;
}

const char *mesh_fe_set_name(const mesh_fe *mesh, int set) {
  return set < MESH_N_SETS ? mesh_set_name((mesh_set_id)set) : mesh->more[set - MESH_N_SETS];
}

int mesh_fe_set_named(const mesh_fe *mesh, const char *name) {
  for (int s = 0; s < mesh_fe_sets(mesh); s++)
    if (strcmp(mesh_fe_set_name(mesh, s), name) == 0) return s;
  return -1;
}

void mesh_fe_note_group(mesh_fe *mesh, const char *name) {
  static const char more[] = ", ...";
  const size_t      length = strlen(mesh->found), room = sizeof mesh->found - sizeof more;
  char             *end = mesh->found + length;
  if (length >= sizeof more && strcmp(end - strlen(more), more) == 0) return;
  const bool fits = length + 2 + strlen(name) <= room;
  snprintf(end, sizeof mesh->found - length, "%s%s", length && fits ? ", " : "",
           fits ? name : more);
  for (; *end; end++)
    if ((unsigned char)*end < ' ' || *end == 127) *end = '?';
}

int mesh_fe_take_group(mesh_fe *mesh, const mesh_names *names, const char *label) {
  if (!*label) return -1;
  mesh_fe_note_group(mesh, label);
  for (int set = 0; set < mesh_fe_sets(mesh); set++)
    if (strcmp(label, mesh_names_set(names, set)) == 0) return set;
  return -1;
}

const char *mesh_fe_found(const mesh_fe *mesh, char text[MESH_FOUND + 40]) {
  if (!*mesh->found) return "the mesh has no groups of faces";
  snprintf(text, MESH_FOUND + 40, "the mesh has the groups %s", mesh->found);
  return text;
}

const char *mesh_names_set(const mesh_names *names, int set) {
  if (set < MESH_N_SETS)
    return names && names->set[set] ? names->set[set] : mesh_set_name((mesh_set_id)set);
  return names->more[set - MESH_N_SETS].name;
}

/* Tangential component of the summed area vectors of a set, m2. Each face counts by the triangle of
 * its first three corners. */
static double tangential_area(const mesh_fe *mesh, const mesh_face_set *set, mesh_axis axis) {
  const int width = mesh_topology_of(mesh->kind)->face_nodes;
  double    sum   = 0;
  for (int f = 0; f < set->n; f++) {
    const double *x[3];
    double        a[3], b[3], centre[3], axes[3][3], normal[3];
    for (int c = 0; c < 3; c++) x[c] = mesh->coordinates + 3 * (size_t)set->nodes[width * f + c];
    vec3_minus(x[1], x[0], a);
    vec3_minus(x[2], x[0], b);
    vec3_cross(a, b, normal);
    for (int d = 0; d < 3; d++) centre[d] = (x[0][d] + x[1][d] + x[2][d]) / 3;
    mesh_axes_at(axis, centre, axes);
    sum += 0.5 * vec3_dot(normal, axes[0]);
  }
  return sum;
}

shb_status mesh_fe_orient(mesh_fe *mesh, mesh_axis axis) {
  mesh_face_set *right = &mesh->set[MESH_CONTACT_RIGHT], *left = &mesh->set[MESH_CONTACT_LEFT];
  if (!right->n || !left->n) return SHB_OK;
  const double area[2]  = {tangential_area(mesh, right, axis), tangential_area(mesh, left, axis)};
  const bool   opposite = area[0] * area[1] < 0;
  SHB_CHECK(opposite, SHB_ERR_INPUT,
            "groups contact_right and contact_left both face the %s side of the blade about the "
            "engine axis; one must face each neighbour",
            area[0] + area[1] > 0 ? "right" : "left");
  if (area[0] < 0) {
    mesh_face_set swap = *right;
    *right             = *left;
    *left              = swap;
  }
  return SHB_OK;
}

mesh_fe mesh_fe_facing(const mesh_fe *mesh, int right, int left) {
  mesh_fe view                 = *mesh;
  view.set[MESH_CONTACT_RIGHT] = mesh->set[right];
  view.set[MESH_CONTACT_LEFT]  = left < 0 ? (mesh_face_set){0, NULL} : mesh->set[left];
  return view;
}

shb_status mesh_fe_orient_groups(mesh_fe *mesh, mesh_axis axis, int right, int left) {
  mesh_fe view = mesh_fe_facing(mesh, right, left);
  SHB_TRY(mesh_fe_orient(&view, axis));
  mesh->set[right] = view.set[MESH_CONTACT_RIGHT];
  mesh->set[left]  = view.set[MESH_CONTACT_LEFT];
  return SHB_OK;
}

int mesh_fe_nearest(const mesh_fe *mesh, const double point[3]) {
  int    nearest = 0;
  double best    = INFINITY;
  for (int i = 0; i < mesh->n_nodes; i++) {
    double from[3];
    vec3_minus(mesh->coordinates + 3 * (size_t)i, point, from);
    double distance = vec3_dot(from, from); /* squared */
    if (distance < best) {
      best    = distance;
      nearest = i;
    }
  }
  return nearest;
}

double mesh_fe_extent(const mesh_fe *mesh) {
  double low[3], high[3];
  for (int d = 0; d < 3; d++) {
    low[d]  = INFINITY;
    high[d] = -INFINITY;
  }
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int d = 0; d < 3; d++) {
      low[d]  = fmin(low[d], mesh->coordinates[3 * (size_t)i + d]);
      high[d] = fmax(high[d], mesh->coordinates[3 * (size_t)i + d]);
    }
  return vec3_distance(high, low);
}

const char *mesh_unit_hint(double extent, bool unit_given) {
  static const double least = 2e-3, most = 10; /* m */
  if (unit_given) return "";
  if (extent > most) return "; are its coordinates in mm? Say so with mesh.unit";
  return extent < least ? "; are its coordinates in m? Say so with mesh.unit" : "";
}

shb_status mesh_fe_near(const mesh_fe *mesh, const double point[3], const char *what, int *node) {
  *node                  = mesh_fe_nearest(mesh, point);
  const double *x        = mesh->coordinates + 3 * (size_t)*node;
  const double  distance = vec3_distance(x, point), extent = mesh_fe_extent(mesh);
  SHB_CHECK(distance <= MESH_FE_NEAR * extent, SHB_ERR_INPUT,
            "%s: (%g, %g, %g) m is %.3g m off the nearest node of the body, which measures %.3g m; "
            "give a point on it, in mesh axes (that node is at (%.4g, %.4g, %.4g) m)%s",
            what, point[0], point[1], point[2], distance, extent, x[0], x[1], x[2],
            mesh_unit_hint(extent, mesh->unit_given));
  return SHB_OK;
}

void mesh_fe_free(mesh_fe *mesh) {
  free(mesh->coordinates);
  free(mesh->connectivity);
  free(mesh->node_tag);
  free(mesh->element_tag);
  free(mesh->region);
  free(mesh->region_name);
  free(mesh->image);
  for (int s = 0; s < MESH_MAX_SETS; s++) free(mesh->set[s].nodes);
  memset(mesh, 0, sizeof *mesh);
}
