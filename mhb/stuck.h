/* Static friction of a contact that never slips or opens.
 *
 * The physics leaves its mean undetermined (any c with |f_ac + c| <= mu n at all times persists). Convention, flagged
 * as such in the results: the smallest admissible mean,
 *   c = argmin |c|  subject to  |f_ac(t) + c| <= mu n(t) for all t,   f_ac = Ku (s - mean s).
 * It is zero wherever zero is admissible, unique, and continuous where slip begins; that no c is admissible is the
 * exact test for slip. The origin is projected onto an intersection of discs: at most two are active; times between
 * grid points are added (cutting planes) until the worst violation is below rounding. */
#ifndef MHB_STUCK_H
#define MHB_STUCK_H

#include "mhb/fourier.h"

typedef struct {
  int    feasible; /* 0: the contact slips */
  double c[2];     /* mean friction, in units of x */
  int    n_active; /* 0, 1 or 2 */
  double time[2];  /* when the friction limit is touched */
} mhb_stuck;

/* signals: (n, x_1, x_2) with n > 0 throughout. */
void mhb_stuck_solve(const mhb_signals *signals, double mu, mhb_stuck *stuck);

/* dc/d(motion): for each column j of a basis change its values and slopes (dn, dx_1, dx_2) at the active times.
 *   value, slope  in  [n_active] of the column at time[i] (dx without its mean)
 *   dc            out the column's change of c */
void mhb_stuck_derivative(const mhb_signals *signals, double mu, const mhb_stuck *stuck,
                          const double value[2][3], const double slope[2][3], double dc[2]);

#endif
