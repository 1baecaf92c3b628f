#include "postproc/analysis/findings.h"
#include "postproc/analysis/response_analysis.h"
#include "tests/support/check.h"
#include "tests/support/fixture.h"

/* One resonance at three preloads (two branches at one of them), the limits, and a branch with
 * varying n0. */
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
  mhb_response  *r = small();
  post_analysis *analysis;
  char           name[64];
  assert_non_null(r);
  for (int p = 0; p < r->branch[2].n_points; p++)
    r->branch[2].n0[p] = 100 * (1 + 1e-13 * p); /* as good as 100 */
  for (int p = 0; p < r->branch[3].n_points; p++) r->branch[3].n0[p] = p;
  assert_ok(post_analysis_create(r, &analysis));
  assert_int_equal(analysis->n_groups, 4); /* 100 N twice, varying, open, stuck */
  assert_int_equal(analysis->n_ranks, 1);
  assert_near(analysis->group[0].n0, 100, 1e-9);
  assert_int_equal(analysis->curve[2].group, 0);
  assert_int_equal(analysis->curve[4].group, 0);
  post_group_name(&analysis->group[0], name);
  assert_string_equal(name, "n₀ = 100\u00a0N");
  post_group_name(&analysis->group[1], name);
  assert_string_equal(name, "n₀ varying");
  post_group_name(&analysis->group[analysis->curve[0].group], name);
  assert_string_equal(name, "open");
  assert_int_equal(analysis->tracking.n, 1);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

static void tracking(void **state) {
  (void)state;
  mhb_response  *r = small();
  post_analysis *analysis;
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  const post_tracking *t = &analysis->tracking;
  assert_int_equal(t->n, 3);
  assert_near(t->point[0].n0, 20, 0); /* ascending, for any order of the branches */
  assert_near(t->point[2].n0, 300, 0);
  assert_int_equal(t->best, 1);
  assert_near(t->bracket[0], 20, 0);
  assert_near(t->bracket[1], 300, 0);
  assert_true(t->optimum_n0 > 20 && t->optimum_n0 < 300);
  assert_true(t->optimum_amplitude <= t->point[1].amplitude);
  assert_true(t->open.amplitude > t->stuck.amplitude && t->stuck.at > t->open.at);
  assert_int_equal(t->point[1].branch, 4);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

/* Vertex of log a = log 3 + 2 (ln n0 - ln 70)^2 from three preloads: exact for a parabola. */
static void optimum(void **state) {
  (void)state;
  static const double n0[] = {25, 60, 210};
  fixture_options     o    = fixture_usual();
  o.n_preloads             = 3;
  o.n0                     = n0;
  o.n_points               = 61;
  o.incomplete             = false;
  mhb_response  *r         = fixture_response(&o);
  post_analysis *analysis;
  post_tracking  t;
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  double **values;
  assert_ok(post_values(r, analysis->primary, POST_QUANTITY_FIRST_HARMONIC, &values));
  for (int b = 2; b < 5; b++)
    for (int p = 0; p < 61; p++) { /* symmetric about its middle point, so that the peak is exact */
      double height             = 3e-4 * exp(2 * pow(log(n0[b - 2] / 70), 2));
      values[b][p]              = height / (1 + pow((p - 30) / 9.0, 2));
      r->branch[b].frequency[p] = 100 + 0.1 * p;
    }
  assert_ok(post_track(analysis, values, &t));
  assert_near(t.optimum_n0, 70, 1e-9);
  assert_near(t.optimum_amplitude, 3e-4, 1e-15);
  post_tracking_free(&t);
  post_values_free(r, values);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

/* A branch that stops before its peak must not win as the lowest peak. */
static void incomplete(void **state) {
  (void)state;
  mhb_response  *r = small();
  post_analysis *analysis;
  assert_non_null(r);
  r->branch[4].n_points = 40; /* 100 N, the lowest: now cut far below its peak */
  r->branch[4].complete = false;
  assert_ok(post_analysis_create(r, &analysis));
  const post_tracking *t = &analysis->tracking;
  assert_true(t->point[1].edge && !t->point[1].complete);
  assert_true(t->point[1].amplitude < t->point[0].amplitude &&
              t->point[1].amplitude < t->point[2].amplitude);
  assert_int_equal(t->best != 1, 1);
  assert_true(isnan(t->optimum_n0));
  post_buffer text = {0};
  post_findings(analysis, &text);
  assert_has(text.text, "Not complete:");
  assert_has_not(text.text, "Widen"); /* a wider range would not help */
  post_buffer_free(&text);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

static void errors(void **state) {
  (void)state;
  mhb_response *r        = small();
  mhb_branch   *b        = &r->branch[2];
  b->error_newton[5]     = NAN;
  b->error_spatial[5]    = -1; /* one contact point: not known */
  b->error_sampling[5]   = 3e-3;
  b->error_modal[5]      = INFINITY;
  b->error_truncation[5] = 1e-3;
  assert_near(post_error(b, 5), 3e-3, 0);
  b->error_sampling[5] = b->error_truncation[5] = NAN;
  assert_true(isnan(post_error(b, 5)));
  mhb_response_destroy(r);
  post_analysis *analysis = NULL;
  r                       = mhb_response_create(1, 0, 3);
  assert_int_equal(post_analysis_create(r, &analysis), SHB_ERR_INPUT);
  assert_has(shb_message(), "no point");
  assert_null(analysis);
  mhb_response_destroy(r);
  r = mhb_response_create(0, 0, 3);
  assert_int_equal(post_analysis_create(r, &analysis), SHB_ERR_INPUT);
  assert_has(shb_message(), "neither a probe nor a contact");
  mhb_response_destroy(r);
}

/* Two folds 1e-6 apart are in the tables but are no jump; a wider pair is reported with its own
 * interval. */
static void jumps(void **state) {
  (void)state;
  mhb_response  *r = small();
  post_analysis *analysis;
  post_buffer    text = {0};
  assert_ok(post_analysis_create(r, &analysis));
  for (int b = 0; b < r->n_branches; b++) analysis->curve[b].n_folds = 0;
  post_curve *c = &analysis->curve[3];
  free(c->fold);
  c->fold       = calloc(4, sizeof *c->fold);
  c->n_folds    = 4;
  c->fold[0].at = 103.9;
  c->fold[1].at = 103.25;
  c->fold[2].at = 121.5;
  c->fold[3].at = 121.5 + 1e-6;
  post_findings(analysis, &text);
  assert_has(text.text, "n₀ = 20\u00a0N (103.250 to 103.900\u00a0Hz). In between");
  post_buffer_free(&text);
  c->fold[1].at = 103.9 - 1e-6;
  post_findings(analysis, &text);
  assert_has(text.text, "No curve folds visibly");
  post_buffer_free(&text);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

/* n0 is followed: one curve, constant limits, no tracking, and a least amplitude at an exact
 * minimum. */
static void followed(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  post_analysis  *analysis;
  post_buffer     text = {0};
  o.n_preloads         = 1;
  o.incomplete         = false;
  o.parameter          = MHB_IN_N0;
  mhb_response *r      = fixture_response(&o);
  mhb_branch   *b      = &r->branch[2];
  double        least  = 2e-4, a[240];
  for (int p = 0; p < b->n_points;
       p++) { /* a^2 is a parabola over n0: its vertex is found exactly */
    b->value[p] = b->n0[p] = -250 + 1250.0 * p / 239;
    b->stable[p]           = 1;
    a[p]                   = least * sqrt(1 + pow((b->value[p] - 87.5) / 60, 2));
    double now             = post_amplitude(r, b, p, post_output_primary(r), 1);
    for (int i = 0; i < 2 * 3 * 4; i++) b->probe[p * 24 + i] *= a[p] / now;
  }
  assert_ok(post_analysis_create(r, &analysis));
  assert_int_equal(analysis->n_groups, 3);
  assert_int_equal(analysis->n_ranks, 0);
  assert_int_equal(analysis->tracking.n, 0);
  assert_true(analysis->tracking.open.level && analysis->tracking.stuck.level);
  assert_near(analysis->tracking.open.at, -250, 1e-9);
  assert_near(analysis->tracking.stuck.at, 1000, 1e-9);
  assert_int_equal(analysis->curve[2].n_valleys, 1);
  assert_near(analysis->curve[2].valley[0].at, 87.5, 1e-6);
  assert_near(analysis->curve[2].valley[0].amplitude, least, 1e-12);
  post_findings(analysis, &text);
  assert_has(text.text, "least at <b>n₀ = 87.5\u00a0N</b>, 200\u00a0µm");
  assert_has(text.text, "largest at n₀ = 1000\u00a0N, the edge of the range");
  assert_has_not(text.text, "Widen");
  post_buffer_free(&text);
  post_key_figures(analysis, &text);
  assert_has(text.text, "at every n₀");
  assert_has(text.text, "Lowest with friction");
  post_buffer_free(&text);
  post_analysis_destroy(analysis);
  /* an unstable minimum does not count */
  for (int p = 50; p < 80; p++) b->stable[p] = 0;
  assert_ok(post_analysis_create(r, &analysis));
  post_findings(analysis, &text);
  assert_has_not(text.text, "87.5");
  post_buffer_free(&text);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

/* Another parameter: a group for each preload, and the highest peak over the parameter. */
static void followed_by_preload(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  post_analysis  *analysis, *swept;
  mhb_response   *sweep = fixture_response(&o);
  o.parameter           = MHB_IN_KV;
  mhb_response *r       = fixture_response(&o);
  assert_ok(post_analysis_create(r, &analysis));
  assert_ok(post_analysis_create(sweep, &swept));
  assert_int_equal(analysis->n_ranks, 7);
  for (int i = 0; i < analysis->tracking.n; i++) {
    double share = (swept->tracking.point[i].at - 92) / 46;
    assert_near(analysis->tracking.point[i].at, 1e5 + 1.9e6 * share, 1);
    assert_near(analysis->tracking.point[i].amplitude, swept->tracking.point[i].amplitude, 1e-12);
  }
  post_analysis_destroy(analysis);
  post_analysis_destroy(swept);
  mhb_response_destroy(r);
  mhb_response_destroy(sweep);
}

/* The sentences agree with the numbers. */
static void words(void **state) {
  (void)state;
  mhb_response  *r = small();
  post_analysis *analysis;
  post_buffer    text = {0};
  assert_ok(post_analysis_create(r, &analysis));
  double best = analysis->tracking.point[1].amplitude, open = analysis->tracking.open.amplitude;
  char   below[64];
  snprintf(below, sizeof below, "%.0f\u00a0%% below open", 100 * (1 - best / open));
  post_findings(analysis, &text);
  assert_has(text.text, "<b>100\u00a0N</b> of the 3 preloads computed gives the lowest peak");
  assert_has(text.text, below);
  assert_has(text.text, "between 20 and 300\u00a0N");
  assert_has(text.text, "<b>Jumps.</b>");
  post_buffer_free(&text);
  post_key_figures(analysis, &text);
  assert_has(text.text, "Lowest peak, n₀ = 100\u00a0N");
  post_buffer_free(&text);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(groups),
                                     cmocka_unit_test(tracking),
                                     cmocka_unit_test(optimum),
                                     cmocka_unit_test(incomplete),
                                     cmocka_unit_test(errors),
                                     cmocka_unit_test(jumps),
                                     cmocka_unit_test(words),
                                     cmocka_unit_test(followed),
                                     cmocka_unit_test(followed_by_preload)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
