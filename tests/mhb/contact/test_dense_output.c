/* The pieces of a period: what is kept, where one ends, the polynomial of a slip panel. */
#include "mesh/base/constants.h"
#include "mhb/contact/dense_output.h"
#include "tests/support/check.h"

enum { M = 2, SIZE = 2 * M + 1 };

typedef struct {
  mhb_signals      signals;
  mhb_collocation  rule;
  mhb_dense_output output;
} fixture;

/* n = 2 + cos t, x = (3 cos t, -sin t) */
static void start(fixture *f) {
  const double n[SIZE] = {2, 1}, x1[SIZE] = {0, 3}, x2[SIZE] = {0, 0, 1};
  assert_ok(mhb_collocation_create(&f->rule));
  assert_ok(mhb_signals_create(M, &f->signals));
  mhb_signals_set(&f->signals, (const double *const[3]){n, x1, x2});
  assert_ok(mhb_dense_output_create(&f->rule, &f->output));
  f->output.signals = &f->signals;
  f->output.mu      = .5;
  f->output.enabled = 1;
}

static void stop(fixture *f) {
  mhb_dense_output_destroy(&f->output);
  mhb_signals_destroy(&f->signals);
}

/* A polynomial of degree 8 passes through start and nodes as it is. */
static double angle(double s) {
  return .3 + s * (1 - s * (.7 - s * s * (.2 + s * s * s * (.1 - .4 * s))));
}

static mhb_panel panel_of(const fixture *f, double t0, double h) {
  mhb_panel p = {.t0 = t0, .h = h, .theta0 = angle(0)};
  for (int i = 0; i < MHB_NODES; i++) p.theta[i] = angle(f->rule.node[i]);
  return p;
}

static void pieces_are_found_and_evaluated(void **state) {
  (void)state;
  fixture f;
  double  force[3], z[2] = {.7, -.2};
  start(&f);
  mhb_panel p = panel_of(&f, 1.5, 2);
  mhb_dense_output_stick(&f.output, .5, z);
  mhb_dense_output_slip(&f.output, &p);
  mhb_dense_output_open(&f.output, 3.5);
  for (double t = .5; t < 6.7; t += .09) {
    mhb_state now = mhb_dense_output_at(&f.output, t, force);
    if (t < 1.5) {
      assert_int_equal(now, MHB_STICK);
      assert_near(force[0], 2 + cos(t), 1e-14);
      assert_near(force[1], 3 * cos(t) - .7, 1e-14);
      assert_near(force[2], -sin(t) + .2, 1e-14);
    } else if (t < 3.5) {
      double theta = angle((t - 1.5) / 2), limit = .5 * (2 + cos(t));
      assert_int_equal(now, MHB_SLIDE);
      assert_near(force[1], limit * cos(theta), 1e-13);
      assert_near(force[2], limit * sin(theta), 1e-13);
    } else {
      assert_int_equal(now, MHB_SEPARATE);
      assert_near(force[0], 0, 0);
    }
  }
  /* before the first piece: one period on, where it is open */
  assert_int_equal(mhb_dense_output_at(&f.output, .1, force), MHB_SEPARATE);
  /* at a node, where the barycentric formula has no denominator */
  mhb_dense_output_at(&f.output, 1.5 + 2 * f.rule.node[3], force);
  assert_near(atan2(force[2], force[1]), angle(f.rule.node[3]), 1e-13);
  stop(&f);
}

static void only_what_is_wanted_is_kept(void **state) {
  (void)state;
  fixture f;
  double  force[3], z[2] = {0, 0};
  start(&f);
  assert_int_equal(mhb_dense_output_at(&f.output, 1, force), MHB_SEPARATE); /* no piece */
  mhb_panel empty = {.h = 0};
  mhb_dense_output_slip(&f.output, &empty);
  f.output.enabled = 0;
  mhb_dense_output_stick(&f.output, 0, z);
  assert_int_equal(f.output.n, 0);
  stop(&f);
}

static void no_room_is_told(void **state) {
  (void)state;
  fixture f;
  double  z[2] = {0, 0};
  start(&f);
  for (int i = 0; i < MHB_MAX_PIECES; i++) mhb_dense_output_stick(&f.output, 1e-4 * i, z);
  assert_false(f.output.full);
  mhb_dense_output_open(&f.output, 6);
  assert_true(f.output.full);
  assert_int_equal(f.output.n, MHB_MAX_PIECES);
  stop(&f);
}

static void without_friction_only_the_load_acts(void **state) {
  (void)state;
  fixture f;
  double  force[3];
  start(&f);
  f.output.mu = 0;
  mhb_dense_output_frictionless(&f.output, 0);
  assert_int_equal(mhb_dense_output_at(&f.output, 4, force), MHB_SLIDE);
  assert_near(force[0], 2 + cos(4), 1e-14);
  assert_near(hypot(force[1], force[2]), 0, 0);
  stop(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pieces_are_found_and_evaluated),
      cmocka_unit_test(only_what_is_wanted_is_kept),
      cmocka_unit_test(no_room_is_told),
      cmocka_unit_test(without_friction_only_the_load_acts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
