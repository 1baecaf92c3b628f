/* No curve has a gap: stiff and weak friction, preloads from a gap to stuck, contacts to ground and
 * around rings. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

/* Curves that do not cover the range; each is told. */
static int gaps(const modal_model *model, mhb_settings *s, double from, double to, int *points) {
  mhb_response *r = NULL;
  int           n = 0;
  s->frequency[0] = from / SHB_TWO_PI;
  s->frequency[1] = to / SHB_TWO_PI;
  mhb_forced_response(model, s, NULL, NULL, NULL, &r);
  if (!r) fail_msg("%s", shb_message());
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    *points += b->n_points;
    n += !b->complete;
    if (!b->complete)
      print_message("  mu %g n0 %g, %d points: %s\n", s->mu, s->n0[i - 2], b->n_points, b->reason);
  }
  mhb_response_destroy(r);
  return n;
}

static void three_degrees(void **state) {
  (void)state;
  static const double mu[] = {.05, .4, 1, 3, 8, 30},
                      n0[] = {-.4, -.2, -.05, 0, .02, .05, .1, .15, .2, .3, .4, .5, .7, 1, 1.5, 2};
  modal_model model;
  int         points = 0;
  three_degree_model(&model);
  for (int i = 0; i < 6; i++) {
    mhb_settings s = ground_settings(mu[i], .8, .5, 0, 5);
    s.n_preloads   = 16;
    memcpy(s.n0, n0, sizeof n0);
    int n = gaps(&model, &s, .8, 1.7, &points);
    verdict_count(n, 0, "three degrees, mu %g: gaps in 16 curves", mu[i]);
  }
  print_message("  %d points\n", points);
  modal_model_free(&model);
  verdict_all();
}

static void beam(void **state) {
  (void)state;
  static const double n0[] = {-20, 0, 5, 20, 50, 100, 200, 400}, force[] = {8, 20};
  int                 points = 0;
  for (int i = 0; i < 4; i++) {
    modal_model model;
    tip_contact_beam_model(force[i / 2], &model);
    mhb_settings s = ground_settings(i % 2 ? 3 : .3, 2e5, 2e5, 100, 7);
    s.n_preloads   = 8;
    memcpy(s.n0, n0, sizeof n0);
    int n = gaps(&model, &s, SHB_TWO_PI * 190, SHB_TWO_PI * 320, &points);
    verdict_count(n, 0, "beam, F %g mu %g: gaps in 8 curves", force[i / 2], s.mu);
    modal_model_free(&model);
  }
  print_message("  %d points\n", points);
  verdict_all();
}

static void rings(void **state) {
  (void)state;
  static const double n0[]   = {-.05, 0, .03, .1, .2, .4};
  int                 points = 0, n = 0;
  for (unsigned i = 0; i < 12; i++) {
    modal_model  model;
    mhb_settings s = random_settings(i % 3 ? 3 : 5);
    random_model(1 + (int)(i % 2),
                 WITH_LEFT | WITH_NORMALS | WITH_AREAS | (i % 4 ? WITH_RESIDUAL : 0), 50 + i,
                 &model);
    s.tolerance    = 1e-8;
    s.engine_order = 1 + (int)(i % 3);
    s.n_preloads   = 6;
    memcpy(s.n0, n0, sizeof n0);
    n += gaps(&model, &s, .7, 2, &points);
    modal_model_free(&model);
  }
  verdict_count(n, 0, "12 rings: gaps in 72 curves, %d points", points);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_degrees),
      cmocka_unit_test(beam),
      cmocka_unit_test(rings),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
