#include "mhb/ring/ring_statistics.h"

#include <math.h>
#include <stdlib.h>

static const double SETTLED = 0.01, MOST_CORRELATION = 0.9;

static double mean_of(const double *x, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i];
  return sum / n;
}

mhb_block_mean mhb_block_mean_of(const double *x, int n) {
  double mean = mean_of(x, n), square = 0, product = 0;
  for (int i = 0; i < n; i++) square += (x[i] - mean) * (x[i] - mean);
  for (int i = 0; i + 1 < n; i++) product += (x[i] - mean) * (x[i + 1] - mean);
  double r = square > 0 ? fmin(fmax(product / square, 0), MOST_CORRELATION) : 0;
  return (mhb_block_mean){.mean  = mean,
                          .error = sqrt(square / (n - 1) / n * (1 + r) / (1 - r)),
                          .drift = mean_of(x + n - n / 2, n / 2) - mean_of(x, n / 2)};
}

bool mhb_block_mean_is_settled(const mhb_block_mean *a) {
  return a->error < SETTLED * a->mean && fabs(a->drift) < fmax(SETTLED * a->mean, 2 * a->error);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double mhb_percentile(double *x, int n, double share) {
  int at = (int)ceil(share * n) - 1;
  qsort(x, (size_t)n, sizeof *x, ascending);
  return x[at < 0 ? 0 : at < n ? at : n - 1];
}
