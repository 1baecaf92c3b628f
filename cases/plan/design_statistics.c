#include "cases/plan/design_statistics.h"

#include <math.h>
#include <stdlib.h>

#include "cases/plan/sobol_indices.h"
#include "cases/plan/statistics.h"

enum { N_LEVELS = 3 };
static const double LEVEL[N_LEVELS] = {5, 50, 95};
static const double CONFIDENCE      = 0.95;

/* Where the statistics of one output go. */
typedef struct {
  double *mean, *deviation;
  double *percentile, *low, *high; /* [N_LEVELS] */
} place;

static double value_of(const design_study *s, int design, int output) {
  const study_design *d = &s->design[design];
  return d->state == STUDY_DONE ? d->value[output] : NAN;
}

/* The samples of an output in a group; blocks hold two each. Returns their number. */
static int take(const design_samples *p, const design_study *s, int group, int output, double *y) {
  int block = s->n_keys + 2, n = 0;
  for (int i = 0; i < p->group; i++)
    if (!p->blocks || i % block < 2) y[n++] = value_of(s, group * p->group + i, output);
  return n;
}

static shb_status put_percentiles(int n, const double *y, const place *to) {
  for (int q = 0; q < N_LEVELS; q++) {
    plan_percentile one;
    SHB_TRY(plan_percentile_of(n, y, LEVEL[q] / 100, CONFIDENCE, &one));
    to->percentile[q] = one.value;
    to->low[q]        = isfinite(one.low) ? one.low : NAN;
    to->high[q]       = isfinite(one.high) ? one.high : NAN;
  }
  return SHB_OK;
}

/* Statistics of samples y [n]; counts of good and failed ones. */
static shb_status put_statistics(int n, const double *y, const place *to, int *good, int *failed) {
  plan_moments moments;
  *good = 0;
  for (int i = 0; i < n; i++) *good += isfinite(y[i]);
  *failed = n - *good;
  if (*good == 0) return SHB_OK;
  SHB_TRY(plan_moments_of(n, y, &moments));
  *to->mean      = moments.mean;
  *to->deviation = moments.deviation;
  return put_percentiles(n, y, to);
}

/* Indices of one output; those of an output without variance stay unknown. */
static shb_status put_indices(const design_samples *p, design_study *s, int output, double *y) {
  study_uncertainty *u = &s->uncertainty;
  plan_indices       indices;
  for (int i = 0; i < p->group; i++) y[i] = value_of(s, i, output);
  shb_status status =
      plan_indices_of(p->group / (s->n_keys + 2), s->n_keys, y, CONFIDENCE, p->seed, &indices);
  if (status == SHB_ERR_INPUT) return SHB_OK;
  SHB_TRY(status);
  for (int k = 0; k < s->n_keys; k++) {
    int i            = output * s->n_keys + k;
    u->first[i]      = indices.first[k].value;
    u->first_low[i]  = indices.first[k].low;
    u->first_high[i] = indices.first[k].high;
    u->total[i]      = indices.total[k].value;
    u->total_low[i]  = indices.total[k].low;
    u->total_high[i] = indices.total[k].high;
  }
  return SHB_OK;
}

static shb_status fill_uncertainty(const design_samples *p, design_study *s, double *y) {
  SHB_TRY(design_study_take_uncertainty(s, N_LEVELS, p->blocks));
  study_uncertainty *u = &s->uncertainty;
  u->confidence        = CONFIDENCE;
  for (int q = 0; q < N_LEVELS; q++) u->level[q] = LEVEL[q];
  for (int m = 0; m < s->n_outputs; m++) {
    int         n = take(p, s, 0, m, y), good, failed, at = m * N_LEVELS;
    const place to = {u->mean + m, u->deviation + m, u->percentile + at, u->percentile_low + at,
                      u->percentile_high + at};
    SHB_TRY(put_statistics(n, y, &to, &good, &failed));
    if (m == 0) u->n_samples = good;
    if (m == 0) u->n_failed = failed;
    if (p->blocks) SHB_TRY(put_indices(p, s, m, y));
  }
  return SHB_OK;
}

static shb_status fill_robust(const design_samples *p, design_study *s, double *y) {
  int groups = s->n / p->group;
  SHB_TRY(design_study_take_robust(s, groups, p->n_varied, N_LEVELS));
  study_robust *r = &s->robust;
  r->confidence   = CONFIDENCE;
  for (int q = 0; q < N_LEVELS; q++) r->level[q] = LEVEL[q];
  for (int i = 0; i < groups * s->n_outputs; i++) {
    int         g = i / s->n_outputs, m = i % s->n_outputs, at = i * N_LEVELS, good, failed;
    int         n  = take(p, s, g, m, y);
    const place to = {r->mean + i, r->deviation + i, r->percentile + at, r->percentile_low + at,
                      r->percentile_high + at};
    SHB_TRY(put_statistics(n, y, &to, &good, &failed));
    if (m > 0) continue;
    r->n_samples[g] = good;
    r->n_failed[g]  = failed;
    for (int k = 0; k < p->n_varied; k++)
      r->key[g * p->n_varied + k] = s->design[g * p->group].key[k];
  }
  return SHB_OK;
}

shb_status design_statistics(const design_samples *p, design_study *s) {
  double *y = calloc((size_t)p->group + 1, sizeof *y);
  SHB_CHECK(y, SHB_ERR_IO, "no memory for the statistics of %d samples", p->group);
  shb_status status = p->n_varied > 0 ? fill_robust(p, s, y) : fill_uncertainty(p, s, y);
  free(y);
  return status;
}
