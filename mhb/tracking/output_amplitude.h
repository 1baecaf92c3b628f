/* The amplitude of an output at a solution of the balance, and its gradient.
 *
 *   A = the semi-major axis of the ellipse Re a_k e^{jt}
 *
 * a_k is the harmonic of the output (mhb_output_harmonic), of a probe or of the relative motion of
 * a contact pair. Or A is the rss of a_k, or the peak to peak of all harmonics
 * (mhb/numerics/extent.h). A probe answers the load and the contact forces p(x). Its gradient by x
 * passes through dp/dx. */
#ifndef MHB_TRACKING_OUTPUT_AMPLITUDE_H
#define MHB_TRACKING_OUTPUT_AMPLITUDE_H

#include "mhb/balance/balance.h"

/* Which of them. */
typedef enum { MHB_SIZE_HALF_AXIS, MHB_SIZE_RSS, MHB_SIZE_PEAK_TO_PEAK } mhb_size;

/* Gradient of the amplitude at fixed operating point (by x) and at fixed x (by omega). */
typedef struct {
  double          amplitude;  /* m */
  double         *by_x;       /* [n] */
  double          by_omega;   /* m s/rad */
  double          by_scale;   /* m */
  double          by_damping; /* m, by a common relative change of all damping ratios */
  double complex *weight;     /* [m + 1][3 pairs] of the contact force: dA = Re sum weight_k dp_k at
                           * fixed x */
  mhb_size        size;
} mhb_amplitude;

/* The amplitude and its gradient at x[n], which the evaluation in use was linearised at.
 *   output  in   a probe, or the number of probes plus a pair
 *   out     inout  by_x and weight are the caller's arrays; size says which amplitude */
void mhb_output_amplitude(mhb_balance *balance, const double *x, int output, mhb_amplitude *out);

/* Length of weight. */
size_t mhb_amplitude_weights(const mhb_balance *balance);

/* dA/dparameter at fixed x and omega; by_parameter[n] is the change of the contact force. */
double mhb_amplitude_by_parameter(const mhb_balance *balance, const mhb_amplitude *amplitude,
                                  mhb_parameter parameter, const double *by_parameter);

/* slope[n] <- dr/d ln zeta, common to all damping ratios, at the point of the evaluation in
 * use. */
void mhb_slope_by_damping(mhb_balance *balance, double *slope);

#endif
