/* The contact law linearised about a periodic motion: over a sub-step, and its jumps at transitions
 * (saltation; Mueller 1995, Leine and Nijmeijer 2004).
 *
 * Slip (contact/slip.h for beta, gamma, theta'), e along the friction and q across it:
 *   df = mu dn e + tau q,
 *   tau' = -kappa tau + ((q - beta e)^T Ku) ds' + mu beta dn' - mu theta' dn,
 *   kappa = [gamma + beta q.x' + gamma beta']/(mu n),   x = Ku s.
 * So f.df = mu^2 n dn exactly: one of the two friction states vanishes in slip.
 *
 * Transitions, with (dv, df) before them:
 *   stick -> slip   df - Ku e (e.df - mu dn)/(e.Ku e), independent of the speed of onset
 *   slip -> stick   no jump
 *   any -> open     df = 0
 *   open -> stick   df = Ku s' dn/n'
 *   open -> slip    df = mu d dn, d the direction of slip; tau = 0
 * With residual flexibility R all contacts jump. The force rates are p' = G (w' - R p'), w the
 * motion without R p and G the tangent stiffnesses. A jump is the difference of p' before and after
 * times the shift of the event. Derivation: docs/theory/stability.md. Source: Chen, Yang, Menq
 * 1999, eqs. 4-15, linearised. */
#ifndef MHB_VARIATION_LINEARISED_LAW_H
#define MHB_VARIATION_LINEARISED_LAW_H

#include "mhb/contact/contact.h"
#include "mhb/variation/variational.h"

/* One contact at one time of the periodic motion. */
typedef struct {
  const mhb_law *law;
  mhb_state      state;
  double         n, e[2]; /* slip: normal load, N, and direction of the friction */
  double         rate[3]; /* (v, u, w)' m/s */
} mhb_contact_state;

/* Law over a sub-step of h seconds; point: the contact at its middle. */
void mhb_linearised_law_at(const mhb_contact_state *point, double h,
                           mhb_linearised_law *linearised);

/* Jump of the rows of one contact at its transition to a state, without residual flexibility. */
void mhb_saltation_at(const mhb_contact_state *point, mhb_state to, mhb_saltation *jump);

/* Tangent stiffness G[3][3], N/m: force rate by motion rate in the contact's state. */
void mhb_linearised_law_rate(const mhb_contact_state *point, double G[3][3]);

#endif
