/* Multipliers of a ring that is g equal cells, N/g blades each, from what one cell's disturbances become over 1/chunks of a period.
 *
 * With g = gcd(E, N) the wave repeats every N/g blades, so the map S of all disturbances over the stretch is block-circulant:
 * each of its eigenvectors is psi e^{i kappa c} in cell c (Bloch's theorem), kappa = 2 pi l/g, with
 *   S(kappa) psi = lambda psi,   S(kappa) = sum over cells c of e^{-i kappa c} S_c,
 * S_c what cell c holds at the end of a disturbance of cell 0. Blades were renamed at the end of each stretch; over a period
 * that is k cells, so that the multiplier is e^{-i kappa k} lambda^chunks. g problems of n states, half of them conjugates of the other
 * half, instead of one of g n. */
#ifndef MHB_FLOQUET_BLOCH_H
#define MHB_FLOQUET_BLOCH_H

#include <complex.h>

#include "mesh/base/status.h"

typedef struct {
  int             cells, capacity; /* g; states a cell */
  double         *real;            /* [room][room] */
  double         *re, *im;         /* [room] */
  double complex *matrix;          /* [room][room], and what follows for complex problems only */
  double complex *value;           /* [room] */
  double         *work;            /* [size] */
  int             size;
} mhb_bloch;

/* For up to room states a cell. SHB_ERR_IO: no memory. */
shb_status mhb_bloch_create(int cells, int capacity, mhb_bloch *bloch);
void       mhb_bloch_destroy(mhb_bloch *bloch);

/* S [cells][n][n], column-major -> multiplier [cells n], conjugates side by side. names: k. 0: the eigensolver failed. */
int mhb_bloch_multipliers(mhb_bloch *bloch, int n, const double *S, int n_segments, int cell_shift,
                          double complex *multiplier);

#endif
