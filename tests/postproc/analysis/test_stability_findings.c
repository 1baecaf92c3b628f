/* Verdicts and the motion that lasts in words. */
#include "postproc/analysis/stability_findings.h"

#include "tests/support/check.h"
#include "tests/support/fixture.h"

/* The closed-form response, its lowest peak at 100 N, with changes at that peak. */
typedef struct {
  mhb_response  *response;
  post_analysis *analysis;
  mhb_branch    *branch; /* of the lowest peak */
  int            point;
} peak;

static void set_up(peak *f) {
  fixture_options o = fixture_usual();
  f->response       = fixture_response(&o);
  assert_non_null(f->response);
  for (int b = 0; b < f->response->n_branches; b++) /* every wave is stable */
    for (int p = 0; p < f->response->branch[b].n_points; p++) f->response->branch[b].stable[p] = 1;
  assert_ok(post_analysis_create(f->response, &f->analysis));
  const post_track_point *best = &f->analysis->tracking.point[f->analysis->tracking.best];
  f->branch                    = &f->response->branch[best->branch];
  f->point                     = best->point;
}

static void tear_down(peak *f) {
  post_analysis_destroy(f->analysis);
  mhb_response_destroy(f->response);
}

static void modulate(peak *f) {
  f->branch->stable[f->point] = 0;
  f->branch->loss[f->point]   = MHB_LOSS_NEIMARK_SACKER;
}

static void settle(peak *f, int kind, double mean, double worst) {
  f->branch->lasting_kind[f->point]  = kind;
  f->branch->lasting_mean[f->point]  = mean;
  f->branch->lasting_worst[f->point] = worst;
}

static char *findings(peak *f) {
  post_buffer out = {0};
  post_put(&out, ".");
  post_stability_findings(f->analysis, &out);
  return out.text;
}

/* What figure and summary say of the lowest peak. */
static char *headline(peak *f) {
  post_buffer             out  = {0};
  const post_track_point *best = &f->analysis->tracking.point[f->analysis->tracking.best];
  post_put(&out, ".");
  post_lasting_figure(f->analysis, best, &out);
  post_lasting_summary(f->analysis, best, &out);
  return out.text;
}

/* Each verdict has a word of its own. */
static void verdicts_are_told_apart(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  mhb_branch *b = f.branch;
  assert_int_equal(post_verdict_of(b, 0), POST_VERDICT_STABLE);
  b->stable[0] = -1;
  assert_int_equal(post_verdict_of(b, 0), POST_VERDICT_NOT_JUDGED);
  b->stable[1] = 0;
  b->loss[1]   = MHB_LOSS_FOLD;
  assert_int_equal(post_verdict_of(b, 1), POST_VERDICT_NEVER_SEEN);
  b->stable[2] = b->stable[3] = 0;
  b->loss[2]                  = MHB_LOSS_FLIP;
  b->loss[3]                  = MHB_LOSS_NEIMARK_SACKER;
  assert_int_equal(post_verdict_of(b, 2), POST_VERDICT_MODULATED);
  assert_int_equal(post_verdict_of(b, 3), POST_VERDICT_MODULATED);
  char *text = findings(&f);
  assert_has(text, "<b>Modulated</b> (dashed): at 2 of ");
  assert_has(text, "<b>Never seen</b> (dotted): 1 of ");
  assert_has(text, "<b>Not judged</b> (thin): 1 of ");
  free(text);
  tear_down(&f);
}

/* Multipliers hold to one side where contacts stick at the friction limit; other points of the
 * kind are not counted. */
static void contacts_at_the_limit_are_counted(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  mhb_branch *b  = f.branch;
  b->at_limit[0] = 5; /* not judged by multipliers */
  b->judged[0]   = MHB_BY_NEIGHBOURS;
  b->judged[1] = b->judged[2] = MHB_BY_MULTIPLIERS;
  char *text                  = findings(&f);
  assert_has_not(text, "At the friction limit");
  free(text);
  b->at_limit[1] = 1;
  text           = findings(&f);
  assert_has(text, "at 1 of 2 points with multipliers, up to 1 contact sticks and reaches the");
  free(text);
  b->judged[3]   = MHB_JUDGED_MARGINAL;
  b->at_limit[3] = 4;
  text           = findings(&f);
  assert_has(text, "at 2 of 3 points with multipliers, up to 4 contacts stick and reach the limit");
  free(text);
  tear_down(&f);
}

/* A stable wave needs no words. */
static void a_stable_wave_says_nothing(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  char *text = headline(&f);
  assert_string_equal(text, ".");
  free(text);
  text = findings(&f);
  assert_string_equal(text, ".");
  free(text);
  tear_down(&f);
}

/* How many starts there were, what they leave to chance, and the smallest motion beside the
 * largest. Files of earlier versions do not know the number. */
static void starts_and_several_motions_are_told(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  modulate(&f);
  settle(&f, MHB_LASTING_SEVERAL, 0.52, 0.83);
  char *text = findings(&f);
  assert_has_not(text, "disturbed starts");
  assert_has_not(text, "the smallest");
  free(text);
  f.branch->lasting_starts[f.point]      = 17;
  f.branch->lasting_least[f.point]       = 0.148;
  f.branch->lasting_least_worst[f.point] = 0.203;
  text                                   = findings(&f);
  assert_has(text, "several motions (0.52, 0.83; the smallest 0.148, 0.203).");
  assert_has(text,
             "At least 17 disturbed starts were told apart at each: all of them miss a motion "
             "that one in six reaches with a chance of 4.5\u00a0%.");
  free(text);
  f.branch->lasting_starts[f.point] = 5;
  text                              = findings(&f);
  assert_has(text, "At least 5 disturbed starts");
  assert_has(text, "a chance of 40\u00a0%.");
  free(text);
  text = headline(&f);
  assert_has(text, "several motions; the smallest 0.148, 0.203");
  free(text);
  tear_down(&f);
}

/* Where the wave is modulated, the headline says how far the blades swing. */
static void the_headline_says_what_lasts(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  modulate(&f);
  settle(&f, MHB_LASTING_MODULATED, 1.07, 1.27);
  char *text = headline(&f);
  assert_has(text, "<b>× 1.27</b>");
  assert_has(text, "mean × 1.07: modulated");
  assert_has(text, ", modulated: blades swing up to 1.27 times the wave");
  assert_has_not(text, "over the range");
  free(text);
  text = findings(&f);
  assert_has(text, "100\u00a0N modulated (1.07, 1.27)");
  assert_has_not(text, "not computed");
  free(text);
  /* the sweep's largest */
  mhb_response_lasting_curve(f.branch, 3);
  double amplitude = f.analysis->tracking.point[f.analysis->tracking.best].amplitude;
  for (int i = 0; i < 3; i++) {
    f.branch->lasting_curve.frequency[i] = 100 + i;
    f.branch->lasting_curve.mean[i]      = amplitude;
    f.branch->lasting_curve.worst[i]     = amplitude * (i == 1 ? 1.5 : 1.2);
  }
  /* where the wave is stable a sweep shows what rings on, not what lasts */
  assert_int_equal(post_largest_swing(f.branch), -1);
  for (int p = 0; p < f.branch->n_points; p++) f.branch->stable[p] = 0;
  assert_int_equal(post_largest_swing(f.branch), 1);
  text = headline(&f);
  assert_has(text, "over the range up to ");
  assert_has(text, ", at 101.0\u00a0Hz");
  free(text);
  /* less than at the peak: nothing to add */
  f.branch->lasting_curve.worst[1] = 1.25 * amplitude;
  text                             = headline(&f);
  assert_has_not(text, "over the range");
  free(text);
  tear_down(&f);
}

/* What was not computed or judged is said. */
static void what_is_missing_is_said(void **state) {
  (void)state;
  peak f;
  set_up(&f);
  modulate(&f);
  f.branch->lasting = strdup("the speed changes along the curve");
  char *text        = headline(&f);
  assert_has(text, ", modulated: what lasts was not computed");
  free(text);
  text = findings(&f);
  assert_has(text, "<b>not computed</b>: the speed changes along the curve.");
  free(text);
  free(f.branch->lasting);
  f.branch->lasting      = NULL;
  f.response->unfinished = true;
  text                   = findings(&f);
  assert_has(text, "<b>not computed</b>: the run was interrupted.");
  free(text);
  f.branch->stable[f.point] = -1;
  text                      = headline(&f);
  assert_has(text, ", stability not judged");
  free(text);
  f.branch->stable[f.point] = 0;
  f.branch->loss[f.point]   = MHB_LOSS_FOLD;
  text                      = headline(&f);
  assert_has(text, ", beyond a fold: never seen");
  free(text);
  for (int b = 0; b < f.response->n_branches; b++)
    for (int p = 0; p < f.response->branch[b].n_points; p++) f.response->branch[b].stable[p] = -1;
  text = findings(&f);
  assert_has(text, "Stability was <b>not judged</b>: <code>mhb.stability</code> does.");
  free(text);
  f.response->lacks_diameters = true;
  text                        = findings(&f);
  assert_has(text, "<code>modal.nodal_diameters: all</code> adds them.");
  assert_null(strstr(text, "mhb.stability"));
  free(text);
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(verdicts_are_told_apart),
      cmocka_unit_test(contacts_at_the_limit_are_counted),
      cmocka_unit_test(a_stable_wave_says_nothing),
      cmocka_unit_test(the_headline_says_what_lasts),
      cmocka_unit_test(starts_and_several_motions_are_told),
      cmocka_unit_test(what_is_missing_is_said),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
