#include "mhb/tracking/peak_derivatives.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/vector.h"
#include "mhb/tracking/corner_point.h"
#include "mhb/tracking/kink.h"

/* The peak solved here is the one that was found if amplitude and frequency agree, relative. */
static const double SAME_AMPLITUDE = 1e-4, SAME_FREQUENCY = 1e-3;

/* The peak's matrices are dense: with more unknowns the derivatives are not judged. */
enum { MOST_UNKNOWNS = 1300 };

/* Newton's method for a peak ends at this residual, relative to the motion. */
static const double SETTLED = 1e-10;

/* The solution may be at a corner of a pair whose h is this part of its friction limit. */
static const double CANDIDATE = 0.01;

/* On either side of a kink |G| is larger than this. */
static const double JUMP = 1e-4;

/* Where slip just begins the law's error hides G. A bracketed peak is that of a more accurate law.
 * This is the share of its tolerance. */
static const double SHARPER = 0.01;

typedef struct {
  mhb_balance  *balance;
  int           output;
  mhb_size      size;
  mhb_peak_near near; /* of a smooth peak */
  double       *x;
  double        omega, found;
} search;

mhb_peak_near mhb_peak_at(double omega) {
  return (mhb_peak_near){{omega * (1 - SAME_FREQUENCY), omega * (1 + SAME_FREQUENCY)},
                         {1 - SAME_AMPLITUDE, 1 + SAME_AMPLITUDE},
                         false,
                         false};
}

static bool is_near(const search *s, double omega, double amplitude) {
  const mhb_peak_near *n = &s->near;
  return omega >= n->omega[0] && omega <= n->omega[1] && amplitude >= n->amplitude[0] * s->found &&
         amplitude <= n->amplitude[1] * s->found;
}

static bool is_same(const search *s, double omega, double amplitude) {
  return fabs(amplitude - s->found) <= SAME_AMPLITUDE * s->found &&
         fabs(omega - s->omega) <= SAME_FREQUENCY * s->omega;
}

/* ---- a smooth peak ---- */

static void solve_smooth(const search *s, mhb_curve_system *system, mhb_curve_point *point,
                         mhb_peak_derivatives *out) {
  mhb_peak_system_pack(system, s->x, s->omega, point->x);
  point->value = s->balance->eval->at.n0;
  if (system->solve_at_value(system, SETTLED, point) != MHB_CONVERGED) return;
  mhb_peak_report report = mhb_peak_system_report(system, point);
  double          omega  = mhb_peak_system_omega(system, point->x);
  if (!is_near(s, omega, report.amplitude) || !(report.curvature < 0)) return;
  if (!(report.slip_share > 0)) return; /* at the corner, where no derivative by x is continuous */
  out->kind      = MHB_PEAK_SMOOTH;
  out->omega     = omega;
  out->amplitude = report.amplitude;
  if (!s->near.no_derivatives) mhb_peak_system_derivatives(system, point, out->by);
  memcpy(s->x, point->x, (size_t)s->balance->n * sizeof *s->x);
}

static shb_status smooth(const search *s, mhb_peak_derivatives *out) {
  const double    *range = s->balance->settings->frequency;
  mhb_peak_system *made;
  mhb_curve_point  point;
  SHB_TRY(mhb_peak_system_create(s->balance, MHB_TRACK_PEAK, s->output, MHB_IN_N0,
                                 SHB_TWO_PI * (range[1] - range[0]), mhb_norm(s->x, s->balance->n),
                                 &made));
  mhb_curve_system *system = mhb_peak_system_base(made);
  mhb_peak_system_measure(system, s->size);
  mhb_curve_point_create(system, &point);
  solve_smooth(s, system, &point, out);
  mhb_balance_use(s->balance, NULL);
  mhb_curve_point_destroy(system, &point);
  system->destroy(system);
  return SHB_OK;
}

/* ---- a peak without slip ---- */

static void corner_derivatives(const search *s, mhb_corner *corner, mhb_peak_derivatives *out) {
  const mhb_operating_point at    = s->balance->eval->at;
  const mhb_corner_state    state = mhb_corner_linearise(corner, out->omega, at.n0);
  for (int i = 0; i < MHB_PEAK_PARAMETERS; i++) {
    const bool          damping   = i == MHB_PEAK_BY_DAMPING;
    const mhb_parameter parameter = damping ? MHB_IN_N0 : mhb_peak_parameter(i);
    out->by[i] = mhb_corner_derivative(corner, &state, out->omega, parameter, damping);
    /* n0 and mu do not reach a stuck motion: what remains is round-off */
    const double value = damping ? 1 : mhb_parameter_get(&at, parameter);
    if (fabs(out->by[i] * value) < 1e-9 * out->amplitude) out->by[i] = 0;
  }
  const mhb_settings *settings = s->balance->settings;
  if (settings->run_up || settings->nodal_diameters) /* not one model */
    out->by[MHB_PEAK_BY_DAMPING] = NAN;
}

/* A corner of a pair (or, below 0, the stuck peak) near the solution. Returns its relative distance
 * in amplitude; INFINITY: there is none. */
static double distance_to(const search *s, mhb_corner *corner, int pair, double *omega,
                          double *amplitude) {
  const mhb_operating_point at = s->balance->eval->at;
  *omega                       = s->omega;
  mhb_corner_take(corner, pair, at.n0, s->x);
  bool found = mhb_corner_solve(corner, at.n0, pair < 0 ? -1 : 0, omega);
  if (found) {
    const mhb_corner_state state = mhb_corner_evaluate(corner, *omega, at.n0);
    *amplitude                   = state.amplitude;
    found                        = is_same(s, *omega, *amplitude) && (pair >= 0 || state.onset < 0);
  }
  mhb_balance_set_operating_point(s->balance, &at);
  return found ? fabs(*amplitude / s->found - 1) : INFINITY;
}

static void without_slip(const search *s, mhb_corner *corner, mhb_peak_derivatives *out) {
  const double n0      = s->balance->eval->at.n0;
  const int    n_pairs = s->balance->n_pairs;
  const double share   = n_pairs == 1 ? INFINITY : CANDIDATE;
  int          pair[n_pairs + 1], nearest = 0;
  const int    n        = mhb_corner_candidates(corner, n0, s->x, share, pair);
  double       distance = INFINITY;
  pair[n]               = -1; /* the stuck peak */
  for (int i = 0; i <= n; i++) {
    double omega = s->omega, amplitude = s->found;
    double here = distance_to(s, corner, pair[i], &omega, &amplitude);
    if (!(here < distance)) continue;
    distance       = here;
    nearest        = i;
    out->omega     = omega;
    out->amplitude = amplitude;
  }
  if (!isfinite(distance)) return;
  out->kind = pair[nearest] < 0 ? MHB_PEAK_STUCK : MHB_PEAK_CORNER;
  if (s->near.no_derivatives) return;
  distance_to(s, corner, pair[nearest], &out->omega, &out->amplitude);
  corner_derivatives(s, corner, out);
}

static shb_status find_without_slip(const search *s, const mhb_tracking *tracking,
                                    mhb_peak_derivatives *out) {
  mhb_corner *corner;
  corner = mhb_corner_create(s->balance, tracking);
  without_slip(s, corner, out);
  mhb_corner_destroy(corner);
  return SHB_OK;
}

/* ---- a peak that is bracketed ---- */

/* The next maximum of the response curve, if slip bounds it on both sides. A jump of G within the
 * law's error is none. */
static void take_bracketed(const search *s, mhb_kink *kink, mhb_peak_derivatives *out) {
  mhb_peak_place at = {.value = s->balance->eval->at.n0, .omega = s->omega};
  mhb_end        why;
  const bool     found = mhb_kink_start(kink, s->x, &at, &why), on_kink = found && at.margin > JUMP;
  if (!found && why != MHB_END_SMOOTH) return;
  if (!(on_kink ? is_same : is_near)(s, at.omega, at.amplitude)) return;
  if (!(mhb_kink_slip_share(kink) > 0)) return; /* at the corner, or stuck */
  out->kind      = on_kink ? MHB_PEAK_KINK : MHB_PEAK_SMOOTH;
  out->omega     = at.omega;
  out->amplitude = at.amplitude;
  mhb_kink_maximum(kink, s->x, s->near.no_derivatives ? NULL : out->by);
}

static shb_status bracketed(const search *s, const mhb_tracking *tracking,
                            mhb_peak_derivatives *out) {
  const mhb_operating_point at = s->balance->eval->at;
  mhb_kink                 *kink;
  kink = mhb_kink_create(s->balance, tracking);
  mhb_balance_sharpen_law(s->balance, SHARPER);
  take_bracketed(s, kink, out);
  mhb_balance_sharpen_law(s->balance, 1);
  mhb_balance_set_operating_point(s->balance, &at);
  mhb_kink_destroy(kink);
  return SHB_OK;
}

shb_status mhb_peak_derivatives_find(mhb_balance *balance, int output, mhb_size size,
                                     mhb_peak_near near, double *x, double omega, double found,
                                     mhb_peak_derivatives *out) {
  const search s = {balance, output, size, near, x, omega, found};
  *out           = (mhb_peak_derivatives){.kind = MHB_PEAK_UNJUDGED};
  for (int i = 0; i < MHB_PEAK_PARAMETERS; i++) out->by[i] = NAN;
  if (balance->n > MOST_UNKNOWNS) return SHB_OK;
  SHB_TRY(smooth(&s, out));
  if (out->kind == MHB_PEAK_SMOOTH || near.smooth_only) return SHB_OK;
  const double       n0 = balance->eval->at.n0, *range = balance->settings->frequency;
  const mhb_tracking tracking = {.kind      = MHB_TRACK_PEAK,
                                 .output    = output,
                                 .parameter = MHB_IN_N0,
                                 .low       = n0,
                                 .high      = n0,
                                 .frequency = {SHB_TWO_PI * range[0], SHB_TWO_PI * range[1]},
                                 .size      = size};
  const bool         stuck    = mhb_balance_is_linear(balance);
  if (stuck) SHB_TRY(find_without_slip(&s, &tracking, out));
  if (out->kind == MHB_PEAK_STUCK) return SHB_OK;
  SHB_TRY(bracketed(&s, &tracking, out)); /* where it is, it is higher than the corner */
  return out->kind == MHB_PEAK_UNJUDGED && !stuck ? find_without_slip(&s, &tracking, out) : SHB_OK;
}
