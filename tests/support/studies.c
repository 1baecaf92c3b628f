#include "tests/support/studies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/check.h"

enum { POINTS = 160, LARGE = 2000, SAMPLES = 256, SEARCH = 60 };

static const double NOMINAL[] = {100, 0.3, 5e-3, 0};

const char *studies_name(studies_kind kind) {
  static const char *const names[STUDIES_N] = {"grid",  "pair", "optimise", "uncertain", "robust",
                                               "large", "one",  "empty",    "failed"};
  return names[kind];
}

double studies_peak(double n0, double mu, double thickness) {
  double x = log(n0 * mu / 45);
  return 60e-6 * (0.25 + 0.6 * x * x) * pow(5e-3 / thickness, 1.5);
}

static double frequency_of(double n0, double thickness) {
  return 115.7 + 126.6 * n0 / (n0 + 60) * thickness / 5e-3;
}

static void name_column(study_column *column, const char *name, const char *unit) {
  snprintf(column->name, sizeof column->name, "%s", name);
  snprintf(column->unit, sizeof column->unit, "%s", unit);
}

static void start(studies_kind kind, int n_keys, const char *plan, design_study *s) {
  static const char *const key[][2]    = {{"contact.n0", "N"},
                                          {"contact.mu", "-"},
                                          {"mesh.blade.sections[4].thickness", "m"},
                                          {"contact.psi", "rad"}};
  static const char *const output[][2] = {{"peak", "m"}, {"frequency", "Hz"}, {"stable", "-"}};
  static const char *const slope[][2]  = {{"n0", "m/N"}, {"mu", "m"}, {"kv", "m²/N"}};
  assert_int_equal(design_study_create(n_keys, 3, 3, s), SHB_OK);
  s->name      = strdup(studies_name(kind));
  s->path      = strdup("STUDY.yaml");
  s->text      = strdup("name: study\nplan: grid   # <closed form>\n");
  s->case_path = strdup("../z_notch_blade/case.yaml");
  s->case_text = strdup("name: z_notch_blade\n");
  s->finished  = true;
  snprintf(s->plan, sizeof s->plan, "%s", plan);
  for (int i = 0; i < n_keys; i++) name_column(&s->key[i], key[i][0], key[i][1]);
  for (int i = 0; i < 3; i++) name_column(&s->output[i], output[i][0], output[i][1]);
  for (int i = 0; i < 3; i++) name_column(&s->derivative[i], slope[i][0], slope[i][1]);
}

static void draw_curve(study_design *d, double peak, double frequency) {
  assert_int_equal(study_curve_take(&d->curve, POINTS), SHB_OK);
  for (int i = 0; i < POINTS; i++) {
    double f              = 90 + 180 * i / (POINTS - 1.0);
    f                     = i == POINTS / 2 ? frequency : f;
    d->curve.frequency[i] = f;
    d->curve.amplitude[i] = peak / sqrt(1 + pow((f - frequency) / 3, 2));
    d->curve.stable[i]    = fabs(f - frequency) < 4 ? 0 : 1;
    d->curve.branch[i]    = 0;
  }
  /* ascending frequency: the resonance takes its place among the others */
  for (int i = 0; i + 1 < POINTS; i++)
    for (int j = i + 1; j > 0 && d->curve.frequency[j - 1] > d->curve.frequency[j]; j--) {
      double f = d->curve.frequency[j], a = d->curve.amplitude[j];
      int    v                  = d->curve.stable[j];
      d->curve.frequency[j]     = d->curve.frequency[j - 1];
      d->curve.amplitude[j]     = d->curve.amplitude[j - 1];
      d->curve.stable[j]        = d->curve.stable[j - 1];
      d->curve.frequency[j - 1] = f;
      d->curve.amplitude[j - 1] = a;
      d->curve.stable[j - 1]    = v;
    }
}

static study_design *add(design_study *s, const double *key) {
  double full[4];
  for (int i = 0; i < 4; i++) full[i] = i < s->n_keys ? key[i] : NOMINAL[i];
  study_design *d = design_study_add(s, key);
  assert_non_null(d);
  double peak      = studies_peak(full[0], full[1], full[2]) * (1 + 0.1 * full[3]);
  double slope     = 72e-6 * log(full[0] * full[1] / 45) * pow(5e-3 / full[2], 1.5);
  d->state         = STUDY_DONE;
  d->value[0]      = peak;
  d->error[0]      = 1e-6 * peak;
  d->value[1]      = frequency_of(full[0], full[2]);
  d->value[2]      = full[0] > 20;
  d->derivative[0] = slope / full[0];
  d->derivative[1] = slope / full[1];
  d->derivative[2] = 1e-13;
  d->seconds       = 0.12;
  draw_curve(d, peak, d->value[1]);
  return d;
}

static void refuse(design_study *s, int i, study_state state, const char *reason) {
  study_design *d = &s->design[i];
  d->state        = state;
  study_design_set_reason(d, reason);
  if (state != STUDY_FAILED) return;
  for (int k = 0; k < s->n_outputs; k++) d->value[k] = d->error[k] = NAN;
  for (int k = 0; k < s->n_derivatives; k++) d->derivative[k] = NAN;
  assert_int_equal(study_curve_take(&d->curve, 0), SHB_OK);
}

static double geometric(double lo, double hi, int i, int n) {
  return lo * pow(hi / lo, n > 1 ? i / (n - 1.0) : 0);
}

static void make_grid(design_study *s, int n0, int mu, int thickness) {
  for (int i = 0; i < n0; i++)
    for (int j = 0; j < mu; j++)
      for (int k = 0; k < thickness; k++)
        add(s, (double[]){geometric(5, 500, i, n0), 0.2 + 0.1 * j, 4e-3 + 1e-3 * k});
}

static double uniform(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (*seed >> 8) / 16777216.0;
}

static void make_scattered(design_study *s, int n, double narrow) {
  unsigned seed = 7;
  for (int i = 0; i < n; i++) {
    double key[4];
    key[0] = 100 * pow(5, narrow * (2 * uniform(&seed) - 1));
    key[1] = 0.3 + 0.1 * narrow * (2 * uniform(&seed) - 1);
    key[2] = 5e-3 + 1e-3 * (2 * uniform(&seed) - 1);
    key[3] = 0.6 * (2 * uniform(&seed) - 1);
    add(s, key);
  }
}

static void make_search(design_study *s) {
  unsigned seed = 11;
  double   at[] = {30, 0.22};
  assert_int_equal(design_study_take_optimum(s, SEARCH), SHB_OK);
  for (int i = 0; i < SEARCH; i++) {
    double wide = 1.2 * exp(-i / 12.0), target[] = {110, 0.45};
    for (int k = 0; k < 2; k++) at[k] = target[k] * pow(at[k] / target[k], 0.93);
    add(s, (double[]){fmin(100, at[0] * exp(wide * (uniform(&seed) - 0.5))),
                      fmin(0.4, at[1] * exp(0.5 * wide * (uniform(&seed) - 0.5)))});
    s->optimum.history[i] = i;
    if (s->design[i].value[0] < s->design[s->optimum.best < 0 ? 0 : s->optimum.best].value[0])
      s->optimum.best = i;
  }
  s->optimum.on_bound[0] = s->optimum.on_bound[1] = 1;
  s->optimum.note = strdup("The optimum is within the error of its neighbours.");
  snprintf(s->optimum.method, sizeof s->optimum.method, "SBPLX (NLopt)");
  snprintf(s->optimum.objective, sizeof s->optimum.objective, "peak");
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Statistics of one output; the indices are set, not estimated. */
static void make_statistics(design_study *s) {
  static const double level[] = {5, 50, 95};
  assert_int_equal(design_study_take_uncertainty(s, 3, true), SHB_OK);
  study_uncertainty *u = &s->uncertainty;
  u->n_samples         = s->n;
  u->confidence        = 0.95;
  memcpy(u->level, level, sizeof level);
  for (int o = 0; o < 2; o++) {
    double list[SAMPLES], sum = 0, square = 0;
    for (int i = 0; i < s->n; i++) sum += list[i] = s->design[i].value[o];
    for (int i = 0; i < s->n; i++) square += pow(list[i] - sum / s->n, 2);
    u->mean[o]      = sum / s->n;
    u->deviation[o] = sqrt(square / (s->n - 1));
    qsort(list, (size_t)s->n, sizeof *list, ascending);
    for (int q = 0; q < 3; q++) {
      double at                    = level[q] / 100 * s->n;
      u->percentile[3 * o + q]     = list[(int)at];
      u->percentile_low[3 * o + q] = list[(int)fmax(0, at - 7)];
      /* as of few samples: the highest percentile has no upper bound */
      if (q < 2) u->percentile_high[3 * o + q] = list[(int)fmin(s->n - 1, at + 7)];
    }
    for (int k = 0; k < s->n_keys; k++) {
      int    i         = o * s->n_keys + k;
      double v         = k == 0 ? 0.7 : 0.12;
      u->first[i]      = v;
      u->first_low[i]  = v - 0.05;
      u->first_high[i] = v + 0.05;
      u->total[i]      = v + 0.08;
      u->total_low[i]  = v + 0.02;
      u->total_high[i] = v + 0.14;
    }
  }
}

/* Five preloads, at each of them 40 samples of mu; the percentiles are set, not estimated. */
static void make_robust(design_study *s) {
  enum { GROUPS = 5, EACH = 40 };
  for (int i = 0; i < GROUPS * EACH; i++) {
    const int group = i / EACH, sample = i % EACH;
    add(s, (double[]){60. + 30 * group, 0.2 + 0.005 * sample});
  }
  assert_int_equal(design_study_take_robust(s, GROUPS, 1, 2), SHB_OK);
  study_robust *r = &s->robust;
  r->confidence   = 0.95;
  r->level[0]     = 50;
  r->level[1]     = 95;
  for (int g = 0; g < GROUPS; g++) {
    r->key[g]           = 60. + 30 * g;
    r->n_samples[g]     = EACH - g;
    r->n_failed[g]      = g;
    r->mean[g * 3]      = studies_peak(r->key[g], 0.3, 5e-3);
    r->deviation[g * 3] = 1e-6;
    for (int q = 0; q < 2; q++) {
      int i                = g * 6 + q;
      r->percentile[i]     = (1 + 0.2 * q) * r->mean[g * 3];
      r->percentile_low[i] = 0.95 * r->percentile[i];
      if (q == 0) r->percentile_high[i] = 1.05 * r->percentile[i];
    }
  }
}

void studies_make(studies_kind kind, design_study *s) {
  switch (kind) {
    case STUDIES_GRID:
      start(kind, 3, "grid", s);
      make_grid(s, 9, 3, 3);
      for (int i = 72; i < 75; i++)
        refuse(s, i, STUDY_FAILED, "mesh: the sections overlap <at 0.4>");
      refuse(s, 40, STUDY_NOT_CONVERGED, "the curve stalled at 182.4 Hz");
      break;
    case STUDIES_PAIR:
      start(kind, 2, "grid", s);
      make_grid(s, 8, 5, 1);
      break;
    case STUDIES_OPTIMISE:
      start(kind, 2, "optimise", s);
      make_search(s);
      break;
    case STUDIES_UNCERTAIN:
      start(kind, 2, "uncertain", s);
      make_scattered(s, SAMPLES, 0.3);
      make_statistics(s);
      break;
    case STUDIES_ROBUST:
      start(kind, 2, "grid, 40 samples each", s);
      make_robust(s);
      break;
    case STUDIES_LARGE:
      start(kind, 4, "sobol", s);
      make_scattered(s, LARGE, 1);
      for (int i = 0; i < LARGE; i += 97) refuse(s, i, STUDY_FAILED, "mesh: no hexahedra");
      break;
    case STUDIES_ONE:
      start(kind, 1, "grid", s);
      add(s, NOMINAL);
      break;
    case STUDIES_FAILED:
      start(kind, 2, "grid", s);
      make_grid(s, 2, 2, 1);
      for (int i = 0; i < s->n; i++) refuse(s, i, STUDY_FAILED, "the case has no probe");
      break;
    default:
      start(kind, 2, "grid", s);
      s->finished = false;
  }
}
