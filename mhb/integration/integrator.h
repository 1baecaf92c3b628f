/* Direct time integration of the blade on the ground, or of every blade of a ring, with the contact law: the witness of the
 * harmonic balance.
 *
 * z is what the contact forces add to the steady response without contact, which is known exactly:
 *   z'' + 2 zeta w z' + w^2 z = -B^T p,   u = u_free(t) + B z - R p
 * A step propagates every mode exactly under the collocated force (modal_step.h); all contacts are solved together, block by block
 * (contact_step.h). A step in which a contact changes its state is cut at the change; nominal steps divide the period
 * of the fundamental, 2 pi nu/omega. Fifth order; nothing is linearised, nothing assumed periodic.
 * Blade b of a ring lags by b times the wave's phase, as in the balance. Derivation: docs/theory/time_integration.md. */
#ifndef MHB_INTEGRATION_INTEGRATOR_H
#define MHB_INTEGRATION_INTEGRATOR_H

#include "mhb/integration/contact_step.h"
#include "mhb/integration/inertia_modes.h"

typedef struct {
  long steps, events; /* since the start */
  long
      forced; /* short steps taken although a state had ended, where states alternate without end */
} mhb_integrator_count;

typedef struct mhb_integrator mhb_integrator;

/* Called after each accepted step that began at t0 (s from the start of the period) and lasted h; step[] holds the stages. */
typedef void (*mhb_integrator_watch)(void *context, const mhb_integrator *integrator, double t0,
                                     double h);

struct mhb_integrator {
  mhb_settings settings;
  modal_model  model; /* with residual modes, if the model given has residual inertia; else empty */
  mhb_receptance *receptance; /* harmonics 0..n_harmonics, at omega */
  mhb_ring_step   chain;
  int             n_harmonics, n_load; /* of outputs and starts; highest one of the free motion */
  int             blades, modes, pairs, contacts;
  mhb_law        *law;           /* [pair] */
  double          n0;            /* N, total */
  double          omega, period; /* rad/s of the excitation; s of the fundamental */
  int             steps;         /* a period */
  double          t;             /* s, in [0, period] */
  double         *z;             /* [2 (z, z')][blade][mode] */
  mhb_contact_point *rub;        /* [contact] */
  mhb_contact_step  *step;       /* [contact] of the last step */
  int *idle, *hush; /* [contact] changes without progress; events not heeded in the coming step */
  double              *y; /* [contact][9] motion at the stages without contact forces of the step */
  double              *stage; /* [6][modes] */
  mhb_modal_step       nominal, cut;
  double               scale; /* N, largest force so far */
  mhb_integrator_count count;
  mhb_integrator_watch watch;
  void                *context;
};

/* For outputs, and starts from balances, of up to n_harmonics (of the fundamental); the model must outlive it.
 * Errors: SHB_ERR_INPUT as mhb_receptance_create; SHB_ERR_IO no memory. */
shb_status mhb_integrator_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_integrator **integrator);
void       mhb_integrator_destroy(mhb_integrator *integrator);

/* Go on at another frequency (rad/s), preload (N, total) and number of steps a period. Displacements, velocities and sliders are
 * carried over; the phase is 0. */
void mhb_integrator_set(mhb_integrator *integrator, double omega, double n0, int steps);

/* At rest, without friction, at phase 0. After mhb_integrator_set. */
void mhb_integrator_rest(mhb_integrator *integrator);

/* On a solution of the balance at phase 0, as far as its harmonics tell: force[n_harmonics + 1][3 pairs] N, as in
 * the response file but k first. After mhb_integrator_set. */
void mhb_integrator_balance(mhb_integrator *integrator, int n_harmonics,
                            const double complex *force);

/* One period of the fundamental from phase 0 to phase 0. 0: the contact forces of a step were not found. */
int mhb_integrator_period(mhb_integrator *integrator);

/* Phase by which a blade lags at the fundamental, rad. */
double mhb_integrator_lag(const mhb_integrator *integrator, int blade);

/* Motion without contact forces of the contacts to the right of a blade at t, [3 pairs] m, added to u. */
void mhb_integrator_free(const mhb_integrator *integrator, int blade, double t, double *u);

/* The state as numbers, for differences and disturbances: z, z' and friction. */
int  mhb_integrator_size(const mhb_integrator *integrator);
void mhb_integrator_get(const mhb_integrator *integrator, double *state);
void mhb_integrator_put(mhb_integrator *integrator, const double *state);

#endif
