#include "postproc/findings.h"
#include "postproc/study.h"
#include "tests/postproc/check.h"
#include "tests/postproc/fixture.h"

/* The same resonance at three preloads (two branches at one of them), limits, one branch along which n0 changes. */
static mhb_response *small(void) {
  static const double n0[] = {300, 20, 100};
  fixture_options     o    = fixture_usual();
  o.n_preloads             = 3;
  o.n0                     = n0;
  o.incomplete             = false;
  return fixture_response(&o);
}

static void groups(void **state) {
  (void)state;
  mhb_response *r = small();
  post_study   *study;
  char          name[64];
  assert_non_null(r);
  for (int p = 0; p < r->branch[2].n_points; p++)
    r->branch[2].n0[p] = 100 * (1 + 1e-13 * p); /* as good as 100 */
  for (int p = 0; p < r->branch[3].n_points; p++) r->branch[3].n0[p] = p;
  assert_ok(post_study_create(r, &study));
  assert_int_equal(study->n_groups, 4); /* 100 N twice, varying, open, stuck */
  assert_int_equal(study->n_ranks, 1);
  assert_near(study->group[0].n0, 100, 1e-9);
  assert_int_equal(study->curve[2].group, 0);
  assert_int_equal(study->curve[4].group, 0);
  post_group_name(&study->group[0], name);
  assert_string_equal(name, "n₀ = 100\u00a0N");
  post_group_name(&study->group[1], name);
  assert_string_equal(name, "n₀ varying");
  post_group_name(&study->group[study->curve[0].group], name);
  assert_string_equal(name, "open");
  assert_int_equal(study->tracking.n, 1);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

static void tracking(void **state) {
  (void)state;
  mhb_response *r = small();
  post_study   *study;
  assert_non_null(r);
  assert_ok(post_study_create(r, &study));
  const post_tracking *t = &study->tracking;
  assert_int_equal(t->n, 3);
  assert_near(t->point[0].n0, 20, 0); /* ascending, whatever the order of the branches */
  assert_near(t->point[2].n0, 300, 0);
  assert_int_equal(t->best, 1);
  assert_near(t->bracket[0], 20, 0);
  assert_near(t->bracket[1], 300, 0);
  assert_true(t->optimum_n0 > 20 && t->optimum_n0 < 300);
  assert_true(t->optimum_amplitude <= t->point[1].amplitude);
  assert_true(t->open.amplitude > t->stuck.amplitude && t->stuck.frequency > t->open.frequency);
  assert_int_equal(t->point[1].branch, 4);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

/* Vertex of log a = log 3 + 2 (ln n0 - ln 70)^2 from three preloads: exact, for it is a parabola. */
static void optimum(void **state) {
  (void)state;
  static const double n0[] = {25, 60, 210};
  fixture_options     o    = fixture_usual();
  o.n_preloads             = 3;
  o.n0                     = n0;
  o.n_points               = 61;
  o.incomplete             = false;
  mhb_response *r          = fixture_response(&o);
  post_study   *study;
  post_tracking t;
  assert_non_null(r);
  assert_ok(post_study_create(r, &study));
  double **values;
  assert_ok(post_values(r, study->primary, POST_FIRST_HARMONIC, &values));
  for (int b = 2; b < 5; b++)
    for (int p = 0; p < 61; p++) { /* symmetric about its middle point, so that the peak is exact */
      double height             = 3e-4 * exp(2 * pow(log(n0[b - 2] / 70), 2));
      values[b][p]              = height / (1 + pow((p - 30) / 9.0, 2));
      r->branch[b].frequency[p] = 100 + 0.1 * p;
    }
  assert_ok(post_track(study, values, &t));
  assert_near(t.optimum_n0, 70, 1e-9);
  assert_near(t.optimum_amplitude, 3e-4, 1e-15);
  post_tracking_free(&t);
  post_values_free(r, values);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

/* A branch that stopped on its way up must not win as the lowest peak. */
static void incomplete(void **state) {
  (void)state;
  mhb_response *r = small();
  post_study   *study;
  assert_non_null(r);
  r->branch[4].n_points = 40; /* 100 N, the lowest: now cut far below its peak */
  r->branch[4].complete = false;
  assert_ok(post_study_create(r, &study));
  const post_tracking *t = &study->tracking;
  assert_true(t->point[1].edge && !t->point[1].complete);
  assert_true(t->point[1].amplitude < t->point[0].amplitude &&
              t->point[1].amplitude < t->point[2].amplitude);
  assert_int_equal(t->best != 1, 1);
  assert_true(isnan(t->optimum_n0));
  post_buffer text = {0};
  post_findings(study, &text);
  assert_has(text.text, "Not complete:");
  assert_has_not(text.text, "Widen"); /* a wider range would not help */
  post_buffer_free(&text);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

static void errors(void **state) {
  (void)state;
  mhb_response *r        = small();
  mhb_branch   *b        = &r->branch[2];
  b->error_newton[5]     = NAN;
  b->error_sampling[5]   = 3e-3;
  b->error_modal[5]      = INFINITY;
  b->error_truncation[5] = 1e-3;
  assert_near(post_error(b, 5), 3e-3, 0);
  b->error_sampling[5] = b->error_truncation[5] = NAN;
  assert_true(isnan(post_error(b, 5)));
  mhb_response_destroy(r);
  post_study *study = NULL;
  r                 = mhb_response_create(1, 0, 3);
  assert_int_equal(post_study_create(r, &study), SHB_ERR_INPUT);
  assert_has(shb_message(), "no point");
  assert_null(study);
  mhb_response_destroy(r);
  r = mhb_response_create(0, 0, 3);
  assert_int_equal(post_study_create(r, &study), SHB_ERR_INPUT);
  assert_has(shb_message(), "neither a probe nor a contact");
  mhb_response_destroy(r);
}

/* Two folds a millionth apart are in the tables but no jump; a pair of its own is named by its own span. */
static void jumps(void **state) {
  (void)state;
  mhb_response *r = small();
  post_study   *study;
  post_buffer   text = {0};
  assert_ok(post_study_create(r, &study));
  for (int b = 0; b < r->n_branches; b++) study->curve[b].n_folds = 0;
  post_curve *c = &study->curve[3];
  free(c->fold);
  c->fold              = calloc(4, sizeof *c->fold);
  c->n_folds           = 4;
  c->fold[0].frequency = 103.9;
  c->fold[1].frequency = 103.25;
  c->fold[2].frequency = 121.5;
  c->fold[3].frequency = 121.5 + 1e-6;
  post_findings(study, &text);
  assert_has(text.text, "n₀ = 20\u00a0N (103.250 to 103.900\u00a0Hz). In between");
  post_buffer_free(&text);
  c->fold[1].frequency = 103.9 - 1e-6;
  post_findings(study, &text);
  assert_has(text.text, "No curve folds visibly");
  post_buffer_free(&text);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

/* What the page says agrees with the numbers. */
static void words(void **state) {
  (void)state;
  mhb_response *r = small();
  post_study   *study;
  post_buffer   text = {0};
  assert_ok(post_study_create(r, &study));
  double best = study->tracking.point[1].amplitude, open = study->tracking.open.amplitude;
  char   below[64];
  snprintf(below, sizeof below, "%.0f\u00a0%% below open", 100 * (1 - best / open));
  post_findings(study, &text);
  assert_has(text.text, "<b>100\u00a0N</b> of the 3 preloads computed gives the lowest peak");
  assert_has(text.text, below);
  assert_has(text.text, "between 20 and 300\u00a0N");
  assert_has(text.text, "<b>Jumps.</b>");
  post_buffer_free(&text);
  post_figures(study, &text);
  assert_has(text.text, "Lowest peak, n₀ = 100\u00a0N");
  post_buffer_free(&text);
  post_study_destroy(study);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(groups),  cmocka_unit_test(tracking),
                                     cmocka_unit_test(optimum), cmocka_unit_test(incomplete),
                                     cmocka_unit_test(errors),  cmocka_unit_test(jumps),
                                     cmocka_unit_test(words)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
