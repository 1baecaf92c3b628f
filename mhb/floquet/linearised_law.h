/* The contact law linearised about a periodic motion: over a sub-step and through its events.
 *
 * Slip (slip.h for beta, gamma, theta'): with e along the friction and q across it,
 *   df = mu dn e + tau q,   tau' = -kappa tau + ((q - beta e)^T Ku) ds' + mu beta dn' - mu theta' dn,
 *   kappa = [gamma + beta q.x' + gamma beta']/(mu n),   x = Ku s
 * which keeps f.df = mu^2 n dn exactly: one of the two friction states is lost while it slips.
 *
 * Events, y = (dv, df) before them:
 *   stick -> slip   df - Ku e (e.df - mu dn)/(e.Ku e), free of the speed of onset
 *   slip -> stick   no jump;    -> open  df = 0
 *   open -> stick   df = Ku s' dn/n';    open -> slip  df = mu d dn, tau = 0
 * With residual flexibility the contacts share the jump: force rates follow from p' = G (w' - R p'), w the motion without
 * R p and G the tangents, and each jump is the difference of two such rates times the shift of the event.
 * Derivation: docs/theory/stability.md. Source: Chen, Yang, Menq 1999, eqs. 4-15, linearised. */
#ifndef MHB_FLOQUET_LINEARISED_LAW_H
#define MHB_FLOQUET_LINEARISED_LAW_H

#include "mhb/contact/contact.h"
#include "mhb/floquet/variational.h"

/* One contact at one time of the periodic motion. */
typedef struct {
  const mhb_law *law;
  mhb_state      state;
  double         n, e[2]; /* slip: normal load, N, and direction of the friction */
  double         rate[3]; /* (v, u, w)' m/s */
} mhb_contact_state;

/* Over a sub-step h, touch at its middle. */
void mhb_linearised_law_at(const mhb_contact_state *touch, double h, mhb_linearised_law *relation);

/* Jump of the rows of one contact when it passes to a state (no residual flexibility). */
void mhb_saltation_at(const mhb_contact_state *touch, mhb_state to, mhb_saltation *jump);

/* Force rate by motion rate, G[3][3], in the state of touch. */
void mhb_linearised_law_rate(const mhb_contact_state *touch, double G[3][3]);

#endif
