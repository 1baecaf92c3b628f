/* Transition times from the harmonics themselves (eqs. 7, 11, 12): every root is bracketed by a
 * bound.
 *
 * Signals are (n, x_1, x_2): normal load before clipping, and x = Ku s, all divided by one force
 * scale. On a cell of width h a function with |y''''| <= M4 differs from its cubic Hermite
 * interpolant by at most h^4 M4/384. The cubic lies inside the hull of its Bezier points y0, y0 + h
 * y0'/3, y1 - h y1'/3, y1.
 *
 * A cell whose hull, widened by the bound, stays on one side of zero holds no root. Any other cell
 * is bisected. Where the slope has one sign the root is found by safeguarded Newton. */
#ifndef MHB_CONTACT_TRANSITIONS_H
#define MHB_CONTACT_TRANSITIONS_H

#include "mhb/numerics/fourier.h"

/* Intervals of the period in which n > 0. */
typedef struct {
  int     room; /* m harmonics have 2m roots at most */
  int     n;    /* number of closed intervals; 0 with always_* set */
  int     always_closed, always_open;
  double *closing; /* [room + 1] in [0, 2 pi), ascending */
  double *opening; /* [room + 1] the opening after closing[i], up to closing[i] + 2 pi */
} mhb_contact_intervals;

/* For loads of up to m harmonics. SHB_ERR_IO: no memory. */
shb_status mhb_contact_intervals_create(int m, mhb_contact_intervals *closed);
void       mhb_contact_intervals_destroy(mhb_contact_intervals *closed);

/* Roots of n (eqs. 11, 12). Touching zero without crossing counts as closed (n >= 0). */
void mhb_contact_intervals_find(const mhb_signals *signals, mhb_contact_intervals *closed);

/* First t in (from, to] at which |x - z| reaches mu n from below (eq. 7), and the signals there; to
 * + 1 if there is none. from may be a double zero, where slip has just ended or the contact has
 * just closed: it is stepped over. */
double mhb_slip_onset(const mhb_signals *signals, double mu, const double z[2], double from,
                      double to, double value[3]);

#endif
