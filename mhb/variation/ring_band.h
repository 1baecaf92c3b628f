/* Linear systems between the contacts of a ring, solved for MHB_COLUMNS right-hand sides at once.
 *
 * A contact is coupled to those of its own and the neighbouring blades only. With the ring folded
 * flat (blades 0, N-1, 1, N-2, ...) the matrix of order n is a band with w = 3 blocks - 1 diagonals
 * on each side. Gaussian elimination with partial pivoting costs 3 w^2 n, a solution 3 w n. Up to
 * five blades the band is the whole matrix.
 *
 * LAPACK's dgbtrf and dgbtrs solve column by column. With them all multipliers of a curve took more
 * CPU time. A blade on the ground took 1.6 times as long with 1 contact point, 1.8 times with 4. A
 * ring of 40 blades took 1.2 times as long (on a busy machine). */
#ifndef MHB_VARIATION_RING_BAND_H
#define MHB_VARIATION_RING_BAND_H

#include "mesh/base/arena.h"
#include "mhb/numerics/simd.h"

/* Columns that are computed at once. They fill one register of AVX2. A vector of eight, twice as
 * wide, passes through memory at every store (GCC 12). A sub-step then took 2.6 times as long. */
enum { MHB_COLUMNS = 4 };
typedef double mhb_columns __attribute__((vector_size(32)));

typedef struct {
  int       n, block, blades, width; /* order; unknowns a blade; w */
  double   *row;                     /* [n][3 w + 1] of the folded matrix, then its LU factors */
  int      *pivot;                   /* [n] */
  int      *place;                   /* [n] position of an unknown in the folded order */
  shb_arena arena;
} mhb_ring_band;

/* For blades of block unknowns each, blade by blade. */
void mhb_ring_band_create(int blades, int block, mhb_ring_band *band);
void mhb_ring_band_destroy(mhb_ring_band *band);

/* Blades coupled to a blade, itself among them, each once. Returns their number, up to three. */
int mhb_ring_band_neighbours(const mhb_ring_band *band, int blade, int neighbour[3]);

/* Set the matrix to zero. */
void mhb_ring_band_clear(mhb_ring_band *band);

/* Entry of the matrix; row and column belong to blades that are coupled. */
static inline double *mhb_ring_band_at(mhb_ring_band *b, int row, int column) {
  return b->row + (long)b->place[row] * (3 * b->width + 1) + b->place[column] - b->place[row] +
         b->width;
}

/* LU factors in place. Returns 0 if singular. */
int mhb_ring_band_factor(mhb_ring_band *band);

/* x[n] <- matrix^-1 x; folded[n] is scratch. */
void mhb_ring_band_solve(const mhb_ring_band *band, mhb_columns *x, mhb_columns *folded);

#endif
