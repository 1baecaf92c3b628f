/* The parametric blade: contact geometry, groups, volume, reproducibility, refused input. */
#include "mesh/blade/blade.h"

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
#include "mesh/core/face_match.h"
#include "mesh/core/fe_mesh.h"
#include "mesh/core/jacobian.h"
#include "mesh/gmsh/provenance.h"
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

static const shb_provenance origin = {.case_path = "case.yaml",
                                      .case_text = "name: odd\n$EndComments\n$Nodes\n1\n",
                                      .settings  = "mesh.blade.size = 0.011\nrotor.blades = 43\n",
                                      .command   = "test"};

static shb_status write_blade(const mesh_blade *blade) {
  unlink(path);
  return mesh_blade_write(blade, path, &origin, NULL);
}

static void make(const mesh_blade *blade, mesh_fe *mesh) {
  if (write_blade(blade) != SHB_OK) fail_msg("%s", shb_message());
  if (read_mesh(path, mesh) != SHB_OK) fail_msg("%s", shb_message());
}

/* Unit normal and area centroid of a set of planar triangles. */
static void normal_and_centre(const mesh_fe *mesh, mesh_set_id id, double normal[3],
                              double centre[3]) {
  double total = 0;
  for (int d = 0; d < 3; d++) normal[d] = centre[d] = 0;
  for (int f = 0; f < mesh->set[id].n; f++) {
    const double *x[3];
    double        n[3];
    for (int c = 0; c < 3; c++)
      x[c] = mesh->coordinates + 3 * (size_t)mesh->set[id].nodes[6 * f + c];
    for (int d = 0; d < 3; d++) {
      int i = (d + 1) % 3, j = (d + 2) % 3;
      n[d] = 0.5 * ((x[1][i] - x[0][i]) * (x[2][j] - x[0][j]) -
                    (x[1][j] - x[0][j]) * (x[2][i] - x[0][i]));
    }
    double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int d = 0; d < 3; d++) {
      normal[d] += n[d];
      centre[d] += area * (x[0][d] + x[1][d] + x[2][d]) / 3;
    }
    total += area;
  }
  double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  for (int d = 0; d < 3; d++) {
    normal[d] /= length;
    centre[d] /= total;
  }
}

/* v of eq. 2 in the cylindrical axes at the centre of the right face, and -v on the left. */
static void check_contact(const mesh_blade *blade, mesh_fe *mesh) {
  double psi = blade->psi, phi = blade->phi;
  double v[3] = {cos(psi) * cos(phi), sin(psi) * cos(phi), -sin(phi)};
  for (int side = 0; side < 2; side++) {
    mesh_set_id id = side ? MESH_CONTACT_LEFT : MESH_CONTACT_RIGHT;
    double      normal[3], centre[3], axes[3][3];
    assert_true(mesh->set[id].n > 0);
    normal_and_centre(mesh, id, normal, centre);
    mesh_axes_at(blade->axis, centre, axes);
    for (int i = 0; i < 3; i++) {
      double along = axes[i][0] * normal[0] + axes[i][1] * normal[1] + axes[i][2] * normal[2];
      assert_near(along, side ? -v[i] : v[i], 1e-12);
    }
  }
  const int *right = mesh->set[MESH_CONTACT_RIGHT].nodes;
  assert_int_equal(mesh_fe_orient(mesh, blade->axis), SHB_OK);
  assert_ptr_equal(mesh->set[MESH_CONTACT_RIGHT].nodes, right);
  int pairs = 0, *r = NULL, *l = NULL;
  if (mesh_fe_match(mesh, blade->axis, blade->blades, &pairs, &r, &l) != SHB_OK)
    fail_msg("%s", shb_message());
  assert_true(pairs >= 6);
  for (int i = 0; i < pairs; i++) {
    double at[3];
    mesh_axis_rotate(blade->axis, SHB_TWO_PI / blade->blades, mesh->coordinates + 3 * l[i], at);
    for (int d = 0; d < 3; d++) assert_near(at[d], mesh->coordinates[3 * r[i] + d], 1e-14);
  }
  free(r);
  free(l);
}

/* Length of the contact face along u. */
static double extent_along_u(const mesh_blade *blade, const mesh_fe *mesh) {
  double normal[3], centre[3], axes[3][3], low = INFINITY, high = -INFINITY;
  normal_and_centre(mesh, MESH_CONTACT_RIGHT, normal, centre);
  mesh_axes_at(blade->axis, centre, axes);
  for (int i = 0; i < 6 * mesh->set[MESH_CONTACT_RIGHT].n; i++) {
    const double *x = mesh->coordinates + 3 * mesh->set[MESH_CONTACT_RIGHT].nodes[i];
    double        t = 0, a = 0;
    for (int d = 0; d < 3; d++) {
      t += axes[0][d] * x[d];
      a += axes[1][d] * x[d];
    }
    double u = -sin(blade->psi) * t + cos(blade->psi) * a;
    low      = fmin(low, u);
    high     = fmax(high, u);
  }
  return high - low;
}

/* The sample with few elements. */
static mesh_blade coarse_blade(void) {
  mesh_blade blade  = odd_blade();
  blade.size        = 0.02;
  blade.shroud_size = 0.009;
  return blade;
}

static void contact_planes_are_as_asked(void **state) {
  (void)state;
  const double angle[][2] = {{0, 0}, {-48, 13}, {70, -45}, {-70, 7}, {21, 45}};
  for (size_t i = 0; i < sizeof angle / sizeof *angle; i++) {
    mesh_blade blade = coarse_blade();
    mesh_fe    mesh;
    blade.psi = angle[i][0] * degree;
    blade.phi = angle[i][1] * degree;
    make(&blade, &mesh);
    check_contact(&blade, &mesh);
    if (blade.phi == 0) assert_near(extent_along_u(&blade, &mesh), blade.shroud_contact, 1e-12);
    mesh_fe_free(&mesh);
  }
}

static void every_engine_axis_works(void **state) {
  (void)state;
  for (int axis = MESH_AXIS_X; axis <= MESH_AXIS_MZ; axis++) {
    mesh_blade blade = coarse_blade();
    mesh_fe    mesh;
    blade.axis   = (mesh_axis)axis;
    blade.blades = 37 + axis;
    blade.phi    = 11 * degree;
    make(&blade, &mesh);
    check_contact(&blade, &mesh);
    mesh_fe_free(&mesh);
  }
}

static int root_of(int *parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* Parts of the mesh that share no node. */
static int count_parts(const mesh_fe *mesh) {
  int *parent = malloc((size_t)mesh->n_nodes * sizeof *parent), parts = 0;
  assert_non_null(parent);
  for (int i = 0; i < mesh->n_nodes; i++) parent[i] = i;
  for (int e = 0; e < mesh->n_elements; e++)
    for (int i = 1; i < 10; i++)
      parent[root_of(parent, mesh->connectivity[10 * e + i])] =
          root_of(parent, mesh->connectivity[10 * e]);
  for (int i = 0; i < mesh->n_nodes; i++) parts += parent[i] == i;
  free(parent);
  return parts;
}

/* Four-point rule on each element, exact for the quadratic map to its leading order. */
static double volume(const mesh_fe *mesh) {
  const double a   = (5 - sqrt(5)) / 20;
  double       sum = 0;
  for (int e = 0; e < mesh->n_elements; e++)
    for (int p = 0; p < 4; p++) {
      double J[3][3] = {{0}};
      for (int n = 0; n < 10; n++) {
        double L[4], dL[4][3] = {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int i = 0; i < 4; i++) L[i] = i == p ? 1 - 3 * a : a;
        for (int d = 0; d < 3; d++) {
          double g = n < 4 ? (4 * L[n] - 1) * dL[n][d]
                           : 4 * (L[mesh_topology_of(MESH_TET10)->edge[n - 4][0]] *
                                      dL[mesh_topology_of(MESH_TET10)->edge[n - 4][1]][d] +
                                  L[mesh_topology_of(MESH_TET10)->edge[n - 4][1]] *
                                      dL[mesh_topology_of(MESH_TET10)->edge[n - 4][0]][d]);
          for (int i = 0; i < 3; i++)
            J[i][d] += g * mesh->coordinates[3 * mesh->connectivity[10 * e + n] + i];
        }
      }
      for (int i = 0; i < 3; i++)
        sum += J[0][i] *
               (J[1][(i + 1) % 3] * J[2][(i + 2) % 3] - J[1][(i + 2) % 3] * J[2][(i + 1) % 3]) / 24;
    }
  return sum;
}

/* Block + airfoil (sections' areas, Simpson over the radius) + ring segment. */
static double expected_volume(const mesh_blade *blade) {
  const mesh_section *s   = blade->section;
  double              top = 0, mean = 0, area[3];
  for (int i = 0; i < 100000; i++) {
    double x = (i + 0.5) / 100000, g = x * (1 - x) * (1 + 0.3 * (1 - 2 * x));
    mean += g / 100000;
    top = fmax(top, g);
  }
  for (int i = 0; i < 3; i++) area[i] = s[i].chord * s[i].thickness * mean / top;
  double airfoil = (s[2].radius - s[0].radius) / 6 * (area[0] + 4 * area[1] + area[2]);
  double ring    = blade->shroud_length * blade->shroud_thickness * SHB_TWO_PI / blade->blades *
                (s[2].radius + blade->shroud_thickness / 2);
  return blade->root_length * blade->root_width * blade->root_height + airfoil + ring;
}

static void one_solid_of_the_right_volume(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  mesh_fe    mesh;
  blade.size        = 0.007;
  blade.shroud_size = 0;
  make(&blade, &mesh);
  assert_int_equal(count_parts(&mesh), 1);
  double wanted = expected_volume(&blade);
  assert_near(volume(&mesh) / wanted, 1, 2e-3);
  mesh_fe_free(&mesh);
}

static void groups_lie_where_they_should(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  mesh_fe    mesh;
  make(&blade, &mesh);
  double area = 0;
  for (int f = 0; f < mesh.set[MESH_ROOT].n; f++) {
    const int *n = mesh.set[MESH_ROOT].nodes + 6 * f;
    for (int i = 0; i < 6; i++)
      assert_near(mesh.coordinates[3 * n[i] + 2], blade.section[0].radius - blade.root_height,
                  1e-14);
    const double *x = mesh.coordinates + 3 * n[0], *y = mesh.coordinates + 3 * n[1],
                 *z = mesh.coordinates + 3 * n[2];
    area -= 0.5 * ((y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]));
  }
  assert_near(area, blade.root_length * blade.root_width, 1e-15);
  for (int i = 0; i < 6 * mesh.set[MESH_LOAD].n; i++) {
    double radius = mesh.coordinates[3 * mesh.set[MESH_LOAD].nodes[i] + 2];
    assert_true(radius > blade.section[0].radius - 1e-6);
    assert_true(radius < blade.section[2].radius + 1e-3);
  }
  mesh_fe_free(&mesh);
}

/* The loaded side is concave: seen along its normal, its middle lies behind its edges. */
static void check_hollow(const mesh_blade *blade, const mesh_fe *mesh, double bulge) {
  double normal[3], centre[3], axes[3][3], edge[2][2] = {{INFINITY, 0}, {-INFINITY, 0}};
  double middle[2] = {INFINITY, 0}, stacking[3];
  mesh_axis_stacking(blade->axis, stacking);
  mesh_axes_at(blade->axis, stacking, axes);
  normal_and_centre(mesh, MESH_LOAD, normal, centre);
  double facing = 0;
  for (int d = 0; d < 3; d++) facing += normal[d] * axes[0][d];
  assert_true(facing * bulge < 0);
  for (int i = 0; i < 6 * mesh->set[MESH_LOAD].n; i++) {
    const double *x      = mesh->coordinates + 3 * mesh->set[MESH_LOAD].nodes[i];
    double        own[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 3; d++) own[k] += axes[k][d] * x[d];
    if (own[2] > 0.27) continue; /* near the root, where the twist is small */
    if (own[1] < edge[0][0]) memcpy(edge[0], (double[]){own[1], own[0]}, sizeof edge[0]);
    if (own[1] > edge[1][0]) memcpy(edge[1], (double[]){own[1], own[0]}, sizeof edge[1]);
    if (fabs(own[1]) < fabs(middle[0])) memcpy(middle, (double[]){own[1], own[0]}, sizeof middle);
  }
  assert_true((middle[1] - 0.5 * (edge[0][1] + edge[1][1])) * facing < 0);
}

static void load_is_on_the_concave_side(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  mesh_fe    mesh;
  blade.axis = MESH_AXIS_MY;
  make(&blade, &mesh);
  check_hollow(&blade, &mesh, 1);
  mesh_fe_free(&mesh);
  for (int i = 0; i < 3; i++) {
    blade.section[i].camber *= -1;
    blade.section[i].twist *= -1;
  }
  make(&blade, &mesh);
  check_hollow(&blade, &mesh, -1);
  mesh_fe_free(&mesh);
}

static void smaller_sizes_refine(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  int        nodes[4], faces[4];
  for (int i = 0; i < 4; i++) {
    mesh_fe mesh;
    blade.size        = i < 2 ? 0.014 : 0.007;
    blade.shroud_size = i == 0 ? 0 : i < 3 ? 0.0045 : 0.0032;
    make(&blade, &mesh);
    nodes[i] = mesh.n_nodes;
    faces[i] = mesh.set[MESH_CONTACT_RIGHT].n;
    mesh_fe_free(&mesh);
  }
  assert_true(nodes[1] > nodes[0] && faces[1] > 3 * faces[0]);
  assert_true(nodes[2] > 2 * nodes[0] && abs(faces[2] - faces[1]) <= 4);
  assert_true(nodes[3] > nodes[2] && faces[3] > 1.5 * faces[2]);
}

static char *whole(const char *name) {
  FILE *file = fopen(name, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  long  size = ftell(file);
  char *text = calloc((size_t)size + 1, 1);
  rewind(file);
  assert_int_equal(fread(text, 1, (size_t)size, file), size);
  fclose(file);
  return text;
}

static void same_case_same_mesh(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  assert_int_equal(mesh_blade_write(&blade, path, &origin, NULL), SHB_OK);
  assert_int_equal(mesh_blade_write(&blade, other, &origin, NULL), SHB_OK);
  char *a = whole(path), *b = whole(other);
  assert_string_equal(a, b);
  free(a);
  free(b);
}

static void provenance_comes_back(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  mesh_fe    mesh;
  char      *settings = NULL;
  make(&blade, &mesh);
  mesh_fe_free(&mesh);
  assert_int_equal(mesh_settings_read(path, &settings), SHB_OK);
  assert_string_equal(settings, origin.settings);
  free(settings);
  char *text = whole(path);
  assert_non_null(strstr(text, "\n  name: odd\n  $EndComments\n  $Nodes\n  1\n$EndComments\n"));
  free(text);
  assert_int_equal(mesh_settings_read("/nowhere/blade.msh", &settings), SHB_ERR_IO);
  FILE *file = fopen(other, "w");
  fputs("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", file);
  fclose(file);
  assert_int_equal(mesh_settings_read(other, &settings), SHB_OK);
  assert_string_equal(settings, "");
  free(settings);
}

/* A thin, strongly cambered airfoil: a few elements are straightened, the mesh is good. */
static mesh_blade thin(double thickness, double camber, double size) {
  mesh_blade blade  = odd_blade();
  blade.blades      = 20;
  blade.root_length = 0.08;
  blade.root_width  = 0.07;
  for (int i = 0; i < 3; i++) {
    blade.section[i].thickness = thickness * (1 - 0.1 * i);
    blade.section[i].camber    = camber;
  }
  blade.shroud_length = 0.06;
  blade.size          = size;
  blade.shroud_size   = 0;
  return blade;
}

static void few_inverted_elements_are_straightened(void **state) {
  (void)state;
  mesh_blade blade = thin(0.0012, 0.006, 0.0065);
  mesh_fe    mesh;
  make(&blade, &mesh);
  check_contact(&blade, &mesh);
  int straight = 0; /* elements with six straight edges on the loaded side, which is curved */
  for (int f = 0; f < mesh.set[MESH_LOAD].n; f++) {
    const int *n   = mesh.set[MESH_LOAD].nodes + 6 * f;
    double     sag = 0;
    for (int s = 0; s < 3; s++)
      for (int d = 0; d < 3; d++)
        sag = fmax(sag, fabs(mesh.coordinates[3 * n[3 + s] + d] -
                             0.5 * (mesh.coordinates[3 * n[s] + d] +
                                    mesh.coordinates[3 * n[(s + 1) % 3] + d])));
    straight += sag < 1e-12;
  }
  assert_in_range(straight, 1, mesh.set[MESH_LOAD].n / 10);
  mesh_fe_free(&mesh);
}

/* Status, and a one-line message with the words; no file is written. */
static void assert_blade_refused(const mesh_blade *blade, const char *words) {
  shb_status status = write_blade(blade);
  if (status != SHB_ERR_INPUT || !strstr(shb_message(), words))
    fail_msg("status %d, text '%s'; wanted bad input with '%s'", status, shb_message(), words);
  assert_null(strchr(shb_message(), '\n'));
  assert_int_not_equal(access(path, F_OK), 0);
}

static void unresolved_blades_are_refused(void **state) {
  (void)state;
  mesh_blade blade = thin(0.001, 0.011, 0.009);
  assert_blade_refused(&blade, "elements inverted (det J <= 0): elements ");
  blade = thin(0.001, 0.0168, 0.0135);
  assert_blade_refused(&blade, "mesh.blade.size: gmsh cannot fill");
}

/* One invalid number of the sample, and the key that the message must name. */
typedef struct {
  size_t      offset;
  double      value;
  const char *words;
} fault;

#define FAULT(member, value, words) \
  { offsetof(mesh_blade, member), value, words }

static void wrong_numbers_are_named(void **state) {
  (void)state;
  const fault faults[] = {
      FAULT(psi, 71 * degree, "contact.psi: 71 deg"),
      FAULT(psi, -NAN, "contact.psi"),
      FAULT(phi, -46 * degree, "contact.phi: -46 deg"),
      FAULT(root_length, 0.05, "mesh.blade.root.length: 50 mm does not hold"),
      FAULT(root_length, -1, "mesh.blade.root.length"),
      FAULT(root_width, 0.02, "mesh.blade.root.width: 20 mm does not hold"),
      FAULT(root_width, 0.05, "mesh.blade.root.width: 50 mm is wider than the sector"),
      FAULT(root_height, 0, "mesh.blade.root.height"),
      FAULT(root_height, 0.25, "mesh.blade.root.height: 250 mm reaches the engine axis"),
      FAULT(section[0].radius, -0.1, "mesh.blade.sections[0].radius"),
      FAULT(section[1].radius, 0.25, "mesh.blade.sections[1].radius: 250 mm is not above"),
      FAULT(section[1].chord, 0, "mesh.blade.sections[1].chord"),
      FAULT(section[2].thickness, 0.03, "mesh.blade.sections[2].thickness"),
      FAULT(section[2].thickness, 0, "mesh.blade.sections[2].thickness"),
      FAULT(section[1].camber, -0.007, "mesh.blade.sections[1].camber: -7 mm bends the other way"),
      FAULT(section[0].camber, 0.05, "mesh.blade.sections[0].camber: 50 mm"),
      FAULT(section[0].twist, 85 * degree, "mesh.blade.sections[0].twist: 85 deg"),
      FAULT(section[2].chord, 0.06, "mesh.blade.shroud.length: 45 mm does not cover"),
      FAULT(shroud_length, 0.03, "mesh.blade.shroud.length: 30 mm does not cover"),
      FAULT(shroud_length, 0, "mesh.blade.shroud.length"),
      FAULT(shroud_thickness, 0, "mesh.blade.shroud.thickness"),
      FAULT(shroud_thickness, 0.2, "mesh.blade.shroud.thickness: 200 mm"),
      FAULT(shroud_thickness, 0.0008, "mesh.blade.shroud.thickness: 0.8 mm is too thin"),
      FAULT(shroud_contact, 0.06, "mesh.blade.shroud.contact: 60 mm is too long"),
      FAULT(shroud_contact, 0, "mesh.blade.shroud.contact"),
      FAULT(size, 0, "mesh.blade.size"),
      FAULT(size, 1e-5, "mesh.blade.size: 0.01 mm would give"),
      FAULT(shroud_size, -1, "mesh.blade.shroud_size"),
      FAULT(shroud_size, 1e-5, "mesh.blade.shroud_size: 0.01 mm would give"),
  };
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    mesh_blade blade                               = odd_blade();
    *(double *)((char *)&blade + faults[i].offset) = faults[i].value;
    assert_blade_refused(&blade, faults[i].words);
  }
  mesh_blade blade = odd_blade();
  blade.blades     = 2;
  assert_blade_refused(&blade, "rotor.blades: 2");
  blade.blades = 90;
  assert_blade_refused(&blade, "rotor.blades");
  blade                  = odd_blade();
  blade.blades           = 60;
  blade.section[2].twist = 60 * degree;
  assert_blade_refused(&blade, "mesh.blade.sections[2]: the last section reaches");
  blade                      = odd_blade();
  blade.shroud_thickness     = 0.02;
  blade.section[2].thickness = 0.0005;
  assert_blade_refused(&blade, "mesh.blade.sections[2]: the airfoil tapers to nothing");
  blade            = odd_blade();
  blade.n_sections = 1;
  assert_blade_refused(&blade, "mesh.blade.sections: 1 given");
}

static void unwritable_folder_is_an_io_error(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  assert_int_equal(mesh_blade_write(&blade, "/nowhere/blade.msh", &origin, NULL), SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "/nowhere/blade.msh: cannot be written: No such file"));
}

/* A failure leaves the earlier mesh unchanged. */
static void earlier_mesh_survives_a_failure(void **state) {
  (void)state;
  mesh_blade blade = odd_blade();
  assert_int_equal(write_blade(&blade), SHB_OK);
  char *before = whole(path);
  blade        = thin(0.001, 0.011, 0.009);
  assert_int_equal(mesh_blade_write(&blade, path, &origin, NULL), SHB_ERR_INPUT);
  char *after = whole(path);
  assert_string_equal(before, after);
  free(before);
  free(after);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contact_planes_are_as_asked),
      cmocka_unit_test(every_engine_axis_works),
      cmocka_unit_test(one_solid_of_the_right_volume),
      cmocka_unit_test(groups_lie_where_they_should),
      cmocka_unit_test(load_is_on_the_concave_side),
      cmocka_unit_test(smaller_sizes_refine),
      cmocka_unit_test(same_case_same_mesh),
      cmocka_unit_test(provenance_comes_back),
      cmocka_unit_test(few_inverted_elements_are_straightened),
      cmocka_unit_test(unresolved_blades_are_refused),
      cmocka_unit_test(wrong_numbers_are_named),
      cmocka_unit_test(unwritable_folder_is_an_io_error),
      cmocka_unit_test(earlier_mesh_survives_a_failure),
  };
  return cmocka_run_group_tests_name("mesh.blade", tests, set_up, tear_down);
}
