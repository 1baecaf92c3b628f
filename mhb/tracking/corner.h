/* Peaks without slip, followed along a parameter q (docs/theory/tracking.md). They are the corner
 * between the stuck and the slipping side, and the peak of the stuck side.
 *
 * While the pair sticks, its response is linear, and omega and q give it without iteration. Slip is
 * possible where the friction forces f (without their mean) of two phases t_1, t_2 lie further
 * apart than their limits allow:
 *   h(omega, q) = max over t_1, t_2 of (|f_1 - f_2| - mu (n_1 + n_2))/2 = 0.
 * There the mean friction c is determined, for the two discs |f_i + c| <= mu n_i touch:
 *   c = -(f_1 + f_2)/2 + mu (n_1 - n_2) e/2,   e = (f_1 - f_2)/|f_1 - f_2|.
 * It moves the mean of the normal motion through the static receptance, so n and c are solved
 * together. A corner peak is a root of h in omega, a stuck peak one of dA/domega with h < 0.
 *
 * Derivatives of A and h are central differences of fourth order of these functions. The relative
 * steps are 1e-5 (omega) and 1e-3 (q), the relative errors below 1e-8. */
#ifndef MHB_TRACKING_CORNER_H
#define MHB_TRACKING_CORNER_H

#include "mhb/tracking/tracked_curve.h"

/* At one (omega, q), the pair stuck. */
typedef struct {
  double amplitude;   /* m, of the output */
  double onset;       /* h, N: below 0 the pair sticks */
  double friction[2]; /* c, N: the mean friction of two touching discs */
  double time[2];     /* t_1, t_2 */
} mhb_stuck_state;

/* Evaluate with the pair stuck; x[n] <- the motion, with the mean that c gives. The balance is left
 * at (omega, q). SHB_ERR_INPUT: the stuck system is singular. */
shb_status mhb_stuck_response(mhb_balance *balance, const mhb_tracking *tracking, double omega,
                              double value, double *x, mhb_stuck_state *state);

/* Amplitude and frequency of the corner (stuck false: h = 0) or the stuck peak (true) at a value.
 *   omega   inout  rad/s: a guess, within 2 % of which the root is sought; the root
 *   x       out    [n] motion
 * False: there is none. */
bool mhb_corner_at(mhb_balance *balance, const mhb_tracking *tracking, bool stuck, double value,
                   double *omega, double *x, double *amplitude);

/* dA/dq along corners (stuck false) or stuck peaks, at one of them. x[n]: scratch. NAN:
 * singular. */
double mhb_corner_slope(mhb_balance *balance, const mhb_tracking *tracking, bool stuck,
                        double omega, double value, double *x);

/* Follow a corner or stuck peak from a seed both ways into an empty branch that ascends in the
 * parameter. It ends at the ends of the range, where the corner is no maximum any more, or where a
 * stuck peak begins to slip (MHB_END_CORNER). Points are as dense as linear interpolation of the
 * amplitude to 3e-5 asks for. MHB_OPTIMUM marks where the amplitude is stationary.
 * *found false: the seed is neither, or there are several contact pairs. SHB_ERR_IO: no memory. */
shb_status mhb_trace_corner(mhb_balance *balance, const mhb_tracking *tracking,
                            const mhb_tracking_seed *seed, mhb_response *response, int branch,
                            bool *found, mhb_tracking_end *end);

#endif
