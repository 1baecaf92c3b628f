/* The receptance of a ring of different blades, without a matrix of the whole ring.
 *
 * The right and left contact faces of blade b move by (r_b, -l_b) under the forces (p_b, p_{b-1}).
 * All are in shroud axes, n = 3 P numbers each with P pairs a contact:
 *   (r_b, -l_b) = free_b - H_b (p_b, p_{b-1}),   H_b [2n][2n], split rr rl / lr ll
 * and the relative motion of contact b is u_b = r_b - l_{b+1}. Hence u = free - R p, where R is
 * block-cyclic: R_{b,b} = H_b,rr + H_{b+1},ll; R_{b,b-1} = H_b,rl; R_{b,b+1} = H_{b+1},lr.
 * Cost and memory are linear in the number of blades. The source is blade_receptances.c. Each blade
 * has a receptance of its own (receptance.h). */
#ifndef MHB_STRUCTURE_RING_RECEPTANCE_H
#define MHB_STRUCTURE_RING_RECEPTANCE_H

#include "mesh/base/arena.h"
#include "mesh/base/status.h"
#include "mhb/mistuning/mistuned_ring.h"

/* Block of R beside the diagonal. */
typedef enum { MHB_RING_BEFORE, MHB_RING_OWN, MHB_RING_AFTER, MHB_RING_BLOCKS } mhb_ring_block;

struct mhb_receptance; /* of one blade */
struct mhb_equal_shapes;

typedef struct mhb_ring_receptance {
  const mhb_mistuned_ring *ring;
  int                      blades, n, q;  /* n = 3 pairs of a contact; q = 3 probes of a blade */
  struct mhb_receptance  **blade;         /* [blades]; their R are not made */
  struct mhb_equal_shapes *shapes;        /* makes the matrices of the blades */
  double complex          *R;             /* [k][blades][before, own, after][n][n] m/N */
  double complex          *p, *dp, *part; /* [2n] of one blade */
  shb_arena                arena;
} mhb_ring_receptance;

/* settings->ring gives the blades. Errors: as mhb_receptance_create. */
shb_status mhb_ring_receptance_create(const mhb_settings *settings, int n_harmonics,
                                      mhb_ring_receptance **ring);
void       mhb_ring_receptance_destroy(mhb_ring_receptance *ring);

void mhb_ring_receptance_set_frequency(mhb_ring_receptance *ring, double omega);
void mhb_ring_receptance_scale(mhb_ring_receptance *ring, double scale);

/* Blocks of harmonic k, and free and unit[blades n] of the load. */
void mhb_ring_receptance_update(mhb_ring_receptance *ring, int k, double complex *free,
                                double complex *unit);
void mhb_ring_receptance_update_load(mhb_ring_receptance *ring, int k, double complex *free,
                                     double complex *unit);

/* Block [n][n] of harmonic k between contact b and itself, or the one before or after it. */
static inline const double complex *mhb_ring_receptance_block(const mhb_ring_receptance *ring,
                                                              int k, int b, mhb_ring_block which) {
  const size_t n = (size_t)ring->n, row = (size_t)k * (size_t)ring->blades + (size_t)b;
  return ring->R + (row * MHB_RING_BLOCKS + (size_t)which) * n * n;
}

/* own[2n] <- of p[blades n] the forces on a blade: those of its contact and of the one before. It
 * returns own; NULL where p is NULL. */
const double complex *mhb_ring_forces_of_blade(const mhb_ring_receptance *ring, int blade,
                                               const double complex *p, double complex *own);

/* all[blades n] += the motions own[2n] of a blade's faces. */
void mhb_ring_add_blade(const mhb_ring_receptance *ring, int blade, const double complex *own,
                        double complex *all);

/* out[3] <- row `row` of R_k, columns of a pair. */
void mhb_ring_receptance_row(const mhb_ring_receptance *ring, int k, int row, int pair,
                             double complex out[3]);

/* motion[blades n] += R_k p, with the blocks of the last update. */
void mhb_ring_receptance_product(const mhb_ring_receptance *ring, int k, const double complex *p,
                                 double complex *motion);

/* The functions of the same names of mhb_receptance; p[blades n], motion[blades n], probes
 * [blades q], amplitudes [blades modes]. */
void mhb_ring_receptance_motion(const mhb_ring_receptance *ring, int k, const double complex *p,
                                double complex *motion);
void mhb_ring_receptance_slope(const mhb_ring_receptance *ring, int k, const double complex *p,
                               double complex *slope);
void mhb_ring_receptance_amplitudes(const mhb_ring_receptance *ring, int k, const double complex *p,
                                    double complex *amplitude);
void mhb_ring_receptance_probe_change(const mhb_ring_receptance *ring, int k,
                                      const double complex *p, const double complex *dp,
                                      double d_omega, double d_scale, double complex *change);
void mhb_ring_receptance_by_damping(const mhb_ring_receptance *ring, int k, const double complex *p,
                                    double complex *motion, double complex *probe);

#endif
