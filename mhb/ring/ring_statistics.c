#include "mhb/ring/ring_statistics.h"

#include <math.h>

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

bool mhb_block_mean_is_level(const mhb_block_mean *a) {
  return fabs(a->drift) < fmax(SETTLED * a->mean, 2 * a->error);
}

bool mhb_block_mean_is_settled(const mhb_block_mean *a) {
  return a->error < SETTLED * a->mean && mhb_block_mean_is_level(a);
}

static void swap(double *a, double *b) {
  const double x = *a;
  *a             = *b;
  *b             = x;
}

/* Hoare's selection: what is left and right of `at` is not larger, and not smaller. */
static double select_at(double *x, int n, int at) {
  for (int low = 0, high = n - 1; low < high;) {
    const double pivot = x[low + (high - low) / 2];
    int          i = low, j = high;
    while (i <= j) {
      while (x[i] < pivot) i++;
      while (x[j] > pivot) j--;
      if (i <= j) swap(&x[i++], &x[j--]);
    }
    if (at <= j)
      high = j;
    else if (at >= i)
      low = i;
    else
      break;
  }
  return x[at];
}

double mhb_percentile(double *x, int n, double share) {
  const int at = (int)ceil(share * n) - 1;
  return select_at(x, n, at < 0 ? 0 : at < n ? at : n - 1);
}
