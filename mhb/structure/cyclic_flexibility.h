/* Residual flexibility or inertia of a blade as its contact pairs see it, for any inter-blade phase
 * e.
 *
 * With the blocks of a matrix M between right and left side, each pair in its own axes,
 *   T M T^H = M_rr + M_ll - conj(e) M_rl - e M_lr
 *           = self - Re(e) even_coupling - j Im(e) odd_coupling,
 *   self = M_rr + M_ll,  even_coupling = M_rl + M_lr,  odd_coupling = M_lr - M_rl,
 * three real matrices for all harmonics. To ground M_ll = M_rl = M_lr = 0. */
#ifndef MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H
#define MHB_STRUCTURE_CYCLIC_FLEXIBILITY_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

typedef struct {
  int       n;                                   /* 3 pairs */
  double   *self, *even_coupling, *odd_coupling; /* [n][n]; couplings are NULL to ground */
  shb_arena arena;
} mhb_cyclic_flexibility;

/* matrix[nc][nc] over (side, pair, axis), nc = n or 2n, m/N.
 *   T0     in  [pair][3][3] columns v, u, w
 *   sides  in  1 (ground) or 2
 * SHB_ERR_IO: no memory. */
shb_status mhb_cyclic_flexibility_create(const double *matrix, int nc, const double *T0,
                                         int n_pairs, int sides,
                                         mhb_cyclic_flexibility **flexibility);
void       mhb_cyclic_flexibility_destroy(mhb_cyclic_flexibility *flexibility);

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

/* Row i of T M T^H times p[n]. */
double complex mhb_cyclic_flexibility_row(const mhb_cyclic_flexibility *flexibility,
                                          double complex phase, int i, const double complex *p);

#endif
