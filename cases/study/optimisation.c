#include "cases/study/optimisation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cases/designs/digest.h"
#include "cases/study/design_message.h"
#include "cases/study/optimiser.h"

/* A limit that is broken by 1 % of itself raises the objective by its own size. */
static const double PENALTY = 100;
/* Value of a design without a result. */
static const double FAILED = 1e30;
/* A key lies on a bound within this share of its range. */
static const double ON_BOUND = 1e-4;
/* Designs whose values differ by less than their error are told where they reach over this share of
 * a range. */
static const double INDISTINCT = 0.005;

typedef struct {
  int round, start, design;
} evaluation;

struct optimisation {
  const study_spec *spec;
  design_study     *study;
  optimiser        *search;
  int               n_known;
  design_study     *known; /* [n_known] */
  int               n, capacity;
  evaluation       *history;                   /* [n] */
  int               rounds[STUDY_MOST_STARTS]; /* evaluations of a start */
  int               waits[STUDY_MOST_STARTS];  /* design that a start waits for; -1: none */
  shb_status        status;
};

/* ---------------------------------------------------------------- values */

/* By how much a design breaks the limits, in parts of them. */
static double violation(const optimisation *o, const study_design *d) {
  const study_optimise *s   = &o->spec->optimise;
  double                sum = 0;
  for (int i = 0; i < s->n_limits; i++) {
    double limit = s->limit[i].value, value = d->value[s->limit[i].output];
    double over = s->limit[i].least ? limit - value : value - limit;
    if (!(over <= 0)) sum += over / (limit != 0 ? fabs(limit) : 1);
  }
  return sum;
}

static bool has_result(const optimisation *o, const study_design *d) {
  return d->state == STUDY_DONE && isfinite(d->value[o->spec->optimise.objective]) &&
         isfinite(violation(o, d));
}

/* What the search minimises. */
static double worth(const optimisation *o, const study_design *d) {
  if (!has_result(o, d)) return o->spec->optimise.algorithm == STUDY_SLOPE ? INFINITY : FAILED;
  double value = d->value[o->spec->optimise.objective];
  return value + PENALTY * violation(o, d) * fabs(value);
}

/* Slope of the peak along the only key, over its range; NAN: not known. */
static double slope(const optimisation *o, const study_design *d) {
  const study_key *key = &o->spec->keys.key[0];
  if (o->spec->optimise.algorithm != STUDY_SLOPE || !has_result(o, d)) return NAN;
  const double by = d->derivative[study_key_derivative(&o->spec->base, key)];
  return by * (key->log ? d->key[0] * log(key->to / key->from) : key->to - key->from);
}

/* ---------------------------------------------------------------- designs */

static double key_at(const study_key *key, double u) {
  if (u <= 0) return key->from;
  if (u >= 1) return key->to;
  return study_key_at(key, u);
}

static double unit_of(const study_key *key, double value) {
  return key->log ? log(value / key->from) / log(key->to / key->from)
                  : (value - key->from) / (key->to - key->from);
}

static int find(const design_study *s, const char *digest) {
  for (int i = 0; i < s->n && digest[0]; i++)
    if (strcmp(s->design[i].digest, digest) == 0) return i;
  return -1;
}

/* Take the result from a known study. */
static bool take_known(optimisation *o, study_design *to) {
  design_study *s = o->study;
  for (int i = 0; i < o->n_known; i++) {
    int at = find(&o->known[i], to->digest);
    if (at < 0) continue;
    const study_design *from = &o->known[i].design[at];
    if (from->state == STUDY_WAITING || from->state == STUDY_FAILED) continue;
    return design_message_copy(from, s->n_outputs, s->n_derivatives, to) == SHB_OK;
  }
  return false;
}

/* The design at a point of the unit cube, appended if it is new; -1: no memory. *open: it has no
 * result yet and is not at work. */
static int design_at(optimisation *o, const double *point, bool *open) {
  const study_keys *keys = &o->spec->keys;
  double            value[STUDY_MAX_KEYS];
  char              digest[DIGEST_TEXT], why[512];
  *open = false;
  for (int k = 0; k < keys->n; k++) value[k] = key_at(&keys->key[k], point[k]);
  study_spec_digest(o->spec, value, digest, why, sizeof why);
  int known = find(o->study, digest);
  if (known >= 0) return known;
  study_design *d = design_study_add(o->study, value);
  if (!d) return -1;
  snprintf(d->digest, STUDY_DIGEST, "%s", digest);
  if (!digest[0]) {
    d->state = STUDY_FAILED;
    study_design_set_reason(d, why[0] ? why : "the case is refused");
  } else {
    *open = !take_known(o, d);
  }
  return o->study->n - 1;
}

static bool remember(optimisation *o, int start, int design) {
  if (o->n == o->capacity) {
    int         more = o->capacity ? 2 * o->capacity : 256;
    evaluation *list = realloc(o->history, (size_t)more * sizeof *list);
    if (!list) return false;
    o->history  = list;
    o->capacity = more;
  }
  o->history[o->n++] = (evaluation){o->rounds[start]++, start, design};
  return true;
}

int optimisation_next(optimisation *o, const double **value) {
  const double *point;
  for (int start; o->status == SHB_OK && (start = optimiser_ask(o->search, &point)) >= 0;) {
    bool open;
    int  design = design_at(o, point, &open);
    if (design < 0 || !remember(o, start, design)) {
      o->status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
      return -1;
    }
    const study_design *d = &o->study->design[design];
    o->waits[start]       = design;
    if (open) {
      *value = d->key;
      return design;
    }
    if (d->state != STUDY_WAITING) optimisation_done(o, design);
  }
  return -1;
}

void optimisation_done(optimisation *o, int design) {
  const study_design *d = &o->study->design[design];
  for (int i = 0; i < o->spec->optimise.starts; i++) {
    if (o->waits[i] != design) continue;
    o->waits[i] = -1;
    optimiser_tell(o->search, i, worth(o, d), slope(o, d));
  }
}

/* ---------------------------------------------------------------- the end */

static int by_round(const void *left, const void *right) {
  const evaluation *a = left, *b = right;
  return a->round != b->round ? a->round - b->round : a->start - b->start;
}

/* Designs in the order of the history. */
static shb_status put_in_order(optimisation *o) {
  design_study *s    = o->study;
  study_design *list = calloc((size_t)s->capacity + 1, sizeof *list);
  int          *to = malloc(((size_t)s->n + 1) * sizeof *to), n = 0;
  if (!list || !to) {
    free(list);
    free(to);
    SHB_FAIL(SHB_ERR_IO, "out of memory");
  }
  if (o->n > 0) qsort(o->history, (size_t)o->n, sizeof *o->history, by_round);
  for (int i = 0; i < s->n; i++) to[i] = -1;
  for (int i = 0; i < o->n; i++) {
    int *place = &to[o->history[i].design];
    if (*place < 0) {
      list[n] = s->design[o->history[i].design];
      *place  = n++;
    }
    o->history[i].design = *place;
  }
  free(s->design);
  free(to);
  s->design = list;
  return SHB_OK;
}

static int best_of(const optimisation *o, int start) {
  int objective = o->spec->optimise.objective, best = -1;
  for (int i = 0; i < o->n; i++) {
    int                 at = o->history[i].design;
    const study_design *d  = &o->study->design[at];
    if ((start >= 0 && o->history[i].start != start) || !has_result(o, d)) continue;
    if (violation(o, d) > 0) continue;
    if (best < 0 || d->value[objective] < o->study->design[best].value[objective]) best = at;
  }
  return best;
}

static void note_limits(const optimisation *o, const study_design *best, FILE *out) {
  const study_optimise *s = &o->spec->optimise;
  for (int i = 0; i < s->n_limits; i++) {
    double value = best->value[s->limit[i].output], limit = s->limit[i].value;
    if (fabs(value - limit) > 1e-3 * fabs(limit)) continue;
    fprintf(out, "the limit of %s is reached: %.6g of %.6g\n",
            o->spec->output[s->limit[i].output].name, value, limit);
  }
}

/* How far the keys reach over the designs that the errors do not tell from the optimum. */
static void note_indistinct(const optimisation *o, const study_design *best, double error,
                            FILE *out) {
  for (int k = 0; k < o->spec->keys.n; k++) {
    const study_key *key = &o->spec->keys.key[k];
    double           low = best->key[k], high = low;
    for (int i = 0; i < o->study->n; i++) {
      const study_design *d = &o->study->design[i];
      if (!has_result(o, d) || violation(o, d) > 0) continue;
      if (d->value[o->spec->optimise.objective] > best->value[o->spec->optimise.objective] + error)
        continue;
      low  = fmin(low, d->key[k]);
      high = fmax(high, d->key[k]);
    }
    if (unit_of(key, high) - unit_of(key, low) > INDISTINCT)
      fprintf(out, "%s: designs from %.4g to %.4g %s are within the error of the optimum\n",
              key->path, low, high, strcmp(key->unit, "-") == 0 ? "" : key->unit);
  }
}

/* Warnings, one a line. */
static char *make_note(const optimisation *o, int best) {
  const study_optimise *s    = &o->spec->optimise;
  char                 *text = NULL;
  size_t                size;
  int                   used = 0, agree = 0;
  FILE                 *out = open_memstream(&text, &size);
  if (!out) return NULL;
  const study_design *b = best >= 0 ? &o->study->design[best] : NULL;
  if (!b) fprintf(out, "no design meets the limits\n");
  double error = b && isfinite(b->error[s->objective]) ? b->error[s->objective] : 0;
  for (int i = 0; i < s->starts; i++) {
    int own = best_of(o, i);
    used += optimiser_used_up(o->search, i);
    if (b && own >= 0)
      agree +=
          o->study->design[own].value[s->objective] <= b->value[s->objective] * (1 + 1e-4) + error;
  }
  if (used > 0)
    fprintf(out, "%d of %d starts used up their %d evaluations\n", used, s->starts,
            s->evaluations / s->starts);
  if (b && s->starts > 1 && s->algorithm != STUDY_SLOPE)
    fprintf(out, "%d of %d starts came to the same value within 1e-4\n", agree, s->starts);
  for (int k = 0; b && k < o->spec->keys.n; k++)
    if (o->study->optimum.on_bound[k])
      fprintf(out, "%s lies on the %s bound of its range\n", o->spec->keys.key[k].path,
              o->study->optimum.on_bound[k] < 0 ? "lower" : "upper");
  if (b) note_limits(o, b, out);
  if (b) note_indistinct(o, b, error, out);
  fclose(out);
  if (text && size > 0 && text[size - 1] == '\n') text[size - 1] = '\0';
  return text;
}

shb_status optimisation_finish(optimisation *o) {
  const study_optimise *s = &o->spec->optimise;
  char                  method[64];
  SHB_TRY(o->status);
  SHB_TRY(put_in_order(o));
  SHB_TRY(design_study_take_optimum(o->study, o->n));
  study_optimum *out = &o->study->optimum;
  for (int i = 0; i < o->n; i++) out->history[i] = o->history[i].design;
  out->best = best_of(o, -1);
  optimiser_name(s->algorithm, method, sizeof method);
  snprintf(out->method, STUDY_NAME, "%s, %d starts of %d evaluations, seed %d", method, s->starts,
           s->evaluations / s->starts, s->seed);
  snprintf(out->objective, STUDY_NAME, "%s", o->spec->output[s->objective].name);
  for (int k = 0; out->best >= 0 && k < o->spec->keys.n; k++) {
    double u         = unit_of(&o->spec->keys.key[k], o->study->design[out->best].key[k]);
    out->on_bound[k] = u < ON_BOUND ? -1 : u > 1 - ON_BOUND ? 1 : 0;
  }
  out->note = make_note(o, out->best);
  return SHB_OK;
}

shb_status optimisation_know(optimisation *o, design_study *known) {
  const design_study *s    = o->study;
  design_study       *list = realloc(o->known, ((size_t)o->n_known + 1) * sizeof *list);
  if (list) o->known = list;
  if (!list || known->n_outputs != s->n_outputs || known->n_derivatives != s->n_derivatives) {
    design_study_free(known);
    return list ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  o->known[o->n_known++] = *known;
  return SHB_OK;
}

shb_status optimisation_create(const study_spec *spec, design_study *study, optimisation **out) {
  optimisation *o     = calloc(1, sizeof *o);
  int           n     = spec->keys.n;
  double       *first = calloc((size_t)spec->n_designs * (size_t)n + 1, sizeof *first);
  shb_status    status =
      o && first ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  for (int i = 0; status == SHB_OK && i < spec->optimise.starts; i++) {
    o->waits[i] = -1;
    for (int k = 0; k < n; k++)
      first[i * n + k] = unit_of(&spec->keys.key[k], spec->design[(i + 2) * n + k]);
  }
  if (status == SHB_OK) {
    o->spec  = spec;
    o->study = study;
    status   = optimiser_create(&spec->optimise, n, first, &o->search);
  }
  free(first);
  if (status != SHB_OK) optimisation_destroy(o);
  if (status == SHB_OK) *out = o;
  return status;
}

void optimisation_destroy(optimisation *o) {
  if (!o) return;
  optimiser_destroy(o->search);
  for (int i = 0; i < o->n_known; i++) design_study_free(&o->known[i]);
  free(o->known);
  free(o->history);
  free(o);
}
