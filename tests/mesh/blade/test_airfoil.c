/* Outlines of airfoil sections against their equations, and sections that are none. */
#include "mesh/blade/airfoil.h"

#include "tests/support/check.h"

enum { N = MESH_AIRFOIL_POINTS };

static mesh_blade straight(double camber, double twist) {
  return (mesh_blade){
      .n_sections       = 2,
      .section          = {{0.3, 0.05, 0.006, camber, twist}, {0.4, 0.04, 0.004, camber, twist}},
      .root_height      = 0.02,
      .shroud_thickness = 0.006};
}

/* Chord, greatest thickness and camber of the section, seen in its own axes. */
static void outlines_have_the_section_s_numbers(void **state) {
  (void)state;
  const double     twist = 0.4;
  const mesh_blade blade = straight(0.005, twist);
  mesh_outline     outline;
  double           thickest = 0, xi[2];
  mesh_airfoil_outline(&blade, &blade.section[0], &outline);
  for (int i = 0; i < N; i++) {
    const double *s = outline.suction[i], *p = outline.pressure[i];
    assert_near(s[2], 0.3, 0);
    thickest = fmax(thickest, hypot(s[0] - p[0], s[1] - p[1]));
  }
  assert_true(thickest > 0.0059 && thickest <= 0.006 * (1 + 1e-12));
  for (int k = 0; k < 2; k++) {
    const double *edge = outline.suction[k ? N - 1 : 0], *other = outline.pressure[k ? N - 1 : 0];
    assert_near(hypot(edge[0] - other[0], edge[1] - other[1]), 0, 1e-16);
    xi[k] = sin(twist) * edge[0] + cos(twist) * edge[1];
  }
  assert_near(xi[1] - xi[0], 0.05, 1e-15);
  /* half way along the chord the camber line is camber above the chord */
  const double *s = outline.suction[N / 2], *p = outline.pressure[N / 2], *e = outline.suction[0];
  const double  eta =
      cos(twist) * ((s[0] + p[0]) / 2 - e[0]) - sin(twist) * ((s[1] + p[1]) / 2 - e[1]);
  assert_near(eta, 0.005, 1e-15);
}

/* Negative camber mirrors the section across its chord, suction side with it. */
static void camber_of_the_other_sign_mirrors(void **state) {
  (void)state;
  const mesh_blade one = straight(0.005, 0), other = straight(-0.005, 0);
  mesh_outline     a, b;
  mesh_airfoil_outline(&one, &one.section[0], &a);
  mesh_airfoil_outline(&other, &other.section[0], &b);
  for (int i = 0; i < N; i++) {
    assert_near(b.suction[i][0], -a.suction[i][0], 1e-17);
    assert_near(b.suction[i][1], a.suction[i][1], 1e-17);
    assert_near(b.pressure[i][0], -a.pressure[i][0], 1e-17);
  }
}

static void sections_are_linear_between_and_beyond(void **state) {
  (void)state;
  const mesh_blade blade = straight(0.005, 0.1);
  assert_near(mesh_airfoil_at(&blade, 0.35).chord, 0.045, 1e-16);
  assert_near(mesh_airfoil_at(&blade, 0.41).thickness, 0.0038, 1e-16);
  assert_near(mesh_airfoil_chord(&blade), 0.05, 0);
  assert_near(mesh_airfoil_low_radius(&blade), 0.3 - 0.006, 1e-16);
  assert_near(mesh_airfoil_high_radius(&blade), 0.4 + 0.003, 1e-16);
}

static void assert_airfoil_refused(const mesh_blade *blade, const char *words) {
  assert_int_equal(mesh_airfoil_check(blade), SHB_ERR_INPUT);
  assert_has(shb_message(), words);
}

static void sections_that_are_none_are_refused(void **state) {
  (void)state;
  mesh_blade blade = straight(0.005, 0);
  assert_ok(mesh_airfoil_check(&blade));
  blade.section[1].radius = 0.3;
  assert_airfoil_refused(&blade, "sections[1].radius: 300 mm is not above");
  blade                  = straight(0.005, 0);
  blade.section[0].chord = 0;
  assert_airfoil_refused(&blade, "sections[0].chord");
  blade                      = straight(0.005, 0);
  blade.section[1].thickness = 0.03;
  assert_airfoil_refused(&blade, "sections[1].thickness: 30 mm");
  blade                   = straight(0.005, 0);
  blade.section[1].camber = -0.005;
  assert_airfoil_refused(&blade, "bends the other way");
  blade                  = straight(0.005, 0);
  blade.section[0].twist = 1.5;
  assert_airfoil_refused(&blade, "between -80 and 80 deg");
  blade.n_sections = 1;
  assert_airfoil_refused(&blade, "2 to 16 are needed");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(outlines_have_the_section_s_numbers),
                                     cmocka_unit_test(camber_of_the_other_sign_mirrors),
                                     cmocka_unit_test(sections_are_linear_between_and_beyond),
                                     cmocka_unit_test(sections_that_are_none_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
