/* Findings of the closed-form response: the sentences, the key figures and the lines for a
 * terminal. */
#include "postproc/analysis/findings.h"

#include "tests/support/check.h"
#include "tests/support/fixture.h"

typedef void (*writer)(const post_analysis *, post_buffer *);

/* What a writer says of a response. The caller frees the text. */
static char *text_of(const fixture_options *o, writer write) {
  mhb_response  *r = fixture_response(o);
  post_analysis *analysis;
  post_buffer    out = {0};
  assert_non_null(r);
  assert_ok(post_analysis_create(r, &analysis));
  write(analysis, &out);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
  return out.text;
}

/* Seven preloads: the optimum at 100 N, folds, one incomplete curve, unstable points. */
static void response_is_told(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  char           *text = text_of(&o, post_findings);
  assert_has(text, "<b>100\u00a0N</b> of the 7 preloads computed gives the lowest peak");
  assert_has(text, "below open, ");
  assert_has(text, "The optimum lies between 50 and 200\u00a0N");
  assert_has(text, "<b>Jumps.</b> Folds on n₀ = ");
  assert_has(text, "<b>Never seen</b> (dotted): ");
  assert_has(text, "were <b>not searched</b> for");
  assert_has(text, "<b>Not complete:</b> n₀ = 1000\u00a0N (curve 8) stopped at ");
  assert_has(text, "Estimated error of the harmonic balance: at most ");
  free(text);
}

/* The usual response with all points of a nonlinear curve marked, or of all of them (-1). */
static char *marked_text(int curve, writer write) {
  fixture_options o = fixture_usual();
  mhb_response   *r = fixture_response(&o);
  post_analysis  *analysis;
  post_buffer     out = {0};
  for (int i = 0, n = 0; i < r->n_branches; i++) {
    mhb_branch *b = &r->branch[i];
    if (b->kind != MHB_BRANCH_NONLINEAR) continue;
    if (curve < 0 || n++ == curve)
      for (int p = 0; p < b->n_points; p++) b->mark[p] = MHB_ABOVE_TOLERANCE;
  }
  assert_ok(post_analysis_create(r, &analysis));
  write(analysis, &out);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
  return out.text;
}

/* The lowest peak is that of the fourth curve, at 100 N, where its points are results. */
static void points_above_the_tolerance_are_no_headline(void **state) {
  (void)state;
  char *text = marked_text(3, post_findings);
  assert_has(text, "<b>Marked:</b> at 240 of ");
  assert_has(text, "of the 6 preloads whose peak is known gives the lowest peak");
  assert_null(strstr(text, "<b>100\u00a0N</b> of"));
  free(text);
  text = marked_text(3, post_summary);
  assert_has(text, "; 240 of ");
  assert_null(strstr(text, "lowest (n0 = 100\u00a0N)"));
  free(text);
  text = marked_text(-1, post_summary);
  assert_has(text, "above mhb.tolerance, no peak is told from them");
  assert_null(strstr(text, "lowest ("));
  free(text);
  text = marked_text(-1, post_key_figures);
  assert_has(text, "<dt>Lowest peak</dt><dd><b>not known</b>");
  free(text);
}

/* Two searches found three curves, and motions that were not followed. */
static void motions_not_followed_are_told(void **state) {
  (void)state;
  fixture_options o   = fixture_usual();
  mhb_response   *r   = fixture_response(&o);
  post_buffer     out = {0};
  post_analysis  *analysis;
  assert_non_null(r);
  for (int i = 0; i < 2; i++) {
    mhb_search made = {.value = 1, .order = 1, .starts = 10, .found = 1 + i, .untraced = 2 * i};
    mhb_response_note_search(&r->branch[2], &made);
  }
  r->branch[2].flips_untraced = 5;
  assert_ok(post_analysis_create(r, &analysis));
  post_findings(analysis, &out);
  assert_has(out.text,
             "At <b>5 of the points where the period doubles</b> the doubled curve was left out");
  assert_has(out.text,
             ". 20 random starts there found 3. 2 more motions were found, but not "
             "followed along a curve.");
  free(out.text);
  post_analysis_destroy(analysis);
  mhb_response_destroy(r);
}

static void limits_may_be_absent(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.limits          = false;
  o.incomplete      = false;
  char *text        = text_of(&o, post_findings);
  assert_has_not(text, "below open");
  assert_has_not(text, "Not complete");
  free(text);
  text = text_of(&o, post_key_figures);
  assert_has_not(text, "shrouds open");
  assert_has_not(text, "Reduction");
  assert_has(text, "<dt>Lowest peak, n₀ = 100\u00a0N</dt>");
  free(text);
}

static void figures_are_four(void **state) {
  (void)state;
  static const char *const labels[] = {
      "<dt>Peak, shrouds open</dt>", "<dt>Peak, shrouds stuck</dt>",
      "<dt>Lowest peak, n₀ = 100\u00a0N</dt>", "<dt>Reduction</dt>"};
  fixture_options o    = fixture_usual();
  char           *text = text_of(&o, post_key_figures);
  for (size_t i = 0; i < sizeof labels / sizeof *labels; i++) assert_has(text, labels[i]);
  free(text);
}

/* Without motion there is nothing to compare. */
static void rest_is_told(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.scale           = 0;
  char *text        = text_of(&o, post_findings);
  assert_has(text, "Nothing moves: every amplitude is zero.");
  free(text);
  assert_null(text_of(&o, post_summary));
}

static void summary_is_plain(void **state) {
  (void)state;
  fixture_options o    = fixture_usual();
  char           *text = text_of(&o, post_summary);
  assert_has(text, "open peak 1.24");
  assert_has(text, "; stuck peak ");
  assert_has(text, "; lowest (n0 = 100\u00a0N) peak ");
  assert_null(strpbrk(text, "<>\n"));
  free(text);
}

/* Text of a response in which every peak of the preloads from `first` on, by rank, is doubtful. */
static char *doubted(int first, void (*put)(const post_analysis *, post_buffer *)) {
  fixture_options o   = fixture_usual();
  mhb_response   *r   = fixture_response(&o);
  post_buffer     out = {0};
  post_analysis  *a;
  assert_ok(post_analysis_create(r, &a));
  for (int i = first; i < a->tracking.n; i++) {
    const post_track_point *p = &a->tracking.point[i];
    r->branch[p->branch].mark[p->point] |= MHB_ABOVE_TOLERANCE;
  }
  post_analysis_destroy(a);
  assert_ok(post_analysis_create(r, &a));
  put(a, &out);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
  return out.text;
}

/* The lowest peak, at 100 N, is the fourth of seven. */
static void doubtful_peaks_are_no_headline(void **state) {
  (void)state;
  char *text = doubted(3, post_key_figures);
  assert_has(text, "<dt>Lowest peak, n₀ = 50\u00a0N</dt>");
  free(text);
  text = doubted(3, post_findings);
  assert_has(text, "<b>Marked:</b> at 4 of ");
  assert_has(text, "Of 7 preloads 4 have the highest peak among them.");
  assert_has(text, "It is the highest preload whose peak is known");
  free(text);
  text = doubted(0, post_key_figures);
  assert_has(text, "<dt>Lowest peak</dt><dd><b>not known</b>");
  free(text);
  text = doubted(0, post_summary);
  assert_has(text, " points above mhb.tolerance, no peak is told from them");
  assert_has_not(text, "lowest");
  free(text);
  text = doubted(7, post_findings);
  assert_has_not(text, "above the tolerance");
  free(text);
}

static void modes_without_damping_are_told(void **state) {
  (void)state;
  double          damping[2] = {0, 0.001};
  fixture_options o          = fixture_usual();
  mhb_response   *r          = fixture_response(&o);
  const int       n          = r->n_modes;
  double         *kept       = r->mode_damping;
  post_analysis  *a;
  assert_ok(post_analysis_create(r, &a));
  r->mode_damping = damping;
  for (r->n_modes = 1; r->n_modes <= 2; r->n_modes++) {
    post_buffer out = {0}, line = {0};
    post_findings(a, &out);
    post_summary(a, &line);
    assert_has(out.text, r->n_modes == 1 ? "<b>No mode has damping</b>"
                                         : "<b>1 of 2 modes has no damping</b>");
    assert_has(line.text, "no damping: heights where nothing slips are those of the grid");
    post_buffer_free(&out);
    post_buffer_free(&line);
  }
  r->mode_damping = kept;
  r->n_modes      = n;
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

/* A curve of a single preload moves nowhere, and limits at the ends of the range are no peaks. */
static void what_does_not_move_is_not_said_to(void **state) {
  (void)state;
  fixture_options o = fixture_usual();
  o.n_preloads      = 1;
  o.incomplete      = false;
  char *text        = text_of(&o, post_findings);
  assert_has_not(text, "peaks move");
  assert_has(text, "With sticking shrouds the highest peak moves from ");
  free(text);
  mhb_response  *r   = fixture_response(&o);
  post_buffer    out = {0};
  post_analysis *a;
  assert_ok(post_analysis_create(r, &a));
  a->tracking.stuck.at = a->tracking.open.at * (1 + 1e-9);
  post_findings(a, &out);
  assert_has(out.text, "With sticking shrouds the highest peak stays at ");
  post_buffer_free(&out);
  a->tracking.open.edge = true;
  post_findings(a, &out);
  assert_has_not(out.text, "With sticking shrouds");
  post_buffer_free(&out);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

/* The 95 % quantile of 20 samples has no upper bound at 97.5 %: 0.95^20 = 0.36. */
static void a_bound_that_samples_lack_is_said(void **state) {
  (void)state;
  fixture_options o   = fixture_usual();
  mhb_response   *r   = fixture_response(&o);
  post_buffer     out = {0};
  post_analysis  *a;
  assert_ok(post_analysis_create(r, &a));
  r->samples = mhb_samples_create(20, 1, 3);
  for (int i = 0; i < 20; i++) r->samples->factor[i] = 1.1 + 0.01 * i;
  r->samples->mark[19]              = 1; /* the largest is no result */
  r->samples->n0[0]                 = 100;
  r->branch[2].amplification.factor = 1.2;
  r->ring                           = 6;
  post_findings(a, &out);
  r->ring = 0;
  assert_has(out.text, "20 random rings, n0 = 100\u00a0N: the factor's median is 1.19 (");
  assert_has(out.text, "of 20 random rings with n0 = 100\u00a0N the peaks of 1 have an estimated");
  assert_has(out.text, "the largest is 1.28 (sample 18)");
  assert_has(out.text, ", its 95\u00a0% quantile 1.2");
  assert_has(out.text,
             " with 97.5\u00a0% confidence; 20 samples give no upper bound); the largest");
  post_buffer_free(&out);
  post_analysis_destroy(a);
  mhb_response_destroy(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(points_above_the_tolerance_are_no_headline),
                                     cmocka_unit_test(response_is_told),
                                     cmocka_unit_test(motions_not_followed_are_told),
                                     cmocka_unit_test(limits_may_be_absent),
                                     cmocka_unit_test(figures_are_four),
                                     cmocka_unit_test(rest_is_told),
                                     cmocka_unit_test(summary_is_plain),
                                     cmocka_unit_test(doubtful_peaks_are_no_headline),
                                     cmocka_unit_test(a_bound_that_samples_lack_is_said),
                                     cmocka_unit_test(modes_without_damping_are_told),
                                     cmocka_unit_test(what_does_not_move_is_not_said_to)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
