/* Derivatives of one peak by the parameters of contact, load and damping.
 *
 * A smooth peak is solved again, and one adjoint solution gives all derivatives (peak_system.h).
 * Where Newton's method does not reach it, it is bracketed along the response curve (kink.h). Slip
 * that just begins bends the curve within 1e-5 of the motion. A peak at the corner between stuck
 * and slipping moves along the corner: dA/dq = A_q - A_omega h_q/h_omega (corner_point.h). On the
 * stuck side it is A_q. On a kink both sides count (kink.h). Other peaks are not judged. */
#ifndef MHB_TRACKING_PEAK_DERIVATIVES_H
#define MHB_TRACKING_PEAK_DERIVATIVES_H

#include "mhb/tracking/peak_system.h"

typedef enum {
  MHB_PEAK_UNJUDGED,
  MHB_PEAK_SMOOTH,
  MHB_PEAK_CORNER,
  MHB_PEAK_STUCK,
  MHB_PEAK_KINK
} mhb_peak_kind;

typedef struct {
  mhb_peak_kind kind;
  double        omega, amplitude; /* rad/s, m: of the peak as it was solved here */
  double by[MHB_PEAK_PARAMETERS]; /* m a unit; NAN: not judged. n0 of the leading interface */
} mhb_peak_derivatives;

/* How far from the solution a smooth peak may be: its frequency, rad/s, and its amplitude over that
 * of the solution. Other peaks are to be the solution itself. */
typedef struct {
  double omega[2], amplitude[2];
  bool   smooth_only, no_derivatives; /* other peaks are not looked for; all derivatives are NAN */
} mhb_peak_near;

/* The peak is the solution itself: 1e-4 in amplitude, 1e-3 in frequency. */
mhb_peak_near mhb_peak_at(double omega);

/* Derivatives of a peak near a solution.
 *   output    in  output_amplitude.h
 *   x, omega  inout, in  [n], rad/s: the solution, which the balance is at; its amplitude in found.
 *                        x becomes that of a smooth peak or of one on a kink
 * The parameters of the balance's operating point are those of the solution, before and after. Its
 * evaluation may be another one then. */
shb_status mhb_peak_derivatives_find(mhb_balance *balance, int output, mhb_size size,
                                     mhb_peak_near near, double *x, double omega, double found,
                                     mhb_peak_derivatives *derivatives);

#endif
