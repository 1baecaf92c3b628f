/* The variational problem of the blade, or of a ring of blades, in modal coordinates: one sub-step for all columns.
 *
 *   dq'' + 2 zeta w dq' + w^2 dq = -B^T dp,   du = B dq - R dp
 * Over a sub-step h the modes are propagated exactly under the mean force P = mean of dp, and each contact answers by its
 * linearised law (linearised_law.h) to the change of du. For a linear spring the work P.(du1 - du0) is then exactly the
 * change of its energy: the scheme is of second order and never makes a passive contact active, however stiff it is.
 *
 * Contact j = blade * pairs + pair. Rows of a block of LANES columns:
 *   q [blade][mode] | v = q' [blade][mode] | u [3 j + (v, u, w)] | sigma [2 j + i]
 * sigma: stick the friction (fu, fw); slip (tau, -), its part across the slip direction; open nothing. */
#ifndef MHB_FLOQUET_VARIATIONAL_H
#define MHB_FLOQUET_VARIATIONAL_H

#include "mhb/floquet/ring_band.h"
#include "mhb/structure/modal_structure.h"

/* One contact over one sub-step, linear in y = (v, sigma) at its start and in the change D of (v, u, w):
 *   mean force = a y + hold D/2,   change of force = b y + grow D,   sigma at the end = keep y + gain D. */
typedef struct {
  double a[3][3], hold[3][3], b[3][3], grow[3][3];
  double keep[2][3], gain[2][3];
} mhb_linearised_law;

/* What an event does to the rows of contact j: sigma = set y; and with residual flexibility, alpha = measure . y times
 * the workspace's du and dsigma to all rows. */
typedef struct {
  int    contact;
  double set[2][3], measure[3];
} mhb_saltation;

typedef struct {
  const mhb_modal_structure *structure;
  int                 columns, blocks, rows, capacity; /* in use; room for capacity columns */
  mhb_lanes          *Y;                               /* [block][rows] */
  mhb_lanes          *P; /* [block][n] mean force of the last sub-step, not yet felt by the modes */
  mhb_lanes          *work;       /* [3][n] */
  mhb_linearised_law *relation;   /* [contact] of the coming sub-step */
  double              h;          /* s, of the propagator */
  double             *propagator; /* [mode][6] */
  double             *compliance; /* [n][n] change of du by a unit mean force */
  int (*near)[3];                 /* [blade] the blades that its contacts meet */
  int           meets;            /* how many */
  mhb_ring_band band;             /* what a change of du meets */
  double       *du, *dsigma;      /* [n], [2 contacts] of a jump */
} mhb_variational;

/* Room for capacity columns. SHB_ERR_IO: no memory. The structure must outlive it. */
shb_status mhb_variational_create(const mhb_modal_structure *structure, int capacity,
                                  mhb_variational **variation);
void       mhb_variational_destroy(mhb_variational *variation);

/* All rows zero, for a number of columns. */
void mhb_variational_clear(mhb_variational *variation, int columns);

static inline double *mhb_variational_at(mhb_variational *v, int row, int column) {
  return (double *)&v->Y[(long)(column / MHB_LANES) * v->rows + row] + column % MHB_LANES;
}

/* Sub-steps of length h from here on. */
void mhb_variational_length(mhb_variational *variation, double h);

/* Take the relations into use. 0: singular. */
int mhb_variational_couple(mhb_variational *variation);

/* One sub-step of all columns. */
void mhb_variational_step(mhb_variational *variation);

void mhb_variational_saltation(mhb_variational *variation, const mhb_saltation *jump);

/* Let the modes feel the last mean force: q and v are valid only after this. */
void mhb_variational_settle(mhb_variational *variation);

#endif
