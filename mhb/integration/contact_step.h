/* The contact law over one step of the time integration, collocated at Radau's points. The contact
 * sticks, slips or is open over the whole step; s = (u, w) its tangential motion.
 *
 *   n = n0 + kv v
 *   stick  f = Ku s - zeta, zeta constant
 *   open   n = f = 0
 *   slip   f = mu n e, zeta' = lambda Ku e, lambda >= 0:
 *          mu n_i e_i + sum_j a_ij kappa_j Ku e_j = Ku s_i - zeta_0
 *
 * kappa = h lambda is the path of the slider. Slip is posed as an algebraic equation of index two
 * in the slider's position. No velocity of the contact enters: with residual flexibility that
 * velocity jumps at every transition. No code is shared with the law of the harmonic balance
 * (mhb/contact), only its parameters. Source: Chen, Yang, Menq 1999, eqs. 4-15; Hairer and Wanner
 * 1996, VII.4. */
#ifndef MHB_INTEGRATION_CONTACT_STEP_H
#define MHB_INTEGRATION_CONTACT_STEP_H

#include "mhb/contact/contact.h"
#include "mhb/integration/modal_step.h"

/* A contact between two steps. */
typedef struct {
  mhb_state state;
  double    zeta[2];    /* Ku times the slider's position, N */
  double    theta;      /* slip: direction of the friction, rad */
  double    lambda;     /* slip: speed of the slider at the end of the last step, m/s */
  double    u[3], p[3]; /* motion m, force N */
} mhb_contact_point;

/* A contact at the stages of a step. */
typedef struct {
  double u[MHB_STAGE_FORCES], p[MHB_STAGE_FORCES];            /* [stage][axis] m, N */
  double n[MHB_STAGES], theta[MHB_STAGES], kappa[MHB_STAGES]; /* slip: N, rad, m */
} mhb_contact_step;

typedef enum {
  MHB_CONTACT_CLOSES,
  MHB_CONTACT_OPENS,
  MHB_STICK_TO_SLIP,
  MHB_SLIP_TO_STICK
} mhb_contact_event;

/* The law as the steps use it: with mu = 0 also Ku = 0. */
mhb_law mhb_contact_step_law(const mhb_law *law);

/* Forces of a step that starts at point: u = y - S p, y the motion without own forces.
 *   S      in      [9][9] m/N
 *   stuck  in out  made where it is not factored yet
 *   scale  in      N; forces are solved to 1e-13 of it
 *   step   in out  a guess of p, n, theta, kappa; the result
 * Returns 0 if no solution was found. */
int mhb_contact_step_solve(const mhb_radau *rule, const mhb_law *law,
                           const mhb_contact_point *point, const double *S, mhb_stuck_factor *stuck,
                           const double *y, double scale, mhb_contact_step *step);

/* A guess for a step of h seconds, from the contact's state before it. */
void mhb_contact_step_guess(const mhb_law *law, const mhb_contact_point *point, double h,
                            mhb_contact_step *step);

/* Event function at tau in [0, 1] of the step, N: positive after the event. */
double mhb_contact_step_excess(const mhb_radau *rule, const mhb_law *law,
                               const mhb_contact_point *point, const mhb_contact_step *step,
                               mhb_contact_event event, double tau);

/* First event whose function exceeds the tolerance (N). Returns its place in [0, 1], 2 if none. */
double mhb_contact_step_first(const mhb_radau *rule, const mhb_law *law,
                              const mhb_contact_point *point, const mhb_contact_step *step,
                              double tolerance, mhb_contact_event *event);

/* Whether the direction of slip turns in a step that ends with this event, an opening. It may turn
 * like a power of the time left; steps then shrink with that time. */
bool mhb_contact_step_turns(const mhb_contact_point *point, const mhb_contact_step *step,
                            mhb_contact_event event);

/* Move the contact to the end of a step of h seconds. */
void mhb_contact_step_advance(const mhb_law *law, const mhb_contact_step *step, double h,
                              mhb_contact_point *point);

/* Change the state at the present motion. direction: of the friction, at an onset of slip, rad. */
void mhb_contact_step_change(const mhb_law *law, mhb_state state, double direction,
                             mhb_contact_point *point);

/* The state after an event of a closed contact: open, slip along the friction, or stick. */
void mhb_contact_step_after(const mhb_law *law, mhb_contact_event event, mhb_contact_point *point);

/* Whether a closing contact slips (eq. 13): rate of |f| - mu n at the start of a step that sticks,
 * N a step. Slip if positive.
 *   direction  out  of f, rad */
double mhb_contact_step_closing(const mhb_radau *rule, const mhb_law *law,
                                const mhb_contact_point *point, const mhb_contact_step *step,
                                double *direction);

#endif
