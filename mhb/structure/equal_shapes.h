/* Receptances of the blades of a ring, which have the same shapes and other frequencies.
 *
 * Blade b, free at both faces, has n motions. With the shapes B of its modes, S of its residual
 * modes, and the terms M_t of residual_terms.h:
 *
 *   H_b = sum_i L_i B_i B_i^T + sum_j g_j S_j S_j^T + sum_t a_t M_t,b          [n][n] m/N
 *
 * All matrices are real. Those of the modes are common to all blades. So a blade at a harmonic
 * costs 2 n^2 multiplications a mode, by whole vectors; only L is complex. The terms M_t are
 * those of each blade. */
#ifndef MHB_STRUCTURE_EQUAL_SHAPES_H
#define MHB_STRUCTURE_EQUAL_SHAPES_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mesh/base/status.h"

struct mhb_receptance;

typedef struct mhb_equal_shapes {
  int       n, modes, residual_modes;
  int       square;         /* n^2 in whole vectors */
  double   *shapes;         /* [n][modes + residual_modes] B, S */
  double   *outer;          /* [modes + residual_modes][square] B_i B_i^T, S_j S_j^T */
  double   *matrix[2];      /* [square] real and imaginary part of H_b, of the last call */
  double   *weight, *slope; /* [residual_modes] g, dg/d(w^2) */
  double   *drive[2];       /* [modes + residual_modes] */
  shb_arena arena;
} mhb_equal_shapes;

/* From one of the blades, which all have its shapes. */
mhb_equal_shapes *mhb_equal_shapes_create(const struct mhb_receptance *blade);
void              mhb_equal_shapes_destroy(mhb_equal_shapes *shapes);

/* matrix <- H of a blade at harmonic k. lambda of the blade is up to date. */
void mhb_equal_shapes_receptance(mhb_equal_shapes *shapes, const struct mhb_receptance *blade,
                                 int k);

/* slope[n] <- d/d omega of harmonic k of free - H p, at fixed p[n]; p NULL: of free. lambda of the
 * blade is up to date. */
void mhb_equal_shapes_slope(mhb_equal_shapes *shapes, const struct mhb_receptance *blade, int k,
                            const double complex *p, double complex *slope);

#endif
