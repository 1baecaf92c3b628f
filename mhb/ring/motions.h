/* Motions that starts of a ring reach, told apart by their statistics.
 *
 * Blocks have 25 periods; the first half of them is discarded. A start is settled by
 * mhb_block_mean_is_settled. Two are compared by their means and percentiles; of two waves by those
 * of the last block. The spread of a block is
 *   D^2 = mean over blades and periods of |a_b - mean|^2/|mean|^2,
 * a_b the first harmonic of the output with the lag of the wave undone. Rules and how they were
 * found: docs/theory/lasting.md. */
#ifndef MHB_RING_MOTIONS_H
#define MHB_RING_MOTIONS_H

#include "mhb/ring/ring_statistics.h"

/* One start: mean of the peaks and spread of each block [blocks], over the wave's, and the peaks
 * [n_peaks] of the half that counts. */
typedef struct {
  int           blocks, n_peaks;
  const double *mean, *spread;
  double       *peak;     /* mhb_motion_of reorders them */
  bool          mistuned; /* steps err differently in every blade: a spread of 1 % is none */
} mhb_lasting_series;

/* What a start shows, or several that reached the same motion. */
typedef struct {
  bool           wave;        /* on a wave, or coming back to one */
  bool           settled;     /* its statistics */
  bool           calm;        /* they do not drift, and tell motions 10 % apart */
  int            starts;      /* that reached it */
  mhb_block_mean half;        /* of the blocks that count, over the wave's */
  double         last;        /* mean of the last block */
  double         worst;       /* 99.9 percentile of the peaks that count */
  double         worst_error; /* its standard error, from quarters of the periods */
} mhb_motion;

/* Of one start. A motion is settled if its mean is and its spread is steady: side waves that still
 * grow or die change the mean late. last: no more blocks can be had, so the mean decides alone. */
mhb_motion mhb_motion_of(const mhb_lasting_series *series, bool last);

/* Mean, its standard error, and worst; of a wave those of the last block. */
double mhb_motion_mean(const mhb_motion *m, bool wave);
double mhb_motion_error(const mhb_motion *m, bool wave);
double mhb_motion_worst(const mhb_motion *m, bool wave);

/* How far two are apart: 1 at 1 % or three standard errors of the mean, or at 3 % or three standard
 * errors of the percentile. Below 1 they are the same, above 2 they are different motions. */
double mhb_motion_distance(const mhb_motion *a, const mhb_motion *b);

#endif
