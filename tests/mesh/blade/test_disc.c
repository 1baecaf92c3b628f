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

/* The same of hexahedra, which need a taper. */
static mesh_blade of_hexahedra(void) {
  mesh_blade blade = on_a_disc();
  blade.elements   = MESH_HEX20;
  blade.disc_taper = 0.0137;
  return blade;
}

static int face_nodes(const mesh_fe *mesh) {
  return mesh_topology_of(mesh->kind)->face_nodes;
}

/* Area of a group by its flat corners, m2: triangles, or the two halves of a quadrangle. */
static double area_of(const mesh_fe *mesh, mesh_set_id id) {
  const int width = face_nodes(mesh), corners = width / 2;
  double    sum = 0;
  for (int f = 0; f < mesh->set[id].n; f++)
    for (int half = 0; half < corners - 2; half++) {
      const int *node = mesh->set[id].nodes + width * f;
      double     a[3], b[3], normal[3];
      vec3_minus(mesh->coordinates + 3 * node[1 + half], mesh->coordinates + 3 * node[0], a);
      vec3_minus(mesh->coordinates + 3 * node[2 + half], mesh->coordinates + 3 * node[0], b);
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
  for (int k = 0; k < face_nodes(mesh) * mesh->set[MESH_ROOT].n; k++) {
    vec3_cross(axial, mesh->coordinates + 3 * mesh->set[MESH_ROOT].nodes[k], across);
    worst = fmax(worst, fabs(vec3_norm(across) - blade->disc_bore));
  }
  assert_near(worst, 0, 1e-9);
}

/* The clamp is the bore; the sides have the area of the profile and match. */
static void check_groups(const mesh_blade *blade, double most) {
  mesh_cyclic_sides   sides;
  mesh_fe             mesh  = make(blade);
  const mesh_face_set right = mesh.set[MESH_CYCLIC_RIGHT];
  /* the top of the rim is half way from the corners of the block to its top */
  const double corner = hypot(0.25 - 0.017, 0.0315 / 2), top = (corner + 0.25) / 2;
  const double foot = top - blade->disc_rim, web = foot - blade->disc_taper;
  const double area = blade->disc_rim * blade->root_length + (web - 0.143) * blade->disc_web +
                      blade->disc_taper * (blade->disc_web + blade->root_length) / 2;
  check_bore(blade, &mesh);
  assert_near(area_of(&mesh, MESH_CYCLIC_RIGHT), area, 1e-12);
  assert_near(area_of(&mesh, MESH_CYCLIC_LEFT), area, 1e-12);
  assert_ok(mesh_cyclic_pair(&mesh, blade->axis, blade->blades, &sides));
  assert_ptr_equal(mesh.set[MESH_CYCLIC_RIGHT].nodes, right.nodes); /* not swapped */
  print_message("%d nodes, %d pairs, gap %.1e m\n", mesh.n_nodes, sides.n, sides.gap);
  assert_true(sides.n > 50 && sides.gap < most);
  mesh_fe_free(&mesh);
}

static void groups_of_a_disc(void **state) {
  (void)state;
  mesh_blade blade = on_a_disc();
  check_groups(&blade, 1e-9);
  blade.disc_taper = 0.0137;
  check_groups(&blade, 1e-9);
}

/* Hexahedra of several sizes; no element is inverted (mesh_blade_write). */
static void hexahedra_of_a_disc(void **state) {
  (void)state;
  mesh_blade blade = of_hexahedra();
  for (int i = 0; i < 3; i++) {
    check_groups(&blade, 1e-11);
    blade.size *= 0.8;
  }
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
  blade.disc_taper = 0.011; /* two triangles less the rings that they replace */
  const double low = foot - 0.011, wide = (blade.root_length - blade.disc_web) / 2;
  const double more = SHB_TWO_PI * wide * 0.011 * (low + 2 * 0.011 / 3);
  assert_near(mesh_disc_volume(&blade) / ((ring + more) / blade.blades), 1, 1e-14);
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
  refused(blade,
          "mesh.blade.disc.taper: hexahedra are swept along the radius, and need the web to "
          "widen over ");
  blade            = on_a_disc();
  blade.disc_taper = 0.09;
  refused(blade, "mesh.blade.disc.bore: 143 mm is not below the rim, whose foot with its taper");
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
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(groups_of_a_disc), cmocka_unit_test(hexahedra_of_a_disc),
      cmocka_unit_test(volume_of_a_disc), cmocka_unit_test(discs_that_cannot_be)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
