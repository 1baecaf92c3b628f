/* Disturbances of the modes of a flexible disc over a sub-step (mhb/structure/disc_modes.h).
 *
 * Between mhb_disc_propagation_begin and _end the rows q and v hold the real coordinates of z in
 * place of y: [coordinate][mode]. The mean force P of the contacts is transformed in the same way.
 * A nodal diameter then meets its own part alone:
 *   p^ = F P,   z <- propagated under -Phi^H p^,   W += F^T Phi (change of z)
 * With Coriolis terms the rows hold the amplitudes of the coupled modes, the first half in q and
 * the second in v. Of real shapes q holds the real part and v the imaginary part. It costs 2 N^2 n
 * + 8 N n modes products a column, N sectors with n = 3 pairs. */
#ifndef MHB_VARIATION_DISC_PROPAGATION_H
#define MHB_VARIATION_DISC_PROPAGATION_H

#include "mesh/base/arena.h"
#include "mhb/structure/disc_modes.h"
#include "mhb/variation/ring_band.h"

typedef struct {
  const mhb_disc_modes *modes;
  double               *propagator;           /* [diameter][mode][PROPAGATOR] */
  double complex       *growth, *gain;        /* [diameter][2][mode] of coupled modes, else NULL:
                                               * e^(p h) - 1 and that over p */
  mhb_columns          *state;                /* [4 modes] of one nodal diameter */
  double complex       *block;                /* [diameter][n][n] of the compliance */
  mhb_columns          *force, *motion, *row; /* [N][n], [N][n], [N]: of one block of columns */
  shb_arena             arena;
} mhb_disc_propagation;

/* The modes must outlive it. */
mhb_disc_propagation *mhb_disc_propagation_create(const mhb_disc_modes *modes);
void                  mhb_disc_propagation_destroy(mhb_disc_propagation *disc);

/* Sub-steps of h seconds. compliance [N n][N n] <- motion of the contacts over h by unit mean
 * forces. */
void mhb_disc_propagation_set_step(mhb_disc_propagation *disc, double h, double *compliance);

/* Rows q [N][modes] and v of one block of columns: from y to the coordinates of z, and back. */
void mhb_disc_propagation_begin(mhb_disc_propagation *disc, mhb_columns *q, mhb_columns *v);
void mhb_disc_propagation_end(mhb_disc_propagation *disc, mhb_columns *q, mhb_columns *v);

/* Apply the mean force P [N][n] of the last sub-step. */
void mhb_disc_propagation_apply(mhb_disc_propagation *disc, mhb_columns *q, mhb_columns *v,
                                const mhb_columns *P);

/* Apply it, then propagate freely; W [N][n] += the motion of the contacts by that. */
void mhb_disc_propagation_advance(mhb_disc_propagation *disc, mhb_columns *q, mhb_columns *v,
                                  const mhb_columns *P, mhb_columns *W);

#endif
