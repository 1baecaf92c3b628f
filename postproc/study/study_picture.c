#include "postproc/study/study_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/colour.h"
#include "postproc/draw/plot.h"
#include "postproc/study/study_effects.h"

enum { WIDTH = 900, HEIGHT = 500, RAMP = 9, LABEL = STUDY_NAME + 64 };

static const char css[] =
    ".dot{opacity:.85}.far{opacity:.25}.chosen{fill:none;stroke-width:2}"
    ".best,.line,.range{color:#0b6670}.range{stroke:currentColor;"
    "stroke-width:3}"
    "@media screen and (prefers-color-scheme:dark){.best,.line,.range"
    "{color:#66c5c6}}";

/* Values in the order of a chart: x, y and a third number for the colour. */
typedef struct {
  double *x, *y, *third;
  int     n;
  char    x_label[LABEL], y_label[LABEL];
} series;

static shb_status take(int n, series *list) {
  size_t bytes = ((size_t)n + 1) * sizeof(double);
  *list        = (series){.x = malloc(bytes), .y = malloc(bytes), .third = malloc(bytes)};
  SHB_CHECK(list->x && list->y && list->third, SHB_ERR_IO, "no memory for the picture of a study");
  return SHB_OK;
}

static void free_series(series *list) {
  free(list->x);
  free(list->y);
  free(list->third);
}

static void range(const double *v, int n, double out[2]) {
  out[0] = INFINITY;
  out[1] = -INFINITY;
  for (int i = 0; i < n; i++) {
    out[0] = fmin(out[0], v[i]);
    out[1] = fmax(out[1], v[i]);
  }
}

static void label(char out[LABEL], const char *before, const char *name, post_unit unit) {
  snprintf(out, LABEL, "%s%s%s%s", before, name, *unit.name ? ", " : "", unit.name);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A range is shown in decades if it spans one and its values are spread over it evenly so. */
static bool reads_in_decades(const double *v, int n, const double lo_hi[2]) {
  int below = 0;
  if (!(lo_hi[0] > 0) || lo_hi[1] < 10 * lo_hi[0]) return false;
  for (int i = 0; i < n; i++) below += v[i] < sqrt(lo_hi[0] * lo_hi[1]);
  return 3 * below >= n;
}

static post_plot open_plot(series *list, post_unit x, post_unit y, bool from_zero,
                           post_buffer *out) {
  post_plot plot = {.out = out, .id = "study", .left = 72, .top = 84, .width = 790, .height = 350};
  double    xs[2], ys[2];
  range(list->x, list->n, xs);
  range(list->y, list->n, ys);
  plot.x = plot_axis_around(xs[0], xs[1], reads_in_decades(list->x, list->n, xs), x.scale,
                            list->x_label);
  plot.y = plot_axis_around(ys[0], ys[1], false, y.scale, list->y_label);
  if (from_zero && ys[0] > 0 && ys[1] > 0) plot.y.lo = 0;
  plot_frame(&plot);
  return plot;
}

/* ---------------------------------------------------------------- uncertain keys */

static void draw_percentiles(const design_study *s, int objective, const post_plot *plot) {
  const study_uncertainty *u = &s->uncertainty;
  for (int q = 0; q < u->n_percentiles; q++) {
    int    i = objective * u->n_percentiles + q;
    double y = u->level[q] / 100;
    char   text[64], number[POST_NUMBER];
    if (!isfinite(u->percentile[i])) continue;
    if (isfinite(u->percentile_low[i]))
      plot_line(plot, "range", 2, (double[]){u->percentile_low[i], u->percentile_high[i]},
                (double[]){y, y}, NULL);
    plot_dot(plot, "best dot", u->percentile[i], y, 4);
    post_unit unit = study_output_unit(s, objective);
    snprintf(text, sizeof text, "%g %%: %s %s", u->level[q],
             post_plain(number, u->percentile[i] / unit.scale, 3), unit.name);
    bool right = plot_x(plot, u->percentile[i]) < plot->left + 0.7 * plot->width;
    plot_text(plot, "mark", u->percentile[i], y, (double[2]){right ? 10 : -10, right ? 14 : -8},
              right ? "start" : "end", text);
  }
}

static void draw_distribution(const design_study *s, int objective, series *list,
                              post_buffer *out) {
  for (int i = 0; i < s->n; i++) {
    double value = study_done_value(&s->design[i], objective);
    if (isfinite(value)) list->x[list->n++] = value;
  }
  qsort(list->x, (size_t)list->n, sizeof *list->x, ascending);
  for (int i = 0; i < list->n; i++) list->y[i] = (i + 0.5) / list->n;
  post_unit unit = study_output_unit(s, objective);
  label(list->x_label, "", s->output[objective].name, unit);
  strcpy(list->y_label, "share of the samples below, %");
  post_plot plot = open_plot(list, unit, (post_unit){"%", 0.01}, true, out);
  plot_line(&plot, "line", list->n, list->x, list->y, NULL);
  draw_percentiles(s, objective, &plot);
}

/* ---------------------------------------------------------------- robust designs */

/* The varied key with the most values; the others spread its dots. */
static int widest_key(const design_study *s) {
  const study_robust *r      = &s->robust;
  int                 widest = 0, most = 0;
  for (int k = 0; k < r->n_varied; k++) {
    int levels = 0;
    for (int g = 0; g < r->n_groups; g++) {
      int first = 0;
      while (r->key[first * r->n_varied + k] != r->key[g * r->n_varied + k]) first++;
      levels += first == g;
    }
    if (levels > most) widest = k;
    if (levels > most) most = levels;
  }
  return widest;
}

static void draw_robust_level(const design_study *s, int objective, int key, int q,
                              const post_plot *plot, series *list) {
  const study_robust *r = &s->robust;
  list->n               = 0;
  for (int g = 0; g < r->n_groups; g++) {
    int i = (g * s->n_outputs + objective) * r->n_percentiles + q;
    if (!isfinite(r->percentile[i])) continue;
    list->x[list->n]   = r->key[g * r->n_varied + key];
    list->y[list->n++] = r->percentile[i];
    if (isfinite(r->percentile_low[i]) && isfinite(r->percentile_high[i]))
      plot_line(plot, "range", 2, (double[]){list->x[list->n - 1], list->x[list->n - 1]},
                (double[]){r->percentile_low[i], r->percentile_high[i]}, NULL);
    plot_dot(plot, "best dot", list->x[list->n - 1], r->percentile[i], 4);
  }
  if (r->n_varied == 1) plot_line(plot, "line", list->n, list->x, list->y, NULL);
  if (list->n == 0) return;
  char text[32];
  snprintf(text, sizeof text, "%g %%", r->level[q]);
  plot_text(plot, "mark", list->x[list->n - 1], list->y[list->n - 1], (double[2]){0, -10}, "end",
            text);
}

/* Percentiles with their intervals over a varied key. */
static void draw_robust(const design_study *s, int objective, series *list, post_buffer *out) {
  const study_robust *r   = &s->robust;
  int                 key = widest_key(s);
  for (int i = 0; i < r->n_groups * r->n_percentiles && list->n < s->n; i++) {
    int g = i / r->n_percentiles, q = i % r->n_percentiles;
    int at = (g * s->n_outputs + objective) * r->n_percentiles + q;
    if (!isfinite(r->percentile[at])) continue;
    list->x[list->n] = r->key[g * r->n_varied + key];
    list->y[list->n++] =
        isfinite(r->percentile_high[at]) ? r->percentile_high[at] : r->percentile[at];
  }
  post_unit unit = study_output_unit(s, objective), x_unit = study_key_unit(s, key);
  label(list->x_label, "", s->key[key].name, x_unit);
  label(list->y_label, "percentiles of ", s->output[objective].name, unit);
  post_plot plot = open_plot(list, x_unit, unit, true, out);
  for (int q = 0; q < r->n_percentiles; q++) draw_robust_level(s, objective, key, q, &plot, list);
}

/* ---------------------------------------------------------------- optimisation */

static void draw_history(const design_study *s, int objective, series *list, post_buffer *out) {
  const study_optimum *o = &s->optimum;
  for (int i = 0; i < o->n_history; i++) {
    double value = study_done_value(&s->design[o->history[i]], objective);
    if (!isfinite(value)) continue;
    list->x[list->n]     = i + 1;
    list->third[list->n] = list->n ? fmin(value, list->third[list->n - 1]) : value;
    list->y[list->n++]   = value;
  }
  post_unit unit = study_output_unit(s, objective);
  strcpy(list->x_label, "evaluation");
  label(list->y_label, "", s->output[objective].name, unit);
  post_plot plot = open_plot(list, (post_unit){"", 1}, unit, false, out);
  for (int i = 0; i < list->n; i++) plot_dot(&plot, "dot far", list->x[i], list->y[i], 3);
  if (o->best < 0 || list->n == 0) return;
  double best = s->design[o->best].value[objective];
  if (best <= list->third[list->n - 1]) /* else lower designs break a constraint */
    plot_line(&plot, "line", list->n, list->x, list->third, NULL);
  plot_level(&plot, "base", best);
}

/* ---------------------------------------------------------------- designs over a key */

static void draw_key(const design_study *s, int objective, series *list, post_buffer *out) {
  double share, third[2];
  int    chief = study_chief_key(s, &share), x = chief < 0 ? 0 : chief;
  int    colour = s->n_keys > 1 ? (x == 0) : -1, best = study_best(s);
  for (int i = 0; i < s->n; i++) {
    double value = study_done_value(&s->design[i], objective);
    if (!isfinite(value)) continue;
    list->x[list->n]     = s->design[i].key[x];
    list->third[list->n] = colour < 0 ? 0 : s->design[i].key[colour];
    list->y[list->n++]   = value;
  }
  post_unit unit = study_output_unit(s, objective), x_unit = study_key_unit(s, x);
  label(list->x_label, "", s->key[x].name, x_unit);
  label(list->y_label, "", s->output[objective].name, unit);
  post_plot plot = open_plot(list, x_unit, unit, false, out);
  range(list->third, list->n, third);
  study_effect mean = study_main_effect(s, objective, x);
  if (mean.n_groups > 1) plot_line(&plot, "base", mean.n_groups, mean.at, mean.mean, NULL);
  for (int i = 0; i < list->n; i++) {
    double t = third[1] > third[0] ? (list->third[i] - third[0]) / (third[1] - third[0]) : 0.5;
    char   classes[32];
    snprintf(classes, sizeof classes, "dot c%d", (int)lround(t * (RAMP - 1)));
    plot_dot(&plot, classes, list->x[i], list->y[i], list->n > 400 ? 2.2 : 4);
  }
  if (best >= 0)
    plot_dot(&plot, "best base chosen", s->design[best].key[x], s->design[best].value[objective],
             8);
  if (colour < 0) return;
  char      text[LABEL + 2 * POST_NUMBER], lo[POST_NUMBER], hi[POST_NUMBER];
  post_unit c = study_key_unit(s, colour);
  snprintf(text, sizeof text, "colour: %s, %s (amber) to %s%s%s (indigo); line: mean",
           s->key[colour].name, post_plain(lo, third[0] / c.scale, 3),
           post_plain(hi, third[1] / c.scale, 3), *c.name ? " " : "", c.name);
  post_put(out, "<text x=\"%g\" y=\"%g\">", plot.left, plot.top + plot.height + 54);
  post_put_escaped(out, text);
  post_put(out, "</text>\n");
}

/* ---------------------------------------------------------------- picture */

static int count_values(const design_study *s, int objective) {
  int n = 0;
  for (int i = 0; i < s->n; i++) n += isfinite(study_done_value(&s->design[i], objective));
  return n;
}

shb_status study_picture(const design_study *s, post_buffer *out) {
  int objective = study_objective(s);
  SHB_CHECK(count_values(s, objective) > 0, SHB_ERR_INPUT,
            "%s: no design gave a result, so there is no picture", s->name ? s->name : "study");
  series     list;
  int        most = s->optimum.n_history > s->n ? s->optimum.n_history : s->n;
  char       title[STUDY_NAME + 256];
  shb_status status = take(most, &list);
  if (status == SHB_OK) {
    snprintf(title, sizeof title, "%s: %s", s->name ? s->name : "study", s->output[objective].name);
    plot_picture_open(out, "study-picture", WIDTH, HEIGHT, title,
                      "The chief chart of the design study.", css);
    post_put(out, "<style>");
    post_put_ramp(RAMP, false, out);
    post_put(out, "@media screen and (prefers-color-scheme:dark){");
    post_put_ramp(RAMP, true, out);
    post_put(out, "}</style>\n");
    if (s->robust.n_groups > 0)
      draw_robust(s, objective, &list, out);
    else if (s->uncertainty.n_samples > 0)
      draw_distribution(s, objective, &list, out);
    else if (s->optimum.n_history > 0)
      draw_history(s, objective, &list, out);
    else
      draw_key(s, objective, &list, out);
    plot_svg_close(out);
  }
  free_series(&list);
  return status;
}
