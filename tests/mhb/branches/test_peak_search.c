/* The small search of every run: where it looks, how many starts it makes, and what it finds. */
#include "mhb/branches/peak_search.h"

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/secondary_branches.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/scratch.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

/* ---- places ---- */

enum { POINTS = 11 };

/* A branch over 100 to 200 Hz: a probe's peak of the given size at point `top`. */
static void add_branch(mhb_response *r, mhb_branch_kind kind, int top, double size) {
  int index;
  index         = mhb_response_branch(r, kind);
  mhb_branch *b = &r->branch[index];
  for (int i = 0; i < POINTS; i++) {
    mhb_response_point(r, index);
    b->frequency[i] = b->value[i] = 100 + 10 * i;
    b->iterations[i]              = 100;
    b->probe[(size_t)i * 6 + 1]   = size / (1 + abs(i - top));
  }
}

static mhb_response *create(void) {
  mhb_response *r = mhb_response_create(1, 1, 1);
  assert_non_null(r);
  return r;
}

/* Three preloads: the lowest peak is the second's, the highest the third's. Peaks of the linear
 * limits and three values between them are places too. One at the end of the range is not, nor one
 * beside another place. */
static void the_lowest_and_the_highest_peak(void **state) {
  (void)state;
  static const int    top[]  = {3, 4, 7};
  static const double size[] = {2, 1, 3};
  mhb_response       *limits = create(), *own[3];
  mhb_peak_places     places[3];
  add_branch(limits, MHB_BRANCH_OPEN, 2, 9);
  add_branch(limits, MHB_BRANCH_STUCK, 7, 9);
  for (int i = 0; i < 3; i++) {
    own[i] = create();
    add_branch(own[i], MHB_BRANCH_NONLINEAR, top[i], size[i]);
  }
  mhb_peak_places_choose(limits, (const mhb_response *const *)own, 3, places);
  assert_int_equal(places[0].n, 0);
  static const double at[] = {140, 120, 170, 132.5, 145, 157.5};
  assert_int_equal(places[1].n, 6);
  for (int i = 0; i < 6; i++) assert_near(places[1].value[i], at[i], 1e-12);
  assert_int_equal(places[2].n, 5);
  assert_near(places[2].value[0], 170, 1e-12);
  assert_near(places[2].value[1], 120, 1e-12);
  assert_int_equal(places[1].starts, 3300 / 50 / 11);
  /* at the end of the range there is no resonance */
  for (int i = 0; i < POINTS; i++) limits->branch[0].probe[(size_t)i * 6 + 1] = i;
  mhb_peak_places_choose(limits, (const mhb_response *const *)own, 3, places);
  assert_int_equal(places[1].n, 2);
  /* one preload alone, and one that was not begun */
  const mhb_response *some[] = {NULL, own[1]};
  mhb_peak_places_choose(limits, some, 2, places);
  assert_int_equal(places[0].n, 0);
  assert_int_equal(places[1].n, 2);
  for (int i = 0; i < 3; i++) mhb_response_destroy(own[i]);
  mhb_response_destroy(limits);
}

/* Along another parameter than the frequency: the largest and the least output. */
static void along_another_parameter(void **state) {
  (void)state;
  mhb_response   *limits = create(), *own = create();
  mhb_peak_places places[1];
  own->parameter = limits->parameter = MHB_IN_N0;
  add_branch(limits, MHB_BRANCH_OPEN, 2, 9);
  add_branch(own, MHB_BRANCH_NONLINEAR, 6, 1);
  mhb_peak_places_choose(limits, (const mhb_response *const[]){own}, 1, places);
  assert_int_equal(places[0].n, 2);
  assert_near(places[0].value[0], 160, 1e-12);
  assert_near(places[0].value[1], 100, 1e-12);
  mhb_response_destroy(own);
  mhb_response_destroy(limits);
}

/* ---- what it finds ---- */

static mhb_settings small_gap(void) {
  mhb_settings s = ground_settings(0.05, 0.8, 0.5, -0.05, 9);
  s.frequency[0] = 0.8 / SHB_TWO_PI;
  s.frequency[1] = 1.7 / SHB_TWO_PI;
  return s;
}

/* Little friction and a small gap: beside the main branch there is a closed one, from 1.0125 to
 * 1.0382 rad/s. Starts within its range find it, and the record says so. */
static void a_detached_curve_is_found(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *own;
  double        value[] = {0.9 / SHB_TWO_PI, 1.025 / SHB_TWO_PI};
  mhb_settings  s       = small_gap();
  quiet_monitor monitor = quiet_monitor_create(0);
  three_degree_model(&model);
  assert_ok(main_curve(&model, &s, 9, NULL, &own));
  assert_ok(mhb_secondary_branches_at(&model, &s, own, 2, value, 20, &monitor.base));
  const mhb_branch *main = &own->branch[0];
  assert_int_equal(own->n_branches, 2);
  assert_int_equal(own->branch[1].origin, MHB_FROM_SEARCH);
  assert_string_equal(own->branch[1].reason, "closed curve");
  assert_int_equal(main->n_searches, 2);
  for (int i = 0; i < 2; i++) {
    assert_near(main->search[i].value, value[i], 1e-15);
    assert_int_equal(main->search[i].starts, 20);
    assert_int_equal(main->search[i].found, i);
  }
  mhb_response_destroy(own);
  modal_model_free(&model);
}

/* Outlines are solved to a coarse residual. Their closed curves end after one round all the same:
 * none has many more points than the exact one, whatever point it starts at. */
static void a_detached_curve_in_outline_closes(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *own;
  mhb_settings  s       = small_gap();
  quiet_monitor monitor = quiet_monitor_create(0);
  int           found = 0, most = 0;
  s.outline    = true;
  s.tolerance  = 1e-3;
  s.max_points = 2000;
  three_degree_model(&model);
  for (int i = 0; i < 3; i++) {
    double value = (1.014 + 0.008 * i) / SHB_TWO_PI;
    assert_ok(main_curve(&model, &s, 9, NULL, &own));
    assert_ok(mhb_secondary_branches_at(&model, &s, own, 1, &value, 20, &monitor.base));
    for (int k = 1; k < own->n_branches; k++) {
      assert_string_equal(own->branch[k].reason, "closed curve");
      most = own->branch[k].n_points > most ? own->branch[k].n_points : most;
      found++;
    }
    mhb_response_destroy(own);
  }
  print_message("%d closed curves, at most %d points\n", found, most);
  assert_true(found >= 2);
  assert_true(most < 200);
  modal_model_free(&model);
}

/* An outline has no linear limits. A sweep that covers its range succeeds without them, and one
 * that does not names its own curve. */
static void an_outline_is_judged_by_its_curves(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *r;
  mhb_settings  s = small_gap();
  s.outline       = true;
  s.search.starts = 0;
  three_degree_model(&model);
  assert_ok(mhb_forced_response(&model, &s, NULL, NULL, NULL, &r));
  assert_int_equal(r->branch[0].n_points, 0);
  mhb_response_destroy(r);
  s.max_points = 3;
  assert_int_equal(mhb_forced_response(&model, &s, NULL, NULL, NULL, &r), SHB_NOT_CONVERGED);
  assert_non_null(strstr(shb_message(), "branch 2 "));
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* What a stopped search found is dropped, with its records: a resumed run makes it anew. */
static void a_stopped_search_leaves_nothing(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *own;
  double        value   = 1.025 / SHB_TWO_PI;
  mhb_settings  s       = small_gap();
  quiet_monitor monitor = quiet_monitor_create(5);
  three_degree_model(&model);
  assert_ok(main_curve(&model, &s, 9, NULL, &own));
  assert_ok(mhb_secondary_branches_at(&model, &s, own, 1, &value, 20, &monitor.base));
  assert_int_equal(monitor.n_points, 5);
  assert_int_equal(own->n_branches, 1);
  assert_int_equal(own->branch[0].n_searches, 0);
  mhb_response_destroy(own);
  modal_model_free(&model);
}

/* Without being asked a run searches, and the file keeps what was searched. Told not to, it does
 * not. */
static void every_run_searches(void **state) {
  (void)state;
  static const shb_provenance none = {"", "", "", ""};
  char                        folder[SCRATCH_PATH], path[2 * SCRATCH_PATH];
  modal_model                 model;
  mhb_response               *r, *read;
  scratch_create(folder);
  snprintf(path, sizeof path, "%s/r.h5", folder);
  three_degree_model(&model);
  for (int searches = 0; searches < 2; searches++) {
    mhb_settings s  = small_gap();
    s.search.starts = searches ? MHB_SEARCH_PEAKS : 0;
    assert_ok(mhb_forced_response(&model, &s, path, &none, NULL, &r));
    assert_ok(mhb_response_read(path, &read));
    const mhb_branch *made = &r->branch[2], *kept = &read->branch[2];
    assert_int_equal(made->n_searches > 0, searches);
    assert_int_equal(made->n_searches, kept->n_searches);
    for (int i = 0; i < made->n_searches; i++) {
      assert_near(made->search[i].value, kept->search[i].value, 0);
      assert_int_equal(made->search[i].starts, kept->search[i].starts);
      assert_true(kept->search[i].starts > 0 && kept->search[i].order == 1);
    }
    mhb_response_destroy(read);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
  scratch_remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_lowest_and_the_highest_peak),
      cmocka_unit_test(along_another_parameter),
      cmocka_unit_test(a_detached_curve_is_found),
      cmocka_unit_test(a_detached_curve_in_outline_closes),
      cmocka_unit_test(an_outline_is_judged_by_its_curves),
      cmocka_unit_test(a_stopped_search_leaves_nothing),
      cmocka_unit_test(every_run_searches),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
