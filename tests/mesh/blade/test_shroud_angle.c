/* psi and phi turn the contact face of the parametric blade, for both kinds of element. The blade
 * stays as it is elsewhere. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/blade/blade.h"
#include "mesh/core/face_match.h"
#include "mesh/core/jacobian.h"
#include "mesh/core/triangle.h"
#include "tests/support/check.h"
#include "tests/support/odd_blade.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

static const double degree = SHB_PI / 180;

static char path[300];

static int set_up(void **state) {
  int failed = scratch_make(state);
  snprintf(path, sizeof path, "%s/blade.msh", scratch_folder);
  return failed;
}

static int tear_down(void **state) {
  (void)state;
  unlink(path);
  return rmdir(scratch_folder);
}

static mesh_blade turned(mesh_kind kind, double psi, double phi) {
  mesh_blade blade = odd_blade();
  blade.elements   = kind;
  blade.size       = 0.014;
  blade.psi        = psi * degree;
  blade.phi        = phi * degree;
  return blade;
}

static const shb_provenance origin = {
    .case_path = "case.yaml", .case_text = "name: odd\n", .settings = "", .command = "test"};

static void make(const mesh_blade *blade, mesh_fe *mesh) {
  if (mesh_blade_write(blade, path, &origin, NULL) != SHB_OK) fail_msg("%s", shb_message());
  if (read_mesh(path, mesh) != SHB_OK) fail_msg("%s", shb_message());
}

/* Area of a contact face, m2, and the largest deviation of a facet's normal from `normal`. */
static double face_area(const mesh_fe *mesh, mesh_set_id id, const double normal[3], double *off) {
  const int each  = mesh_topology_of(mesh->kind)->face_nodes;
  double    total = 0;
  *off            = 0;
  for (int f = 0; f < mesh->set[id].n; f++) {
    mesh_triangle part[MESH_TRIANGLES];
    const int     n = mesh_triangles(mesh, mesh->set[id].nodes + each * f, part);
    for (int i = 0; i < n; i++) {
      double area[3], size = 0;
      mesh_triangle_area(&part[i], area);
      for (int d = 0; d < 3; d++) size += area[d] * area[d];
      total += size = sqrt(size);
      for (int d = 0; d < 3; d++) *off = fmax(*off, fabs(area[d] / size - normal[d]));
    }
  }
  return total;
}

/* Largest distance of a node of the face from the plane through `at`, m. */
static double out_of_plane(const mesh_fe *mesh, mesh_set_id id, const double normal[3],
                           const double at[3]) {
  double    most = 0;
  const int n    = mesh_topology_of(mesh->kind)->face_nodes * mesh->set[id].n;
  for (int i = 0; i < n; i++) {
    double off = 0;
    for (int d = 0; d < 3; d++)
      off += normal[d] * (mesh->coordinates[3 * mesh->set[id].nodes[i] + d] - at[d]);
    most = fmax(most, fabs(off));
  }
  return most;
}

/* Outward normal of a contact face, v of eq. 2 on the right, and the centre of the face. The centre
 * lies at mid thickness, half a sector from the stacking line. */
static void plane_of(const mesh_blade *blade, bool right, double normal[3], double centre[3]) {
  const double psi = blade->psi, phi = blade->phi, sign = right ? 1 : -1;
  const double v[3] = {cos(psi) * cos(phi), sin(psi) * cos(phi), -sin(phi)};
  double       stacking[3], axes[3][3];
  mesh_axis_stacking(blade->axis, stacking);
  mesh_axis_rotate(blade->axis, sign * SHB_PI / blade->blades, stacking, centre);
  const double radius = blade->section[blade->n_sections - 1].radius + .5 * blade->shroud_thickness;
  mesh_axes_at(blade->axis, centre, axes);
  for (int d = 0; d < 3; d++) {
    centre[d] *= radius;
    normal[d] = sign * (v[0] * axes[0][d] + v[1] * axes[1][d] + v[2] * axes[2][d]);
  }
}

static void check_faces(const mesh_blade *blade, const mesh_fe *mesh) {
  const double area = blade->shroud_contact * blade->shroud_thickness / cos(blade->phi);
  for (int side = 0; side < 2; side++) {
    const mesh_set_id id = side ? MESH_CONTACT_LEFT : MESH_CONTACT_RIGHT;
    double            normal[3], centre[3], off;
    plane_of(blade, !side, normal, centre);
    assert_near(face_area(mesh, id, normal, &off) / area, 1, 1e-9);
    assert_true(off < 1e-9);
    assert_true(out_of_plane(mesh, id, normal, centre) < 1e-12);
  }
}

/* Every right node is a left node turned by the sector angle. */
static void check_fit(const mesh_blade *blade, const mesh_fe *mesh) {
  int    pairs, *right, *left;
  double gap = 0;
  if (mesh_fe_match(mesh, blade->axis, blade->blades, &pairs, &right, &left) != SHB_OK)
    fail_msg("%s", shb_message());
  for (int i = 0; i < pairs; i++) {
    double at[3];
    mesh_axis_rotate(blade->axis, SHB_TWO_PI / blade->blades, mesh->coordinates + 3 * left[i], at);
    for (int d = 0; d < 3; d++) gap = fmax(gap, fabs(at[d] - mesh->coordinates[3 * right[i] + d]));
  }
  free(right);
  free(left);
  assert_true(pairs >= 9);
  assert_true(gap < 1e-13);
}

/* Volume inside the mesh: a third of the flux of x through the faces of all elements. The faces
 * between two elements cancel. */
static double volume_of(const mesh_fe *mesh) {
  const mesh_topology *t     = mesh_topology_of(mesh->kind);
  double               total = 0;
  for (int e = 0; e < mesh->n_elements; e++)
    for (int f = 0; f < t->faces; f++) {
      int           node[MESH_FACE_NODES];
      mesh_triangle part[MESH_TRIANGLES];
      for (int i = 0; i < t->face_nodes; i++)
        node[i] = mesh->connectivity[t->nodes * e + t->face[f][i]];
      const int n = mesh_triangles(mesh, node, part);
      for (int i = 0; i < n; i++) {
        double area[3];
        mesh_triangle_area(&part[i], area);
        for (int d = 0; d < 3; d++) total += area[d] * part[i].x[0][d] / 3;
      }
    }
  return total;
}

typedef struct {
  double corner;      /* the sharpest, a share of a right one */
  double least, most; /* volume, m3 */
} record;

static void check_blade(mesh_kind kind, double psi, double phi, record *all) {
  const mesh_blade blade = turned(kind, psi, phi);
  mesh_fe          mesh;
  double           x[3];
  make(&blade, &mesh);
  assert_int_equal(mesh_jacobian_inverted(&mesh), 0);
  check_faces(&blade, &mesh);
  check_fit(&blade, &mesh);
  const double volume = volume_of(&mesh), corner = mesh_jacobian_worst_corner(&mesh, x);
  all->corner = fmin(all->corner, corner);
  all->least  = fmin(all->least, volume);
  all->most   = fmax(all->most, volume);
  mesh_fe_free(&mesh);
}

/* The volume of the shroud does not depend on the angles: its sides are congruent. What varies is
 * the sag of chords in the mesh. */
static void a_grid_of_angles(mesh_kind kind, int n_psi, const double *psi, int n_phi,
                             const double *phi, double corner) {
  record all = {1, INFINITY, 0};
  for (int i = 0; i < n_psi; i++)
    for (int j = 0; j < n_phi; j++) check_blade(kind, psi[i], phi[j], &all);
  print_message("sharpest corner %.3f, volume %.6g to %.6g mm3 (%.1e)\n", all.corner,
                1e9 * all.least, 1e9 * all.most, all.most / all.least - 1);
  assert_true(all.corner > corner);
  assert_near(all.most / all.least, 1, 1e-3);
}

static void hexahedra_follow_the_angles(void **state) {
  (void)state;
  static const double psi[] = {-60, -48, -21, 0, 9, 33, 52, 70}, phi[] = {-45, -17, 0, 23, 45};
  a_grid_of_angles(MESH_HEX20, 8, psi, 5, phi, .05);
}

static void tetrahedra_follow_the_angles(void **state) {
  (void)state;
  static const double psi[] = {-60, 4, 70}, phi[] = {-45, 31};
  a_grid_of_angles(MESH_TET10, 3, psi, 2, phi, .03);
}

/* Where the airfoil reaches past the turned side, the message gives the angles with room for it.
 * The next degree beyond them is refused. */
static void angles_that_cut_the_airfoil_are_refused(void **state) {
  (void)state;
  mesh_blade blade = turned(MESH_HEX20, -70, -45);
  mesh_fe    mesh;
  unlink(path);
  assert_refused(mesh_blade_write(&blade, path, &origin, NULL), SHB_ERR_INPUT,
                 "at contact.psi -70 deg; less chord, camber or twist there, fewer rotor.blades, "
                 "or a contact.psi from -66 to 70 deg");
  blade.psi = -67 * degree;
  assert_refused(mesh_blade_write(&blade, path, &origin, NULL), SHB_ERR_INPUT,
                 "contact.psi from -66 to 70 deg");
  assert_int_not_equal(access(path, F_OK), 0);
  blade.psi = -66 * degree;
  make(&blade, &mesh);
  check_faces(&blade, &mesh);
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hexahedra_follow_the_angles),
      cmocka_unit_test(tetrahedra_follow_the_angles),
      cmocka_unit_test(angles_that_cut_the_airfoil_are_refused),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
