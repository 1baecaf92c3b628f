#include "cases/designs/study_echo.h"

#include <math.h>
#include <string.h>

#include "mesh/base/constants.h"

/* An SI unit and the one in which engineers read it: value times factor, from a magnitude on. */
static const struct {
  const char *si, *shown;
  double      factor, from;
} scales[] = {{"m", "mm", 1e3, 1e-4},          {"m", "um", 1e6, 0},
              {"Pa", "GPa", 1e-9, 1e10},       {"Pa", "MPa", 1e-6, 1e3},
              {"rad", "deg", 180 / SHB_PI, 0}, {"rad/s", "rpm", 30 / SHB_PI, 0},
              {"N/m", "kN/mm", 1e-6, 1e6},     {"N/m", "N/m", 1, 0}};

void study_echo_value(double value, const char *unit, char out[STUDY_ECHO]) {
  for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
    if (strcmp(unit, scales[i].si) != 0 || fabs(value) < scales[i].from) continue;
    snprintf(out, STUDY_ECHO, "%.6g %s", value * scales[i].factor,
             value == 0 ? unit : scales[i].shown);
    return;
  }
  const bool pure = strcmp(unit, "-") == 0 || !unit[0];
  snprintf(out, STUDY_ECHO, "%.6g%s%s", value, pure ? "" : " ", pure ? "" : unit);
}

static void print_range(const study_key *key, FILE *out) {
  char low[STUDY_ECHO], high[STUDY_ECHO];
  study_echo_value(key->from, key->unit, low);
  study_echo_value(key->to, key->unit, high);
  fprintf(out, "%s to %s", low, high);
  if (key->n > 0) fprintf(out, ", %d points", key->n);
  if (key->log) fputs(", in equal ratios", out);
}

/* The values of a list; of a long one the first and the last. */
static void print_list(const study_key *key, FILE *out) {
  enum { SHOWN = 8 };
  for (int i = 0; i < key->n; i++) {
    char value[STUDY_ECHO];
    if (key->n > SHOWN && i == SHOWN - 2) {
      fputs(", ...", out);
      i = key->n - 1;
    }
    study_echo_value(key->value[i], key->unit, value);
    fprintf(out, "%s%s", i ? ", " : "", value);
  }
}

static void print_distribution(const study_key *key, FILE *out) {
  static const char *const        mean[]   = {"mean", "deviation", "from", "to"},
                           *const low[]    = {"from", "to"},
                           *const three[]  = {"from", "most likely", "to"};
  const plan_distribution        *d        = &key->distribution;
  const bool                      triangle = d->kind == PLAN_TRIANGULAR;
  const bool         has_range             = d->kind == PLAN_UNIFORM || d->kind == PLAN_LOG_UNIFORM;
  const char *const *name                  = triangle ? three : has_range ? low : mean;
  fputs(plan_distribution_name(d->kind), out);
  for (int i = 0; i < plan_distribution_parameters(d->kind); i++) {
    char value[STUDY_ECHO];
    study_echo_value(d->parameter[i], key->unit, value);
    fprintf(out, ", %s %s", name[i], value);
    if (name == mean && i == 1 && d->parameter[0] != 0)
      fprintf(out, " (%.3g %%)", 100 * d->parameter[1] / fabs(d->parameter[0]));
  }
}

/* The extremes of a column of a table. */
static void print_column(const study_spec *s, int k, FILE *out) {
  double low = INFINITY, high = -INFINITY;
  char   from[STUDY_ECHO], to[STUDY_ECHO];
  for (int d = 0; d < s->n_designs; d++) {
    const double value = s->design[(size_t)d * (size_t)s->keys.n + (size_t)k];
    low                = fmin(low, value);
    high               = fmax(high, value);
  }
  study_echo_value(low, s->keys.key[k].unit, from);
  study_echo_value(high, s->keys.key[k].unit, to);
  fprintf(out, low == high ? "%s" : "%s to %s", from, to);
}

static void print_key(const study_spec *s, int k, FILE *out) {
  const study_key *key = &s->keys.key[k];
  char             name[STUDY_KEY_TEXT];
  study_key_name(key, name);
  fprintf(out, "  %-9s %s: ", key->is_uncertain ? "uncertain" : "vary", name);
  if (key->is_uncertain)
    print_distribution(key, out);
  else if (key->is_range)
    print_range(key, out);
  else if (key->n > 0)
    print_list(key, out);
  else
    print_column(s, k, out);
  fputc('\n', out);
}

static void print_plan(const study_spec *s, FILE *out) {
  const study_optimise *o = &s->optimise;
  char                  plan[128], value[STUDY_ECHO];
  if (o->wanted) {
    fprintf(out, "  optimise  %s by %s, %d starts of %d evaluations\n",
            s->output[o->objective].name, study_algorithm_name(o->algorithm), o->starts,
            o->evaluations / o->starts);
    for (int i = 0; i < o->n_limits; i++) {
      const study_output *output = &s->output[o->limit[i].output];
      study_echo_value(o->limit[i].value, output->unit, value);
      fprintf(out, "  limit     %s at %s %s\n", output->name, o->limit[i].least ? "least" : "most",
              value);
    }
    return;
  }
  study_plan_text(&s->plan, &s->keys, plan, sizeof plan);
  fprintf(out, "  plan      %s\n  designs   %d\n", plan, s->n_designs);
  if (study_plan_has_blocks(&s->plan, &s->keys))
    fprintf(out, "  samples   %d; the other designs are for the Sobol' indices\n",
            2 * study_plan_group(&s->plan, &s->keys) / (s->keys.n + 2));
}

/* "90 s", "12 min", "3.5 h", "2.1 days" */
static void put_time(double seconds, char out[STUDY_ECHO]) {
  static const struct {
    double      unit;
    const char *name;
  } scale[] = {{86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}};
  int i     = 0;
  while (i < 3 && seconds < 2 * scale[i].unit) i++;
  snprintf(out, STUDY_ECHO, "%.2g %s", seconds / scale[i].unit, scale[i].name);
}

static void print_cost(const study_spec *s, const study_cost *cost, int cores, FILE *out) {
  const int n = s->optimise.wanted ? s->optimise.evaluations : s->n_designs;
  char      all[STUDY_ECHO], each[STUDY_ECHO];
  fprintf(out, "  cost      %s%d sweep%s", s->optimise.wanted ? "at most " : "", n,
          n == 1 ? "" : "s");
  if (s->n_models > 0 && !s->optimise.wanted)
    fprintf(out, ", %d set%s of modes", s->n_models, s->n_models == 1 ? "" : "s");
  if (cost->n == 0) {
    fputs("; no design of this case is known yet, so no time\n", out);
    return;
  }
  put_time(cost->seconds * n / cores, all);
  put_time(cost->seconds, each);
  fprintf(out, ": about %s on %d core%s, at %s each, as %d known design%s took\n", all, cores,
          cores == 1 ? "" : "s", each, cost->n, cost->n == 1 ? "" : "s");
}

void study_echo(const study_spec *s, const study_cost *cost, int cores, FILE *out) {
  fprintf(out, "%s: ok\n  case      %s\n", s->path, s->case_path);
  print_plan(s, out);
  for (int k = 0; k < s->keys.n; k++) print_key(s, k, out);
  fputs("  outputs   ", out);
  for (int i = 0; i < s->n_outputs; i++) fprintf(out, "%s%s", i ? ", " : "", s->output[i].name);
  fputc('\n', out);
  print_cost(s, cost, cores, out);
}
