/* Residual flexibility or inertia of a blade as its contact pairs see it, for any inter-blade phase
 * e.
 *
 * With the blocks of a symmetric matrix M between right and left side, each pair in its own axes,
 *   T M T^H = M_rr + M_ll - conj(e) M_rl - e M_lr
 *           = self - Re(e) (C + C^T) - j Im(e) (C - C^T),
 *   self = M_rr + M_ll,  C = M_lr = M_rl^T,
 * two real matrices for all harmonics. To ground M_ll = M_rl = M_lr = 0. */
#ifndef MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H
#define MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

typedef struct {
  int       n;               /* 3 pairs */
  double   *self, *coupling; /* [n][n]; C is NULL to ground */
  float    *single;          /* [n][n] self in single precision, once it is asked for */
  shb_arena arena;
} mhb_cyclic_flexibility;

/* matrix[nc][nc] over (side, pair, axis), nc = n or 2n, m/N. Of M_lr and M_rl^T, which differ by
 * rounding, C is the mean.
 *   T0     in  [pair][3][3] columns v, u, w
 *   sides  in  1 (ground) or 2 */
mhb_cyclic_flexibility *mhb_cyclic_flexibility_create(const double *matrix, int nc,
                                                      const double *T0, int n_pairs, int sides);
void                    mhb_cyclic_flexibility_destroy(mhb_cyclic_flexibility *flexibility);

/* The same axes, another matrix of that size. */
void mhb_cyclic_flexibility_set(mhb_cyclic_flexibility *flexibility, const double *matrix, int nc,
                                const double *T0);

/* R[n][n] += factor T M T^H */
void mhb_cyclic_flexibility_add(const mhb_cyclic_flexibility *flexibility, double complex phase,
                                double factor, double complex *R);

/* R[3][3] += factor times the block of a pair with itself. */
void mhb_cyclic_flexibility_add_block(const mhb_cyclic_flexibility *flexibility,
                                      double complex phase, double factor, int pair,
                                      double complex R[3][3]);

/* to[n] += factor T M T^H p */
void mhb_cyclic_flexibility_add_product(const mhb_cyclic_flexibility *flexibility,
                                        double complex phase, double factor,
                                        const double complex *p, double complex *to);

/* out[n][n] <- C + sign C^T */
void mhb_cyclic_flexibility_both(const mhb_cyclic_flexibility *flexibility, int sign, double *out);

/* self[n][n] in single precision, made by the first call, of whatever thread. */
const float *mhb_cyclic_flexibility_single(mhb_cyclic_flexibility *flexibility);

#endif
