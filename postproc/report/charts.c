#include "postproc/report/charts.h"
#include "postproc/analysis/stability_findings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/draw/plot.h"

enum { SHOWN_HARMONICS = 8 };

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

enum { DESCRIPTION = 420 };

static void describe(const post_analysis *analysis, char out[DESCRIPTION]) {
  char frequency[POST_PLACE];
  snprintf(
      out, DESCRIPTION,
      "Amplitude against %s%s, %d curves; solid: nonlinear, one colour a preload; "
      "dots: time integration; "
      "dashed grey: the linear limits; dashed: modulated; dotted: never seen; thin: not judged; "
      "band: mean and worst blade of the ring. The same numbers are in the tables and in the CSV "
      "file.",
      analysis->abscissa.name, post_frequency_text(analysis, frequency),
      analysis->response->n_branches);
}

void post_chart_response(const post_analysis *analysis, const char *case_name, post_buffer *out) {
  char title[256], text[DESCRIPTION];
  snprintf(title, sizeof title, "Forced response of %s", case_name);
  describe(analysis, text);
  plot_svg_open(out, "response", 1100, 540, title, text);
  post_plot plot = {
      .out = out, .id = "response", .left = 60, .top = 34, .width = 1020, .height = 456};
  post_draw_response(analysis, &plot);
  plot_svg_close(out);
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

/* Logarithmic axis over decades; with gaps (n0 < 0), an axis of both signs about the smallest
 * value. */
static plot_axis preload_axis(const post_tracking *t, double unit, const char *label) {
  double lo = t->point[0].n0, hi = t->point[t->n - 1].n0, least = INFINITY;
  for (int i = 0; i < t->n; i++)
    if (t->point[i].n0 != 0) least = fmin(least, fabs(t->point[i].n0));
  bool wide = fmax(fabs(lo), fabs(hi)) >= 8 * least;
  if (wide && lo <= 0) return plot_axis_signed(lo, hi, least, unit, label);
  return plot_axis_around(lo, hi, wide, unit, label);
}

/* Axis with space for the text below the lowest peak. */
static plot_axis peak_axis(const double range[2], bool log_scale, double unit, const char *label) {
  if (!log_scale) return (plot_axis){0, 1.1 * range[1], false, 0, unit, label};
  double air = 1.15 * pow(range[1] / range[0], 0.14);
  return (plot_axis){range[0] / air, 1.2 * range[1], true, 0, unit, label};
}

/* Horizontal line of a limit, with its label at one end. */
static void draw_level(const post_plot *plot, double value, bool open) {
  if (!isfinite(value)) return;
  const double move[2] = {open ? 6 : -6, -5};
  plot_level(plot, open ? "line limit open" : "line limit stuck", value);
  plot_text(plot, open ? "mark open" : "mark stuck", open ? plot->x.lo : plot->x.hi, value, move,
            open ? "start" : "end", open ? "open" : "stuck");
}

static double shown(const post_track_point *p, bool place) {
  return place ? p->at : p->amplitude;
}

static void join_peaks(const post_tracking *t, const post_plot *plot, bool place,
                       const char *classes) {
  double *x = calloc((size_t)t->n + 1, 2 * sizeof *x), *y = x ? x + t->n : NULL;
  if (!x) {
    plot->out->failed = true;
    return;
  }
  for (int i = 0; i < t->n; i++) {
    x[i] = t->point[i].n0;
    y[i] = shown(&t->point[i], place);
  }
  plot_line(plot, classes, t->n, x, y, NULL);
  free(x);
}

/* Draw all lower peaks of the preloads, faint, and join the highest ones. */
static void draw_track(const post_analysis *analysis, const post_plot *plot, bool place) {
  const post_tracking *t = &analysis->tracking;
  if (!place || !post_at_one_frequency(analysis)) {
    draw_level(plot, place ? t->open.at : t->open.amplitude, true);
    draw_level(plot, place ? t->stuck.at : t->stuck.amplitude, false);
  }
  for (int b = 0; b < analysis->response->n_branches; b++) {
    const post_group *group = &analysis->group[analysis->curve[b].group];
    for (int i = 0; group->rank >= 0 && i < analysis->curve[b].n_peaks; i++) {
      const post_peak *peak = &analysis->curve[b].peak[i];
      plot_dot(plot, "lesser", group->n0, place ? peak->at : peak->amplitude, 2.4);
    }
  }
  const post_resonances *r = &analysis->resonances;
  for (int i = 0; i < r->n && r->n > 1; i++) join_peaks(&r->list[i], plot, place, "line resonance");
  join_peaks(t, plot, place, "line track");
  for (int i = 0; i < t->n; i++) {
    const post_track_point *p = &t->point[i];
    char                    classes[40];
    snprintf(classes, sizeof classes, "%s c%d",
             p->doubtful ? "doubtful"
             : p->edge   ? "ring"
                         : "dot",
             i);
    plot_dot(plot, classes, p->n0, shown(p, place), i == t->best ? 5.5 : 4);
  }
}

void post_chart_tracking(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t = &analysis->tracking;
  if (t->n < 2) return;
  char      label[64], optimum[96], number[POST_NUMBER], preload[64], where[POST_LABEL], text[320];
  double    range[2], low = INFINITY, high = -INFINITY;
  post_unit unit  = post_unit_length(analysis->largest);
  post_unit force = post_unit_force(fmax(fabs(t->point[0].n0), fabs(t->point[t->n - 1].n0)));
  peak_range(analysis, range);
  for (int i = 0; i < t->n + (post_at_one_frequency(analysis) ? 0 : 2); i++) {
    double at = i < t->n ? t->point[i].at : i == t->n ? t->open.at : t->stuck.at;
    low       = fmin(low, at);
    high      = fmax(high, at);
  }
  snprintf(text, sizeof text,
           "Above: amplitude of the highest peak; below: its %s. Dashed: linear limits.",
           analysis->abscissa.name);
  plot_svg_open(out, "tracking", 1100, 600, "Highest peak against preload", text);
  snprintf(label, sizeof label, "highest peak, %s", unit.name);
  post_plot above = {
      .out = out, .id = "tracking-a", .left = 60, .top = 34, .width = 1020, .height = 280};
  above.x = preload_axis(t, force.scale, NULL);
  above.y = peak_axis(range, post_amplitude_is_log(analysis), unit.scale, label);
  plot_frame(&above);
  draw_track(analysis, &above, false);
  if (t->best >= 0) {
    const post_track_point *best = &t->point[t->best];
    snprintf(optimum, sizeof optimum, "lowest: %s\u00a0%s",
             post_plain(number, best->n0 / force.scale, 4), force.name);
    plot_text(&above, "mark strong", best->n0, best->amplitude, (const double[2]){0, 21}, "middle",
              optimum);
  }
  snprintf(preload, sizeof preload, "preload n₀, %s", force.name);
  post_plot below = {
      .out = out, .id = "tracking-f", .left = 60, .top = 374, .width = 1020, .height = 170};
  below.x       = above.x;
  below.x.label = preload;
  below.y       = plot_axis_around(low, high, analysis->abscissa.log && high > 8 * low,
                                   analysis->abscissa.unit.scale,
                                   post_abscissa_label(&analysis->abscissa, "its ", where));
  plot_frame(&below);
  draw_track(analysis, &below, true);
  plot_svg_close(out);
}

/* Label the preloads under the bars, as many as fit. */
static void draw_categories(const post_plot *plot, const post_tracking *t) {
  int every = 1 + (t->n - 1) / 12;
  for (int i = 0; i < t->n; i += every) {
    char number[POST_NUMBER];
    post_put(plot->out,
             "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n",
             plot_x(plot, i), plot->top + plot->height + 17, post_plain(number, t->point[i].n0, 4));
  }
  post_put(plot->out,
           "<text class=\"axis\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">preload n₀, N</text>\n",
           plot->left + plot->width, plot->top + plot->height + 36);
}

static void draw_state_bars(const post_analysis *analysis, const post_plot *shares,
                            const post_plot *energy) {
  static const char *const classes[] = {"state stick", "state slip", "state gap"};
  const post_tracking     *t         = &analysis->tracking;
  for (int i = 0; i < t->n; i++) {
    const mhb_branch *branch = &analysis->response->branch[t->point[i].branch];
    double            below = 0, x[2] = {i - 0.36, i + 0.36};
    for (int s = 0; s < 3; s++) {
      double share = post_state(analysis->response, branch, t->point[i].point, s);
      plot_bar(shares, classes[s], x, (const double[2]){below, below + share});
      below += share;
    }
    char   colour[40];
    double spent = post_dissipation(analysis->response, branch, t->point[i].point);
    snprintf(colour, sizeof colour, "bar c%d", i);
    plot_bar(energy, colour, x, (const double[2]){0, spent});
  }
}

/* Two data areas, one above the other: shares of the period, and energy up to most (J). */
typedef struct {
  post_plot shares, energy;
  char      id[2][16], label[64];
} contact_panels;

static void open_panels(contact_panels *p, const char *id, const char *title, const char *text,
                        double most, post_buffer *out) {
  if (most < 1e-16) most = 0; /* rounding errors of contacts that stick throughout */
  post_unit unit = post_unit_energy(most);
  snprintf(p->id[0], sizeof p->id[0], "%s-s", id);
  snprintf(p->id[1], sizeof p->id[1], "%s-d", id);
  snprintf(p->label, sizeof p->label, "dissipated a cycle, %s", unit.name);
  p->shares =
      (post_plot){.out = out, .id = p->id[0], .left = 60, .top = 34, .width = 464, .height = 180};
  p->energy =
      (post_plot){.out = out, .id = p->id[1], .left = 60, .top = 266, .width = 464, .height = 150};
  p->energy.y = (plot_axis){0, most > 0 ? 1.08 * most : unit.scale, false, 0, unit.scale, p->label};
  plot_svg_open(out, id, 540, 470, title, text);
}

void post_chart_state(const post_analysis *analysis, post_buffer *out) {
  const post_tracking *t    = &analysis->tracking;
  double               most = 0;
  contact_panels       panels;
  if (t->n < 1 || analysis->response->n_pairs < 1) return;
  for (int i = 0; i < t->n; i++) {
    const mhb_branch *branch = &analysis->response->branch[t->point[i].branch];
    most = fmax(most, post_dissipation(analysis->response, branch, t->point[i].point));
  }
  open_panels(&panels, "state", "Contact at the highest peak, by preload",
              "Above: share of the period stuck, slipping, open (mean of the contacts). Below: "
              "energy dissipated a cycle (all contacts).",
              most, out);
  const plot_axis categories = {-0.6, t->n - 0.4, false, 0, 0, NULL}; /* unit 0: no ticks */
  panels.shares.x = panels.energy.x = categories;
  panels.shares.y                   = (plot_axis){0, 1, false, 0, 0.01, "share of the period, %"};
  plot_frame(&panels.shares);
  plot_frame(&panels.energy);
  draw_state_bars(analysis, &panels.shares, &panels.energy);
  draw_categories(&panels.energy, t);
  plot_svg_close(out);
}

void post_chart_along(const post_analysis *analysis, int b, post_buffer *out) {
  static const char *const classes[] = {"line stick", "line slip", "line gap"};
  const mhb_branch        *branch    = &analysis->response->branch[b];
  const double            *x         = post_abscissa_values(analysis->response, branch);
  int                      n         = branch->n_points;
  if (n < 1 || analysis->response->n_pairs < 1) return;
  double *y = calloc((size_t)n, 4 * sizeof *y), most = 0;
  if (!y) {
    out->failed = true;
    return;
  }
  for (int i = 0; i < n; i++) {
    for (int s = 0; s < 3; s++) y[s * n + i] = post_state(analysis->response, branch, i, s);
    y[3 * n + i] = post_dissipation(analysis->response, branch, i);
    most         = fmax(most, y[3 * n + i]);
  }
  char           below[POST_LABEL], text[320], group[POST_CLASS], line[64];
  contact_panels panels;
  snprintf(text, sizeof text,
           "Above: share of the period stuck, slipping, open against %s. Below: energy "
           "dissipated a cycle.",
           analysis->abscissa.name);
  open_panels(&panels, "along", "Contact along one curve", text, most, out);
  panels.shares.x = panels.energy.x = post_abscissa_axis(&analysis->abscissa, NULL);
  panels.energy.x.label             = post_abscissa_label(&analysis->abscissa, "", below);
  panels.shares.y = (plot_axis){-0.02, 1.02, false, 0, 0.01, "share of the period, %"};
  plot_frame(&panels.shares);
  plot_frame(&panels.energy);
  for (int s = 0; s < 3; s++) plot_line(&panels.shares, classes[s], n, x, y + s * n, NULL);
  post_group_class(&analysis->group[analysis->curve[b].group], group);
  snprintf(line, sizeof line, "line %s", group);
  plot_line(&panels.energy, line, n, x, y + 3 * n, NULL);
  free(y);
  plot_svg_close(out);
}

/* Label each curve of y [m + 1][n_points] at its end, "k = 1". Overlapping labels move down. */
static void name_harmonics(const post_plot *plot, int m, const mhb_branch *branch, const double *x,
                           const double *y) {
  int    n = branch->n_points, used = 0;
  double taken[SHOWN_HARMONICS];
  for (int k = 0; k <= m; k++) {
    double end = y[k * n + n - 1], at = plot_y(plot, end) + 4;
    char   classes[24], name[24];
    if (end <= plot->y.lo) continue;
    for (int i = 0; i < used; i++)
      if (fabs(taken[i] - at) < 14) {
        at += 14;
        i = -1;
      }
    taken[used++] = at;
    snprintf(classes, sizeof classes, "mark h%d", k);
    snprintf(name, sizeof name, k > 0 && branch->order > 1 ? "k = %d/%d" : "k = %d", k,
             branch->order);
    const double move[2] = {6, at - plot_y(plot, end)};
    plot_text(plot, classes, x[n - 1], end, move, "start", name);
  }
}

void post_chart_harmonics(const post_analysis *analysis, int b, post_buffer *out) {
  const mhb_response *response = analysis->response;
  const mhb_branch   *branch   = &response->branch[b];
  const double       *x        = post_abscissa_values(response, branch);
  int                 n = branch->n_points, m = branch->n_harmonics;
  if (n < 1) return;
  if (m >= SHOWN_HARMONICS) m = SHOWN_HARMONICS - 1;
  double *y = calloc((size_t)n * (size_t)(m + 1), sizeof *y), most = 0, least = INFINITY;
  if (!y) {
    out->failed = true;
    return;
  }
  for (int k = 0; k <= m; k++)
    for (int i = 0; i < n; i++) {
      y[k * n + i] = post_amplitude(response, branch, i, analysis->primary, k);
      most         = fmax(most, y[k * n + i]);
      if (y[k * n + i] > 0) least = fmin(least, y[k * n + i]);
    }
  post_unit unit = post_unit_length(most);
  char      label[160], place[128], below[POST_LABEL], text[160];
  post_place_name(response, analysis->primary, place);
  snprintf(label, sizeof label, "%s, amplitude of each harmonic, %s", place, unit.name);
  if (!(most > 0)) most = least = unit.scale;
  snprintf(text, sizeof text, "Amplitude of each harmonic of the motion against %s, logarithmic.",
           analysis->abscissa.name);
  plot_svg_open(out, "harmonics", 1100, 360, "Harmonics along one curve", text);
  post_plot plot = {
      .out = out, .id = "harmonics", .left = 60, .top = 34, .width = 980, .height = 272};
  plot.x =
      post_abscissa_axis(&analysis->abscissa, post_abscissa_label(&analysis->abscissa, "", below));
  plot.y = (plot_axis){fmax(1e-6 * most, least / 2), 2 * most, true, 0, unit.scale, label};
  plot_frame(&plot);
  for (int k = 0; k <= m; k++) {
    char classes[24];
    snprintf(classes, sizeof classes, "line h%d", k);
    plot_line(&plot, classes, n, x, y + k * n, NULL);
  }
  name_harmonics(&plot, m, branch, x, y);
  free(y);
  plot_svg_close(out);
}
