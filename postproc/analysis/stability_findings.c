#include "postproc/analysis/stability_findings.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mhb/response/response.h"
#include "postproc/draw/number_format.h"

enum { MOST_NAMED = 8 }; /* preloads listed */

post_verdict post_verdict_of(const mhb_branch *branch, int point) {
  if (branch->stable[point] < 0) return POST_VERDICT_NOT_JUDGED;
  if (branch->stable[point] > 0) return POST_VERDICT_STABLE;
  int loss = branch->kind == MHB_BRANCH_NONLINEAR ? branch->loss[point] : MHB_LOSS_FOLD;
  return loss == MHB_LOSS_FLIP || loss == MHB_LOSS_NEIMARK_SACKER ? POST_VERDICT_MODULATED
                                                                  : POST_VERDICT_NEVER_SEEN;
}

bool post_swing_lasts(const mhb_branch *branch, int window) {
  double f    = branch->lasting_curve.frequency[window];
  int    near = 0;
  for (int i = 1; i < branch->n_points; i++)
    if (fabs(branch->frequency[i] - f) < fabs(branch->frequency[near] - f)) near = i;
  return branch->n_points > 0 && branch->stable[near] != 1;
}

int post_largest_swing(const mhb_branch *branch) {
  const mhb_lasting_curve *curve = &branch->lasting_curve;
  int                      best  = -1;
  for (int i = 0; i < curve->n; i++)
    if (post_swing_lasts(branch, i) && (best < 0 || curve->worst[i] > curve->worst[best])) best = i;
  return best;
}

/* ---- how many points have which verdict ---- */

typedef struct {
  int total, points[POST_N_VERDICTS], curves[POST_N_VERDICTS];
} tally;

static tally count(const post_analysis *analysis) {
  tally t = {0};
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch                  = &analysis->response->branch[b];
    int               before[POST_N_VERDICTS] = {0};
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int p = 0; p < branch->n_points; p++) before[post_verdict_of(branch, p)]++;
    for (int v = 0; v < POST_N_VERDICTS; v++) {
      t.points[v] += before[v];
      t.curves[v] += before[v] > 0;
    }
    t.total += branch->n_points;
  }
  return t;
}

static void put_verdicts(const tally *t, bool lacks_diameters, post_buffer *out) {
  if (lacks_diameters) {
    post_put(out,
             "<li>Stability was <b>not judged</b>: disturbances may have any nodal diameter, and "
             "the modal file lacks some. <code>modal.nodal_diameters: all</code> adds "
             "them.</li>\n");
    return;
  }
  if (t->points[POST_VERDICT_NOT_JUDGED] == t->total) {
    post_put(out,
             "<li>Stability was <b>not judged</b>: <code>mhb.stability</code> does. Between the "
             "folds of a curve it is usually lost.</li>\n");
    return;
  }
  if (t->points[POST_VERDICT_MODULATED] > 0)
    post_put(out,
             "<li><b>Modulated</b> (dashed): at %d of %d points, on %d curve%s, the wave loses "
             "its stability without a fold. Side waves make it quasi-periodic, or its period "
             "doubles; the blades no longer swing alike.</li>\n",
             t->points[POST_VERDICT_MODULATED], t->total, t->curves[POST_VERDICT_MODULATED],
             t->curves[POST_VERDICT_MODULATED] > 1 ? "s" : "");
  if (t->points[POST_VERDICT_NEVER_SEEN] > 0)
    post_put(out,
             "<li><b>Never seen</b> (dotted): %d of %d points lie beyond a fold. A machine does "
             "not stay there.</li>\n",
             t->points[POST_VERDICT_NEVER_SEEN], t->total);
  if (t->points[POST_VERDICT_NOT_JUDGED] > 0)
    post_put(out,
             "<li><b>Not judged</b> (thin): %d of %d points, where no multipliers were computed. "
             "<code>mhb.stability: always</code> judges all.</li>\n",
             t->points[POST_VERDICT_NOT_JUDGED], t->total);
}

/* Where contacts stick at the friction limit the map of disturbances has another derivative to
 * either side. */
static void put_at_limit(const post_analysis *analysis, post_buffer *out) {
  int points = 0, judged = 0, most = 0;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int p = 0; p < branch->n_points; p++) {
      if (branch->judged[p] != MHB_BY_MULTIPLIERS && branch->judged[p] != MHB_JUDGED_MARGINAL)
        continue;
      judged++;
      points += branch->at_limit[p] > 0;
      if (branch->at_limit[p] > most) most = branch->at_limit[p];
    }
  }
  if (points == 0) return;
  post_put(out,
           "<li><b>At the friction limit</b>: at %d of %d points with multipliers, up to %d "
           "contact%s and reach%s the limit. They count as stuck. A disturbance may make "
           "them slip: the multipliers there hold for those that do not.</li>\n",
           points, judged, most, most > 1 ? "s stick" : " sticks", most > 1 ? "" : "es");
}

/* ---- the motion that lasts ---- */

static const char *kind_name(int kind) {
  static const char *const name[MHB_LASTING_KINDS] = {"",          "the wave",  "mildly modulated",
                                                      "modulated", "irregular", "several motions"};
  return name[kind];
}

/* The motion that lasts at a peak was computed. */
static bool is_known(const post_analysis *analysis, const post_track_point *p) {
  if (p->branch < 0) return false;
  const mhb_branch *branch = &analysis->response->branch[p->branch];
  return branch->kind == MHB_BRANCH_NONLINEAR && branch->lasting_kind[p->point] > 0;
}

/* "; over the range up to 53.9 µm, at 213.2 Hz", if that is more than at the peak. */
static void put_largest_swing(const post_analysis *analysis, const post_track_point *p,
                              post_buffer *out) {
  const mhb_branch *branch = &analysis->response->branch[p->branch];
  char              at[POST_PLACE], size[POST_NUMBER];
  int               i     = post_largest_swing(branch);
  double            worst = i < 0 ? 0 : branch->lasting_curve.worst[i];
  if (!(worst > p->amplitude * branch->lasting_worst[p->point])) return;
  post_put(out, "; over the range up to %s, at %s",
           post_measure(size, worst, post_unit_length(worst), 3),
           post_abscissa_place(&analysis->abscissa, branch->lasting_curve.frequency[i], 4, at));
}

/* "; the smallest 0.148, 0.203", where there are several motions and both are known. */
static void put_least(const mhb_branch *branch, int point, post_buffer *out) {
  char mean[POST_NUMBER], worst[POST_NUMBER];
  if (!(branch->lasting_least[point] > 0)) return;
  post_put(out, "; the smallest %s, %s", post_plain(mean, branch->lasting_least[point], 3),
           post_plain(worst, branch->lasting_least_worst[point], 3));
}

/* What the fewest starts of a peak leave to chance; 0: not known. */
static void put_starts(int fewest, post_buffer *out) {
  char chance[POST_NUMBER];
  if (fewest <= 0) return;
  post_put(out,
           " At least %d disturbed starts were told apart at each: all of them miss a motion that "
           "one in six reaches with a chance of %s\u00a0%%.",
           fewest, post_plain(chance, 100 * mhb_response_lasting_missed(fewest), 2));
}

/* "10 N: irregular, mean 1.14 and worst blade 1.45 times the wave" for every preload whose peak is
 * not that of a stable wave. */
static void put_lasting(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  int                  n = 0, fewest = INT_MAX;
  for (int i = 0; i < t->n; i++) {
    const post_track_point *p = &t->point[i];
    if (!is_known(analysis, p)) continue;
    const mhb_branch *branch = &analysis->response->branch[p->branch];
    const int         starts = branch->lasting_starts[p->point];
    fewest                   = starts < fewest ? starts : fewest;
    if (++n > MOST_NAMED) continue;
    char n0[POST_NUMBER], mean[POST_NUMBER], worst[POST_NUMBER];
    post_put(out, "%s%s\u00a0N %s (%s, %s",
             n > 1 ? ", " : "<li><b>What lasts at the peaks</b>: ", post_plain(n0, p->n0, 5),
             kind_name(branch->lasting_kind[p->point]),
             post_plain(mean, branch->lasting_mean[p->point], 3),
             post_plain(worst, branch->lasting_worst[p->point], 3));
    put_least(branch, p->point, out);
    post_put(out, ")");
  }
  if (n == 0) return;
  if (n > MOST_NAMED) post_put(out, ", and %d more", n - MOST_NAMED);
  post_put(out,
           ". In brackets: mean over blades and time, and the worst blade (99.9 %%), over the "
           "amplitude of the wave. The whole ring was integrated in time.");
  put_starts(fewest, out);
  post_put(out, "</li>\n");
}

/* Where the wave is modulated and nothing was integrated: why. */
static void put_not_computed(const post_analysis *analysis, post_buffer *out) {
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch    = &analysis->response->branch[b];
    bool              modulated = false, known = false;
    if (branch->kind != MHB_BRANCH_NONLINEAR || branch->main != b) continue;
    for (int p = 0; p < branch->n_points; p++) {
      modulated = modulated || post_verdict_of(branch, p) == POST_VERDICT_MODULATED;
      known     = known || branch->lasting_kind[p] > 0;
    }
    if (!modulated || known) continue;
    static const char not_computed[] = "not computed: ";
    const char       *why            = branch->lasting                  ? branch->lasting
                                       : analysis->response->unfinished ? "the run was interrupted"
                                                                        : "mhb.lasting is never";
    if (strncmp(why, not_computed, strlen(not_computed)) == 0) why += strlen(not_computed);
    post_put(out, "<li>What lasts where the wave is modulated was <b>not computed</b>: ");
    post_put_escaped(out, why);
    post_put(out, ".</li>\n");
    return;
  }
}

void post_stability_findings(const post_analysis *analysis, post_buffer *out) {
  tally t = count(analysis);
  if (t.total == 0) return;
  put_verdicts(&t, analysis->response->lacks_diameters, out);
  put_at_limit(analysis, out);
  put_lasting(analysis, out);
  put_not_computed(analysis, out);
}

void post_lasting_figure(const post_analysis *analysis, const post_track_point *p,
                         post_buffer *out) {
  if (p->branch < 0) return;
  const mhb_branch *branch  = &analysis->response->branch[p->branch];
  post_verdict      verdict = post_verdict_of(branch, p->point);
  char              worst[POST_NUMBER], mean[POST_NUMBER];
  if (is_known(analysis, p)) {
    post_put(out,
             "<div class=\"figure\"><dt>Worst blade there</dt><dd><b>× %s</b>"
             "<span>the wave, mean × %s: %s",
             post_plain(worst, branch->lasting_worst[p->point], 3),
             post_plain(mean, branch->lasting_mean[p->point], 3),
             kind_name(branch->lasting_kind[p->point]));
    put_least(branch, p->point, out);
    put_largest_swing(analysis, p, out);
    post_put(out, "</span></dd></div>\n");
  } else if (verdict != POST_VERDICT_STABLE) {
    post_put(out,
             "<div class=\"figure\"><dt>Stability there</dt><dd><b>%s</b><span>%s</span></dd>"
             "</div>\n",
             verdict == POST_VERDICT_NOT_JUDGED   ? "not judged"
             : verdict == POST_VERDICT_NEVER_SEEN ? "never seen"
                                                  : "modulated",
             verdict == POST_VERDICT_MODULATED ? "what lasts was not computed" : "");
  }
}

void post_lasting_summary(const post_analysis *analysis, const post_track_point *p,
                          post_buffer *out) {
  if (p->branch < 0) return;
  const mhb_branch *branch  = &analysis->response->branch[p->branch];
  post_verdict      verdict = post_verdict_of(branch, p->point);
  char              worst[POST_NUMBER];
  if (is_known(analysis, p)) {
    post_put(out, ", %s: blades swing up to %s times the wave",
             branch->lasting_kind[p->point] == MHB_LASTING_WAVE
                 ? "where the wave lasts"
                 : kind_name(branch->lasting_kind[p->point]),
             post_plain(worst, branch->lasting_worst[p->point], 3));
    put_largest_swing(analysis, p, out);
  } else if (verdict != POST_VERDICT_STABLE) {
    post_put(out, ", %s",
             verdict == POST_VERDICT_NOT_JUDGED   ? "stability not judged"
             : verdict == POST_VERDICT_NEVER_SEEN ? "beyond a fold: never seen"
                                                  : "modulated: what lasts was not computed");
  }
}
