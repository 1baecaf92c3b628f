/* The parametric blade on a disc: groups, sides that match, area of the profile, refused input. */
#include "mesh/blade/disc.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/base/vec3.h"
#include "mesh/blade/blade.h"
#include "mesh/core/cyclic_sides.h"
#include "tests/support/check.h"
#include "tests/support/odd_blade.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

static const shb_provenance origin = {"case.yaml", "name: case\n", "mesh.blade\n", "shroudhb-mesh"};

static mesh_blade on_a_disc(void) {
  mesh_blade blade = odd_blade();
  blade.elements   = MESH_TET10;
  blade.axis       = MESH_AXIS_MZ;
  blade.root_width = 0.0315;
  blade.disc_bore  = 0.143;
  blade.disc_web   = 0.0117;
  blade.disc_rim   = 0.0213;
  return blade;
}

static mesh_fe make(const mesh_blade *blade) {
  mesh_fe mesh;
  assert_ok(mesh_blade_write(blade, scratch("blade.msh"), &origin, NULL));
  assert_ok(read_mesh(scratch("blade.msh"), &mesh));
  return mesh;
}

/* Area of a group by its flat corners, m2. */
static double area_of(const mesh_fe *mesh, mesh_set_id id) {
  double sum = 0;
  for (int f = 0; f < mesh->set[id].n; f++) {
    const int *node = mesh->set[id].nodes + 6 * f;
    double     a[3], b[3], normal[3];
    vec3_minus(mesh->coordinates + 3 * node[1], mesh->coordinates + 3 * node[0], a);
    vec3_minus(mesh->coordinates + 3 * node[2], mesh->coordinates + 3 * node[0], b);
    vec3_cross(a, b, normal);
    sum += vec3_norm(normal) / 2;
  }
  return sum;
}

/* All nodes of the clamp lie on the bore. */
static void check_bore(const mesh_blade *blade, const mesh_fe *mesh) {
  double axial[3], across[3], worst = 0;
  mesh_axis_vector(blade->axis, axial);
  assert_true(mesh->set[MESH_ROOT].n > 0);
  for (int k = 0; k < 6 * mesh->set[MESH_ROOT].n; k++) {
    vec3_cross(axial, mesh->coordinates + 3 * mesh->set[MESH_ROOT].nodes[k], across);
    worst = fmax(worst, fabs(vec3_norm(across) - blade->disc_bore));
  }
  assert_near(worst, 0, 1e-9);
}

/* The clamp is the bore; the sides have the area of the profile and match. */
static void groups_of_a_disc(void **state) {
  (void)state;
  mesh_blade          blade = on_a_disc();
  mesh_cyclic_sides   sides;
  mesh_fe             mesh  = make(&blade);
  const mesh_face_set right = mesh.set[MESH_CYCLIC_RIGHT];
  /* the top of the rim is half way from the corners of the block to its top */
  const double corner = hypot(0.25 - 0.017, 0.0315 / 2), top = (corner + 0.25) / 2;
  const double foot = top - blade.disc_rim;
  const double area = blade.disc_rim * blade.root_length + (foot - 0.143) * blade.disc_web;
  check_bore(&blade, &mesh);
  assert_near(area_of(&mesh, MESH_CYCLIC_RIGHT), area, 1e-12);
  assert_near(area_of(&mesh, MESH_CYCLIC_LEFT), area, 1e-12);
  assert_ok(mesh_cyclic_pair(&mesh, blade.axis, blade.blades, &sides));
  assert_ptr_equal(mesh.set[MESH_CYCLIC_RIGHT].nodes, right.nodes); /* not swapped */
  print_message("%d pairs, gap %.1e m\n", sides.n, sides.gap);
  assert_true(sides.n > 50 && sides.gap < 1e-9);
  mesh_fe_free(&mesh);
}

/* The volume by Pappus is that of a ring of rectangles. */
static void volume_of_a_disc(void **state) {
  (void)state;
  mesh_blade   blade  = on_a_disc();
  const double corner = hypot(0.25 - 0.017, 0.0315 / 2), top = (corner + 0.25) / 2;
  const double foot = top - blade.disc_rim;
  const double ring = SHB_PI * (blade.root_length * (top * top - foot * foot) +
                                blade.disc_web * (foot * foot - 0.143 * 0.143));
  assert_near(mesh_disc_volume(&blade) / (ring / blade.blades), 1, 1e-14);
  blade.disc_bore = 0;
  assert_true(mesh_disc_volume(&blade) == 0);
  assert_ok(mesh_disc_check(&blade));
}

static void refused(mesh_blade blade, const char *text) {
  assert_refused(mesh_blade_write(&blade, scratch("bad.msh"), &origin, NULL), SHB_ERR_INPUT, text);
  assert_int_not_equal(access(scratch("bad.msh"), F_OK), 0);
}

static void discs_that_cannot_be(void **state) {
  (void)state;
  mesh_blade blade = on_a_disc();
  blade.elements   = MESH_HEX20;
  refused(blade, "mesh.blade.elements: hexahedra are not swept through a disc; give tet10");
  blade           = on_a_disc();
  blade.disc_bore = 0.24;
  refused(blade, "mesh.blade.disc.bore: 240 mm is not below the rim");
  blade          = on_a_disc();
  blade.disc_web = 0.065;
  refused(blade, "mesh.blade.disc.web: 65 mm; it must be above 0 and at most 62.7 mm");
  blade          = on_a_disc();
  blade.disc_rim = 0.008;
  refused(blade, "mesh.blade.disc.rim: 8 mm leaves the root block below the rim");
  blade            = on_a_disc();
  blade.root_width = 0.033;
  refused(blade, "mesh.blade.root.width: 33 mm reaches the sides of the disc");
  blade             = on_a_disc();
  blade.blades      = 20;
  blade.root_width  = 0.06;
  blade.root_height = 0.002;
  refused(blade, "mesh.blade.root.height: 2 mm is too low");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(groups_of_a_disc),
                                     cmocka_unit_test(volume_of_a_disc),
                                     cmocka_unit_test(discs_that_cannot_be)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
