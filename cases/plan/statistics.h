/* Statistics of a sample, each with its error. Values that are not finite are failed samples: they
 * are counted and left out. */
#ifndef CASES_PLAN_STATISTICS_H
#define CASES_PLAN_STATISTICS_H

#include "mesh/base/status.h"

/* Errors are standard errors of independent samples. A Sobol' plan errs less. */
typedef struct {
  int    n, n_failed; /* n without the failed ones */
  double mean, mean_error;
  double deviation, deviation_error; /* unbiased variance; NAN with fewer than 2 samples */
  double least, greatest;
} plan_moments;

/* A percentile between two values of the sample. */
typedef struct {
  double value;     /* interpolated */
  double low, high; /* bounds; -INFINITY, INFINITY where the sample is too small for one */
  double coverage;  /* probability that the bounds hold the percentile, at least as wanted */
} plan_percentile;

/* An estimate and the bounds of its confidence. */
typedef struct {
  double value, low, high;
} plan_estimate;

/* Moments of y [n].
 *
 * The error of the deviation follows from the fourth moment.
 * Errors: SHB_ERR_INPUT no finite value. */
shb_status plan_moments_of(int n, const double *y, plan_moments *moments);

/* The percentile of probability p, 0 < p < 1, of y [n] with bounds of a confidence, e.g. 0.95.
 *
 * The bounds are values of the sample whose ranks follow from the binomial distribution. They hold
 * for every continuous distribution of y. Each side errs with at most half of 1 - confidence.
 * Source: David, Nagaraja 2003, Order statistics, sec. 7.1.
 * Errors: SHB_ERR_INPUT no finite value; SHB_ERR_IO no memory. */
shb_status plan_percentile_of(int n, const double *y, double p, double confidence,
                              plan_percentile *percentile);

/* Bounds of a statistic from its values in resampled samples [n], which are sorted.
 * Source: Efron 1981, percentile bootstrap. */
void plan_bootstrap_bounds(int n, double *resampled, double confidence, plan_estimate *estimate);

#endif
