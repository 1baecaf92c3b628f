/* Peaks, folds, flips and Neimark-Sacker points of a response curve as solutions with a free
 * frequency, to be followed along a parameter q (docs/theory/tracking.md).
 *
 *   z = (x, xi),  xi = length omega/range    unknowns, m
 *   r(x, omega, q) = 0                          the balance
 *   G = dA/ds = A_z T = 0                       A the output's amplitude; for a fold A = xi
 *   B = [r_x r_xi; c^T],  B [T; .] = [0; 1]     T the unit tangent of the response curve
 *
 * c is a border. G needs no division by a determinant, so a peak is followed through folds of the
 * curve. With the adjoint [l; k] = B^-T A_z the gradient of G is that of the Lagrangian A - l^T r
 * along T:
 *
 *   dG = T^T (A_zz - l r_zz) dz + (A_zq - l r_zq) T dq
 *
 * It is a one-sided difference of the exact first derivatives over a step of 1e-6 |z|. This takes
 * one more linearisation. The error of the row is some 1e-6, which slows Newton's method slightly
 * and leaves its limit as it is.
 *
 * At a flip or a Neimark-Sacker point G = 0.01 length g in its place, g of multiplier_condition.h.
 *
 * Sources: Govaerts 2000 (bordered systems); Krack, Gross 2019 (peaks of a response curve). */
#ifndef MHB_TRACKING_PEAK_SYSTEM_H
#define MHB_TRACKING_PEAK_SYSTEM_H

#include "mhb/continuation/curve.h"
#include "mhb/tracking/multiplier_condition.h"
#include "mhb/tracking/output_amplitude.h"

typedef enum {
  MHB_TRACK_PEAK,
  MHB_TRACK_FOLD,
  MHB_TRACK_FLIP,
  MHB_TRACK_NEIMARK_SACKER
} mhb_tracked_point;

/* What a linearised point of the system tells besides G. */
typedef struct {
  double amplitude;  /* m, of the output */
  double curvature;  /* d2A/ds2 along the response curve, 1/m: below 0 at a maximum */
  double by_value;   /* dA/dq along the peaks; for a fold d xi/dq, m a unit; else 0 */
  double slip_share; /* smallest share of the period in which a nonlinear pair slips or is open; 0:
                        all pairs are linear */
  mhb_multiplier_place multiplier; /* of a flip or Neimark-Sacker point */
} mhb_peak_report;

/* The slip share of a report, at the evaluation in use. */
double mhb_slip_share(const mhb_balance *balance);

typedef struct mhb_peak_system mhb_peak_system;

/* The system of the peaks of an output (output_amplitude.h), or of the other points. The balance
 * must outlive it and be used by nothing else meanwhile.
 *   parameter  in  q, not the frequency
 *   range      in  rad/s, the width of the frequency range
 *   length     in  m, the size of the motion */
shb_status mhb_peak_system_create(mhb_balance *balance, mhb_tracked_point kind, int output,
                                  mhb_parameter parameter, double range, double length,
                                  mhb_peak_system **system);

/* The system for a curve, which takes it over. */
mhb_curve_system *mhb_peak_system_base(mhb_peak_system *system);

/* Steps in q are relative to it, or to this where it is smaller: the range of q contains 0. */
void mhb_peak_system_passes_zero(mhb_curve_system *system, double least_unit);

/* Linearise a point and report. */
mhb_peak_report mhb_peak_system_report(mhb_curve_system *system, const mhb_curve_point *point);

/* Of flips and Neimark-Sacker points: choose the multiplier at a solution x[n] near the first one.
 * Returns NULL, or why there is none. */
const char *mhb_peak_system_choose(mhb_curve_system *system, const double *x, double omega,
                                   double value);

/* The point is on the curve: the multiplier is expected near that of this one. */
void mhb_peak_system_accept(mhb_curve_system *system, const mhb_curve_point *point);

/* The verdict's multipliers at a point; *finer: they took other sub-steps than the curve so far. */
void mhb_peak_system_judge(mhb_curve_system *system, const mhb_curve_point *point,
                           mhb_multipliers *multipliers, bool *finer);

/* Take over the sub-steps of the last verdict; a point is to be corrected then. */
void mhb_peak_system_adapt(mhb_curve_system *system);

/* The derivatives of a peak, by the number of each. */
enum {
  MHB_PEAK_BY_N0,
  MHB_PEAK_BY_SCALE,
  MHB_PEAK_BY_MU,
  MHB_PEAK_BY_KU,
  MHB_PEAK_BY_KV,
  MHB_PEAK_BY_DAMPING, /* m: by a common relative change of all damping ratios */
  MHB_PEAK_PARAMETERS
};

/* The operating point's parameter of a derivative; not of the damping. */
mhb_parameter mhb_peak_parameter(int derivative);

/* Which amplitude has the peak. The semi-major axis after creation. */
void mhb_peak_system_measure(mhb_curve_system *system, mhb_size size);

/* dA/dq by all parameters at a linearised point of the response curve: A_q - l r_q.
 *   amplitude   in   there
 *   adjoint     in   [n] l
 *   by_q        out  [n] work space */
void mhb_peak_gradient(mhb_balance *balance, const double *x, const mhb_amplitude *amplitude,
                       const double *adjoint, double *by_q, double by[MHB_PEAK_PARAMETERS]);

/* The same of a peak, from the adjoint of the point. */
void mhb_peak_system_derivatives(mhb_curve_system *system, const mhb_curve_point *point,
                                 double by[MHB_PEAK_PARAMETERS]);

/* Unknowns from a motion x[n] of the balance at omega, and back. */
void mhb_peak_system_pack(const mhb_curve_system *system, const double *x, double omega, double *z);
double mhb_peak_system_omega(const mhb_curve_system *system, const double *z);
/* d omega/d xi, rad/(s m) */
double mhb_peak_system_rate(const mhb_curve_system *system);

#endif
