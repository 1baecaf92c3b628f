/* Means with their standard errors from blocks of a series, and percentiles. */
#ifndef MHB_RING_RING_STATISTICS_H
#define MHB_RING_RING_STATISTICS_H

#include <stdbool.h>

typedef struct {
  double mean, error; /* of the blocks; standard error with their correlation */
  double drift;       /* difference of the means of both halves */
} mhb_block_mean;

/* error = s/sqrt(n) sqrt((1 + r)/(1 - r)), s the standard deviation of the n block means, r their
 * correlation with the next one, within 0 to 0.9. n >= 3. */
mhb_block_mean mhb_block_mean_of(const double *block, int n);

/* Drift below 1 % of the mean, or two errors. */
bool mhb_block_mean_is_level(const mhb_block_mean *a);

/* Error below 1 % of the mean, and level. */
bool mhb_block_mean_is_settled(const mhb_block_mean *a);

/* Smallest value that at least `share` of x[n] do not exceed; x is reordered. */
double mhb_percentile(double *x, int n, double share);

#endif
