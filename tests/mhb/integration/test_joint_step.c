/* Joint steps, in which contacts change their states, against steps that end there. */
#include <math.h>
#include <stdlib.h>

#include "mesh/base/constants.h"
#include "mhb/integration/steady_state.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { PERIODS = 12, LEVELS = 4 };

/* What a transient from rest is after some periods. */
typedef struct {
  mhb_integrator      *g;
  double              *state;
  mhb_integrator_count count;
} transient;

static transient run(const modal_model *model, const mhb_settings *s, double w, bool joint,
                     int steps) {
  transient t;
  assert_ok(mhb_integrator_create_as(model, s, 7, joint, &t.g));
  mhb_integrator_set(t.g, w, s->n0[0], steps);
  mhb_integrator_rest(t.g);
  for (int i = 0; i < PERIODS; i++) assert_true(mhb_integrator_period(t.g));
  t.count = t.g->count;
  t.state = malloc(sizeof(double) * (size_t)mhb_integrator_size(t.g));
  assert_non_null(t.state);
  mhb_integrator_get(t.g, t.state);
  return t;
}

static void finish(transient *t) {
  free(t->state);
  mhb_integrator_destroy(t->g);
}

/* Errors of joint steps against many steps that end at events: their order over the first levels,
 * and the last error. Steps of either way miss changes of state that are too brief, which leaves up
 * to 7e-9 here. */
static void compare(const char *name, const modal_model *model, const mhb_settings *s, double w,
                    int fewest, double goal) {
  double    error[LEVELS];
  transient exact = run(model, s, w, false, 16 * fewest);
  for (int k = 0; k < LEVELS; k++) {
    transient t = run(model, s, w, true, fewest << k);
    error[k]    = mhb_steady_state_distance(t.g, t.state, exact.state);
    print_message("%s, %4d steps: %.1f events a period, %.1e\n", name, fewest << k,
                  (double)t.count.events / PERIODS, error[k]);
    assert_int_equal(t.count.steps, (fewest << k) * PERIODS);
    finish(&t);
  }
  assert_true(exact.count.events > PERIODS);
  double order = log2(error[0] / error[LEVELS - 2]) / (LEVELS - 2);
  print_message("%s: order %.2f\n", name, order);
  assert_true(order > 3);
  assert_true(error[LEVELS - 1] < goal);
  finish(&exact);
}

/* One pair that sticks, slips and opens. */
static void three_degrees(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(.4, .8, .5, .3, 7);
  three_degree_model(&model);
  compare("three degrees", &model, &s, 1.42, 48, 1e-10);
  modal_model_free(&model);
}

/* Two pairs with skew springs and residual flexibility between them. */
static void two_pairs(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(7);
  s.to_ground    = true;
  s.scale        = 3;
  random_model(2, WITH_RESIDUAL, 11, &model);
  free(model.residual_inertia);
  free(model.residual_fourth);
  model.residual_inertia = model.residual_fourth = NULL;
  compare("two pairs", &model, &s, 1.1, 48, 1e-8);
  modal_model_free(&model);
}

/* A ring of five blades. */
static void ring(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(7);
  s.blades       = 5;
  s.engine_order = 1;
  s.scale        = 3;
  random_model(2, WITH_LEFT, 11, &model);
  compare("ring", &model, &s, 1.1, 48, 1e-8);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(three_degrees), cmocka_unit_test(two_pairs),
                                     cmocka_unit_test(ring)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
