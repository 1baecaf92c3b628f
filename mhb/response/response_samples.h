/* Amplification factors of random samples of a mistuned ring, and their distribution. */
#ifndef MHB_RESPONSE_RESPONSE_SAMPLES_H
#define MHB_RESPONSE_RESPONSE_SAMPLES_H

#include "modal/hdf5/h5.h"

typedef struct {
  int     n, preloads, blades;
  double *n0;        /* [preload] N */
  double *deviation; /* [sample][blade] relative frequency deviations */
  double *factor;    /* [preload][sample] worst blade's peak over the tuned one's; 0: not done */
  double *frequency; /* [preload][sample] Hz, where that is */
  int    *blade;     /* [preload][sample] which blade, from 0 */
  int    *mark;      /* [preload][sample] 1: its error is above the tolerance, it is no result */
} mhb_samples;

/* Zeros. */
mhb_samples *mhb_samples_create(int n, int preloads, int blades);
void         mhb_samples_destroy(mhb_samples *samples);

/* Samples of a preload that are done. */
int mhb_samples_done(const mhb_samples *samples, int preload);

/* Of them, marked. */
int mhb_samples_marked(const mhb_samples *samples, int preload);

/* Sample with the largest factor of a preload, of those not marked; -1: there is none. */
int mhb_samples_worst(const mhb_samples *samples, int preload);

/* A quantile of the factors done, 0 < p < 1, with bounds that hold it with 95 % confidence. The
 * bounds are order statistics. By the binomial distribution each is wrong in 2.5 % of the cases at
 * most, whatever the distribution of the factor. A bound that so few samples do not give is NAN, as
 * are all three without samples. The quantile is of the samples not marked. A marked one may have
 * any factor, and the bounds hold wherever it is.
 *   out  out  [3] quantile (linear between order statistics), lower bound, upper bound */
void mhb_samples_quantile(const mhb_samples *samples, int preload, double p, double out[3]);

/* The group /samples of an open response file. */
shb_status mhb_samples_write(hid_t file, const mhb_samples *samples);
/* *samples <- NULL if the file has none. */
shb_status mhb_samples_read(hid_t file, mhb_samples **samples);

#endif
