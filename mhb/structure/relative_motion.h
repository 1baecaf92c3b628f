/* Relative motion at the contact: T = T0^T T1,k (eqs. 2, 24, 25), with the shroud axes T0 of a pair
 * and the inter-blade phase of the wave. */
#ifndef MHB_STRUCTURE_RELATIVE_MOTION_H
#define MHB_STRUCTURE_RELATIVE_MOTION_H

#include <complex.h>
#include <stddef.h>

#include "mhb/problem/wave.h"

/* From this many relative motions on, products of matrices are left to BLAS. */
enum { MHB_WORTH_BLAS = 12 };

typedef struct {
  int           n, sides; /* 3 pairs; 1 to ground, 2 to the neighbour */
  const double *T0;       /* [pair][3][3], columns v, u, w in (tangential, axial, radial) */
} mhb_relative;

/* Row (pair, c) of T, column (side, pair, axis). Columns of other pairs are zero. phase: e_k. */
static inline double complex mhb_relative_weight(const mhb_relative *t, int row, int side, int axis,
                                                 double complex phase) {
  double weight = t->T0[(row / 3) * 9 + axis * 3 + row % 3];
  return side ? -phase * weight : weight;
}

/* out[n] = T x for a vector over contact dofs (side, pair, axis); both with strides. */
static inline void mhb_relative_motion(const mhb_relative *t, double complex phase,
                                       const double complex *x, int stride, double complex *out,
                                       int out_stride) {
  for (int row = 0; row < t->n; row++) {
    double complex sum = 0;
    for (int side = 0; side < t->sides; side++)
      for (int axis = 0; axis < 3; axis++)
        sum += mhb_relative_weight(t, row, side, axis, phase) *
               x[(size_t)(side * t->n + (row / 3) * 3 + axis) * (size_t)stride];
    out[(size_t)row * (size_t)out_stride] = sum;
  }
}

#endif
