/* The variational equation of a blade, or of a ring of blades, in modal coordinates:
 *
 *   dq'' + 2 zeta w dq' + w^2 dq = -B^T dp,   du = B dq - R dp
 *
 * A sub-step of length h has the mean force P as its unknown. The modes are propagated exactly
 * under P; each contact answers to the change D of du by its linearised law (linearised_law.h). For
 * a linear spring the work P . D is exactly the change of its energy. The scheme is of second
 * order, and no stiffness makes a passive contact active.
 *
 * With y = (dv, sigma) of each contact at the start, C the compliance of the modes over h:
 *   W = B (free change of dq over h),
 *   (I + C mean_du/2 + R df_du) D = W - C mean_y y - R df_y y,   P = mean_y y + mean_du D/2.
 *
 * All columns (initial disturbances) are integrated together, MHB_COLUMNS of them a block. Rows of
 * a block, contact j = blade * pairs + pair:
 *   q [blade][mode] | v = q' [blade][mode] | u [3 j + (v, u, w)] | sigma [2 j + i]
 * sigma of a sticking contact: friction (fu, fw); slipping: (tau, -), the friction across the slip
 * direction; open: none. */
#ifndef MHB_VARIATION_VARIATIONAL_H
#define MHB_VARIATION_VARIATIONAL_H

#include "mesh/base/arena.h"
#include "mhb/structure/modal_structure.h"
#include "mhb/variation/disc_propagation.h"
#include "mhb/variation/ring_band.h"
#include "mhb/variation/slider_propagation.h"
#include "mhb/variation/variational_law.h"

typedef struct {
  const mhb_modal_structure *structure;
  int                        columns, blocks, rows; /* in use */
  int                        capacity;              /* columns there is room for */
  mhb_columns               *Y;                     /* [block][rows] */
  mhb_columns               *P;          /* [block][n] mean force not yet applied to the modes */
  mhb_columns               *work;       /* [3][n] */
  mhb_linearised_law        *linearised; /* [contact] of the coming sub-step */
  double                     h;          /* s, of the propagator; negative: none */
  double *propagator; /* [mode][PROPAGATOR], mistuned: [blade][mode][PROPAGATOR]; NULL on a disc */
  mhb_disc_propagation *disc;       /* in its place on a disc, else NULL */
  double               *compliance; /* [n][n] C, n = 3 contacts */
  int (*neighbour)[3];              /* [group] groups that are coupled with it, itself too */
  int           n_neighbours;
  mhb_ring_band band;        /* I + C mean_du/2 + R df_du, factored */
  double       *du, *dsigma; /* [n], [2 contacts] of a jump: motion, sigma; */
  double       *dp;          /* [n] and force */
  /* In the place of Y and of all that solves, or NULL. */
  mhb_slider_propagation *sliders;
  shb_arena               arena;
} mhb_variational;

/* Room for capacity columns. Structure and springs must outlive it.
 *   springs  in  of a blade on the ground: only contacts that slip or are open cost anything
 *                (slider_propagation.h), with the same result. Else NULL */
mhb_variational *mhb_variational_create(const mhb_modal_structure *structure,
                                        const mhb_stuck_springs *springs, int capacity);
void             mhb_variational_destroy(mhb_variational *variational);

/* All rows zero, for a number of columns. */
void mhb_variational_clear(mhb_variational *variational, int columns);

static inline double *mhb_variational_at(mhb_variational *v, int row, int column) {
  if (v->sliders) return v->sliders->Y + (long)row * v->sliders->width + column;
  return (double *)&v->Y[(long)(column / MHB_COLUMNS) * v->rows + row] + column % MHB_COLUMNS;
}

/* The columns are set: q and v are y of the blades. Between this and mhb_variational_finish these
 * rows are the workspace's own. */
void mhb_variational_begin(mhb_variational *variational);

/* Sub-steps of h seconds from here on. Returns 0 if singular. */
int mhb_variational_set_step(mhb_variational *variational, double h);

/* The structure has changed: the step must be set anew. */
void mhb_variational_forget(mhb_variational *variational);

/* Factor the contacts' system for the linearised laws. Returns 0 if singular. */
int mhb_variational_factor(mhb_variational *variational);

/* One sub-step of all columns. */
void mhb_variational_step(mhb_variational *variational);

void mhb_variational_saltation(mhb_variational *variational, const mhb_saltation *jump);

/* q and v of the blades are valid after this. */
void mhb_variational_finish(mhb_variational *variational);

#endif
