#include "postproc/study/study_data.h"

#include <math.h>
#include <stdlib.h>

#include "postproc/draw/colour.h"
#include "postproc/study/study_effects.h"

enum { RAMP = 33 };

static const double CURVE_BYTES = 1.5e6, FINEST = 1e-3, LOG_FLOOR = 1e-4;

static void put_number(double value, int digits, post_buffer *out) {
  if (isfinite(value)) post_put(out, "%.*g", digits, value);
  if (!isfinite(value)) post_put(out, "null");
}

/* ---------------------------------------------------------------- columns */

static void put_column(const study_column *column, post_unit unit, post_buffer *out) {
  post_put(out, "{\"name\":");
  post_put_json(out, column->name);
  post_put(out, ",\"unit\":");
  post_put_json(out, unit.name);
  post_put(out, ",\"scale\":%.17g}", unit.scale);
}

static void put_columns(const design_study *s, post_buffer *out) {
  post_put(out, ",\"keys\":[");
  for (int i = 0; i < s->n_keys; i++) {
    post_put(out, i ? "," : "");
    put_column(&s->key[i], study_key_unit(s, i), out);
  }
  post_put(out, "],\"outputs\":[");
  for (int i = 0; i < s->n_outputs; i++) {
    post_put(out, i ? "," : "");
    put_column(&s->output[i], study_output_unit(s, i), out);
  }
  post_put(out, "],\"derivatives\":[");
  for (int i = 0; i < s->n_derivatives; i++) {
    post_put(out, i ? "," : "");
    put_column(&s->derivative[i], (post_unit){s->derivative[i].unit, 1}, out);
  }
  post_put(out, "],\"derivative_at\":[");
  for (int i = 0; i < s->n_derivatives; i++) {
    post_put(out, i ? "," : "");
    put_number(s->derivative[i].at, 10, out);
  }
  post_put(out, "]");
}

typedef enum { KEYS, VALUES, ERRORS, DERIVATIVES } block;

static double at(const study_design *d, block which, int column) {
  switch (which) {
    case KEYS:
      return d->key[column];
    case VALUES:
      return d->value[column];
    case ERRORS:
      return d->error[column];
    default:
      return d->derivative[column];
  }
}

static void put_block(const design_study *s, const char *name, block which, int n_columns,
                      post_buffer *out) {
  static const int digits[] = {10, 10, 3, 7};
  post_put(out, ",\"%s\":[", name);
  for (int c = 0; c < n_columns; c++) {
    post_put(out, c ? ",[" : "[");
    for (int i = 0; i < s->n; i++) {
      post_put(out, i ? "," : "");
      put_number(at(&s->design[i], which, c), digits[which], out);
    }
    post_put(out, "]");
  }
  post_put(out, "]");
}

static const char *const state_word[STUDY_N_STATES] = {[STUDY_WAITING]       = "not run",
                                                       [STUDY_DONE]          = "done",
                                                       [STUDY_FAILED]        = "failed",
                                                       [STUDY_NOT_CONVERGED] = "not converged"};

static void put_states(const design_study *s, post_buffer *out) {
  post_put(out, ",\"status\":[");
  for (int i = 0; i < s->n; i++) post_put(out, "%s%d", i ? "," : "", (int)s->design[i].state);
  post_put(out, "],\"seconds\":[");
  for (int i = 0; i < s->n; i++) {
    post_put(out, i ? "," : "");
    put_number(s->design[i].seconds, 3, out);
  }
  post_put(out, "],\"reason\":{");
  bool any = false;
  for (int i = 0; i < s->n; i++) {
    if (!s->design[i].reason) continue;
    post_put(out, "%s\"%d\":", any ? "," : "", i);
    post_put_json(out, s->design[i].reason);
    any = true;
  }
  post_put(out, "}");
}

/* ---------------------------------------------------------------- conclusions */

static void put_list(const double *list, int n, post_buffer *out) {
  post_put(out, "[");
  for (int i = 0; i < n; i++) {
    post_put(out, i ? "," : "");
    put_number(list[i], 8, out);
  }
  post_put(out, "]");
}

static void put_effects(const design_study *s, post_buffer *out) {
  post_put(out, ",\"effects\":[");
  for (int m = 0; m < s->n_outputs; m++) {
    post_put(out, m ? ",[" : "[");
    for (int k = 0; k < s->n_keys; k++) {
      study_effect e = study_main_effect(s, m, k);
      post_put(out, "%s{\"share\":", k ? "," : "");
      put_number(e.share, 4, out);
      post_put(out, ",\"at\":");
      put_list(e.at, e.n_groups, out);
      post_put(out, ",\"mean\":");
      put_list(e.mean, e.n_groups, out);
      post_put(out, "}");
    }
    post_put(out, "]");
  }
  post_put(out, "]");
}

static void put_optimum(const design_study *s, post_buffer *out) {
  const study_optimum *o = &s->optimum;
  if (o->n_history < 1) return;
  post_put(out, ",\"optimum\":{\"method\":");
  post_put_json(out, o->method);
  post_put(out, ",\"history\":[");
  for (int i = 0; i < o->n_history; i++) post_put(out, "%s%d", i ? "," : "", o->history[i]);
  post_put(out, "],\"bound\":[");
  for (int i = 0; i < s->n_keys; i++) post_put(out, "%s%d", i ? "," : "", o->on_bound[i]);
  post_put(out, "]}");
}

/* [[value, low, high], ...] a row, a list of rows */
static void put_intervals(const char *name, const double *value, const double *low,
                          const double *high, int rows, int columns, post_buffer *out) {
  post_put(out, ",\"%s\":[", name);
  for (int r = 0; r < rows; r++) {
    post_put(out, r ? ",[" : "[");
    for (int c = 0; c < columns; c++) {
      int i = r * columns + c;
      post_put(out, c ? "," : "");
      put_list((double[]){value[i], low[i], high[i]}, 3, out);
    }
    post_put(out, "]");
  }
  post_put(out, "]");
}

static void put_uncertainty(const design_study *s, post_buffer *out) {
  const study_uncertainty *u = &s->uncertainty;
  if (u->n_samples < 1) return;
  post_put(out, ",\"uncertainty\":{\"samples\":%d,\"failed\":%d,\"confidence\":", u->n_samples,
           u->n_failed);
  put_number(u->confidence, 4, out);
  post_put(out, ",\"level\":");
  put_list(u->level, u->n_percentiles, out);
  post_put(out, ",\"mean\":");
  put_list(u->mean, s->n_outputs, out);
  post_put(out, ",\"deviation\":");
  put_list(u->deviation, s->n_outputs, out);
  put_intervals("percentile", u->percentile, u->percentile_low, u->percentile_high, s->n_outputs,
                u->n_percentiles, out);
  if (u->has_sobol) {
    put_intervals("first", u->first, u->first_low, u->first_high, s->n_outputs, s->n_keys, out);
    put_intervals("total", u->total, u->total_low, u->total_high, s->n_outputs, s->n_keys, out);
  }
  post_put(out, "}");
}

static void put_rows(const char *name, const double *list, int rows, int columns,
                     post_buffer *out) {
  post_put(out, ",\"%s\":[", name);
  for (int r = 0; r < rows; r++) {
    post_put(out, r ? "," : "");
    put_list(list + r * columns, columns, out);
  }
  post_put(out, "]");
}

static void put_counts(const char *name, const int *list, int n, post_buffer *out) {
  post_put(out, ",\"%s\":[", name);
  for (int i = 0; i < n; i++) post_put(out, "%s%d", i ? "," : "", list[i]);
  post_put(out, "]");
}

static void put_robust(const design_study *s, post_buffer *out) {
  const study_robust *r = &s->robust;
  int                 n = r->n_groups, m = s->n_outputs, q = r->n_percentiles;
  if (n < 1) return;
  post_put(out, ",\"robust\":{\"confidence\":");
  put_number(r->confidence, 4, out);
  put_rows("key", r->key, n, r->n_varied, out);
  put_counts("samples", r->n_samples, n, out);
  put_counts("failed", r->n_failed, n, out);
  post_put(out, ",\"level\":");
  put_list(r->level, q, out);
  put_rows("mean", r->mean, n, m, out);
  put_rows("deviation", r->deviation, n, m, out);
  put_intervals("percentile", r->percentile, r->percentile_low, r->percentile_high, n * m, q, out);
  post_put(out, "}");
}

static void put_colours(post_buffer *out) {
  post_put(out, ",\"ramp\":{");
  for (int dark = 0; dark < 2; dark++) {
    post_put(out, "%s\"%s\":[", dark ? "," : "", dark ? "dark" : "light");
    for (int i = 0; i < RAMP; i++) {
      char colour[8];
      post_colour(i / (RAMP - 1.0), dark, colour);
      post_put(out, "%s\"%s\"", i ? "," : "", colour);
    }
    post_put(out, "]");
  }
  post_put(out, "}");
}

/* ---------------------------------------------------------------- curves */

/* Extent of a design's curve on a chart with linear or logarithmic amplitude. */
typedef struct {
  double f0, width, most;
} frame;

/* Place of a point on both charts at once. */
static void place(const study_curve *c, const frame *f, int i, double out[3]) {
  double a = f->most > 0 ? c->amplitude[i] / f->most : 0;
  out[0]   = (c->frequency[i] - f->f0) / f->width;
  out[1]   = a;
  out[2]   = 1 - log10(fmax(a, LOG_FLOOR)) / log10(LOG_FLOOR);
}

/* Distance of point i from the chord between points a and b. */
static double distance(const study_curve *c, const frame *f, int a, int b, int i) {
  double p[3], q[3], x[3], along = 0, square = 0, sum = 0;
  place(c, f, a, p);
  place(c, f, b, q);
  place(c, f, i, x);
  for (int k = 0; k < 3; k++) {
    along += (x[k] - p[k]) * (q[k] - p[k]);
    square += (q[k] - p[k]) * (q[k] - p[k]);
  }
  double t = square > 0 ? fmin(1, fmax(0, along / square)) : 0;
  for (int k = 0; k < 3; k++) sum += pow(x[k] - p[k] - t * (q[k] - p[k]), 2);
  return sqrt(sum);
}

/* Keep what the chords between kept points miss (Ramer, Douglas, Peucker). */
static void keep_between(const study_curve *c, const frame *f, int a, int b, double tolerance,
                         bool *kept) {
  int    worst = -1;
  double most  = tolerance;
  for (int i = a + 1; i < b; i++) {
    double d = distance(c, f, a, b, i);
    if (d <= most) continue;
    most  = d;
    worst = i;
  }
  if (worst < 0) return;
  kept[worst] = true;
  keep_between(c, f, a, worst, tolerance, kept);
  keep_between(c, f, worst, b, tolerance, kept);
}

static frame frame_of(const design_study *s) {
  double lo = INFINITY, hi = -INFINITY;
  for (int d = 0; d < s->n; d++)
    for (int i = 0; i < s->design[d].curve.n; i++) {
      lo = fmin(lo, s->design[d].curve.frequency[i]);
      hi = fmax(hi, s->design[d].curve.frequency[i]);
    }
  return (frame){lo, hi > lo ? hi - lo : 1, 0};
}

/* Ends of branches and changes of stability stay. Returns the number of points kept. */
static int thin(const study_curve *c, frame f, double tolerance, bool *kept) {
  int last = 0, n = 0;
  for (int i = 0; i < c->n; i++) f.most = fmax(f.most, c->amplitude[i]);
  for (int i = 0; i < c->n; i++) {
    bool begins = i == 0 || c->branch[i] != c->branch[i - 1];
    bool ends   = i == c->n - 1 || c->branch[i] != c->branch[i + 1];
    kept[i] =
        begins || ends || c->stable[i] != c->stable[i - 1] || c->stable[i] != c->stable[i + 1];
    if (!kept[i]) continue;
    if (!begins) keep_between(c, &f, last, i, tolerance, kept);
    last = i;
  }
  for (int i = 0; i < c->n; i++) n += kept[i];
  return n;
}

/* kept [points of all designs]; returns the number kept. */
static int thin_all(const design_study *s, double tolerance, bool *kept) {
  frame f = frame_of(s);
  int   n = 0, first = 0;
  for (int d = 0; d < s->n; d++) {
    n += thin(&s->design[d].curve, f, tolerance, kept + first);
    first += s->design[d].curve.n;
  }
  return n;
}

static void put_starts(const design_study *s, const bool *kept, post_buffer *out) {
  int n = 0, all = 0;
  post_put(out, "\"start\":[0");
  for (int d = 0; d < s->n; d++) {
    for (int i = 0; i < s->design[d].curve.n; i++) n += kept[all++];
    post_put(out, ",%d", n);
  }
  post_put(out, "]");
}

/* Begin of each run, or its code. */
static void put_runs(const design_study *s, const bool *kept, bool code, post_buffer *out) {
  int  n = 0, all = 0;
  bool any = false;
  post_put(out, ",\"%s\":[", code ? "code" : "run");
  for (int d = 0; d < s->n; d++) {
    const study_curve *c = &s->design[d].curve;
    for (int i = 0; i < c->n; i++) {
      bool begins = i == 0 || c->branch[i] != c->branch[i - 1];
      if (begins || c->stable[i] != c->stable[i - 1]) {
        post_put(out, "%s%d", any ? "," : "", code ? c->stable[i] + 1 + 4 * begins : n);
        any = true;
      }
      n += kept[all++];
    }
  }
  post_put(out, "]");
}

static void put_points(const design_study *s, const bool *kept, int n, float *data,
                       post_buffer *out) {
  int to = 0, all = 0;
  for (int d = 0; d < s->n; d++) {
    const study_curve *c = &s->design[d].curve;
    for (int i = 0; i < c->n; i++) {
      if (!kept[all++]) continue;
      data[to]       = (float)c->frequency[i];
      data[n + to++] = (float)c->amplitude[i];
    }
  }
  post_put(out, ",\"data\":\"");
  post_put_base64(out, 2 * (size_t)n, data);
  post_put(out, "\"");
}

static shb_status put_curves(const design_study *s, post_buffer *out, double *tolerance) {
  size_t all = 0;
  for (int d = 0; d < s->n; d++) all += (size_t)s->design[d].curve.n;
  *tolerance = FINEST;
  if (all == 0) return SHB_OK;
  bool  *kept = calloc(all, sizeof *kept);
  float *data = calloc(2 * all, sizeof *data);
  if (!kept || !data) {
    free(kept);
    free(data);
    SHB_FAIL(SHB_ERR_IO, "not enough memory for the page of the study");
  }
  int n = thin_all(s, *tolerance, kept);
  for (; n * 2 * sizeof(float) * 4 / 3.0 > CURVE_BYTES && *tolerance < 0.1;
       n = thin_all(s, *tolerance, kept))
    *tolerance *= 2;
  post_put(out, ",\"curves\":{");
  put_starts(s, kept, out);
  put_runs(s, kept, false, out);
  put_runs(s, kept, true, out);
  put_points(s, kept, n, data, out);
  post_put(out, "}");
  free(kept);
  free(data);
  return SHB_OK;
}

shb_status study_data(const design_study *s, post_buffer *out, double *tolerance) {
  post_put(out, "{\"format\":\"shroudhb study page\",\"version\":1,\"states\":[");
  for (int i = 0; i < STUDY_N_STATES; i++) {
    post_put(out, i ? "," : "");
    post_put_json(out, state_word[i]);
  }
  post_put(out, "],\"name\":");
  post_put_json(out, s->name ? s->name : "");
  post_put(out, ",\"plan\":");
  post_put_json(out, s->plan);
  post_put(out, ",\"path\":");
  post_put_json(out, s->path ? s->path : "");
  post_put(out, ",\"n\":%d,\"finished\":%s,\"objective\":%d,\"best\":%d", s->n,
           s->finished ? "true" : "false", study_objective(s), study_best(s));
  put_columns(s, out);
  put_block(s, "key", KEYS, s->n_keys, out);
  put_block(s, "value", VALUES, s->n_outputs, out);
  put_block(s, "error", ERRORS, s->n_outputs, out);
  put_block(s, "derivative", DERIVATIVES, s->n_derivatives, out);
  put_states(s, out);
  put_effects(s, out);
  put_optimum(s, out);
  put_uncertainty(s, out);
  put_robust(s, out);
  put_colours(out);
  SHB_TRY(put_curves(s, out, tolerance));
  post_put(out, "}");
  return SHB_OK;
}
