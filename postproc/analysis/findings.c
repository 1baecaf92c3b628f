#include "postproc/analysis/findings.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "postproc/analysis/resonances.h"
#include "postproc/analysis/ring_findings.h"
#include "postproc/analysis/stability_findings.h"
#include "postproc/analysis/tracked_findings.h"
#include "postproc/draw/number_format.h"

static const post_unit NEWTON = {"N", 1};

static char *preload(char out[POST_NUMBER], double n0) {
  post_plain(out, n0, 6);
  strcat(out, "\u00a0N");
  return out;
}

/* ---------------------------------------------------------------- key figures */

static void put_figure(post_buffer *out, const char *label, const char *value, const char *note) {
  post_put(out, "<div class=\"figure\"><dt>%s</dt><dd><b>%s</b><span>%s</span></dd></div>\n", label,
           value, note);
}

/* "116.06 Hz", "μ = 0.3"; "every μ" if the value is constant. */
static char *place(const post_analysis *analysis, const post_track_point *p, char out[POST_PLACE]) {
  if (!p->level)
    return post_abscissa_place(&analysis->abscissa, p->at, post_at_one_frequency(analysis) ? 4 : 5,
                               out);
  snprintf(out, POST_PLACE, "every %s", analysis->abscissa.symbol);
  return out;
}

/* True if the largest value is at the end of the range and thus no peak. */
static bool at_end(const post_track_point *p) {
  return p->edge && !p->level;
}

static void put_peak_figure(const post_analysis *analysis, post_buffer *out, const char *label,
                            const post_track_point *p) {
  char a[POST_NUMBER], at[POST_PLACE], note[160];
  if (!(p->amplitude > 0)) return;
  int resonance = post_resonance_of(&analysis->resonances, p->branch, p->point);
  int used      = snprintf(note, sizeof note, "at %s%s", place(analysis, p, at),
                      p->edge && !p->level ? ", the edge of the range" : "");
  if (resonance >= 0 && analysis->resonances.n > 1)
    snprintf(note + used, sizeof note - (size_t)used, ", resonance %d", resonance + 1);
  put_figure(out, label, post_measure(a, p->amplitude, post_unit_length(p->amplitude), 3), note);
}

/* Lower peak of the two linear limits; NAN if neither was computed. */
static double lower_limit(const post_tracking *t) {
  return fmin(t->open.amplitude, t->stuck.amplitude);
}

/* Largest amplitude of all nonlinear curves, or (valleys) the least one at stable points. NAN where
 * its error is above the tolerance. */
static post_track_point extreme(const post_analysis *analysis, bool valleys) {
  post_track_point best = {NAN, NAN, NAN, -1, -1, false, false, true, false};
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    const post_curve *c      = &analysis->curve[b];
    const post_peak  *peak   = valleys ? c->valley : c->peak;
    for (int i = 0; i < (valleys ? c->n_valleys : c->n_peaks); i++) {
      bool better =
          valleys ? peak[i].amplitude < best.amplitude : peak[i].amplitude > best.amplitude;
      if (branch->kind != MHB_BRANCH_NONLINEAR) continue;
      if (valleys && branch->stable[peak[i].point] == 0) continue;
      if (best.branch >= 0 && !better) continue;
      best = (post_track_point){analysis->group[c->group].n0,
                                peak[i].at,
                                peak[i].amplitude,
                                b,
                                peak[i].point,
                                peak[i].edge,
                                peak[i].level,
                                branch->complete,
                                false};
    }
  }
  const bool marked =
      best.branch >= 0 && mhb_branch_marked(&analysis->response->branch[best.branch], best.point);
  if (marked) best.at = best.amplitude = NAN;
  return best;
}

static void put_gain(double amplitude, const post_tracking *t, post_buffer *out) {
  char   percent[POST_NUMBER];
  double gain = 1 - amplitude / lower_limit(t);
  if (isfinite(gain))
    put_figure(out, gain >= 0 ? "Reduction" : "Increase", post_percent(percent, fabs(gain)),
               "against the better linear limit");
}

void post_key_figures(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  const bool one = post_at_one_frequency(analysis); /* there the largest need not be a peak */
  post_put(out, "<dl class=\"figures\">\n");
  if (analysis->response->track) {
    post_tracked_figure(analysis, out);
    post_put(out, "</dl>\n");
    return;
  }
  put_peak_figure(analysis, out,
                  one || at_end(&t->open) ? "Largest, shrouds open" : "Peak, shrouds open",
                  &t->open);
  put_peak_figure(analysis, out,
                  one || at_end(&t->stuck) ? "Largest, shrouds stuck" : "Peak, shrouds stuck",
                  &t->stuck);
  if (analysis->abscissa.parameter == MHB_IN_N0) {
    post_track_point lowest = extreme(analysis, true);
    put_peak_figure(analysis, out, "Lowest with friction", &lowest);
    put_gain(lowest.amplitude, t, out);
  }
  if (t->best >= 0) {
    const post_track_point *best = &t->point[t->best];
    char                    label[160], n0[POST_NUMBER];
    snprintf(label, sizeof label, "Lowest peak, n₀ = %s", preload(n0, best->n0));
    put_peak_figure(analysis, out, label, best);
    put_gain(best->amplitude, t, out);
    post_lasting_figure(analysis, best, out);
  } else if (t->n > 0) {
    put_figure(out, "Lowest peak", "not known",
               "the estimated error of every peak is above the tolerance");
  }
  post_put(out, "</dl>\n");
}

/* ---------------------------------------------------------------- sentences */

/* ": 71 % below open" */
static void put_ratio(const char *joint, double ratio, const char *limit, post_buffer *out) {
  char percent[POST_NUMBER];
  if (fabs(1 - ratio) < 1e-6)
    post_put(out, "%sas %s", joint, limit);
  else
    post_put(out, "%s%s %s %s", joint, post_percent(percent, fabs(1 - ratio)),
             ratio <= 1 ? "below" : "above", limit);
}

static void put_optimum(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  char                 n0[POST_NUMBER], a[POST_NUMBER], f[POST_NUMBER], at[POST_PLACE];
  if (t->best < 0) {
    if (analysis->abscissa.parameter == MHB_IN_N0 && analysis->largest > 0) return;
    if (t->n > 0) return; /* their errors are above the tolerance, which is said elsewhere */
    post_put(out, analysis->largest > 0
                      ? "<li>No nonlinear curve was computed at one preload: there is no "
                        "peak to compare.</li>\n"
                      : "<li>Nothing moves: every amplitude is zero. Check the "
                        "excitation.</li>\n");
    return;
  }
  const post_track_point *best   = &t->point[t->best];
  char                    of[96] = ", the only preload computed, has its highest peak";
  int                     known  = 0;
  for (int i = 0; i < t->n; i++) known += !t->point[i].doubtful;
  if (t->n > 1)
    snprintf(of, sizeof of, " of the %d preloads %s gives the lowest peak", known,
             known < t->n ? "whose peak is known" : "computed");
  post_put(out, "<li><b>%s</b>%s, %s at %s", preload(n0, best->n0), of,
           post_measure(a, best->amplitude, post_unit_length(best->amplitude), 3),
           place(analysis, best, at));
  const char *joint = ": ";
  for (int i = 0; i < 2; i++) {
    double ratio = best->amplitude / (i ? t->stuck : t->open).amplitude;
    if (!isfinite(ratio)) continue;
    put_ratio(joint, ratio, i ? "stuck" : "open", out);
    joint = ", ";
  }
  post_put(out, "%s.", best->complete ? "" : " (but its curve is not complete)");
  if (isfinite(t->bracket[0]) && isfinite(t->bracket[1]))
    post_put(out, " The optimum lies between %s and %s", post_plain(n0, t->bracket[0], 6),
             preload(a, t->bracket[1]));
  else if (t->n > 1)
    post_put(out, " It is the %s preload%s: the optimum may lie beyond it.",
             isnan(t->bracket[0]) ? "lowest" : "highest",
             t->best == 0 || t->best == t->n - 1 ? " computed" : " whose peak is known");
  if (isfinite(t->optimum_n0))
    post_put(out, "; a parabola through these three puts it near %s",
             post_measure(f, t->optimum_n0, NEWTON, 2));
  if (isfinite(t->bracket[0]) && isfinite(t->bracket[1])) post_put(out, ".");
  post_put(out, "</li>\n");
}

/* Least and largest amplitude. Omitted for the excitation level, with which amplitudes rise
 * trivially. */
static void put_extremes(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t      = &analysis->tracking;
  post_track_point     lowest = extreme(analysis, true), highest = extreme(analysis, false);
  char                 a[POST_NUMBER], n0[POST_NUMBER], at[POST_PLACE];
  bool                 named = analysis->n_ranks > 1;
  if (!post_at_one_frequency(analysis) || analysis->abscissa.parameter == MHB_IN_SCALE) return;
  if (!(lowest.amplitude > 0) || !(highest.amplitude > 0)) return;
  post_put(out, "<li>The amplitude is least at <b>%s</b>%s", place(analysis, &lowest, at),
           lowest.edge && !lowest.level ? ", the edge of the range" : "");
  if (named) post_put(out, " and %s of preload", preload(n0, lowest.n0));
  post_put(out, ", %s", post_measure(a, lowest.amplitude, post_unit_length(lowest.amplitude), 3));
  const char *joint = ": ";
  for (int i = 0; i < 2; i++) {
    const post_track_point *limit = i ? &t->stuck : &t->open;
    double                  ratio = lowest.amplitude / limit->amplitude;
    if (!isfinite(ratio) || !limit->level) continue;
    put_ratio(joint, ratio, i ? "stuck" : "open", out);
    joint = ", ";
  }
  post_put(out, ". It is largest at %s%s", place(analysis, &highest, at),
           highest.edge && !highest.level ? ", the edge of the range" : "");
  if (named) post_put(out, " and %s", preload(n0, highest.n0));
  post_put(out, ", %s.</li>\n",
           post_measure(a, highest.amplitude, post_unit_length(highest.amplitude), 3));
}

/* " from 103.6 to 110.2 Hz", or " stays at 103.6 Hz" where the digits that are shown are equal. */
static void put_way(const post_abscissa *x, const char *verb, double from, double to, int digits,
                    post_buffer *out) {
  char a[POST_PLACE], b[POST_PLACE], c[POST_PLACE];
  post_abscissa_number(x, from, digits, a);
  post_abscissa_number(x, to, digits, b);
  if (strcmp(a, b) == 0)
    post_put(out, " stays at %s", post_abscissa_value(x, to, digits, c));
  else
    post_put(out, "%s from %s to %s", verb, a, post_abscissa_value(x, to, digits, c));
}

/* One resonance over the preload: "from 103.6 to 110.2 Hz (open 103.6, stuck 121.9 Hz)". */
static void put_resonance(const post_analysis *analysis, int index, post_buffer *out) {
  const post_tracking *t        = &analysis->resonances.list[index];
  const post_abscissa *x        = &analysis->abscissa;
  const double         limit[2] = {t->open.at, t->stuck.at};
  char                 to[POST_PLACE];
  const char          *joint = " (";
  post_put(out, "%s%d", index ? "; " : " ", index + 1);
  if (t->n > 1)
    put_way(x, "", t->point[0].at, t->point[t->n - 1].at, 5, out);
  else
    post_put(out, " at %s", post_abscissa_value(x, t->point[0].at, 5, to));
  for (int i = 0; i < 2; i++) {
    if (!isfinite(limit[i])) continue;
    post_put(out, "%s%s %s", joint, i ? "stuck" : "open", post_abscissa_value(x, limit[i], 5, to));
    joint = ", ";
  }
  if (joint[0] == ',') post_put(out, ")");
}

static void put_resonances(const post_analysis *analysis, post_buffer *out) {
  const post_resonances *r     = &analysis->resonances;
  bool                   moves = false;
  for (int i = 0; i < r->n; i++) moves |= r->list[i].n > 1;
  post_put(out, "<li>The range holds %d resonances. %s:", r->n,
           moves ? "Over the preloads their peaks move" : "Their peaks are");
  for (int i = 0; i < r->n && i < 6; i++) put_resonance(analysis, i, out);
  post_put(out, "%s.</li>\n", r->n > 6 ? "; and more" : "");
}

static void put_shift(const post_analysis *analysis, post_buffer *out) {
  if (analysis->resonances.n > 1) { /* the highest peak may be another one at each preload */
    put_resonances(analysis, out);
    return;
  }
  const post_tracking *t = &analysis->tracking;
  const post_abscissa *x = &analysis->abscissa;
  char                 from[POST_PLACE], to[POST_PLACE], n0[POST_NUMBER], n1[POST_NUMBER];
  double               limits = post_at_one_frequency(analysis) ? NAN : t->stuck.at - t->open.at;
  int                  digits = post_at_one_frequency(analysis) ? 4 : 5;
  int                  first = 0, last = t->n - 1; /* a value at the edge of the range is no peak */
  while (first < t->n && t->point[first].edge) first++;
  while (last > first && t->point[last].edge) last--;
  if (last > first) {
    const post_track_point *a = &t->point[first], *b = &t->point[last];
    post_put(out, "<li>From %s to %s of preload the highest peak", post_plain(n0, a->n0, 5),
             preload(n1, b->n0));
    put_way(x, " moves", a->at, b->at, digits, out);
    if (isfinite(limits))
      post_put(out, " (open to stuck: %s by %s, %s)", limits >= 0 ? "up" : "down",
               post_abscissa_value(x, fabs(limits), 3, from),
               post_percent(to, fabs(limits) / t->open.at));
    post_put(out, ".</li>\n");
  } else if (isfinite(limits) && !t->open.edge && !t->stuck.edge) {
    post_put(out, "<li>With sticking shrouds the highest peak");
    put_way(x, " moves", t->open.at, t->stuck.at, 5, out);
    post_put(out, ".</li>\n");
  }
}

/* Walk along the turning points of a curve: folds, and ends of the range beyond which the curve
 * folds. */
typedef struct {
  int fold, point, outside; /* next fold and point; number of turns outside the range */
} walk;

static bool next_turn(const post_analysis *analysis, int b, walk *w, double *at) {
  const mhb_branch *branch = &analysis->response->branch[b];
  const post_curve *c      = &analysis->curve[b];
  const double     *x      = post_abscissa_values(analysis->response, branch);
  for (;; w->point++) {
    if (w->fold < c->n_folds &&
        (c->fold[w->fold].point <= w->point || w->point >= branch->n_points)) {
      *at = c->fold[w->fold++].at;
      return true;
    }
    if (w->point >= branch->n_points) return false;
    if (!post_left_range(branch->n_points, x, c->amplitude, w->point)) continue;
    *at = x[w->point++];
    w->outside++;
    return true;
  }
}

/* Interval between the next two turns; false if there are no more. *visible: wide enough for a
 * visible jump (20 ppm). */
static bool next_span(const post_analysis *analysis, int b, walk *w, double span[2],
                      bool *visible) {
  double one, two;
  if (!next_turn(analysis, b, w, &one)) return false;
  if (!next_turn(analysis, b, w, &two)) two = one;
  span[0]  = fmin(one, two);
  span[1]  = fmax(one, two);
  *visible = one == two || span[1] - span[0] > 2e-5 * fmax(fabs(span[0]), fabs(span[1]));
  return true;
}

/* Write " (103.81 to 103.96, 212.2 to 213.7 Hz)" for the curves of a group; returns the number (out
 * NULL: count only). *outside: incremented by the turns outside the range. */
static int put_spans(const post_analysis *analysis, int g, post_buffer *out, int *outside) {
  const post_abscissa *x     = &analysis->abscissa;
  int                  spans = 0;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    walk   w = {0};
    double span[2];
    bool   visible;
    while (analysis->curve[b].group == g && next_span(analysis, b, &w, span, &visible)) {
      char from[POST_NUMBER], to[POST_NUMBER];
      if (!visible || ++spans > 4 || !out) continue;
      post_put(out, "%s%s", spans > 1 ? ", " : " (", post_abscissa_number(x, span[0], 6, from));
      if (span[1] > span[0]) post_put(out, " to %s", post_abscissa_number(x, span[1], 6, to));
    }
    *outside += w.outside;
  }
  if (out && spans > 4) post_put(out, ", …");
  if (out && spans > 0) post_put(out, "%s%s)", *x->unit.name ? "\u00a0" : "", x->unit.name);
  return spans;
}

static void put_folds(const post_analysis *analysis, post_buffer *out) {
  int groups = 0, outside = 0, counted = 0;
  for (int g = 0; g < analysis->n_groups; g++) {
    char name[64];
    if (put_spans(analysis, g, NULL, &outside) == 0 || ++groups > 6) continue;
    post_group_name(&analysis->group[g], name);
    post_put(out, "%s%s", groups > 1 ? "; " : "<li><b>Jumps.</b> Folds on ", name);
    put_spans(analysis, g, out, &counted);
  }
  if (groups > 6) post_put(out, "; and %d more", groups - 6);
  if (groups > 0)
    post_put(out,
             ". In between several answers exist at one %s, and a slow sweep jumps from one "
             "to another.%s</li>\n",
             analysis->abscissa.symbol,
             outside ? " Where one of these is an end of the range, the fold lies beyond it." : "");
  else if (analysis->tracking.n > 0)
    post_put(out, "<li>No curve folds visibly: no jumps on the curves that were followed.</li>\n");
}

static void put_edges(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  if (post_at_one_frequency(analysis)) return; /* there the largest value need not be a peak */
  int edges = (t->open.edge && t->open.complete) + (t->stuck.edge && t->stuck.complete);
  for (int i = 0; i < t->n; i++) edges += t->point[i].edge && t->point[i].complete;
  if (edges == 0) return;
  post_put(out,
           "<li class=\"caution\">On %d curve%s the largest value is at the edge of the frequency "
           "range: the "
           "true peak may lie outside. Widen <code>mhb.frequency</code>.</li>\n",
           edges, edges > 1 ? "s" : "");
}

static void put_incomplete(const post_analysis *analysis, post_buffer *out) {
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    char              name[64], note[64], at[POST_PLACE];
    if (branch->complete) continue;
    post_group_name(&analysis->group[analysis->curve[b].group], name);
    post_branch_note(analysis->response, branch, note);
    post_put(out, "<li class=\"caution\"><b>Not complete:</b> %s%s (curve %d)", name, note, b);
    if (branch->n_points > 0)
      post_put(out, " stopped at %s after %d points",
               post_abscissa_place(
                   &analysis->abscissa,
                   post_abscissa_values(analysis->response, branch)[branch->n_points - 1], 6, at),
               branch->n_points);
    post_put(out, ": ");
    post_put_escaped(out, branch->reason && *branch->reason ? branch->reason : "no reason given");
    post_put(out, ".</li>\n");
  }
}

/* Points that are no result. */
static void put_marked(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t     = &analysis->tracking;
  const mhb_marks      marks = mhb_response_marks(analysis->response);
  char                 error[POST_NUMBER];
  int                  peaks = 0;
  for (int i = 0; i < t->n; i++) peaks += t->point[i].doubtful;
  if (marks.marked == 0) return;
  post_put(
      out,
      "<li class=\"caution\"><b>Marked:</b> at %d of %d points the error by the harmonics left "
      "out is above <code>mhb.tolerance</code>, up to %s",
      marks.marked, marks.points, post_percent(error, marks.largest));
  if (marks.harmonics > 0) post_put(out, " with %d harmonics", marks.harmonics);
  post_put(out, ". They are hollow in the charts, and no peak is told from them.");
  if (peaks > 0)
    post_put(out, " Of %d preloads %d %s the highest peak among them.", t->n, peaks,
             peaks > 1 ? "have" : "has");
  post_put(out, "</li>\n");
}

/* Points where a contact that sticks leaves something open. */
static void put_undetermined(const mhb_response *r, post_buffer *out) {
  int points = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int p = 0; p < r->branch[b].n_points; p++)
      points += (r->branch[b].mark[p] & MHB_TRACTION_UNDETERMINED) != 0;
  if (points > 0)
    post_put(out,
             "<li><b>Not determined:</b> at %d points a contact sticks while others touch. Nothing "
             "determines its mean friction; the smallest is taken. Where others slip or open "
             "meanwhile, the amplitude depends on it too.</li>\n",
             points);
}

/* Curves that a sweep from the end of the range does not reach. */
static void put_other_curves(const post_analysis *analysis, post_buffer *out) {
  int n = 0;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    char              name[64], note[64], from[POST_NUMBER], to[POST_NUMBER];
    if (branch->origin == MHB_FROM_END || branch->n_points == 0 || ++n > 6) continue;
    const double *x  = post_abscissa_values(analysis->response, branch);
    double        lo = INFINITY, hi = -INFINITY;
    for (int p = 0; p < branch->n_points; p++) {
      lo = fmin(lo, x[p]);
      hi = fmax(hi, x[p]);
    }
    post_group_name(&analysis->group[analysis->curve[b].group], name);
    post_branch_note(analysis->response, branch, note);
    post_put(out, "%s%s%s (%s to %s)",
             n > 1 ? "; " : "<li><b>Isolated and branching curves</b>: ", name, note,
             post_abscissa_number(&analysis->abscissa, lo, 6, from),
             post_abscissa_value(&analysis->abscissa, hi, 6, to));
  }
  if (n > 6) post_put(out, "; and %d more", n - 6);
  if (n > 0)
    post_put(out,
             ". A sweep does not come to them by itself; a disturbance can. Motion of order n "
             "repeats after n periods of the excitation.</li>\n");
}

/* "at 115.7, 215.2 and 243.6 Hz" */
static void put_search_places(const post_analysis *analysis, const mhb_branch *branch,
                              post_buffer *out) {
  const post_abscissa *x = &analysis->abscissa;
  for (int i = 0; i < branch->n_searches; i++) {
    char at[POST_NUMBER];
    bool last = i + 1 == branch->n_searches;
    post_put(out, "%s%s",
             i == 0 ? "at "
             : last ? " and "
                    : ", ",
             post_abscissa_number(x, branch->search[i].value, 5, at));
  }
  post_put(out, "%s%s", *x->unit.name ? "\u00a0" : "", x->unit.name);
}

/* What others were not looked for by: the seeds of the random starts. */
static void put_seeds(const mhb_response *r, post_buffer *out) {
  int least = INT_MAX, most = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_searches; i++) {
      const int seed = r->branch[b].search[i].seed;
      least          = seed < least ? seed : least;
      most           = seed > most ? seed : most;
    }
  if (most > 0)
    post_put(out, " Their seeds are %d to %d; other starts may find other motions.", least, most);
}

/* Where random starts looked for other curves, and what they found. */
static void put_searches(const post_analysis *analysis, post_buffer *out) {
  int starts = 0, found = 0, untraced = 0, places = 0;
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const mhb_branch *branch = &analysis->response->branch[b];
    for (int i = 0; i < branch->n_searches; i++) {
      starts += branch->search[i].starts;
      found += branch->search[i].found;
      untraced += branch->search[i].untraced;
    }
    if (branch->n_searches == 0 || ++places > 4) continue;
    char name[64];
    post_group_name(&analysis->group[analysis->curve[b].group], name);
    post_put(out, "%s%s ",
             places > 1 ? "; " : "<li><b>Isolated curves were searched for</b>: ", name);
    put_search_places(analysis, branch, out);
  }
  if (places > 4) post_put(out, "; and at %d more preloads", places - 4);
  if (places > 0 && found > 0)
    post_put(out, ". %d random starts there found %d.", starts, found);
  else if (places > 0)
    post_put(out, ". %d random starts there found none.", starts);
  if (untraced > 0)
    post_put(out, " %d more motion%s found, but not followed along a curve.", untraced,
             untraced > 1 ? "s were" : " was");
  if (places > 0 && analysis->response->ring) put_seeds(analysis->response, out);
  if (places > 0)
    post_put(out, " None was looked for elsewhere (<code>mhb.search</code>).</li>\n");
  else if (analysis->tracking.n > 0)
    post_put(out,
             "<li>Isolated curves, which no sweep comes to, were <b>not searched</b> for: "
             "<code>mhb.search</code> does.</li>\n");
}

/* Doubled curves that were left out. */
static void put_flips(const mhb_response *r, post_buffer *out) {
  int untraced = 0;
  for (int b = 0; b < r->n_branches; b++) untraced += r->branch[b].flips_untraced;
  if (untraced > 0)
    post_put(out,
             "<li>At <b>%d of the points where the period doubles</b> the doubled curve was left "
             "out: a main curve has at most 24 others beside it.</li>\n",
             untraced);
}

int post_undamped(const mhb_response *r) {
  int n = 0;
  for (int i = 0; r->mode_damping && i < r->n_modes; i++) n += r->mode_damping[i] <= 0;
  return n;
}

static void put_undamped(const mhb_response *r, post_buffer *out) {
  const int n = post_undamped(r);
  if (n == 0) return;
  post_put(out, "<li class=\"caution\"><b>");
  if (n == r->n_modes)
    post_put(out, "No mode has damping");
  else
    post_put(out, "%d of %d modes ha%s no damping", n, r->n_modes, n > 1 ? "ve" : "s");
  post_put(out,
           "</b>: where nothing slips a resonance is infinitely high, and the height told here is "
           "that of the grid of frequencies.</li>\n");
}

static void put_accuracy(const post_analysis *analysis, post_buffer *out) {
  double worst = NAN, at_peak = NAN;
  int    unknown = 0; /* points whose estimate is no number below 1 */
  for (int b = 0; b < analysis->response->n_branches; b++)
    for (int p = 0; p < analysis->response->branch[b].n_points; p++) {
      double error = post_error(&analysis->response->branch[b], p);
      if (error > 1)
        unknown++;
      else
        worst = fmax(worst, error);
    }
  for (int i = 0; i < analysis->tracking.n; i++) {
    const post_track_point *p = &analysis->tracking.point[i];
    at_peak = fmax(at_peak, post_error(&analysis->response->branch[p->branch], p->point));
  }
  if (!(worst > 0)) return;
  char a[POST_NUMBER], b[POST_NUMBER];
  post_put(out, "<li>Estimated error of the harmonic balance: at most %s anywhere",
           post_percent(a, worst));
  if (at_peak > 1)
    post_put(out, ", not known at a peak");
  else if (at_peak > 0)
    post_put(out, ", %s at the peaks", post_percent(b, at_peak));
  post_put(out, ".");
  if (unknown > 0)
    post_put(out,
             " At %d point%s the estimate has no bound, as beside a fold; there the error is not "
             "known.",
             unknown, unknown > 1 ? "s" : "");
  post_put(out, "</li>\n");
}

void post_findings(const post_analysis *analysis, post_buffer *out) {
  post_put(out, "<ul class=\"findings\">\n");
  put_incomplete(analysis, out);
  put_marked(analysis, out);
  post_put_ring(analysis, out);
  put_undamped(analysis->response, out);
  if (analysis->response->track) {
    post_tracked_findings(analysis, out);
    put_undetermined(analysis->response, out);
    put_accuracy(analysis, out);
    post_put(out, "</ul>\n");
    return;
  }
  put_edges(analysis, out);
  put_optimum(analysis, out);
  put_extremes(analysis, out);
  put_shift(analysis, out);
  put_folds(analysis, out);
  put_other_curves(analysis, out);
  put_searches(analysis, out);
  put_flips(analysis->response, out);
  post_stability_findings(analysis, out);
  put_undetermined(analysis->response, out);
  put_accuracy(analysis, out);
  post_put(out, "</ul>\n");
}

/* ---------------------------------------------------------------- terminal */

static void put_brief(const post_analysis *analysis, post_buffer *out, const char *name,
                      const post_track_point *p) {
  char a[POST_NUMBER], at[POST_PLACE];
  if (!(p->amplitude > 0)) return;
  post_put(out, "%s%s %s at %s%s", out->length ? "; " : "", name,
           post_measure(a, p->amplitude, post_unit_length(p->amplitude), 3), place(analysis, p, at),
           at_end(p) ? ", the end of the range" : "");
}

static void put_marked_brief(const mhb_response *r, post_buffer *out) {
  const mhb_marks marks = mhb_response_marks(r);
  if (marks.marked > 0)
    post_put(out, "%s%d of %d points above mhb.tolerance, no peak is told from them",
             out->length ? "; " : "", marks.marked, marks.points);
}

static void put_line(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  if (analysis->response->track) {
    post_tracked_summary(analysis, out);
    put_marked_brief(analysis->response, out);
    return;
  }
  put_brief(analysis, out, at_end(&t->open) ? "open, largest" : "open peak", &t->open);
  put_brief(analysis, out, at_end(&t->stuck) ? "stuck, largest" : "stuck peak", &t->stuck);
  if (analysis->abscissa.parameter == MHB_IN_N0) {
    post_track_point lowest = extreme(analysis, true);
    put_brief(analysis, out, "lowest", &lowest);
  }
  put_marked_brief(analysis->response, out);
  if (t->best < 0) return;
  char name[96], n0[POST_NUMBER];
  snprintf(name, sizeof name, "lowest (n0 = %s) peak", preload(n0, t->point[t->best].n0));
  put_brief(analysis, out, name, &t->point[t->best]);
  post_lasting_summary(analysis, &t->point[t->best], out);
}

void post_summary(const post_analysis *analysis, post_buffer *out) {
  const int n = post_undamped(analysis->response);
  put_line(analysis, out);
  if (n == 0) return;
  post_put(out, "%s", out->length ? "; " : "");
  if (n < analysis->response->n_modes) post_put(out, "%d modes have ", n);
  post_put(out, "no damping: heights where nothing slips are those of the grid");
}
