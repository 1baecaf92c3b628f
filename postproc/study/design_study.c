#include "postproc/study/design_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *unknowns(size_t n) {
  double *value = malloc((n ? n : 1) * sizeof *value);
  for (size_t i = 0; value && i < n; i++) value[i] = NAN;
  return value;
}

shb_status design_study_create(int n_keys, int n_outputs, int n_derivatives, design_study *s) {
  *s               = (design_study){.n_keys = n_keys, .n_outputs = n_outputs};
  s->n_derivatives = n_derivatives;
  s->optimum.best  = -1;
  s->key           = calloc((size_t)n_keys + 1, sizeof *s->key);
  s->output        = calloc((size_t)n_outputs + 1, sizeof *s->output);
  s->derivative    = calloc((size_t)n_derivatives + 1, sizeof *s->derivative);
  SHB_CHECK(s->key && s->output && s->derivative, SHB_ERR_IO, "no memory for a design study");
  for (int i = 0; i < n_derivatives; i++) s->derivative[i].at = NAN;
  return SHB_OK;
}

static void free_curve(study_curve *c) {
  free(c->branch);
  free(c->frequency);
  free(c->amplitude);
  free(c->stable);
  *c = (study_curve){0};
}

static void free_design(study_design *d) {
  free(d->key);
  free(d->value);
  free(d->error);
  free(d->derivative);
  free(d->reason);
  free_curve(&d->curve);
}

static void free_optimum(study_optimum *o) {
  free(o->note);
  free(o->on_bound);
  free(o->history);
}

static void free_uncertainty(study_uncertainty *u) {
  double *all[] = {u->level,           u->mean,      u->deviation, u->percentile, u->percentile_low,
                   u->percentile_high, u->first,     u->first_low, u->first_high, u->total,
                   u->total_low,       u->total_high};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
}

static void free_robust(study_robust *r) {
  double *all[] = {r->level,          r->key,        r->mean,
                   r->deviation,      r->percentile, r->percentile_low,
                   r->percentile_high};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
  free(r->n_samples);
  free(r->n_failed);
}

void design_study_free(design_study *s) {
  free(s->name);
  free(s->text);
  free(s->case_text);
  free(s->path);
  free(s->case_path);
  free(s->key);
  free(s->output);
  free(s->derivative);
  for (int i = 0; i < s->n; i++) free_design(&s->design[i]);
  free(s->design);
  free_optimum(&s->optimum);
  free_uncertainty(&s->uncertainty);
  free_robust(&s->robust);
  *s = (design_study){0};
}

static bool grow(design_study *s) {
  if (s->n < s->capacity) return true;
  int           capacity = s->capacity ? 2 * s->capacity : 64;
  study_design *grown    = realloc(s->design, (size_t)capacity * sizeof *grown);
  if (!grown) return false;
  s->design   = grown;
  s->capacity = capacity;
  return true;
}

study_design *design_study_add(design_study *s, const double *key) {
  if (!grow(s)) return NULL;
  study_design d = {.key        = unknowns((size_t)s->n_keys),
                    .value      = unknowns((size_t)s->n_outputs),
                    .error      = unknowns((size_t)s->n_outputs),
                    .derivative = unknowns((size_t)s->n_derivatives),
                    .tried_from = -1};
  if (!d.key || !d.value || !d.error || !d.derivative) {
    free_design(&d);
    return NULL;
  }
  if (s->n_keys > 0) memcpy(d.key, key, (size_t)s->n_keys * sizeof *key);
  s->design[s->n] = d;
  return &s->design[s->n++];
}

shb_status design_study_take_optimum(design_study *s, int n_history) {
  study_optimum *o = &s->optimum;
  free_optimum(o);
  o->note      = NULL;
  o->best      = -1;
  o->n_history = n_history;
  o->on_bound  = calloc((size_t)s->n_keys + 1, sizeof *o->on_bound);
  o->history   = calloc((size_t)n_history + 1, sizeof *o->history);
  SHB_CHECK(o->on_bound && o->history, SHB_ERR_IO, "no memory for an optimum");
  return SHB_OK;
}

shb_status design_study_take_uncertainty(design_study *s, int n_percentiles, bool sobol) {
  study_uncertainty *u = &s->uncertainty;
  free_uncertainty(u);
  *u              = (study_uncertainty){.n_percentiles = n_percentiles, .has_sobol = sobol};
  size_t   m      = (size_t)s->n_outputs;
  size_t   wide   = m * (size_t)n_percentiles;
  size_t   index  = sobol ? m * (size_t)s->n_keys : 0;
  bool     good   = (u->level = unknowns((size_t)n_percentiles)) != NULL;
  double **flat[] = {&u->mean, &u->deviation};
  double **per[]  = {&u->percentile, &u->percentile_low, &u->percentile_high};
  double **six[]  = {&u->first, &u->first_low, &u->first_high,
                     &u->total, &u->total_low, &u->total_high};
  for (size_t i = 0; i < 2; i++) good = (*flat[i] = unknowns(m)) && good;
  for (size_t i = 0; i < 3; i++) good = (*per[i] = unknowns(wide)) && good;
  for (size_t i = 0; i < 6; i++) good = (*six[i] = unknowns(index)) && good;
  SHB_CHECK(good, SHB_ERR_IO, "no memory for the statistics of %d outputs", s->n_outputs);
  return SHB_OK;
}

shb_status design_study_take_robust(design_study *s, int n_groups, int n_varied,
                                    int n_percentiles) {
  study_robust *r = &s->robust;
  free_robust(r);
  *r = (study_robust){.n_groups = n_groups, .n_varied = n_varied, .n_percentiles = n_percentiles};
  size_t   n      = (size_t)n_groups * (size_t)s->n_outputs;
  double **flat[] = {&r->mean, &r->deviation};
  double **per[]  = {&r->percentile, &r->percentile_low, &r->percentile_high};
  bool     good   = (r->level = unknowns((size_t)n_percentiles)) != NULL;
  good            = (r->key = unknowns((size_t)n_groups * (size_t)n_varied)) && good;
  for (size_t i = 0; i < 2; i++) good = (*flat[i] = unknowns(n)) && good;
  for (size_t i = 0; i < 3; i++) good = (*per[i] = unknowns(n * (size_t)n_percentiles)) && good;
  r->n_samples = calloc((size_t)n_groups + 1, sizeof *r->n_samples);
  r->n_failed  = calloc((size_t)n_groups + 1, sizeof *r->n_failed);
  SHB_CHECK(good && r->n_samples && r->n_failed, SHB_ERR_IO,
            "no memory for the statistics of %d designs", n_groups);
  return SHB_OK;
}

void study_design_set_reason(study_design *d, const char *text) {
  free(d->reason);
  d->reason = text && text[0] ? strdup(text) : NULL;
}

shb_status study_curve_take(study_curve *c, int n) {
  free_curve(c);
  size_t size  = (size_t)n + 1;
  c->branch    = calloc(size, sizeof *c->branch);
  c->frequency = calloc(size, sizeof *c->frequency);
  c->amplitude = calloc(size, sizeof *c->amplitude);
  c->stable    = calloc(size, sizeof *c->stable);
  if (!c->branch || !c->frequency || !c->amplitude || !c->stable) {
    free_curve(c);
    SHB_FAIL(SHB_ERR_IO, "no memory for a curve of %d points", n);
  }
  c->n = n;
  return SHB_OK;
}

const char *study_state_name(study_state state) {
  static const char *const names[STUDY_N_STATES] = {"not run", "done", "failed", "not converged"};
  return names[state];
}

int design_study_output(const design_study *s, const char *name) {
  for (int i = 0; i < s->n_outputs; i++)
    if (strcmp(s->output[i].name, name) == 0) return i;
  return -1;
}

int design_study_count(const design_study *s, study_state state) {
  int n = 0;
  for (int i = 0; i < s->n; i++) n += s->design[i].state == state;
  return n;
}
