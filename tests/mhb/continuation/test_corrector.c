/* Newton's method in a plane across a curve: its plane, order, damping and failures; tangents. */
#include "mhb/continuation/corrector.h"

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/scalar_curve.h"

/* What linearise has seen, call by call. */
static struct {
  void (*linearise)(mhb_curve_system *system, mhb_curve_point *point);
  int    n;
  double x[64], value[64], r[64];
} seen;

static void note(mhb_curve_system *system, mhb_curve_point *point) {
  seen.linearise(system, point);
  if (seen.n == 64) return;
  seen.x[seen.n]     = point->x[0];
  seen.value[seen.n] = point->value;
  seen.r[seen.n++]   = fabs(point->r[0]);
}

/* A curve whose linearisations are noted, with current at (x, value). */
static mhb_arclength *noted(scalar_function f, double x, double value) {
  mhb_arclength *curve  = scalar_curve(f, -1, 1);
  seen.n                = 0;
  seen.linearise        = curve->system->linearise;
  curve->system->smooth = false; /* no chord steps */
  curve->current.x[0]   = x;
  curve->current.value  = value;
  return curve;
}

/* next <- the solution in the plane through (x, value). */
static int correct(mhb_arclength *curve, const double normal[2], double clip, double x,
                   double value) {
  curve->system->linearise = note;
  curve->next.x[0]         = x;
  curve->next.value        = value;
  return mhb_arclength_correct(curve, normal, clip, &curve->next);
}

static void lengths_are_those_of_y(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_circle, -1, 3);
  const double   a[] = {2, 3}, b[] = {5, 7};
  curve->current.x[0]  = -2.5;
  curve->current.value = -0.5;
  assert_true(mhb_arclength_unit(curve) == 2.5);
  assert_near(mhb_arclength_inner(curve, 2.5, a, b), 10 / 6.25 + 21 / 16., 1e-15);
  assert_true(mhb_arclength_size(curve) == 4); /* of the range */
  curve->current.value = -6;
  assert_true(mhb_arclength_size(curve) == 6); /* of the value, which is more */
  curve->system->relative = true;
  curve->current.value    = 0.25;
  assert_true(mhb_arclength_size(curve) == 0.25);
  curve->current.x[0]      = 0; /* at rest */
  curve->amplitude_at_rest = 7;
  assert_true(mhb_arclength_unit(curve) == 7);
  curve->current.value = 2; /* f = 9 + 4 - 1 */
  mhb_arclength_measure(curve, &curve->current);
  assert_near(curve->current.residual, 12. / 7, 1e-15);
  mhb_arclength_destroy(curve);
}

static void the_solution_lies_in_the_plane(void **state) {
  (void)state;
  static const double normals[][2] = {{1, 0}, {0, 1}, {1, 1}, {2, -0.3}};
  for (int i = 0; i < 4; i++) {
    const double  *normal = normals[i];
    mhb_arclength *curve  = noted(scalar_circle, 4, 0);
    /* off the circle, and off the plane through its centre */
    const double x = 3.8, value = 0.7;
    assert_true(correct(curve, normal, 1, x, value));
    const mhb_curve_point *next   = &curve->next;
    const double           away[] = {next->x[0] - x, next->value - value};
    assert_below(next->residual, curve->tolerance);
    assert_small(mhb_arclength_inner(curve, 4, normal, away), 1e-14);
    assert_small(hypot(next->x[0] - 3, next->value) - 1, 1e-9);
    mhb_arclength_destroy(curve);
  }
}

/* r_{i+1} = O(r_i^2): the order is the ratio of the logarithms of successive reductions. */
static void newton_is_of_second_order(void **state) {
  (void)state;
  const double   normal[] = {0, 1};
  mhb_arclength *curve    = noted(scalar_circle, 4, 0);
  curve->tolerance        = 1e-14;
  assert_true(correct(curve, normal, 10, 5, 0.5));
  int    n    = seen.n;
  double last = 0;
  assert_true(n >= 5);
  for (int i = 2; i < n && seen.r[i] > 1e-12; i++) {
    double order = log(seen.r[i] / seen.r[i - 1]) / log(seen.r[i - 1] / seen.r[i - 2]);
    print_message("residual %.2e, order %.3f\n", seen.r[i], order);
    last = order;
  }
  assert_near(last, 2, 0.05);
  assert_int_equal(curve->next.iterations, n - 1);
  mhb_arclength_destroy(curve);
}

/* Chord steps come to the same point with fewer linearisations. */
static void chord_steps_save_linearisations(void **state) {
  (void)state;
  const double normal[] = {0, 1};
  double       x[2];
  int          n[2];
  for (int smooth = 0; smooth < 2; smooth++) {
    mhb_arclength *curve  = noted(scalar_circle, 4, 0);
    curve->system->smooth = smooth;
    assert_true(correct(curve, normal, 1, 3.88, 0.5));
    assert_below(curve->next.residual, curve->tolerance);
    x[smooth] = curve->next.x[0];
    n[smooth] = seen.n;
    mhb_arclength_destroy(curve);
  }
  print_message("linearisations: %d, with chord steps %d\n", n[0], n[1]);
  assert_true(n[1] < n[0]);
  assert_near(x[0], x[1], 1e-9);
}

static void the_first_correction_is_clipped(void **state) {
  (void)state;
  static const double clip[]   = {0.02, 0.05, 1};
  const double        normal[] = {0, 1};
  for (int i = 0; i < 3; i++) {
    mhb_arclength *curve = noted(scalar_circle, 4, 0);
    assert_true(correct(curve, normal, clip[i], 4.5, 0.5));
    double moved = fabs(seen.x[1] - seen.x[0]) / 4;
    if (i < 2)
      assert_near(moved, clip[i], 1e-14);
    else
      assert_true(moved < 0.3);
    mhb_arclength_destroy(curve);
  }
}

/* atan(3 (x - 2)): Newton's method overshoots, so the correction is halved until |f| falls. */
static double overshooting(double x, double value, double *f_x, double *f_value) {
  (void)value;
  double y = 3 * (x - 2);
  *f_x     = 3 / (1 + y * y);
  *f_value = 0;
  return atan(y);
}

static void a_correction_is_halved_while_the_residual_grows(void **state) {
  (void)state;
  const double   normal[] = {0, 1};
  mhb_arclength *curve    = noted(overshooting, 2, 0);
  assert_true(correct(curve, normal, 10, 2.7, 0));
  assert_near(curve->next.x[0], 2, 1e-9);
  /* the first try is farther off on the other side, the second half way back */
  assert_true(seen.r[1] > seen.r[0] && seen.x[1] < 2);
  assert_near(seen.x[2], 0.5 * (seen.x[0] + seen.x[1]), 1e-14);
  mhb_arclength_destroy(curve);
}

/* The line, with a residual of 5e-9 at least, as round-off leaves it. */
static double rounded(double x, double value, double *f_x, double *f_value) {
  double f = scalar_line(x, value, f_x, f_value);
  return f + copysign(5e-9, f);
}

static void stagnation_at_round_off_is_accepted(void **state) {
  (void)state;
  const double   normal[] = {0, 1};
  mhb_arclength *curve    = noted(rounded, 2, 0);
  assert_true(correct(curve, normal, 1, 2.2, 0));
  assert_true(curve->next.residual > curve->tolerance);
  assert_below(curve->next.residual, curve->roundoff_level);
  curve->roundoff_level = 1e-10;
  assert_false(correct(curve, normal, 1, 2.2, 0));
  mhb_arclength_destroy(curve);
}

/* ---- what does not converge ---- */

/* A jump at x = 2 between faces whose steps lead to each other: |f|/|x| stays. */
static double alternating(double x, double value, double *f_x, double *f_value) {
  (void)value;
  *f_x     = 1.25 * x;
  *f_value = 0;
  return x > 2 ? 0.25 * x : -0.25 * x;
}

static double not_a_number(double x, double value, double *f_x, double *f_value) {
  (void)x;
  (void)value;
  *f_x = *f_value = 1;
  return NAN;
}

static double constant(double x, double value, double *f_x, double *f_value) {
  (void)x;
  (void)value;
  *f_x = *f_value = 0;
  return 1;
}

static void failures_are_told(void **state) {
  (void)state;
  static const struct {
    scalar_function f;
    double          least;
    int             most; /* linearisations */
  } row[]               = {{scalar_nowhere, -INFINITY, 64},
                           {not_a_number, -INFINITY, 4},
                           {constant, -INFINITY, 1},
                           {alternating, -INFINITY, 8},
                           {scalar_line, 0.19, 2}}; /* the solution is at 0.1 */
  const double normal[] = {1, 0};
  for (int i = 0; i < 5; i++) {
    const double   fixed_value[] = {0, 1};
    mhb_arclength *curve         = noted(row[i].f, 2, 0);
    curve->system->least         = row[i].least;
    assert_false(correct(curve, i < 4 ? fixed_value : normal, 1, 2.1, 0.2));
    print_message("%d linearisations\n", seen.n);
    assert_true(seen.n <= row[i].most);
    mhb_arclength_destroy(curve);
  }
}

/* ---- tangents ---- */

/* At an angle a of the circle the tangent is (-sin a, cos a), of length 1 in y. */
static void the_tangent_touches_the_curve(void **state) {
  (void)state;
  for (int i = 0; i < 12; i++) {
    double         a     = 0.1 + i * SHB_PI / 6;
    mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
    curve->current.x[0]  = 3 + cos(a);
    scalar_point(curve, 3 + cos(a), sin(a), -sin(a), cos(a), &curve->current);
    const double *t = curve->current.tangent, along[] = {sin(a), -cos(a)};
    double        length = mhb_arclength_inner(curve, mhb_arclength_unit(curve), t, t);
    assert_near(length, 1, 1e-14);
    assert_near(t[0] * cos(a) + t[1] * sin(a), 0, 1e-14);
    assert_true(t[1] * cos(a) - t[0] * sin(a) > 0); /* in the sense asked for */
    int orientation = curve->current.orientation;
    assert_true(mhb_arclength_set_tangent(curve, along, &curve->current));
    assert_int_equal(curve->current.orientation, -orientation);
    mhb_arclength_destroy(curve);
  }
}

/* det [J slope; tangent] keeps its sign along a regular curve, also past folds. */
static void the_orientation_is_constant(void **state) {
  (void)state;
  mhb_arclength *curve = scalar_curve(scalar_circle, -2, 2);
  int            first = 0;
  for (int i = 0; i < 40; i++) {
    double a = i * SHB_PI / 20;
    scalar_point(curve, 3 + cos(a), sin(a), -sin(a), cos(a), &curve->next);
    if (i == 0) first = curve->next.orientation;
    assert_int_equal(curve->next.orientation, first);
  }
  mhb_arclength_destroy(curve);
}

static void a_cusp_has_no_tangent(void **state) {
  (void)state;
  const double   along[] = {0, 1};
  mhb_arclength *curve   = scalar_curve(scalar_cusp, -1, 1);
  curve->current.x[0]    = 2;
  curve->current.value   = 0;
  mhb_arclength_measure(curve, &curve->current);
  assert_false(mhb_arclength_set_tangent(curve, along, &curve->current));
  mhb_arclength_destroy(curve);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lengths_are_those_of_y),
      cmocka_unit_test(the_solution_lies_in_the_plane),
      cmocka_unit_test(newton_is_of_second_order),
      cmocka_unit_test(chord_steps_save_linearisations),
      cmocka_unit_test(the_first_correction_is_clipped),
      cmocka_unit_test(a_correction_is_halved_while_the_residual_grows),
      cmocka_unit_test(stagnation_at_round_off_is_accepted),
      cmocka_unit_test(failures_are_told),
      cmocka_unit_test(the_tangent_touches_the_curve),
      cmocka_unit_test(the_orientation_is_constant),
      cmocka_unit_test(a_cusp_has_no_tangent)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
