#include "cases/plan/sobol_indices.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "cases/plan/sampling.h"

enum { RESAMPLED = 1000 }; /* sets of blocks */

static shb_status check_inputs(int d) {
  SHB_CHECK(d >= 1 && d <= PLAN_INDEX_INPUTS, SHB_ERR_INPUT,
            "Sobol' indices are computed of 1 to %d inputs, not of %d", PLAN_INDEX_INPUTS, d);
  return SHB_OK;
}

shb_status plan_saltelli(int n, int d, unsigned long seed, double *u) {
  SHB_TRY(check_inputs(d));
  double *both = malloc((size_t)n * 2 * (size_t)d * sizeof *both + 1); /* [n][A, B][d] */
  SHB_CHECK(both, SHB_ERR_IO, "no memory for a plan of %d points", n);
  shb_status status = plan_sobol(n, 2 * d, seed, both);
  for (int j = 0; status == SHB_OK && j < n; j++) {
    const double *A = both + 2 * d * (size_t)j, *B = A + d;
    double       *block = u + (size_t)j * (size_t)(d + 2) * (size_t)d;
    memcpy(block, A, 2 * (size_t)d * sizeof *u);
    for (int i = 0; i < d; i++) {
      double *mixed = block + (size_t)(i + 2) * (size_t)d;
      memcpy(mixed, A, (size_t)d * sizeof *u);
      mixed[i] = B[i];
    }
  }
  free(both);
  return status;
}

/* First and total indices [2][d] of the blocks pick [n] of y, or of all blocks if pick is NULL.
 * False if the output has no variance. */
static bool estimate(int n, int d, const double *y, const int *pick, double *index) {
  double mean = 0, variance = 0;
  for (int j = 0; j < n; j++) {
    const double *block = y + (size_t)(pick ? pick[j] : j) * (size_t)(d + 2);
    mean += (block[0] + block[1]) / (2.0 * n);
  }
  memset(index, 0, 2 * (size_t)d * sizeof *index);
  for (int j = 0; j < n; j++) {
    const double *block = y + (size_t)(pick ? pick[j] : j) * (size_t)(d + 2);
    double        A = block[0], B = block[1];
    variance += ((A - mean) * (A - mean) + (B - mean) * (B - mean)) / (2.0 * n);
    for (int i = 0; i < d; i++) {
      double step = block[i + 2] - A;
      index[i] += (B - mean) * step / n; /* centred: the same mean, less variance */
      index[d + i] += step * step / (2.0 * n);
    }
  }
  if (!(variance > 0)) return false;
  for (int i = 0; i < 2 * d; i++) index[i] /= variance;
  return true;
}

/* Bounds of all indices. pick [n], index [2 d], resampled [2 d][RESAMPLED] are scratch. A set of
 * blocks without variance is drawn again. */
static void bounds(int n, int d, const double *y, double confidence, gsl_rng *random, int *pick,
                   double *resampled, plan_indices *indices) {
  double index[2 * PLAN_INDEX_INPUTS];
  for (int k = 0; k < RESAMPLED; k++) {
    do {
      for (int j = 0; j < n; j++) pick[j] = (int)gsl_rng_uniform_int(random, (unsigned long)n);
    } while (!estimate(n, d, y, pick, index));
    for (int i = 0; i < 2 * d; i++) resampled[i * RESAMPLED + k] = index[i];
  }
  for (int i = 0; i < d; i++) {
    plan_bootstrap_bounds(RESAMPLED, resampled + i * RESAMPLED, confidence, &indices->first[i]);
    plan_bootstrap_bounds(RESAMPLED, resampled + (d + i) * RESAMPLED, confidence,
                          &indices->total[i]);
  }
}

/* Copy the blocks without a failed design; their number. */
static int whole_blocks(int n, int d, const double *y, double *whole) {
  int kept = 0;
  for (int j = 0; j < n; j++) {
    bool finite = true;
    for (int i = 0; i < d + 2; i++) finite = finite && isfinite(y[(size_t)j * (d + 2) + i]);
    if (!finite) continue;
    memcpy(whole + (size_t)kept++ * (d + 2), y + (size_t)j * (d + 2), (d + 2) * sizeof *y);
  }
  return kept;
}

static shb_status evaluate(int n, int d, const double *whole, plan_indices *indices) {
  double index[2 * PLAN_INDEX_INPUTS];
  SHB_CHECK(n >= 2, SHB_ERR_INPUT,
            "Sobol' indices need 2 blocks of designs that all succeeded, there are %d", n);
  SHB_CHECK(estimate(n, d, whole, NULL, index), SHB_ERR_INPUT,
            "Sobol' indices need an output that varies");
  for (int i = 0; i < d; i++) {
    indices->first[i].value = index[i];
    indices->total[i].value = index[d + i];
  }
  return SHB_OK;
}

shb_status plan_indices_of(int n, int d, const double *y, double confidence, unsigned long seed,
                           plan_indices *indices) {
  SHB_TRY(check_inputs(d));
  double    *whole     = malloc((size_t)n * (size_t)(d + 2) * sizeof *whole + 1);
  double    *resampled = malloc(2 * (size_t)d * RESAMPLED * sizeof *resampled);
  int       *pick      = malloc((size_t)n * sizeof *pick + 1);
  gsl_rng   *random    = gsl_rng_alloc(gsl_rng_mt19937);
  shb_status status    = SHB_OK;
  if (whole && resampled && pick && random) {
    int kept          = whole_blocks(n, d, y, whole);
    indices->n_blocks = kept;
    indices->n_failed = n - kept;
    gsl_rng_set(random, seed + 1);
    status = evaluate(kept, d, whole, indices);
    if (status == SHB_OK) bounds(kept, d, whole, confidence, random, pick, resampled, indices);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "no memory for %d blocks of designs", n);
  }
  if (random) gsl_rng_free(random);
  free(pick);
  free(resampled);
  free(whole);
  return status;
}
