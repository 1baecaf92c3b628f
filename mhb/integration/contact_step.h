/* The contact law over one step of time integration, at Radau's points: stick, slip or separation throughout.
 *
 *   n = n0 + kv v;   stick  f = Ku s - zeta, zeta at rest;   open  n = f = 0
 *   slip   f = mu n e, zeta' = lambda Ku e, lambda >= 0:     mu n_i e_i + sum_j a_ij kappa_j Ku e_j = Ku s_i - zeta_0
 * with kappa = h lambda, the slider's path. Slip is an equation for a slider, of index two, that needs no velocity: residual
 * flexibility, through which the velocity of the contact jumps at every transition, does no harm. Written for this
 * purpose: nothing here is shared with the law of the harmonic balance (contact.h) but its parameters.
 * Source: Chen, Yang, Menq 1999, eqs. 4-15. */
#ifndef MHB_INTEGRATION_CONTACT_STEP_H
#define MHB_INTEGRATION_CONTACT_STEP_H

#include "mhb/contact/contact.h"
#include "mhb/integration/modal_step.h"

/* A contact between two steps. */
typedef struct {
  mhb_state state;
  double    zeta[2];    /* Ku times the slider's position, N */
  double    theta;      /* slip: direction of the friction */
  double    lambda;     /* slip: speed of the slider at the end of the last step, m/s */
  double    u[3], p[3]; /* now: m, N */
} mhb_contact_point;

/* And over a step, at the stages. */
typedef struct {
  double u[MHB_STAGE_FORCES], p[MHB_STAGE_FORCES];            /* [stage][axis] */
  double n[MHB_STAGES], theta[MHB_STAGES], kappa[MHB_STAGES]; /* slip */
} mhb_contact_step;

/* What may end a piece. */
typedef enum {
  MHB_CONTACT_CLOSES,
  MHB_CONTACT_OPENS,
  MHB_STICK_TO_SLIP,
  MHB_SLIP_TO_STICK
} mhb_contact_event;

/* The law without friction has none: mu = 0 sticks by no spring. */
mhb_law mhb_contact_step_law(const mhb_law *law);

/* The forces of a step that starts at rub, given y = u - (own forces' part), u = y - S p.
 *   S      in      [9][9] m/N
 *   stick  in out  [9][9], pivot [9]: factors of the stuck contact, made where pivot[0] < 0
 *   scale  in      N, forces are found to 1e-13 of it
 *   step   in out  a guess of p, n, theta, kappa; the result
 * 0: not found. */
int mhb_contact_step_solve(const mhb_radau *rule, const mhb_law *law,
                           const mhb_contact_point *point, const double *S, double *stick,
                           int *pivot, const double *y, double scale, mhb_contact_step *step);

/* A guess for a step of h seconds, from what the contact did before it. */
void mhb_contact_step_guess(const mhb_law *law, const mhb_contact_point *point, double h,
                            mhb_contact_step *step);

/* The excess of an event at tau in [0, 1], N: the state has ended where it is positive. */
double mhb_contact_step_excess(const mhb_radau *rule, const mhb_law *law,
                               const mhb_contact_point *point, const mhb_contact_step *step,
                               mhb_contact_event event, double tau);

/* The first event of a step whose excess passes the tolerance (N): its place in [0, 1]; 2: none. */
double mhb_contact_step_first(const mhb_radau *rule, const mhb_law *law,
                              const mhb_contact_point *point, const mhb_contact_step *step,
                              double tolerance, mhb_contact_event *event);

/* To the end of a step of h seconds. */
void mhb_contact_step_advance(const mhb_law *law, const mhb_contact_step *step, double h,
                              mhb_contact_point *point);

/* Into another state, where it is now. direction: of the friction, for a slip that begins without any. */
void mhb_contact_step_change(const mhb_law *law, mhb_state state, double direction,
                             mhb_contact_point *point);

/* Rates of (|f|, n) and direction of f at the start of a step: what decides whether a closing contact sticks. */
double mhb_contact_step_closing(const mhb_radau *rule, const mhb_law *law,
                                const mhb_contact_point *point, const mhb_contact_step *step,
                                double *direction);

#endif
