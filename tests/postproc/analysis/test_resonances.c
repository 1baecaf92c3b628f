/* Peaks joined to resonances: heights that change places, a peak that is missing, small ones. */
#include "postproc/analysis/resonances.h"

#include <math.h>
#include <stdlib.h>

#include "tests/support/check.h"
#include "tests/support/fixture.h"

enum { PRELOADS = 7 };
static const double n0[PRELOADS] = {10, 20, 40, 80, 160, 320, 640};

/* Where a resonance is and how high, at x from 0 (open) to 1 (stuck). */
static double first_place(double x) {
  return 98 + 9 * x;
}
static double second_place(double x) {
  return 117 + 12 * x;
}
static double first_height(double x) {
  return 3 - 2.4 * x + 2 * x * x;
}
static double second_height(double x) {
  return 0.8 + 2.8 * x * x;
}

static double bell(double f, double at, double height, double width) {
  return height / (1 + pow((f - at) / width, 2));
}

typedef struct {
  mhb_response   *response;
  post_analysis  *analysis;
  double        **values;
  post_resonances found;
} curves;

/* x of a branch: open 0, the preloads 1/8 ... 7/8, stuck 1. */
static double share_of(const post_analysis *a, int b) {
  const post_group *g = &a->group[a->curve[b].group];
  if (g->kind == MHB_BRANCH_OPEN) return 0;
  if (g->kind == MHB_BRANCH_STUCK) return 1;
  return (g->rank + 1) / 8.;
}

/*   missing  in  rank of a preload without the second peak; -1: none
 *   extra    in  preloads with a third, small peak below both */
static void set_up(int missing, int extra, curves *c) {
  fixture_options o = fixture_usual();
  o.n_preloads      = PRELOADS;
  o.n0              = n0;
  o.n_points        = 401;
  o.incomplete      = false;
  c->response       = fixture_response(&o);
  assert_non_null(c->response);
  assert_ok(post_analysis_create(c->response, &c->analysis));
  assert_ok(
      post_values(c->response, c->analysis->primary, POST_QUANTITY_FIRST_HARMONIC, &c->values));
  for (int b = 0; b < c->response->n_branches; b++) {
    const double x    = share_of(c->analysis, b);
    const int    rank = c->analysis->group[c->analysis->curve[b].group].rank;
    for (int i = 0; i < c->response->branch[b].n_points; i++) {
      double f                            = 85 + 0.12 * i;
      c->response->branch[b].frequency[i] = f;
      c->values[b][i]                     = bell(f, first_place(x), first_height(x), 0.5);
      if (rank != missing || rank < 0)
        c->values[b][i] += bell(f, second_place(x), second_height(x), 0.5);
      if (rank >= 0 && rank < extra) c->values[b][i] += bell(f, 90, 0.4, 0.3);
    }
  }
  assert_ok(post_resonances_find(c->analysis, c->values, &c->found));
}

static void tear_down(curves *c) {
  post_resonances_free(&c->found);
  post_values_free(c->response, c->values);
  post_analysis_destroy(c->analysis);
  mhb_response_destroy(c->response);
}

static void check(const post_tracking *t, int n, double (*place)(double),
                  double (*height)(double)) {
  assert_int_equal(t->n, n);
  assert_near(t->open.at, place(0), 0.05);
  assert_near(t->stuck.at, place(1), 0.05);
  for (int i = 0; i < t->n; i++) {
    double x = 0;
    for (int k = 0; k < PRELOADS; k++)
      if (t->point[i].n0 == n0[k]) x = (k + 1) / 8.;
    assert_near(t->point[i].at, place(x), 0.05);
    assert_near(t->point[i].amplitude, height(x), 0.06);
  }
}

/* The higher peak changes from the first to the second on the way. */
static void heights_change_places(void **state) {
  (void)state;
  curves c;
  set_up(-1, 0, &c);
  assert_int_equal(c.found.n, 2);
  check(&c.found.list[0], PRELOADS, first_place, first_height);
  check(&c.found.list[1], PRELOADS, second_place, second_height);
  assert_near(c.found.list[0].point[c.found.list[0].best].n0, n0[4], 0); /* least near x = 0.6 */
  assert_int_equal(c.found.list[1].best, 0);
  const post_track_point *p = &c.found.list[1].point[3];
  assert_int_equal(post_resonance_of(&c.found, p->branch, p->point), 1);
  assert_int_equal(post_resonance_of(&c.found, p->branch, 0), -1);
  tear_down(&c);
}

static void a_peak_may_be_missing(void **state) {
  (void)state;
  curves c;
  set_up(3, 0, &c);
  assert_int_equal(c.found.n, 2);
  check(&c.found.list[0], PRELOADS, first_place, first_height);
  check(&c.found.list[1], PRELOADS - 1, second_place, second_height);
  tear_down(&c);
}

static void small_peaks_of_some_preloads_are_left_out(void **state) {
  (void)state;
  curves c;
  set_up(-1, 3, &c);
  assert_int_equal(c.found.n, 2);
  check(&c.found.list[0], PRELOADS, first_place, first_height);
  check(&c.found.list[1], PRELOADS, second_place, second_height);
  tear_down(&c);
  set_up(-1, 4, &c); /* at most of the preloads: a resonance of its own */
  assert_int_equal(c.found.n, 3);
  assert_near(c.found.list[0].point[0].at, 90, 0.05);
  tear_down(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(heights_change_places),
                                     cmocka_unit_test(a_peak_may_be_missing),
                                     cmocka_unit_test(small_peaks_of_some_preloads_are_left_out)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
