/* Residual flexibility or inertia of a blade as its contact pairs see it, for any inter-blade phase e.
 *
 * With the blocks of a matrix M between right and left side (l = 0 to ground), each pair in its own axes,
 *   T M T^H = M_rr + M_ll - conj(e) M_rl - e M_lr = own - Re(e) both - j Im(e) odd,   both = M_rl + M_lr, odd = M_lr - M_rl
 * are three real matrices, whatever the number of harmonics. */
#ifndef MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H
#define MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H

#include <complex.h>

#include "mesh/base/status.h"

typedef struct {
  int     n;                /* 3 pairs */
  double *own, *both, *odd; /* [n][n]; both and odd are NULL to ground */
} mhb_cyclic_flexibility;

/* matrix[nc][nc] over (side, pair, axis), nc = n or 2n; T0[pair][3][3] columns v, u, w; sides 1 (ground) or 2.
 * SHB_ERR_IO: no memory. */
shb_status mhb_cyclic_flexibility_create(const double *matrix, int nc, const double *T0,
                                         int n_pairs, int sides,
                                         mhb_cyclic_flexibility **flexibility);
void       mhb_cyclic_flexibility_destroy(mhb_cyclic_flexibility *flexibility);

/* Another matrix of that size, the same axes. */
void mhb_cyclic_flexibility_set(mhb_cyclic_flexibility *flexibility, const double *matrix, int nc,
                                const double *T0);

/* R[n][n] += factor T M T^H */
void mhb_cyclic_flexibility_add(const mhb_cyclic_flexibility *flexibility, double complex phase,
                                double factor, double complex *R);

/* R[3][3] += factor times the block of pair a with itself. */
void mhb_cyclic_flexibility_add_block(const mhb_cyclic_flexibility *flexibility,
                                      double complex phase, double factor, int pair,
                                      double complex R[3][3]);

/* Row i of T M T^H times p[n]. */
double complex mhb_cyclic_flexibility_row(const mhb_cyclic_flexibility *flexibility,
                                          double complex phase, int i, const double complex *p);

#endif
