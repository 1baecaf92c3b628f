#include "cases/plan/statistics.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

shb_status plan_moments_of(int n, const double *y, plan_moments *moments) {
  plan_moments m = {.least = INFINITY, .greatest = -INFINITY};
  for (int i = 0; i < n; i++) {
    if (!isfinite(y[i])) continue;
    m.n++;
    m.mean += (y[i] - m.mean) / m.n; /* no overflow, no large sum */
    m.least    = fmin(m.least, y[i]);
    m.greatest = fmax(m.greatest, y[i]);
  }
  m.n_failed = n - m.n;
  SHB_CHECK(m.n > 0, SHB_ERR_INPUT, "no statistics: all %d samples failed", n);
  double second = 0, fourth = 0; /* sums of powers about the mean */
  for (int i = 0; i < n; i++) {
    if (!isfinite(y[i])) continue;
    double square = (y[i] - m.mean) * (y[i] - m.mean);
    second += square;
    fourth += square * square;
  }
  m.mean_error = m.deviation = m.deviation_error = NAN;
  if (m.n > 1) {
    double variance = second / (m.n - 1);
    m.deviation     = sqrt(variance);
    m.mean_error    = sqrt(variance / m.n);
  }
  if (m.n > 3) {
    double variance = second / (m.n - 1);
    /* variance of the unbiased variance */
    double of_variance = (fourth / m.n - variance * variance * (m.n - 3.0) / (m.n - 1.0)) / m.n;
    m.deviation_error  = m.deviation > 0 ? sqrt(fmax(of_variance, 0)) / (2 * m.deviation) : 0;
  }
  *moments = m;
  return SHB_OK;
}

/* P(B <= k) of B ~ binomial(n, p); k may be -1. */
static double binomial(int k, double p, int n) {
  return k < 0 ? 0 : gsl_cdf_binomial_P((unsigned)k, p, (unsigned)n);
}

/* Least k in -1 ... n with P(B <= k) > limit, which is below 1. */
static int least_above(double limit, double p, int n) {
  int below = -2, k = n;
  while (k - below > 1) {
    int middle = below + (k - below) / 2;
    if (binomial(middle, p, n) > limit)
      k = middle;
    else
      below = middle;
  }
  return k;
}

/* sorted [n]. The percentile lies between the values of ranks l and u, counted from 1, where
 * l <= B < u. */
static void percentile_of_sorted(int n, const double *sorted, double p, double confidence,
                                 plan_percentile *out) {
  double tail   = (1 - confidence) / 2;
  int    l      = least_above(tail, p, n);         /* P(B < l) <= tail */
  int    u      = least_above(1 - tail, p, n) + 1; /* P(B >= u) < tail */
  out->value    = gsl_stats_quantile_from_sorted_data(sorted, 1, (size_t)n, p);
  out->low      = l >= 1 ? sorted[l - 1] : -INFINITY;
  out->high     = u <= n ? sorted[u - 1] : INFINITY;
  double upper  = u <= n ? binomial(u - 1, p, n) : 1;
  out->coverage = upper - (l >= 1 ? binomial(l - 1, p, n) : 0);
}

shb_status plan_percentile_of(int n, const double *y, double p, double confidence,
                              plan_percentile *percentile) {
  double *sorted = malloc((size_t)n * sizeof *sorted + 1);
  SHB_CHECK(sorted, SHB_ERR_IO, "no memory for %d samples", n);
  int finite = 0;
  for (int i = 0; i < n; i++)
    if (isfinite(y[i])) sorted[finite++] = y[i];
  if (finite) {
    gsl_sort(sorted, 1, (size_t)finite);
    percentile_of_sorted(finite, sorted, p, confidence, percentile);
  }
  free(sorted);
  SHB_CHECK(finite, SHB_ERR_INPUT, "no percentile: all %d samples failed", n);
  return SHB_OK;
}

void plan_bootstrap_bounds(int n, double *resampled, double confidence, plan_estimate *estimate) {
  gsl_sort(resampled, 1, (size_t)n);
  double tail    = (1 - confidence) / 2;
  estimate->low  = gsl_stats_quantile_from_sorted_data(resampled, 1, (size_t)n, tail);
  estimate->high = gsl_stats_quantile_from_sorted_data(resampled, 1, (size_t)n, 1 - tail);
}
