/* Linear systems of the contacts around a ring. A contact meets those of its own and the neighbouring blades only: with the ring
 * folded flat (blades 0, N-1, 1, N-2, ...) the matrix is a band of w = 3 blocks less one beside the diagonal, and elimination with row
 * exchanges costs 3 w^2 n instead of n^3/3, a solution 3 w n instead of n^2. Up to five blades the band is the whole matrix. */
#ifndef MHB_FLOQUET_RING_BAND_H
#define MHB_FLOQUET_RING_BAND_H

#include "mhb/numerics/simd.h"

typedef struct {
  int     n, block, blades, width; /* order; unknowns a blade; w */
  double *row;                     /* [n][3 w + 1] of the folded matrix */
  int    *pivot;                   /* [n] */
  int    *place;                   /* [n] where an unknown stands in the folded order */
} mhb_ring_band;

/* blades of block unknowns each, blade by blade. 0: no memory. */
int  mhb_ring_band_create(int blades, int block, mhb_ring_band *band);
void mhb_ring_band_destroy(mhb_ring_band *band);

/* Blades a blade meets, itself among them, each once: up to three. */
int mhb_ring_band_neighbours(const mhb_ring_band *band, int blade, int neighbour[3]);

/* All zero; then each entry of the matrix is set at its row and column, which must be of blades that meet. */
void mhb_ring_band_clear(mhb_ring_band *band);

static inline double *mhb_ring_band_at(mhb_ring_band *b, int row, int column) {
  return b->row + (long)b->place[row] * (3 * b->width + 1) + b->place[column] - b->place[row] +
         b->width;
}

/* LU in place. 0: singular. */
int mhb_ring_band_factor(mhb_ring_band *band);

/* x [n] <- matrix^-1 x; folded [n] is scratch. */
void mhb_ring_band_solve(const mhb_ring_band *band, mhb_lanes *x, mhb_lanes *folded);

#endif
