#include "mhb/tracking/peak_derivatives.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/vector.h"
#include "mhb/tracking/corner.h"

/* The peak solved here is the one that was found if amplitude and frequency agree, relative. */
static const double SAME_AMPLITUDE = 1e-4, SAME_FREQUENCY = 1e-3;

/* The peak's matrices are dense: with more unknowns the derivatives are not judged. */
enum { MOST_UNKNOWNS = 1300 };

/* Newton's method for a peak ends at this residual, relative to the motion. */
static const double SETTLED = 1e-10;

/* Relative change of the damping ratios for the differences at corners. */
static const double DAMPING_STEP = 1e-3;

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
  shb_status status = mhb_curve_point_create(system, &point);
  if (status == SHB_OK) {
    solve_smooth(s, system, &point, out);
    mhb_balance_use(s->balance, NULL);
    mhb_curve_point_destroy(system, &point);
  }
  system->destroy(system);
  return status;
}

/* ---- a peak without slip ---- */

/* Amplitude of the corner with all damping ratios times a factor; NAN: not found. */
static double damped(const search *s, const mhb_tracking *tracking, bool stuck, double factor,
                     double omega, double *x) {
  modal_model  model = *s->balance->receptance->model;
  int          m     = model.n_modes;
  double      *ratio = malloc((size_t)m * sizeof *ratio), amplitude = NAN;
  mhb_balance *other = NULL;
  for (int i = 0; ratio && i < m; i++) ratio[i] = factor * model.damping_ratio[i];
  model.damping_ratio = ratio;
  if (ratio && mhb_balance_create(&model, s->balance->settings, &other) == SHB_OK) {
    mhb_balance_set_operating_point(other, &s->balance->eval->at);
    if (!mhb_corner_at(other, tracking, stuck, tracking->low, &omega, x, &amplitude))
      amplitude = NAN;
  }
  mhb_balance_destroy(other);
  free(ratio);
  return amplitude;
}

static void corner_derivatives(const search *s, mhb_tracking *tracking, bool stuck, double *x,
                               mhb_peak_derivatives *out) {
  mhb_balance              *b  = s->balance;
  const mhb_operating_point at = b->eval->at;
  for (int i = 0; i < MHB_PEAK_BY_DAMPING; i++) {
    tracking->parameter = mhb_peak_parameter(i);
    tracking->low = tracking->high = mhb_parameter_get(&at, tracking->parameter);
    out->by[i] = mhb_corner_slope(b, tracking, stuck, out->omega, tracking->low, x);
    mhb_balance_set_operating_point(b, &at);
    /* n0 and mu do not reach a stuck motion: what remains is round-off */
    if (fabs(out->by[i] * tracking->low) < 1e-9 * out->amplitude) out->by[i] = 0;
  }
  static const double place[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  double              sum = 0;
  tracking->parameter     = MHB_IN_N0;
  tracking->low = tracking->high = at.n0;
  const mhb_settings *settings   = s->balance->settings;
  const bool          several = settings->run_up || settings->nodal_diameters; /* not one model */
  for (int i = 0; i < 4 && !several; i++)
    sum += weight[i] * damped(s, tracking, stuck, 1 + place[i] * DAMPING_STEP, out->omega, x) /
           (12 * DAMPING_STEP);
  out->by[MHB_PEAK_BY_DAMPING] = several ? NAN : sum;
}

/* The corner (stuck false) or the stuck peak near the solution. Returns its relative distance in
 * amplitude; INFINITY: there is none. */
static double distance_to(const search *s, const mhb_tracking *tracking, bool stuck, double *x,
                          double *omega, double *amplitude) {
  const mhb_operating_point at = s->balance->eval->at;
  mhb_stuck_state           state;
  *omega     = s->omega;
  bool found = mhb_corner_at(s->balance, tracking, stuck, at.n0, omega, x, amplitude) &&
               is_same(s, *omega, *amplitude);
  if (found && stuck)
    found = mhb_stuck_response(s->balance, tracking, *omega, at.n0, x, &state) == SHB_OK &&
            state.onset < 0;
  mhb_balance_set_operating_point(s->balance, &at);
  return found ? fabs(*amplitude / s->found - 1) : INFINITY;
}

static void without_slip(const search *s, double *x, mhb_peak_derivatives *out) {
  double       n0       = s->balance->eval->at.n0, omega[2], amplitude[2], distance[2];
  mhb_tracking tracking = {.kind      = MHB_TRACK_PEAK,
                           .output    = s->output,
                           .parameter = MHB_IN_N0,
                           .low       = n0,
                           .high      = n0,
                           .size      = s->size};
  for (int stuck = 0; stuck < 2; stuck++)
    distance[stuck] = distance_to(s, &tracking, stuck, x, &omega[stuck], &amplitude[stuck]);
  int nearer = distance[1] < distance[0];
  if (!isfinite(distance[nearer])) return;
  out->kind      = nearer ? MHB_PEAK_STUCK : MHB_PEAK_CORNER;
  out->omega     = omega[nearer];
  out->amplitude = amplitude[nearer];
  if (!s->near.no_derivatives) corner_derivatives(s, &tracking, nearer, x, out);
}

shb_status mhb_peak_derivatives_find(mhb_balance *balance, int output, mhb_size size,
                                     mhb_peak_near near, double *x, double omega, double found,
                                     mhb_peak_derivatives *out) {
  const search s = {balance, output, size, near, x, omega, found};
  *out           = (mhb_peak_derivatives){.kind = MHB_PEAK_UNJUDGED};
  for (int i = 0; i < MHB_PEAK_PARAMETERS; i++) out->by[i] = NAN;
  if (balance->n > MOST_UNKNOWNS) return SHB_OK;
  SHB_TRY(smooth(&s, out));
  if (out->kind == MHB_PEAK_SMOOTH || near.smooth_only || balance->n_pairs != 1) return SHB_OK;
  double *scratch = calloc((size_t)balance->n, sizeof *scratch);
  SHB_CHECK(scratch, SHB_ERR_IO, "out of memory");
  without_slip(&s, scratch, out);
  free(scratch);
  return SHB_OK;
}
