/* What is read from a ring after each period, and small disturbances of it. */
#ifndef MHB_RING_RING_OUTPUT_H
#define MHB_RING_RING_OUTPUT_H

#include "mhb/ring/noise.h"
#include "mhb/ring/ring_step.h"

typedef struct {
  double         *peak;  /* [lanes] m: largest distance of the output from its mean of the period */
  double complex *first; /* [3][used lanes] m: harmonic of the excitation */
  double         *mean;  /* [3][lanes] m, scratch */
  double         *turn;  /* [samples][2] 2/n exp(-j phase) */
  double         *parts; /* [2 (re, im)][3][lanes] scratch */
  double         *space; /* [2][mode][lanes] scratch of mhb_ring_move and mhb_ring_disturb */
  shb_arena       arena;
} mhb_ring_output;

void mhb_ring_output_create(const mhb_ring *ring, mhb_ring_output *output);
void mhb_ring_output_destroy(mhb_ring_output *output);

/* Peaks of the last period. */
void mhb_ring_peaks(const mhb_ring *ring, mhb_ring_output *output);

/* First harmonics of the last period. */
void mhb_ring_first_harmonics(const mhb_ring *ring, mhb_ring_output *output);

/* Multiply positions and velocities of every blade of a copy by 1 + size N(0, 1). */
void mhb_ring_disturb_copy(mhb_ring *ring, int copy, mhb_ring_output *output, double size,
                           mhb_noise *noise);

/* Those of a ring without copies. */
void mhb_ring_disturb(mhb_ring *ring, mhb_ring_output *output, double size, mhb_noise *noise);

#endif
