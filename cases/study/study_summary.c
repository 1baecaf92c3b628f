#include "cases/study/study_summary.h"

#include <math.h>

#include "postproc/study/study_effects.h"

static void put_bounds(double low, double high, FILE *out) {
  if (isfinite(low) && isfinite(high)) fprintf(out, " (%.4g to %.4g)", low, high);
}

/* "5 % 1.2 (1.1 to 1.3), ..." of n percentiles */
static void put_percentiles(int n, const double *level, const double *value, const double *low,
                            const double *high, FILE *out) {
  for (int q = 0; q < n; q++) {
    fprintf(out, "%s%g %% below %.5g", q ? ", " : "", level[q], value[q]);
    put_bounds(low[q], high[q], out);
  }
}

/* The keys by falling total index, with both indices. */
static void put_indices(const design_study *s, int output, FILE *out) {
  const study_uncertainty *u    = &s->uncertainty;
  double                   last = INFINITY;
  if (!u->has_sobol || !isfinite(u->total[output * s->n_keys])) return;
  fprintf(out, "  what matters most for %s: first and total Sobol' index\n",
          s->output[output].name);
  for (int done = 0, next = 0; next >= 0 && done < s->n_keys; done++) {
    next = -1;
    for (int k = 0; k < s->n_keys; k++) {
      double total = u->total[output * s->n_keys + k];
      if (total < last && (next < 0 || total > u->total[output * s->n_keys + next])) next = k;
    }
    if (next < 0) return;
    int i = output * s->n_keys + next;
    last  = u->total[i];
    fprintf(out, "    %-30s %.3f", s->key[next].name, u->first[i]);
    put_bounds(u->first_low[i], u->first_high[i], out);
    fprintf(out, ", %.3f", u->total[i]);
    put_bounds(u->total_low[i], u->total_high[i], out);
    fprintf(out, "\n");
  }
}

static void put_uncertainty(const design_study *s, FILE *out) {
  const study_uncertainty *u = &s->uncertainty;
  fprintf(out, "  %d samples, %d failed; bounds of %g %% confidence\n", u->n_samples, u->n_failed,
          100 * u->confidence);
  for (int m = 0; m < s->n_outputs; m++) {
    int q = m * u->n_percentiles;
    if (!isfinite(u->mean[m])) continue;
    fprintf(out, "  %-20s mean %.5g, deviation %.4g, ", s->output[m].name, u->mean[m],
            u->deviation[m]);
    put_percentiles(u->n_percentiles, u->level, u->percentile + q, u->percentile_low + q,
                    u->percentile_high + q, out);
    fprintf(out, "\n");
    put_indices(s, m, out);
  }
}

/* Percentiles of the objective at each design of the varied keys. */
static void put_robust(const design_study *s, FILE *out) {
  const study_robust *r = &s->robust;
  int                 level, objective = study_objective(s), best = study_best_group(s, &level);
  if (best < 0) return;
  fprintf(out, "  %s at each design of the varied keys; bounds of %g %% confidence\n",
          s->output[objective].name, 100 * r->confidence);
  for (int g = 0; g < r->n_groups; g++) {
    int i = (g * s->n_outputs + objective) * r->n_percentiles;
    fprintf(out, "   %s", g == best ? "*" : " ");
    for (int k = 0; k < r->n_varied; k++)
      fprintf(out, " %s = %.6g,", s->key[k].name, r->key[g * r->n_varied + k]);
    fprintf(out, " ");
    put_percentiles(r->n_percentiles, r->level, r->percentile + i, r->percentile_low + i,
                    r->percentile_high + i, out);
    if (r->n_failed[g] > 0) fprintf(out, "; %d samples failed", r->n_failed[g]);
    fprintf(out, "\n");
  }
}

void study_summary_statistics(const design_study *s, FILE *out) {
  if (s->uncertainty.mean) put_uncertainty(s, out);
  if (s->robust.n_groups > 0) put_robust(s, out);
}
