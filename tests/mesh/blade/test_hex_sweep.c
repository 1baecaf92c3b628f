/* The blade of hexahedra: volume, groups, contact geometry, range of parameters,
 * reproducibility. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/blade/airfoil.h"
#include "mesh/blade/blade.h"
#include "mesh/blade/layers.h"
#include "mesh/blade/section_mesh.h"
#include "mesh/core/face_match.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/core/jacobian.h"
#include "tests/support/check.h"
#include "tests/support/odd_blade.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

static const double degree = SHB_PI / 180;

static char path[300], other[300];

static int set_up(void **state) {
  int failed = scratch_make(state);
  snprintf(path, sizeof path, "%s/blade.msh", scratch_folder);
  snprintf(other, sizeof other, "%s/other.msh", scratch_folder);
  return failed;
}

/* Fails if a test left a temporary file behind. */
static int tear_down(void **state) {
  (void)state;
  unlink(path);
  unlink(other);
  return rmdir(scratch_folder);
}

static mesh_blade sample(void) {
  mesh_blade blade  = odd_blade();
  blade.shroud_size = 0.008;
  blade.elements    = MESH_HEX20;
  return blade;
}

static const shb_provenance origin = {.case_path = "case.yaml",
                                      .case_text = "name: odd\n",
                                      .settings  = "mesh.blade.size = 0.011\n",
                                      .command   = "test"};

static void make(const mesh_blade *blade, mesh_fe *mesh) {
  if (mesh_blade_write(blade, path, &origin, NULL) != SHB_OK) fail_msg("%s", shb_message());
  if (read_mesh(path, mesh) != SHB_OK) fail_msg("%s", shb_message());
}

/* det J of one element at a reference point, and the point. */
static double jacobian_at(const mesh_fe *mesh, int element, const double at[3], double x[3]) {
  const mesh_topology *t = mesh_topology_of(mesh->kind);
  double               N[MESH_NODES], dN[MESH_NODES][3], J[3][3] = {{0}};
  mesh_shape(mesh->kind, at, N, dN);
  x[0] = x[1] = x[2] = 0;
  for (int i = 0; i < t->nodes; i++)
    for (int d = 0; d < 3; d++) {
      double c = mesh->coordinates[3 * mesh->connectivity[t->nodes * element + i] + d];
      x[d] += N[i] * c;
      for (int a = 0; a < 3; a++) J[a][d] += dN[i][a] * c;
    }
  double det = 0;
  for (int a = 0; a < 3; a++)
    det +=
        J[0][a] * (J[1][(a + 1) % 3] * J[2][(a + 2) % 3] - J[1][(a + 2) % 3] * J[2][(a + 1) % 3]);
  return det;
}

/* Volumes of the elements of root, airfoil and shroud, told apart by the radial coordinate (axis
 * x). */
static void volumes(const mesh_blade *blade, const mesh_fe *mesh, double part[3]) {
  const double far = .5 * sqrt(.6), place[3] = {.5 - far, .5, .5 + far}, weight[3] = {5, 8, 5};
  part[0] = part[1] = part[2] = 0;
  for (int e = 0; e < mesh->n_elements; e++) {
    double x[3], sum = 0, half[3] = {.5, .5, .5};
    for (int i = 0; i < 27; i++) {
      const double at[3] = {place[i % 3], place[i / 3 % 3], place[i / 9]};
      sum += weight[i % 3] * weight[i / 3 % 3] * weight[i / 9] / 5832 * jacobian_at(mesh, e, at, x);
    }
    jacobian_at(mesh, e, half, x);
    double top = blade->section[blade->n_sections - 1].radius;
    part[x[2] < blade->section[0].radius ? 0 : hypot(x[1], x[2]) < top ? 1 : 2] += sum;
  }
}

/* Integral over the radius of the sections' areas: thickness times chord times the mean profile. */
static double airfoil_volume(const mesh_blade *blade) {
  const mesh_section *s   = blade->section;
  double              top = 0, mean = 0, area[3];
  for (int i = 0; i < 100000; i++) {
    double x = (i + 0.5) / 100000, g = x * (1 - x) * (1 + 0.3 * (1 - 2 * x));
    mean += g / 100000;
    top = fmax(top, g);
  }
  for (int i = 0; i < 3; i++) area[i] = s[i].chord * s[i].thickness * mean / top;
  return (s[2].radius - s[0].radius) / 6 * (area[0] + 4 * area[1] + area[2]);
}

/* Root block and ring segment are exact at any size: nothing is covered twice. The airfoil agrees
 * with its sections. */
static void parts_have_their_volumes(void **state) {
  (void)state;
  const double size[4] = {.024, .014, .01, .007};
  for (int i = 0; i < 8; i++) {
    mesh_blade blade = sample();
    mesh_fe    mesh;
    double     part[3];
    blade.size        = size[i / 2];
    blade.shroud_size = 0;
    if (i % 2) { /* the first section just fits into the block */
      blade.root_length = .0594;
      blade.root_width  = .0290;
    }
    make(&blade, &mesh);
    assert_int_equal(mesh.kind, MESH_HEX20);
    volumes(&blade, &mesh, part);
    double root = blade.root_length * blade.root_width * blade.root_height;
    double ring = blade.shroud_length * blade.shroud_thickness * SHB_TWO_PI / blade.blades *
                  (blade.section[2].radius + blade.shroud_thickness / 2);
    assert_near(part[0] / root, 1, 1e-12);
    assert_near(part[1] / airfoil_volume(&blade), 1, 4e-3);
    assert_near(part[2] / ring, 1, 1e-5);
    mesh_fe_free(&mesh);
  }
}

/* The volume of the blade of tetrahedra is approached as both meshes are refined. */
static void solid_is_that_of_tetrahedra(void **state) {
  (void)state;
  mesh_blade blade = sample();
  mesh_fe    mesh;
  double     part[3], hex, tet = 0;
  blade.size = blade.shroud_size = .0055;
  make(&blade, &mesh);
  volumes(&blade, &mesh, part);
  hex = part[0] + part[1] + part[2];
  mesh_fe_free(&mesh);
  blade.elements = MESH_TET10;
  make(&blade, &mesh);
  const double near = (5 - sqrt(5)) / 20;
  for (int e = 0; e < mesh.n_elements; e++)
    for (int i = 0; i < 4; i++) { /* exact for straight sides; the curvature's share is small */
      double at[3] = {near, near, near}, x[3];
      if (i > 0) at[i - 1] = 1 - 3 * near;
      tet += jacobian_at(&mesh, e, at, x) / 24;
    }
  assert_near(hex / tet, 1, 2e-4);
  mesh_fe_free(&mesh);
}

/* Area vector and centroid of a set of quadrangles (parallelograms of their corners). */
static void area_of(const mesh_fe *mesh, mesh_set_id id, double sum[3], double centre[3]) {
  for (int d = 0; d < 3; d++) sum[d] = centre[d] = 0;
  for (int f = 0; f < mesh->set[id].n; f++) {
    const int *n = mesh->set[id].nodes + 8 * f;
    double     a[3], b[3];
    for (int d = 0; d < 3; d++) {
      a[d] = mesh->coordinates[3 * n[2] + d] - mesh->coordinates[3 * n[0] + d];
      b[d] = mesh->coordinates[3 * n[3] + d] - mesh->coordinates[3 * n[1] + d];
    }
    double v[3];
    for (int d = 0; d < 3; d++)
      v[d] = .5 * (a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
    const double size = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int d = 0; d < 3; d++) {
      sum[d] += v[d];
      for (int c = 0; c < 4; c++) centre[d] += size * mesh->coordinates[3 * n[c] + d] / 4;
    }
  }
}

/* Eq. 2 in the cylindrical axes at the centre of the contact leg, which lies on its own radial
 * plane. */
static void contact_faces_have_their_normal_and_match(void **state) {
  (void)state;
  const double angle[4][2] = {{35, 0}, {-40, 0}, {20, 12}, {0, -15}};
  for (int i = 0; i < 4; i++) {
    mesh_blade blade = sample();
    mesh_fe    mesh;
    double     area[3], axes[3][3], centre[3];
    int        pairs, *right, *left;
    blade.axis = i % 2 ? MESH_AXIS_MY : MESH_AXIS_X;
    blade.psi  = angle[i][0] * degree;
    blade.phi  = angle[i][1] * degree;
    for (int s = 0; s < 3 && i % 2; s++)
      blade.section[s].twist *= -1, blade.section[s].camber *= -1;
    make(&blade, &mesh);
    area_of(&mesh, MESH_CONTACT_RIGHT, area, centre);
    mesh_axes_at(blade.axis, centre, axes);
    double       size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
    const double v[3] = {cos(blade.psi) * cos(blade.phi), sin(blade.psi) * cos(blade.phi),
                         -sin(blade.phi)};
    for (int a = 0; a < 3; a++) {
      double along = 0;
      for (int d = 0; d < 3; d++) along += axes[a][d] * area[d] / size;
      assert_near(along, v[a], 1e-9);
    }
    assert_near(size, blade.shroud_contact * blade.shroud_thickness / cos(blade.phi), 1e-12);
    assert_int_equal(mesh_fe_match(&mesh, blade.axis, blade.blades, &pairs, &right, &left), SHB_OK);
    free(right);
    free(left);
    mesh_fe_free(&mesh);
  }
}

static void groups_lie_where_they_should(void **state) {
  (void)state;
  mesh_blade blade = sample();
  mesh_fe    mesh;
  double     area[3], centre[3];
  make(&blade, &mesh);
  area_of(&mesh, MESH_ROOT, area, centre);
  assert_near(area[2], -blade.root_length * blade.root_width, 1e-15);
  for (int i = 0; i < 8 * mesh.set[MESH_ROOT].n; i++)
    assert_near(mesh.coordinates[3 * mesh.set[MESH_ROOT].nodes[i] + 2],
                blade.section[0].radius - blade.root_height, 1e-14);
  /* the loaded side goes through the pressure side of the section in the middle */
  mesh_outline outline;
  mesh_airfoil_outline(&blade, &blade.section[1], &outline);
  const double *at      = outline.pressure[MESH_AIRFOIL_POINTS / 2];
  double        nearest = INFINITY, low = INFINITY, high = 0;
  for (int i = 0; i < 8 * mesh.set[MESH_LOAD].n; i++) {
    const double *x = mesh.coordinates + 3 * mesh.set[MESH_LOAD].nodes[i];
    /* about x the tangential direction at the stacking line is -y */
    nearest = fmin(nearest, hypot(hypot(-x[1] - at[0], x[0] - at[1]), x[2] - at[2]));
    low     = fmin(low, x[2]);
    high    = fmax(high, x[2]);
  }
  assert_true(nearest < .6 * blade.size);
  assert_near(low, blade.section[0].radius, 1e-12);
  assert_near(high, blade.section[2].radius, 1e-3);
  area_of(&mesh, MESH_LOAD, area, centre); /* the concave side faces its centre of curvature */
  assert_true(-area[1] * (outline.pressure[6][0] - outline.suction[6][0]) > 0);
  mesh_fe_free(&mesh);
}

static void any_blade_is_meshed(void **state) {
  (void)state;
  int made = 0;
  for (int i = 0; i < 72; i++) {
    const double size[6]   = {.03, .02, .014, .011, .008, .006};
    const int    blades[3] = {20, 43, 55};
    mesh_blade   blade     = sample();
    mesh_fe      mesh;
    blade.size        = size[i % 6];
    blade.shroud_size = i % 2 ? 0 : .7 * size[i % 6];
    blade.blades      = blades[i / 6 % 3];
    blade.psi         = (i / 18 - 1) * 25 * degree;
    blade.phi         = i % 5 ? 0 : 12 * degree;
    if (blade.blades == 55) { /* narrow: a slimmer airfoil in a narrower block */
      blade.root_width = .0265;
      for (int s = 0; s < 3; s++) {
        blade.section[s].chord *= .75;
        blade.section[s].camber *= .5;
        blade.section[s].twist *= .5;
      }
    }
    make(&blade, &mesh); /* an inverted element would be refused */
    made += mesh.n_elements > 300;
    mesh_fe_free(&mesh);
  }
  assert_int_equal(made, 72);
}

/* Camber that ends at zero changes sign where the airfoil extends into root or shroud. The suction
 * side stays the same. A blade mirrored by camber and twist has the same volumes. */
static void camber_may_end_at_zero(void **state) {
  (void)state;
  for (int end = 0; end < 3; end += 2) {
    double part[2][3];
    for (int mirrored = 0; mirrored < 2; mirrored++) {
      mesh_blade blade = sample();
      mesh_fe    mesh;
      blade.section[end].camber = 0;
      for (int s = 0; s < 3 && mirrored; s++)
        blade.section[s].twist *= -1, blade.section[s].camber *= -1;
      if (mirrored) blade.psi *= -1;
      make(&blade, &mesh);
      volumes(&blade, &mesh, part[mirrored]);
      assert_near(part[mirrored][1] / airfoil_volume(&blade), 1, 4e-3);
      mesh_fe_free(&mesh);
    }
    for (int p = 0; p < 3; p++) assert_near(part[1][p] / part[0][p], 1, 1e-4);
  }
}

/* Sections between which the loft crosses itself. */
static void crossing_airfoil_is_refused(void **state) {
  (void)state;
  mesh_blade blade = sample();
  blade.section[1] = (mesh_section){.26, .09, .0015, .036, 20 * degree};
  assert_int_equal(mesh_blade_write(&blade, other, &origin, NULL), SHB_ERR_INPUT);
  if (!strstr(shb_message(), "mesh.blade.sections: ") ||
      !strstr(shb_message(), "hexahedra are inverted, from radius ") ||
      !strstr(shb_message(), "make neighbouring sections more alike"))
    fail_msg("%s", shb_message());
}

/* The sharpest corner of a blade is at the edge of the airfoil; all corners of a brick are
 * right. */
static void sharpest_corner(void **state) {
  (void)state;
  mesh_blade blade = sample();
  mesh_fe    mesh;
  double     x[3], sine;
  make(&blade, &mesh);
  sine = mesh_jacobian_worst_corner(&mesh, x);
  assert_true(sine > .1 && sine < .5);
  assert_true(hypot(x[1], x[2]) > blade.section[0].radius - 1e-9);
  mesh_fe_free(&mesh);
  /* a parallelepiped: its edges' triple product */
  const double edge[3][3] = {{2, 0, 0}, {.7, 1.1, 0}, {-.4, .3, 3}};
  int          node[MESH_NODES];
  double       at[MESH_NODES][3];
  for (int n = 0; n < MESH_NODES; n++) {
    const double *place = mesh_topology_of(MESH_HEX20)->place[n];
    node[n]             = n;
    for (int d = 0; d < 3; d++)
      at[n][d] = place[0] * edge[0][d] + place[1] * edge[1][d] + place[2] * edge[2][d];
  }
  mesh_fe one = {.kind         = MESH_HEX20,
                 .n_nodes      = MESH_NODES,
                 .n_elements   = 1,
                 .coordinates  = at[0],
                 .connectivity = node};
  assert_near(mesh_jacobian_worst_corner(&one, x), 1.1 / hypot(.7, 1.1) * 3 / sqrt(.16 + .09 + 9),
              1e-14);
}

static void same_case_same_file(void **state) {
  (void)state;
  mesh_blade blade = sample();
  char       first[17], second[17];
  for (int i = 0; i < 2; i++) {
    assert_int_equal(mesh_blade_write(&blade, i ? other : path, &origin, NULL), SHB_OK);
    assert_int_equal(shb_fingerprint(i ? other : path, i ? second : first), SHB_OK);
  }
  assert_string_equal(first, second);
}

/* The quadrangles of a section cover the lens |y| < 4 u (1 - u) once, with 4/3 x half on each
 * side. */
static void section_covers_the_lens(void **state) {
  (void)state;
  const mesh_section_grid grid[3] = {{4, 1, {.2, .2}}, {6, 2, {.15, .1}}, {10, 3, {.1, .2}}};
  for (int g = 0; g < 3; g++) {
    mesh_planar         plan;
    mesh_section_place *place;
    mesh_section_mesh_create(&grid[g], &plan, &place);
    const int k = grid[g].half, n = grid[g].chord;
    assert_int_equal(plan.n_quads, 6 * k * k + 2 * k * n);
    assert_int_equal(plan.n_contour, 4 * (4 * k + n));
    assert_int_equal(plan.n_contour % 4, 0);
    for (int i = 0; i < plan.n_contour; i++) {
      const mesh_section_place *at = &place[plan.contour[i]];
      assert_true(fabs(at->w) == 1 || at->u < 1e-12 || at->u > 1 - 1e-12);
    }
    double area = 0; /* of the corners' polygons in (u, y) */
    for (int q = 0; q < plan.n_quads; q++)
      for (int c = 0; c < 4; c++) {
        const mesh_section_place *a = &place[plan.quad[q][c]],
                                 *b = &place[plan.quad[q][(c + 1) % 4]];
        double ya = a->w * 4 * a->u * (1 - a->u), yb = b->w * 4 * b->u * (1 - b->u);
        area += (a->u * yb - b->u * ya) / 2;
      }
    assert_true(area < 4. / 3 && area > 4. / 3 * .93);
    free(place);
    mesh_planar_free(&plan);
  }
}

static void layers_add_up(void **state) {
  (void)state;
  mesh_layers *layers = malloc(sizeof *layers);
  for (int thin = 0; thin < 4; thin++) {
    mesh_layers_make(.1, .03, thin & 1, thin >> 1, layers);
    assert_int_equal(layers->n, 3 + 2 * (thin & 1) + 2 * (thin >> 1));
    assert_near(layers->at[0], 0, 0);
    assert_near(layers->at[2 * layers->n], 1, 0);
    for (int i = 0; i < 2 * layers->n; i++) assert_true(layers->at[i + 1] > layers->at[i]);
    if (thin & 1) assert_near(layers->at[2] * 3, .08, 1e-15);
    if (thin >> 1) assert_near((1 - layers->at[2 * layers->n - 4]) * 3, .3, 1e-15);
  }
  free(layers);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(section_covers_the_lens),
      cmocka_unit_test(layers_add_up),
      cmocka_unit_test(parts_have_their_volumes),
      cmocka_unit_test(solid_is_that_of_tetrahedra),
      cmocka_unit_test(contact_faces_have_their_normal_and_match),
      cmocka_unit_test(groups_lie_where_they_should),
      cmocka_unit_test(any_blade_is_meshed),
      cmocka_unit_test(camber_may_end_at_zero),
      cmocka_unit_test(crossing_airfoil_is_refused),
      cmocka_unit_test(sharpest_corner),
      cmocka_unit_test(same_case_same_file),
  };
  return cmocka_run_group_tests_name("mesh.sweep", tests, set_up, tear_down);
}
