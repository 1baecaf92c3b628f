/* What gmsh makes of a solid: elements everywhere, the volume, curved faces, straightened elements.
 */
#include "mesh/gmsh/solid_check.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/gmsh/solid.h"
#include "tests/support/read_source.h"
#include "tests/support/scratch_folder.h"

static void assert_relative(double a, double b, double tolerance) {
  assert_near(a / b, 1, tolerance);
}

static mesh_source put(const char *name, double size, double curvature, const char *text) {
  mesh_source source = {.path      = scratch(name),
                        .unit      = 1e-3,
                        .size      = size,
                        .curvature = curvature,
                        .axis      = MESH_AXIS_X};
  FILE       *file   = fopen(source.path, "w");
  assert_non_null(file);
  fprintf(file, "SetFactory(\"OpenCASCADE\");\n%s", text);
  fclose(file);
  return source;
}

/* Mesh and faults of a solid, in mm; the caller frees the mesh. */
static mesh_solid_faults mesh_of(const mesh_source *source, mesh_fe *mesh) {
  mesh_solid solid;
  assert_ok(mesh_solid_open(source, NULL, &solid));
  const shb_status status = mesh_solid_mesh(&solid, mesh);
  mesh_solid_close(&solid);
  assert_ok(status);
  return solid.faults;
}

/* The volume of the solid that is told, within the error that is told, which is at most `most`. */
static void assert_volume(const char *what, const mesh_surface_gap *gap, double exact,
                          double most) {
  const double told = (gap->volume + gap->missing) / exact - 1, error = gap->error / exact;
  print_message("%s: the mesh is %.1e off; the solid as told is %.1e off, error %.1e\n", what,
                gap->volume / exact - 1, told, error);
  assert_true(fabs(told) <= error + 1e-6);
  assert_true(error <= most);
}

/* Coarse triangles of the two walls of a thin tube cross each other. */
static const char tube[] =
    "Cylinder(1) = {0, 0, 300, 0, 0, 60, 5};\n"
    "Cylinder(2) = {0, 0, 300, 0, 0, 60, 4.8};\n"
    "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n"
    "Box(4) = {20, -10, 300, 40, 20, 50};\n";

static void a_solid_without_elements_is_told_with_its_place_and_reason(void **state) {
  (void)state;
  const mesh_source source = put("tube.geo", 8e-3, 0, tube);
  assert_source_refused(&source,
                        "tube.geo: solid 1 of 2, about (0, 0, 0.33) m, got no elements: "
                        "gmsh: PLC Error:  A segment and a facet intersect at point");
  assert_source_refused(&source, "; mesh it finer (mesh.size, mesh.curvature)");
}

static void finer_triangles_on_curved_faces_mesh_that_solid(void **state) {
  (void)state;
  const mesh_source source = put("tube.geo", 8e-3, 24, tube);
  mesh_fe           mesh;
  mesh_solid_faults faults = mesh_of(&source, &mesh);
  const double      exact  = SHB_PI * (25 - 4.8 * 4.8) * 60e-9;
  assert_string_equal(faults.errors, "");
  assert_volume("a thin tube with 24 elements a turn", &faults.gap, exact, 5e-3);
  assert_relative(faults.gap.volume, exact, 1e-3);
  mesh_fe_free(&mesh);
}

/* Elements of second order, half as long as the ball: its volume, and its surface. */
static void a_ball_keeps_its_volume(void **state) {
  (void)state;
  const mesh_source source = put("ball.geo", 9e-3, 0, "Sphere(1) = {0, 0, 300, 10};\n");
  mesh_fe           mesh;
  mesh_solid_faults faults = mesh_of(&source, &mesh);
  print_message("ball of 20 mm, elements of 9 mm: surface %.1e m at %.1e m\n", faults.gap.farthest,
                hypot(hypot(faults.gap.at[0], faults.gap.at[1]), faults.gap.at[2] - .3));
  assert_volume("it", &faults.gap, 4e-6 / 3 * SHB_PI, 1e-4);
  assert_relative(faults.gap.volume, 4e-6 / 3 * SHB_PI, 2e-3);
  assert_true(faults.gap.farthest > 0 && faults.gap.farthest < 2e-4);
  assert_near(hypot(hypot(faults.gap.at[0], faults.gap.at[1]), faults.gap.at[2] - .3), .01,
              1.01 * faults.gap.farthest);
  mesh_fe_free(&mesh);
}

/* Nodes on a circle of the surface. */
static int on_circle(const mesh_fe *mesh, double radius, double height) {
  int n = 0;
  for (int i = 0; i < mesh->n_nodes; i++) {
    const double *x = mesh->coordinates + 3 * (size_t)i;
    n += fabs(hypot(x[0], x[1]) - radius) < 1e-6 && fabs(x[2] - height) < 1e-6;
  }
  return n;
}

static void a_turn_has_the_elements_that_were_asked(void **state) {
  (void)state;
  static const int each[] = {8, 12, 20};
  for (int i = 0; i < 3; i++) {
    const mesh_source source =
        put("rod.geo", .02, each[i], "Cylinder(1) = {0, 0, 300, 0, 0, 30, 10};\n");
    mesh_fe mesh;
    mesh_of(&source, &mesh);
    const int n = on_circle(&mesh, 10, 300) / 2;
    print_message("%d elements a turn asked, %d made\n", each[i], n);
    assert_in_range(n, each[i], 2 * each[i] + 1);
    mesh_fe_free(&mesh);
  }
}

/* A tip has curvature without bound: the least size ends the refinement. */
static void a_cone_is_meshed(void **state) {
  (void)state;
  const mesh_source source = put("cone.geo", 8e-3, 12, "Cone(1) = {0, 0, 300, 0, 0, 30, 10, 0};\n");
  mesh_fe           mesh;
  mesh_solid_faults faults = mesh_of(&source, &mesh);
  print_message("a cone with 12 elements a turn: %d nodes\n", mesh.n_nodes);
  assert_in_range(mesh.n_nodes, 300, 60000);
  assert_volume("it", &faults.gap, SHB_PI * 1e-6, 1e-2);
  mesh_fe_free(&mesh);
}

/* A lofted airfoil with a sharp nose. Coarse elements across the nose are inverted at first. */
static const char airfoil[] =
    "For s In {0:1}\n  p = newp;\n  For i In {0:19}\n    a = 2*Pi*i/20;\n"
    "    Point(p + i) = {15*Cos(a), 3*Sin(a)*(1 + 0.3*Cos(a)) - 4*s*Cos(a), 300 + 50*s};\n"
    "  EndFor\n  BSpline(s + 1) = {p:p + 19, p};\n  Curve Loop(s + 1) = {s + 1};\nEndFor\n"
    "ThruSections(1) = {1, 2};\n";

/* Area of its sections, mm2: 1/2 of the integral of x dy - y dx over a cubic B-spline of uniform
 * knots. The shear between the sections keeps it. */
static double airfoil_area(void) {
  static const double overlap[3] = {245. / 720, 56. / 720, 1. / 720};
  double              area       = 0;
  for (int i = 0; i < 20; i++)
    for (int k = 1; k <= 3; k++) {
      const double a = SHB_TWO_PI * i / 20, b = SHB_TWO_PI * (i + k) / 20;
      area += overlap[k - 1] * 45 *
              (cos(a) * sin(b) * (1 + .3 * cos(b)) - cos(b) * sin(a) * (1 + .3 * cos(a)));
    }
  return area;
}

static void straightened_elements_are_told_with_their_place(void **state) {
  (void)state;
  mesh_fe           mesh;
  mesh_source       source = put("airfoil.geo", 2e-3, 0, airfoil);
  mesh_solid_faults coarse = mesh_of(&source, &mesh);
  print_message(
      "airfoil, 2 mm: %d of %d straightened, %d nodes up to %.2g mm at (%.4g, %.4g, %.4g) "
      "m\n",
      coarse.straightened, mesh.n_elements, coarse.moved, 1e3 * coarse.farthest, coarse.at[0],
      coarse.at[1], coarse.at[2]);
  mesh_fe_free(&mesh);
  assert_true(coarse.straightened > 0 && coarse.moved > 0);
  assert_true(fabs(coarse.at[0]) < .0151 && coarse.at[2] > .2999 && coarse.at[2] < .3501);
  source.curvature         = 6;
  mesh_solid_faults curved = mesh_of(&source, &mesh);
  mesh_fe_free(&mesh);
  print_message("with 6 elements a turn: %d straightened\n", curved.straightened);
  const double exact = 50e-9 * airfoil_area();
  assert_volume("2 mm", &coarse.gap, exact, 1e-2);
  assert_volume("6 a turn", &curved.gap, exact, 5e-3);
  assert_true(fabs(curved.gap.volume / exact - 1) < 0.6 * fabs(coarse.gap.volume / exact - 1));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_solid_without_elements_is_told_with_its_place_and_reason),
      cmocka_unit_test(finer_triangles_on_curved_faces_mesh_that_solid),
      cmocka_unit_test(a_ball_keeps_its_volume),
      cmocka_unit_test(a_turn_has_the_elements_that_were_asked),
      cmocka_unit_test(a_cone_is_meshed),
      cmocka_unit_test(straightened_elements_are_told_with_their_place),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
