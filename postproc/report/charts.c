#include "postproc/report/charts.h"
#include "postproc/analysis/stability_findings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

/* Label such as "tip motion, first harmonic, µm". */
static void amplitude_label(const post_analysis *analysis, const char *unit, char out[256]) {
  char place[128], harmonic[32];
  post_place_name(analysis->response, analysis->primary, place);
  post_quantity_name(analysis->response, post_quantity_primary(analysis->response), harmonic);
  snprintf(out, 256, "%s %s, %s, %s", place, post_axis_name(analysis->primary), harmonic, unit);
}

/* Range of the groups' highest peaks. */
static void peak_range(const post_analysis *analysis, double range[2]) {
  const post_tracking *t = &analysis->tracking;
  range[0]               = INFINITY;
  range[1]               = 0;
  for (int i = 0; i < t->n + 2; i++) {
    double a = i < t->n    ? t->point[i].amplitude
               : i == t->n ? t->open.amplitude
                           : t->stuck.amplitude;
    if (!(a > 0)) continue;
    range[0] = fmin(range[0], a);
    range[1] = fmax(range[1], a);
  }
}

/* Range of amplitudes over all nonlinear points. */
static void whole_range(const post_analysis *analysis, double range[2]) {
  range[0] = INFINITY;
  range[1] = 0;
  for (int b = 0; b < analysis->response->n_branches; b++)
    for (int p = 0; p < analysis->response->branch[b].n_points; p++) {
      double a = analysis->curve[b].amplitude[p];
      if (analysis->response->branch[b].kind != MHB_BRANCH_NONLINEAR || !(a > 0)) continue;
      range[0] = fmin(range[0], a);
      range[1] = fmax(range[1], a);
    }
}

/* The excitation level has the scale of its axis: a linear response is then a straight line. */
bool post_amplitude_is_log(const post_analysis *analysis) {
  double range[2];
  if (analysis->abscissa.parameter == MHB_IN_SCALE) return analysis->abscissa.log;
  if (post_at_one_frequency(analysis)) {
    whole_range(analysis, range);
    return range[1] > 12 * range[0];
  }
  peak_range(analysis, range);
  return range[1] > 6 * range[0];
}

static plot_axis amplitude_axis(const post_analysis *analysis, double unit, const char *label) {
  if (!post_amplitude_is_log(analysis))
    return (plot_axis){
        0, analysis->largest > 0 ? 1.06 * analysis->largest : unit, false, 0, unit, label};
  double least = INFINITY;
  for (int b = 0; b < analysis->response->n_branches; b++)
    for (int p = 0; p < analysis->response->branch[b].n_points; p++) {
      double a = analysis->curve[b].amplitude[p];
      if (a > 0) least = fmin(least, a);
    }
  return (plot_axis){
      fmax(least / 1.2, 1e-4 * analysis->largest), 1.4 * analysis->largest, true, 0, unit, label};
}

void post_group_class(const post_group *group, char out[POST_CLASS]) {
  if (group->kind == MHB_BRANCH_OPEN)
    strcpy(out, "limit open");
  else if (group->kind == MHB_BRANCH_STUCK)
    strcpy(out, "limit stuck");
  else if (group->rank < 0)
    strcpy(out, "varying");
  else
    snprintf(out, POST_CLASS, "c%d", group->rank);
}

/* Points by time integration: dots, or rings where the motion is not periodic. */
static void draw_points(const post_analysis *analysis, const post_plot *plot, int b) {
  const mhb_branch *branch = &analysis->response->branch[b];
  char              group[POST_CLASS], classes[64];
  post_group_class(&analysis->group[analysis->curve[b].group], group);
  for (int i = 0; i < branch->n_points; i++) {
    snprintf(classes, sizeof classes, "integration %s%s", branch->multiple[i] ? "" : "aperiodic ",
             group);
    plot_dot(plot, classes, post_abscissa_values(analysis->response, branch)[i],
             analysis->curve[b].amplitude[i], 2.4);
  }
}

/* The line of one verdict. A piece has the later verdict of its two ends. */
static void draw_verdict(const post_plot *plot, const char *classes, const mhb_branch *branch,
                         const double *x, const double *amplitude, post_verdict verdict) {
  int   n     = branch->n_points;
  bool *piece = calloc((size_t)n + 1, sizeof *piece);
  if (!piece) {
    plot->out->failed = true;
    return;
  }
  for (int i = 0; i < n; i++) {
    post_verdict here   = post_verdict_of(branch, i),
                 before = i > 0 ? post_verdict_of(branch, i - 1) : here;
    piece[i] =
        (here > before ? here : before) == verdict && !post_left_range(n, x, amplitude, i - 1);
  }
  plot_line(plot, classes, n, x, amplitude, piece);
  free(piece);
}

/* Draw one branch, a kind of line for each verdict. Folds are small circles; flips and
 * Neimark-Sacker points are dots. */
static void draw_branch(const post_analysis *analysis, const post_plot *plot, int b) {
  static const char *const kind[POST_N_VERDICTS] = {[POST_VERDICT_STABLE]     = "line",
                                                    [POST_VERDICT_NOT_JUDGED] = "line unjudged",
                                                    [POST_VERDICT_MODULATED]  = "line modulated",
                                                    [POST_VERDICT_NEVER_SEEN] = "line unstable"};
  const mhb_branch        *branch                = &analysis->response->branch[b];
  const post_curve        *c                     = &analysis->curve[b];
  const double            *x                     = post_abscissa_values(analysis->response, branch);
  int                      n                     = branch->n_points;
  char                     group[POST_CLASS], classes[64];
  post_group_class(&analysis->group[c->group], group);
  for (int verdict = 0; verdict < POST_N_VERDICTS; verdict++) {
    snprintf(classes, sizeof classes, "%s %s", kind[verdict], group);
    draw_verdict(plot, classes, branch, x, c->amplitude, (post_verdict)verdict);
  }
  snprintf(classes, sizeof classes, "dot %s", group);
  if (n == 1) plot_dot(plot, classes, x[0], c->amplitude[0], 3);
  snprintf(classes, sizeof classes, "doubtful %s", group);
  for (int i = 0; i < n; i++)
    if (mhb_branch_marked(branch, i)) plot_dot(plot, classes, x[i], c->amplitude[i], 2.2);
  snprintf(classes, sizeof classes, "fold %s", group);
  for (int i = 0; i < c->n_folds; i++)
    plot_dot(plot, classes, c->fold[i].at, c->fold[i].amplitude, 2.6);
  snprintf(classes, sizeof classes, "bifurcation %s", group);
  for (int i = 0; i < n; i++)
    if (branch->special[i] == MHB_FLIP || branch->special[i] == MHB_NEIMARK_SACKER)
      plot_dot(plot, classes, x[i], c->amplitude[i], 2.6);
}

/* The motion that lasts beside a branch. The sweep of the ring is a band from the mean to the worst
 * blade, and a settled point is a bar of the same. Over another parameter there is none. */
static void draw_lasting(const post_analysis *analysis, const post_plot *plot, int b) {
  const mhb_branch        *branch = &analysis->response->branch[b];
  const mhb_lasting_curve *sweep  = &branch->lasting_curve;
  char                     group[POST_CLASS], classes[64];
  if (analysis->abscissa.parameter != MHB_IN_FREQUENCY) return;
  post_group_class(&analysis->group[analysis->curve[b].group], group);
  snprintf(classes, sizeof classes, "swing %s", group);
  for (int i = 0, n; i < sweep->n; i += n + 1) { /* stretches that last, one by one */
    for (n = 0; i + n < sweep->n && post_swing_lasts(branch, i + n);) n++;
    plot_band(plot, classes, n, sweep->frequency + i, sweep->mean + i, sweep->worst + i);
  }
  for (int i = 0; i < branch->n_points; i++) {
    if (branch->lasting_kind[i] <= MHB_LASTING_WAVE) continue;
    double wave = analysis->curve[b].amplitude[i];
    double x[]  = {branch->frequency[i], branch->frequency[i]};
    double y[]  = {wave * branch->lasting_mean[i], wave * branch->lasting_worst[i]};
    snprintf(classes, sizeof classes, "line lasting %s", group);
    plot_line(plot, classes, 2, x, y, NULL);
    snprintf(classes, sizeof classes, "dot %s", group);
    plot_dot(plot, classes, x[1], y[1], 2);
  }
}

/* Label the limits above their peaks, inside the frame, and apart from each other. */
static void name_limits(const post_analysis *analysis, const post_plot *plot) {
  enum { NAME = 44, ABOVE = 7 }; /* width of a label and its height above the peak, px */
  const post_track_point *limit[2] = {&analysis->tracking.open, &analysis->tracking.stuck};
  const double           *range    = analysis->abscissa.range;
  double                  peak[2], centre[2];
  for (int i = 0; i < 2; i++) {
    peak[i]   = (limit[i]->at - range[0]) / (range[1] - range[0]) * plot->width;
    centre[i] = fmin(fmax(peak[i], NAME / 2.0), plot->width - NAME / 2.0);
  }
  const int first = peak[0] > peak[1], second = 1 - first;
  if (limit[0]->amplitude > 0 && limit[1]->amplitude > 0 && centre[second] - centre[first] < NAME) {
    double middle  = (centre[0] + centre[1]) / 2;
    middle         = fmin(fmax(middle, NAME), plot->width - NAME);
    centre[first]  = middle - NAME / 2.0;
    centre[second] = middle + NAME / 2.0;
  }
  for (int i = 0; i < 2; i++) {
    const double move[2] = {centre[i] - peak[i], -ABOVE};
    if (limit[i]->amplitude > 0)
      plot_text(plot, i == 0 ? "mark open" : "mark stuck", limit[i]->at, limit[i]->amplitude, move,
                "middle", i == 0 ? "open" : "stuck");
  }
}

static void draw_curves(const post_analysis *analysis, const post_plot *plot) {
  /* first what lasts and the limits, then nonlinear curves, last points by time integration */
  for (int b = 0; b < analysis->response->n_branches; b++)
    if (analysis->response->branch[b].kind == MHB_BRANCH_NONLINEAR) draw_lasting(analysis, plot, b);
  for (int pass = 0; pass < 2; pass++)
    for (int b = 0; b < analysis->response->n_branches; b++) {
      mhb_branch_kind kind = analysis->response->branch[b].kind;
      if (kind != MHB_BRANCH_INTEGRATION && (kind == MHB_BRANCH_NONLINEAR) == (pass == 1))
        draw_branch(analysis, plot, b);
    }
  for (int b = 0; b < analysis->response->n_branches; b++)
    if (analysis->response->branch[b].kind == MHB_BRANCH_INTEGRATION)
      draw_points(analysis, plot, b);
  name_limits(analysis, plot);
}

void post_draw_response(const post_analysis *analysis, post_plot *plot) {
  char      label[256], below[POST_LABEL];
  post_unit unit = post_unit_length(analysis->largest);
  amplitude_label(analysis, unit.name, label);
  post_abscissa_label(&analysis->abscissa, "", below);
  plot->y = amplitude_axis(analysis, unit.scale, label);
  plot->x = post_abscissa_axis(&analysis->abscissa, below);
  plot_frame(plot);
  draw_curves(analysis, plot);
}

void post_describe_response(const post_analysis *analysis, post_buffer *out) {
  char frequency[POST_PLACE];
  post_put(out,
           "Amplitude against %s%s, %d curves; solid: nonlinear, one colour a preload; "
           "dots: time integration; dashed grey: the linear limits; dashed: modulated; dotted: "
           "never seen; thin: not judged; band: mean and worst blade of the ring. The same numbers "
           "are in the tables and in the CSV file.",
           analysis->abscissa.name, post_frequency_text(analysis, frequency),
           analysis->response->n_branches);
}

int post_chosen_branch(const post_analysis *analysis) {
  const post_tracking *t = &analysis->tracking;
  if (t->best >= 0) return t->point[t->best].branch;
  for (int b = 0; b < analysis->response->n_branches; b++)
    if (analysis->response->branch[b].kind == MHB_BRANCH_NONLINEAR &&
        analysis->response->branch[b].n_points > 0)
      return b;
  return -1;
}
