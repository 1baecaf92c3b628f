/* In a run-up the modal model depends on the frequency: the part of d/d omega that this adds.
 *
 * With d = scale F - B^H p, a = L d and A = L^-1 (speed_model.h), at fixed p:
 *   d(B a) = dB a + B L (dd - dA a),   dA = dK + j w (dN + dG)
 * and the derivative of the residual terms with their weights. */
#ifndef MHB_STRUCTURE_SPEED_DERIVATIVE_H
#define MHB_STRUCTURE_SPEED_DERIVATIVE_H

#include "mhb/run_up/disc_speeds.h"
#include "mhb/structure/modal_part.h"

typedef struct {
  mhb_speed_model     **model; /* [k] the caller's, as are disc and part */
  mhb_disc_speeds      *disc;  /* NULL: a clamped blade, one model */
  const mhb_modal_part *part;  /* of the models */
  mhb_modal_part       *slope; /* of their slopes, the derivative by omega */
} mhb_speed_derivative;

/* The models are differentiated and must outlive the result.
 *   wave  in  [k] of the slopes of a disc; NULL: a clamped blade */
shb_status mhb_speed_derivative_create(mhb_speed_model **model, mhb_disc_speeds *disc,
                                       const modal_wave *wave, const mhb_modal_part *part,
                                       mhb_speed_derivative **derivative);
void       mhb_speed_derivative_destroy(mhb_speed_derivative *derivative);

/* L at a frequency: diagonal, or with Coriolis terms the factor of its inverse. */
typedef struct {
  const double complex *lambda; /* [modes] NULL: factor and pivot count */
  const double complex *factor; /* [modes][modes] */
  const int            *pivot;  /* [modes] */
} mhb_modal_solver;

/* slope[n] += the model's part of d/d omega of the contact motion at harmonic k, w rad/s.
 *   L       in  at w
 *   p       in  [n] contact force, N */
void mhb_speed_derivative_slope(const mhb_speed_derivative *derivative, int k, double w,
                                mhb_modal_solver L, double scale, const double complex *p,
                                double complex *slope);

/* change[3 q] += d_omega times the same of the probes. */
void mhb_speed_derivative_probe(const mhb_speed_derivative *derivative, int k, double w,
                                mhb_modal_solver L, double scale, const double complex *p,
                                double d_omega, double complex *change);

#endif
