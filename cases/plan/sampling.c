#include "cases/plan/sampling.h"

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

/* GSL's Sobol' numbers have 30 bits. */
static const double SOBOL_UNIT = 1 << 30;

/* GSL takes seed 0 for its default seed, which is 4357: seeds are counted from 1. */
static gsl_rng *generator(unsigned long seed) {
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  if (random) gsl_rng_set(random, seed + 1);
  return random;
}

static void shifted_sobol(int n, int d, gsl_qrng *sequence, gsl_rng *random, double *u) {
  unsigned long shift[PLAN_SOBOL_DIMENSIONS];
  double        rest[PLAN_SOBOL_DIMENSIONS];        /* of the digits that the sequence has not */
  double        point[PLAN_SOBOL_DIMENSIONS] = {0}; /* the origin, which GSL leaves out */
  for (int i = 0; i < d; i++) {
    shift[i] = gsl_rng_uniform_int(random, 1UL << 30);
    rest[i]  = gsl_rng_uniform_pos(random);
  }
  for (int j = 0; j < n; j++) {
    for (int i = 0; i < d; i++) {
      unsigned long digits = (unsigned long)lround(point[i] * SOBOL_UNIT) ^ shift[i];
      u[j * d + i]         = ((double)digits + rest[i]) / SOBOL_UNIT;
    }
    gsl_qrng_get(sequence, point);
  }
}

shb_status plan_sobol(int n, int d, unsigned long seed, double *u) {
  SHB_CHECK(d <= PLAN_SOBOL_DIMENSIONS, SHB_ERR_INPUT,
            "a Sobol' sequence has at most %d dimensions, %d are wanted; use a Latin hypercube",
            PLAN_SOBOL_DIMENSIONS, d);
  gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)d);
  gsl_rng  *random   = generator(seed);
  int       enough   = sequence && random;
  if (enough) shifted_sobol(n, d, sequence, random, u);
  if (sequence) gsl_qrng_free(sequence);
  if (random) gsl_rng_free(random);
  SHB_CHECK(enough, SHB_ERR_IO, "no memory for a Sobol' sequence");
  return SHB_OK;
}

shb_status plan_latin_hypercube(int n, int d, unsigned long seed, double *u) {
  gsl_rng *random = generator(seed);
  int     *slice  = malloc((size_t)n * sizeof *slice);
  int      enough = random && slice;
  for (int i = 0; enough && i < d; i++) {
    for (int j = 0; j < n; j++) slice[j] = j;
    gsl_ran_shuffle(random, slice, (size_t)n, sizeof *slice);
    for (int j = 0; j < n; j++) u[j * d + i] = (slice[j] + gsl_rng_uniform_pos(random)) / n;
  }
  free(slice);
  if (random) gsl_rng_free(random);
  SHB_CHECK(enough, SHB_ERR_IO, "no memory for a Latin hypercube of %d points", n);
  return SHB_OK;
}
