/* Mean static friction of a contact that never slips or opens.
 *
 * The physics leaves it undetermined: any c with |f_ac + c| <= mu n at all times persists.
 * Convention, flagged as such in the results: the smallest admissible mean,
 *   c = argmin |c|  subject to  |f_ac(t) + c| <= mu n(t) for all t,   f_ac = Ku (s - mean s).
 * It is zero wherever zero is admissible, unique, and continuous where slip begins. No admissible c
 * is the exact test for slip.
 *
 * The origin is projected onto an intersection of discs, of which at most two are active. Times
 * between grid points are added (cutting planes) until the worst violation is below rounding. */
#ifndef MHB_CONTACT_STATIC_FRICTION_H
#define MHB_CONTACT_STATIC_FRICTION_H

#include "mhb/numerics/fourier.h"

typedef struct {
  int    feasible; /* 0: the contact slips */
  double c[2];     /* mean friction, in units of x */
  int    n_active; /* 0, 1 or 2 */
  double time[2];  /* when the friction limit is touched */
} mhb_static_friction;

/* signals: (n, x_1, x_2) with n > 0 throughout. */
void mhb_static_friction_solve(const mhb_signals *signals, double mu, mhb_static_friction *stuck);

/* dc = weight . (dn, dx_1, dx_2, dn', dx_1', dx_2') at the active times, dx without its mean.
 *   weight  out  [2][n_active][6] */
void mhb_static_friction_gradient(const mhb_signals *signals, double mu,
                                  const mhb_static_friction *stuck, double weight[2][2][6]);

#endif
