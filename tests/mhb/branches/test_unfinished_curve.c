/* A curve that was stopped goes on from its last point, and ends as the one that was not. All
 * numbers of all points agree to the bit, wherever it was stopped. */
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/response/response_fields.h"
#include "tests/support/check.h"
#include "tests/support/files.h"
#include "tests/support/main_curve.h"
#include "tests/support/quiet_monitor.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

/* A case: model, settings, highest number of harmonics. */
typedef struct {
  modal_model  model;
  mhb_settings settings;
  int          harmonics;
} curve_case;

static void set_range(mhb_settings *s, double from, double to) {
  s->frequency[0] = from / SHB_TWO_PI;
  s->frequency[1] = to / SHB_TWO_PI;
}

/* Fields in which the points differ, seconds aside. */
static int differences(const mhb_response *a, const mhb_response *b) {
  int n = 0;
  assert_int_equal(a->n_branches, b->n_branches);
  for (int i = 0; i < a->n_branches; i++) {
    const mhb_branch *p = &a->branch[i], *q = &b->branch[i];
    assert_int_equal(p->n_points, q->n_points);
    assert_string_equal(p->reason, q->reason);
    assert_true(p->complete == q->complete);
    for (int k = 0; k < MHB_N_FIELDS; k++) {
      const mhb_field *f = &mhb_fields[k];
      if (!mhb_field_kept(a, p, f) || strcmp(f->name, "seconds") == 0) continue;
      size_t    size    = mhb_field_row(a, p, f) * (size_t)p->n_points;
      const int differs = memcmp(mhb_field_get(p, f), mhb_field_get(q, f), size) != 0;
      if (differs) printf("%s differs\n", f->name);
      n += differs;
    }
  }
  return n;
}

/* What was stopped, after a way through a file. */
static mhb_response *through_a_file(mhb_response *stopped) {
  mhb_response *read;
  char          path[64];
  snprintf(path, sizeof path, "stopped_%d.response.h5", (int)getpid());
  assert_ok(mhb_response_write(stopped, path, &(shb_provenance){0}));
  assert_ok(mhb_response_read(path, &read));
  remove(path);
  mhb_response_destroy(stopped);
  return read;
}

/* Stop at point p, recorded or judged; go on, and compare with the whole curve.
 *   total  in  points that the whole curve records and judges
 * Returns the number of segments that were there when it stopped. */
static int stop_and_go_on(const curve_case *c, int p, bool file, const mhb_response *whole,
                          int total) {
  quiet_monitor stops = quiet_monitor_create(p), goes_on = quiet_monitor_create(0);
  mhb_response *stopped, *found;
  assert_ok(watched_main_curve(&c->model, &c->settings, c->harmonics, &stops.base, &stopped));
  assert_false(stopped->branch[0].complete);
  assert_non_null(stopped->branch[0].unfinished);
  if (file) stopped = through_a_file(stopped);
  const mhb_unfinished *unfinished = stopped->branch[0].unfinished;
  int                   segments = unfinished->n, kept = 0;
  for (int i = 0; i < segments; i++) kept += unfinished->segments->branch[i].n_points;
  assert_ok(
      continued_main_curve(&c->model, &c->settings, c->harmonics, &goes_on.base, stopped, &found));
  assert_int_equal(differences(whole, found), 0);
  assert_null(found->branch[0].unfinished);
  assert_true(kept >= (p < stops.n_points ? p : 1));
  assert_int_equal(goes_on.n_points, total - kept); /* no point is recorded twice */
  mhb_response_destroy(stopped);
  mhb_response_destroy(found);
  return segments;
}

/* Stop at some points from the first to the last.
 *   segments  in  that the whole curve has at least */
static void check_stops(const char *name, const curve_case *c, int n, int segments) {
  quiet_monitor counts = quiet_monitor_create(0);
  mhb_response *whole;
  int           most = 0;
  assert_ok(watched_main_curve(&c->model, &c->settings, c->harmonics, &counts.base, &whole));
  for (int i = 0; i < n; i++) {
    int p     = 1 + i * (counts.n_points - 1) / (n - 1);
    int found = stop_and_go_on(c, p, i % 3 == 1, whole, counts.n_points);
    most      = found > most ? found : most;
  }
  print_message("%s: %d points, %d stops, up to %d segments\n", name, whole->branch[0].n_points, n,
                most);
  assert_true(whole->branch[0].n_points >= 30 && most >= segments);
  mhb_response_destroy(whole);
}

static void a_curve_with_folds_goes_on(void **state) {
  (void)state;
  curve_case c = {.settings = ground_settings(0.4, 0.8, 0.5, 0.1, 5), .harmonics = 5};
  three_degree_model(&c.model);
  set_range(&c.settings, 0.8, 1.7);
  check_stops("folds", &c, 5, 1);
  modal_model_free(&c.model);
}

/* The number of harmonics changes along the curve. */
static void harmonics_go_on(void **state) {
  (void)state;
  curve_case c = {.settings = ground_settings(0.4, 0.8, 0.5, 0.3, 1), .harmonics = 31};
  three_degree_model(&c.model);
  set_range(&c.settings, 0.8, 1.7);
  c.settings.motion_tolerance = 0.05;
  check_stops("harmonics", &c, 5, 1);
  modal_model_free(&c.model);
}

/* A light mode that a step would skip: the curve remembers it. */
static void a_resonance_stays_known(void **state) {
  (void)state;
  curve_case c = {.settings = ground_settings(0.3, 0.7, 0.5, 0.05, 3), .harmonics = 3};
  two_mode_model(1.31, 1e-4, 1e-3, 1, 0.05, &c.model);
  set_range(&c.settings, 0.7, 1.7);
  check_stops("resonance", &c, 5, 1);
  modal_model_free(&c.model);
}

/* The range begins between two folds: the curve leaves it by the low end and comes back. */
static void an_excursion_goes_on(void **state) {
  (void)state;
  curve_case c = {.settings = ground_settings(0.4, 0.8, 0.5, -0.2, 5), .harmonics = 5};
  three_degree_model(&c.model);
  set_range(&c.settings, 1.17, 1.7);
  check_stops("excursion", &c, 5, 2);
  modal_model_free(&c.model);
}

static void a_preload_goes_on(void **state) {
  (void)state;
  curve_case c = {.settings = ground_settings(0.4, 0.8, 0.5, 0.3, 5), .harmonics = 5};
  three_degree_model(&c.model);
  c.settings.parameter = MHB_IN_N0;
  c.settings.range[0]  = -0.3;
  c.settings.range[1]  = 2;
  set_range(&c.settings, 1.2, 1.2);
  check_stops("preload", &c, 5, 1);
  modal_model_free(&c.model);
}

/* Many pairs: the receptance is multiplied, not formed. */
static void many_pairs_go_on(void **state) {
  (void)state;
  curve_case c = {.settings = random_settings(3), .harmonics = 3};
  random_model(9, WITH_LEFT | WITH_RESIDUAL, 11, &c.model);
  set_range(&c.settings, 0.7, 0.9);
  check_stops("many pairs", &c, 3, 1);
  modal_model_free(&c.model);
}

/* Blades that differ: with a fixed number of harmonics, and with harmonics chosen at each point. */
static void a_ring_goes_on(void **state) {
  enum { N = 4 };
  const double deviation[N] = {0.02, -0.01, 0.015, -0.03};
  (void)state;
  for (int chosen = 0; chosen < 2; chosen++) {
    curve_case         c = {.settings = random_settings(3), .harmonics = chosen ? 31 : 3};
    mhb_mistuned_ring *ring;
    modal_model        blade;
    random_model(1, WITH_LEFT | WITH_RESIDUAL, 3, &blade);
    c.settings.blades           = N;
    c.settings.scale            = 2;
    c.settings.motion_tolerance = chosen ? 0.05 : 0;
    set_range(&c.settings, 1.25, 1.55);
    assert_ok(mhb_mistuned_ring_create(&blade, &c.settings, deviation, 1, &ring));
    c.settings.ring = ring;
    c.model         = ring->whole;
    check_stops(chosen ? "ring, harmonics" : "ring", &c, 4, 1);
    mhb_mistuned_ring_destroy(ring);
    modal_model_free(&blade);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_curve_with_folds_goes_on),
      cmocka_unit_test(harmonics_go_on),
      cmocka_unit_test(a_resonance_stays_known),
      cmocka_unit_test(an_excursion_goes_on),
      cmocka_unit_test(a_preload_goes_on),
      cmocka_unit_test(many_pairs_go_on),
      cmocka_unit_test(a_ring_goes_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
