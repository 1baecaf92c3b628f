/* The contact law over one step of the time integration, with its own changes of state inside the
 * step.
 *
 * The step gives the motion w(tau) of the contact without its own flexibility R, a cubic. The law
 * is followed along u = w - R p in pieces of constant state (contact_step.h). The modes see the
 * quadratic in tau that is nearest to p in the mean square:
 *   p_j = 1/b_j int p l_j dtau,
 * with l_j Lagrange's polynomials at the Radau points and b_j their weights. Without a change of
 * state p_j are the forces at the stages. The modes then do the work that the contact takes, so a
 * passive contact stays passive. Derivation: docs/theory/time_integration.md. */
#ifndef MHB_INTEGRATION_CONTACT_PATH_H
#define MHB_INTEGRATION_CONTACT_PATH_H

#include "mhb/integration/contact_step.h"

/* A contact and its own flexibility. */
typedef struct {
  mhb_law law;
  double  R[3][3];                                     /* m/N */
  double  stuck[3][3];                                 /* (I + K R)^-1 */
  double  square[MHB_STAGE_FORCES * MHB_STAGE_FORCES]; /* R at every stage */
} mhb_contact_spring;

/* R: of the contact itself, m/N. */
void mhb_contact_spring_set(const mhb_law *law, const double R[3][3], mhb_contact_spring *spring);

/* What a contact does in a step. */
typedef struct {
  mhb_contact_point end;
  double            p[MHB_STAGE_FORCES]; /* [stage][axis] N */
  double            share[3];            /* of the step, by state */
  double            work;                /* dissipated, J */
  int               events, forced;      /* changes of state; pieces whose events were ignored */
} mhb_contact_path;

/* Follow the contact from point over a step of h seconds.
 *   start, w  in  [3], [9] m: the cubic at the beginning and at the stages
 *   scale     in  N, size of the forces
 * Returns 0 if the forces of a piece were not found. */
int mhb_contact_path_follow(const mhb_radau *rule, const mhb_contact_spring *spring, double h,
                            const mhb_contact_point *point, const double *start, const double *w,
                            double scale, mhb_contact_path *path);

#endif
