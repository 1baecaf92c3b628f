#include "postproc/study/study_effects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

enum { LEAST_DESIGNS = 8 };

typedef struct {
  double key, value;
} sample;

double study_done_value(const study_design *design, int output) {
  return design->state == STUDY_DONE && output >= 0 ? design->value[output] : NAN;
}

static int by_key(const void *a, const void *b) {
  double x = ((const sample *)a)->key, y = ((const sample *)b)->key;
  return (x > y) - (x < y);
}

/* Designs with a value, sorted by the key; returns their number. */
static int take_samples(const design_study *s, int output, int key, sample *list) {
  int n = 0;
  for (int i = 0; i < s->n; i++) {
    sample one = {s->design[i].key[key], study_done_value(&s->design[i], output)};
    if (isfinite(one.key) && isfinite(one.value)) list[n++] = one;
  }
  qsort(list, (size_t)n, sizeof *list, by_key);
  return n;
}

static bool same_level(double a, double b) {
  return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

static int count_levels(const sample *list, int n) {
  int levels = n > 0;
  for (int i = 1; i < n; i++) levels += !same_level(list[i - 1].key, list[i].key);
  return levels;
}

/* First sample behind group g, which begins at `from`. */
static int end_of_group(const sample *list, int n, int from, bool levels, int g, int groups) {
  if (!levels) return (int)((long)n * (g + 1) / groups);
  int end = from + 1;
  while (end < n && same_level(list[end - 1].key, list[end].key)) end++;
  return end;
}

/* Groups of eight designs at least. */
static int groups_of(int n) {
  int groups = n / LEAST_DESIGNS;
  return groups > STUDY_GROUPS ? STUDY_GROUPS : groups < 1 ? 1 : groups;
}

study_effect study_main_effect(const design_study *s, int output, int key) {
  study_effect e    = {.share = NAN};
  sample      *list = calloc((size_t)s->n + 1, sizeof *list);
  if (!list) return e;
  int    n = take_samples(s, output, key, list), levels = count_levels(list, n);
  bool   by_levels = levels <= STUDY_GROUPS && (n >= 2 * levels || s->n_keys == 1);
  int    groups = by_levels ? levels : groups_of(n), from = 0;
  double mean = 0, within = 0, all = 0;
  for (int i = 0; i < n; i++) mean += list[i].value / n;
  for (int g = 0; g < groups && from < n; g++) {
    int to = end_of_group(list, n, from, by_levels, g, groups), count = to - from;
    for (int i = from; i < to; i++) {
      e.at[g] += list[i].key / count;
      e.mean[g] += list[i].value / count;
    }
    for (int i = from; i < to; i++) {
      within += pow(list[i].value - e.mean[g], 2);
      all += pow(list[i].value - mean, 2);
    }
    from       = to;
    e.n_groups = g + 1;
  }
  free(list);
  bool judged = n >= LEAST_DESIGNS && groups > 1 && n > groups && all > 0 && s->n_keys > 1 &&
                s->optimum.n_history == 0 && design_study_count(s, STUDY_WAITING) == 0;
  if (!judged) return e;
  double chance = by_levels ? 1 : (n - 1.0) / (n - groups);
  e.share       = fmin(1, fmax(0, 1 - chance * within / all));
  return e;
}

int study_objective(const design_study *s) {
  int output = design_study_output(s, s->optimum.objective);
  if (output < 0) output = design_study_output(s, "peak");
  return output < 0 && s->n_outputs > 0 ? 0 : output;
}

int study_best(const design_study *s) {
  int best = -1, objective = study_objective(s);
  if (s->optimum.n_history > 0) return s->optimum.best;
  if (s->robust.n_groups > 0) return -1;
  for (int i = 0; i < s->n; i++) {
    double value = study_done_value(&s->design[i], objective);
    if (isfinite(value) && (best < 0 || value < s->design[best].value[objective])) best = i;
  }
  return best;
}

static int at_group(const design_study *s, int group, int level) {
  return (group * s->n_outputs + study_objective(s)) * s->robust.n_percentiles + level;
}

int study_best_group(const design_study *s, int *level) {
  const study_robust *r    = &s->robust;
  int                 best = -1;
  *level                   = -1;
  for (int q = 0; q < r->n_percentiles; q++)
    if (*level < 0 || r->level[q] > r->level[*level]) *level = q;
  if (*level < 0 || study_objective(s) < 0) return -1;
  for (int g = 0; g < r->n_groups; g++) {
    double value = r->percentile[at_group(s, g, *level)];
    if (isfinite(value) && (best < 0 || value < r->percentile[at_group(s, best, *level)])) best = g;
  }
  return best;
}

int study_count_equal_groups(const design_study *s, int best, int level) {
  const study_robust *r = &s->robust;
  int                 n = 0;
  if (best < 0) return 0;
  double high = r->percentile_high[at_group(s, best, level)];
  for (int g = 0; g < r->n_groups; g++) {
    double low = r->percentile_low[at_group(s, g, level)];
    n += g != best && isfinite(r->percentile[at_group(s, g, level)]) && !(low > high);
  }
  return n;
}

/* Error of an output; 0 if it is not known. */
static double error_of(const study_design *design, int output) {
  return isfinite(design->error[output]) ? fabs(design->error[output]) : 0;
}

int study_count_equals(const design_study *s, int best) {
  int n = 0, objective = study_objective(s);
  if (best < 0 || objective < 0) return 0;
  double least = s->design[best].value[objective], error = error_of(&s->design[best], objective);
  for (int i = 0; i < s->n; i++) {
    double value = study_done_value(&s->design[i], objective);
    n += i != best && fabs(value - least) <= error + error_of(&s->design[i], objective);
  }
  return n;
}

int study_chief_key(const design_study *s, double *share) {
  int chief = -1, objective = study_objective(s);
  *share = NAN;
  if (objective < 0 || s->n_keys < 2) return -1;
  for (int k = 0; k < s->n_keys; k++) {
    double own = s->uncertainty.has_sobol ? s->uncertainty.total[objective * s->n_keys + k]
                                          : study_main_effect(s, objective, k).share;
    if (!isfinite(own) || (chief >= 0 && own <= *share)) continue;
    chief  = k;
    *share = own;
  }
  return chief;
}

post_unit study_unit(const study_column *column, double largest) {
  static const struct {
    const char *unit;
    post_unit (*choose)(double largest);
  } table[] = {{"m", post_unit_length},
               {"N", post_unit_force},
               {"N/m", post_unit_stiffness},
               {"J", post_unit_energy}};
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (strcmp(column->unit, table[i].unit) == 0) return table[i].choose(largest);
  if (strcmp(column->unit, "rad") == 0) return (post_unit){"°", SHB_PI / 180};
  if (strcmp(column->unit, "Pa") == 0)
    return largest >= 1e9 ? (post_unit){"GPa", 1e9} : (post_unit){"MPa", 1e6};
  if (strcmp(column->unit, "-") == 0) return (post_unit){"", 1};
  return (post_unit){column->unit, 1};
}

post_unit study_key_unit(const design_study *s, int key) {
  double largest = 0;
  for (int i = 0; i < s->n; i++) largest = fmax(largest, fabs(s->design[i].key[key]));
  return study_unit(&s->key[key], largest);
}

post_unit study_output_unit(const design_study *s, int output) {
  double largest = 0;
  for (int i = 0; i < s->n; i++) largest = fmax(largest, fabs(s->design[i].value[output]));
  return study_unit(&s->output[output], largest);
}
