/* Direct time integration of the blade on the ground, or of all blades of a ring, with the contact
 * law. It is an independent reference for the harmonic balance.
 *
 * The steady response without contact is known exactly; z is the part by the contact forces:
 *   z'' + 2 zeta w z' + w^2 z = -B^T p,   u = u_free(t) + B z - R p
 * A step propagates every mode exactly under the collocated force (modal_step.h). The contacts are
 * solved one after the other until nothing changes. A step ends where a contact changes its state
 * (contact_step.h), and the method is of fifth order. From MHB_JOINT_PAIRS pairs on, without
 * Coriolis terms, the steps are equal (joint_step.h): each contact changes its state within them.
 * Nominal steps divide the period of the fundamental, 2 pi nu/omega. Nothing is linearised or
 * assumed periodic. Blade b of a ring lags by b times the wave's phase, as in the balance.
 * Derivation: docs/theory/time_integration.md. */
#ifndef MHB_INTEGRATION_INTEGRATOR_H
#define MHB_INTEGRATION_INTEGRATOR_H

#include "mesh/base/arena.h"
#include "mhb/integration/contact_step.h"
#include "mhb/integration/inertia_modes.h"
#include "mhb/integration/joint_step.h"

/* From here on a step of all contacts does not end where one of them changes its state. */
enum { MHB_JOINT_PAIRS = 16 };

/* Counts since the start. */
typedef struct {
  long steps, events;
  long forced; /* events suppressed: the contact changed its state without progress */
} mhb_integrator_count;

typedef struct mhb_integrator mhb_integrator;

/* Called after each accepted step that began at t0 (s from the start of the period) and lasted h;
 * step[] holds the stages. */
typedef void (*mhb_integrator_watch)(void *context, const mhb_integrator *integrator, double t0,
                                     double h);

struct mhb_integrator {
  mhb_settings    settings;
  modal_model     model;      /* with residual modes in place of residual inertia; else empty */
  mhb_receptance *receptance; /* harmonics 0..n_harmonics, at omega */
  mhb_ring_step   ring;
  int             n_harmonics, n_load; /* of outputs and starts; highest one of the free motion */
  int             blades, modes, pairs, contacts;
  mhb_law        *law;           /* [pair] */
  double          n0;            /* N, total */
  double          omega, period; /* rad/s of the excitation; s of the fundamental */
  int             steps;         /* a period */
  double          t;             /* s, in [0, period] */
  double         *z; /* [2 (z, z')][blade][mode]; with Coriolis terms [2 (re, im)] of amplitudes */
  mhb_contact_point   *point;      /* [contact] */
  mhb_contact_step    *step;       /* [contact] of the last step */
  int                 *n_stalled;  /* [contact] changes of state without progress in time */
  int                 *suppressed; /* [contact] 1: its events are ignored in the coming step */
  double              *y; /* [contact][9] motion at the stages without contact forces of the step */
  double              *stage; /* [stage][lines] */
  mhb_modal_step       nominal, cut;
  mhb_joint_step      *joint; /* many contacts: steps do not end at their events; else NULL */
  double               scale; /* N, largest force so far */
  mhb_integrator_count count;
  mhb_integrator_watch watch;
  void                *context;
  shb_arena            arena;
};

/* n_harmonics: of outputs and of starts on a balance, counted in the fundamental. The model must
 * outlive the integrator.
 * Errors: SHB_ERR_INPUT as mhb_receptance_create. */
shb_status mhb_integrator_create(const modal_model *model, const mhb_settings *settings,
                                 int n_harmonics, mhb_integrator **integrator);
/* The same with or without joint steps, which know no Coriolis terms. */
shb_status mhb_integrator_create_as(const modal_model *model, const mhb_settings *settings,
                                    int n_harmonics, bool joint, mhb_integrator **integrator);
void       mhb_integrator_destroy(mhb_integrator *integrator);

/* Continue at another frequency (rad/s), preload (N, total) and number of steps a period, at phase
 * 0. Displacements, velocities and friction forces are kept. */
void mhb_integrator_set(mhb_integrator *integrator, double omega, double n0, int steps);

/* Start at rest, without friction, at phase 0. After mhb_integrator_set. */
void mhb_integrator_rest(mhb_integrator *integrator);

/* Start on a solution of the balance, by the harmonics of its forces, at phase 0. After
 * mhb_integrator_set.
 *   force  in  [n_harmonics + 1][3 pairs] N */
void mhb_integrator_balance(mhb_integrator *integrator, int n_harmonics,
                            const double complex *force);

/* Integrate one period of the fundamental. Returns 0 if the contact forces of a step were not
 * found. */
int mhb_integrator_period(mhb_integrator *integrator);

/* What a contact did in the accepted step, as shares of its time by state, and its work in J. For
 * the watch. */
void mhb_integrator_share(const mhb_integrator *integrator, int contact, double share[3],
                          double *work);

/* Phase by which a blade lags at the fundamental, rad. */
double mhb_integrator_lag(const mhb_integrator *integrator, int blade);

/* Motion without contact forces of the contacts to the right of a blade at t, [3 pairs] m, added to
 * u. */
void mhb_integrator_free(const mhb_integrator *integrator, int blade, double t, double *u);

/* The state as numbers, for differences: z, z' and friction forces. */
int  mhb_integrator_size(const mhb_integrator *integrator);
void mhb_integrator_get(const mhb_integrator *integrator, double *state);

#endif
