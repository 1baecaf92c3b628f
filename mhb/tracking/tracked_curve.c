#include "mhb/tracking/tracked_curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"
#include "mhb/contact/slip_onset.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/segment.h"
#include "mhb/numerics/vector.h"

/* Below this share of the period slip has as good as ended. The response curve has a corner there,
 * and the law's derivatives lose their meaning. */
static const double LEAST_SLIP = 2e-3;

/* A pair of multipliers meets on the real axis within this of its discriminant. */
static const double MEETING = 1e-7;

/* Least unit of the parameter in a range that contains 0, in ranges. */
static const double NEAR_ZERO = 0.05;

/* Beyond a kink amplitude and frequency differ by no more than this, relative. */
static const double NEIGHBOUR = 2e-2;
enum { MOST_KINKS = 12, MOST_REFINEMENTS = 2 };

/* Error of an inflection's place on its step. The parameter has its extremum there: its own error
 * is of the order of the square. */
static const double AT_INFLECTION = 1e-4;

/* Residual of points, relative to the motion. An amplitude differs by less from that of its peak
 * (docs/evidence). */
static const double SETTLED = 1e-9;

/* A peak is that of a seed whose frequency and amplitude it has to within this: the first in units
 * of the seed's reach. */
static const double ROOM = 1.5, AS_SEEN = 0.05;

/* Longest step of a peak. */
static const double LONGEST_STEP = 0.15;

typedef struct {
  mhb_segment_host    host; /* first: its functions get it back */
  mhb_balance        *balance;
  const mhb_tracking *tracking;
  mhb_truncation     *truncation;
  mhb_events          events;
  mhb_curve_place     start;
  mhb_curve_return    back;
  mhb_response       *store;
  int                 segment;   /* under way */
  int                 direction; /* in which it began */
  double              clock;
  bool                spoilt;      /* a point has too large a truncation error */
  mhb_multipliers     multipliers; /* of the point judged last */
  bool               *stuck;       /* [pairs] at the point accepted last */
} tracer;

/* ---- what segments ask for ---- */

static bool by_multiplier(const mhb_tracking *tracking) {
  return tracking->kind == MHB_TRACK_FLIP || tracking->kind == MHB_TRACK_NEIMARK_SACKER;
}

/* The verdict on a point, t->multipliers. If it takes other sub-steps than the curve so far, the
 * point is corrected with those. The verdict then finds its multiplier on the circle. */
static void judge(tracer *t, mhb_curve_point *point) {
  mhb_arclength *curve = t->host.curve;
  const int      n     = curve->n;
  double         fixed[n + 1], normal[n + 1], x[n], value = point->value;
  bool           finer, at_end = value == curve->low || value == curve->high;
  memset(fixed, 0, sizeof fixed);
  fixed[n]                  = curve->parameter_scale;
  const double discriminant = mhb_peak_system_report(curve->system, point).multiplier.discriminant;
  mhb_peak_system_judge(curve->system, point, &t->multipliers, &finer);
  if (discriminant > -MEETING) return; /* the place where a pair meets is located already */
  for (int tries = 0; finer && tries < MOST_REFINEMENTS; tries++) {
    mhb_peak_system_adapt(curve->system);
    memcpy(normal, at_end ? fixed : point->tangent, sizeof normal);
    memcpy(x, point->x, sizeof x);
    bool moved = mhb_arclength_correct(curve, normal, 1, point);
    if (!moved) { /* it stays where it was */
      memcpy(point->x, x, sizeof x);
      mhb_arclength_measure(curve, point);
    }
    if (!moved || at_end) point->value = value;
    if (moved && !mhb_arclength_set_tangent(curve, point->tangent, point)) return;
    mhb_peak_system_judge(curve->system, point, &t->multipliers, &finer);
  }
}

static void estimate_event(mhb_segment_host *host, mhb_curve_point *point) {
  tracer *t = (tracer *)host;
  if (by_multiplier(t->tracking)) judge(t, point);
  mhb_balance_use(t->balance, point->evaluation);
  point->truncation      = mhb_truncation_error(t->truncation, point->x);
  point->truncation_kind = (int)t->truncation->kind;
}

static shb_status estimate(mhb_segment_host *host, mhb_curve_point *point, bool *raised) {
  estimate_event(host, point);
  *raised = false;
  return SHB_OK;
}

/* t->stuck <- the pairs that stick throughout. Returns whether all pairs do, but for open ones. */
static bool note_stuck(tracer *t) {
  const mhb_balance *b    = t->balance;
  int                some = 0, others = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    const mhb_pair_kind kind = b->eval->kind[a];
    t->stuck[a]              = kind == MHB_PAIR_STUCK || kind == MHB_PAIR_AT_LIMIT;
    some += t->stuck[a];
    others += kind == MHB_PAIR_NONLINEAR;
  }
  return some > 0 && others == 0;
}

static shb_status accept(mhb_segment_host *host, bool *moved) {
  tracer *t = (tracer *)host;
  if (by_multiplier(t->tracking))
    mhb_peak_system_accept(host->curve->system, &host->curve->current);
  mhb_balance_use(t->balance, host->curve->current.evaluation);
  note_stuck(t);
  *moved = false;
  return SHB_OK;
}

static shb_status started(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end) {
  tracer *t = (tracer *)host;
  (void)seed;
  /* Without slip the peak is that of mhb_trace_corner. Here it would go on beyond the onset of
   * slip, along the hair of stuck solutions. */
  mhb_balance_use(t->balance, host->curve->current.evaluation);
  const bool all_stick = note_stuck(t);
  if (t->tracking->kind == MHB_TRACK_PEAK && all_stick) *end = MHB_END_NO_START;
  if (by_multiplier(t->tracking) && *end == MHB_END_NONE)
    mhb_peak_system_accept(host->curve->system, &host->curve->current);
  if (*end != MHB_END_NONE) return SHB_OK;
  mhb_curve_place_free(&t->start);
  t->back = (mhb_curve_return){&t->start, 0};
  mhb_curve_place_note(&t->start, host->curve->system, &host->curve->current, 1e-6);
  return SHB_OK;
}

/* A point where no other multiplier is outside is the border of the stable motions. */
static void record_multiplier(tracer *t, mhb_curve_point *point) {
  mhb_branch *branch   = &t->store->branch[t->segment];
  const int   last     = branch->n_points - 1;
  const bool  known    = t->multipliers.verdict != MHB_UNDECIDED;
  branch->stable[last] = known ? t->multipliers.verdict != MHB_UNSTABLE : -1;
  branch->multiplier[last] =
      mhb_peak_system_report(t->host.curve->system, point).multiplier.multiplier;
}

static shb_status record(mhb_segment_host *host, mhb_curve_point *point, int special, bool *go_on) {
  tracer *t   = (tracer *)host;
  double  now = shb_seconds();
  mhb_balance_use(t->balance, point->evaluation);
  mhb_balance_set_parameter(t->balance, t->tracking->parameter);
  mhb_record(t->store, t->segment, t->balance, point, special, now - t->clock);
  if (by_multiplier(t->tracking)) record_multiplier(t, point);
  t->clock = now;
  /* the whole curve is followed again with more harmonics */
  const double most = t->tracking->tolerance;
  t->spoilt         = t->spoilt || (most > 0 && point->truncation > most);
  *go_on            = !t->spoilt && !shb_interrupted();
  return SHB_OK;
}

/* ---- the table of events ---- */

static double beyond_frequency(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const mhb_tracking *tracking = context;
  double              omega    = mhb_peak_system_omega(curve->system, point->x);
  return fmax(tracking->frequency[0] - omega, omega - tracking->frequency[1]);
}

/* The curve has turned in the parameter: where the turn could not be located. */
static double turned(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  return -*(const int *)context * point->tangent[curve->n];
}

static double too_little_slip(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return LEAST_SLIP - mhb_peak_system_report(curve->system, point).slip_share;
}

/* A pair that stuck at the point accepted last begins to slip: the largest h of those, relative to
 * the friction limit. */
static double slip_begins(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const tracer      *t    = context;
  const mhb_balance *b    = t->balance;
  double             most = -1;
  (void)curve;
  mhb_balance_use(t->balance, point->evaluation);
  for (int a = 0; a < b->n_pairs; a++) {
    mhb_slip_onset at;
    if (!t->stuck[a]) continue;
    mhb_slip_onset_find(&b->law[a], b->m, point->x + (size_t)a * 3 * (size_t)b->nb, &at);
    if (at.limit > 0) most = fmax(most, at.h / at.limit);
  }
  return most;
}

/* Extremum of the amplitude along the peaks; of the frequency along folds. */
static double amplitude_slope(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return mhb_peak_system_report(curve->system, point).by_value;
}

/* Extremum of the frequency along flips and Neimark-Sacker points. */
static double frequency_slope(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return point->tangent[curve->n - 1];
}

/* A pair meets on the real axis: its discriminant becomes positive. By the side it meets on. */
static double meets(mhb_arclength *curve, const mhb_curve_point *point, int side) {
  mhb_multiplier_place at = mhb_peak_system_report(curve->system, point).multiplier;
  return side * creal(at.lambda) > 0 ? at.discriminant : -1;
}

static double meets_at_plus(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return meets(curve, point, 1);
}

static double meets_at_minus(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  (void)context;
  return meets(curve, point, -1);
}

enum { MOST_TESTS = 12 };

static int make_tests(tracer *t, mhb_event_test test[MOST_TESTS]) {
  int  n    = 0;
  bool peak = t->tracking->kind == MHB_TRACK_PEAK;
  if (!peak)
    test[n++] = (mhb_event_test){.name      = "closed curve",
                                 .g         = mhb_curve_return_ahead,
                                 .context   = &t->back,
                                 .direction = 1,
                                 .is_near   = mhb_curve_return_is_near,
                                 .accept    = mhb_curve_return_arrived,
                                 .end       = MHB_END_CLOSED};
  if (peak)
    test[n++] = (mhb_event_test){.name    = "inflection",
                                 .g       = mhb_fold_test,
                                 .exact   = AT_INFLECTION,
                                 .special = MHB_FOLD,
                                 .end     = MHB_END_TURNED};
  if (peak)
    test[n++] = (mhb_event_test){.name      = "inflection, not located",
                                 .g         = turned,
                                 .context   = &t->direction,
                                 .direction = 1,
                                 .at_next   = true,
                                 .end       = MHB_END_TURNED};
  if (t->tracking->kind == MHB_TRACK_NEIMARK_SACKER) {
    test[n++] = (mhb_event_test){
        .name = "pair meets at +1", .g = meets_at_plus, .direction = 1, .end = MHB_END_MEETS_PLUS};
    test[n++] = (mhb_event_test){.name      = "pair meets at -1",
                                 .g         = meets_at_minus,
                                 .direction = 1,
                                 .end       = MHB_END_MEETS_MINUS};
  }
  test[n++] = (mhb_event_test){
      .name = "corner", .g = too_little_slip, .direction = 1, .end = MHB_END_CORNER};
  if (peak)
    test[n++] = (mhb_event_test){.name      = "a pair begins to slip",
                                 .g         = slip_begins,
                                 .context   = t,
                                 .direction = 1,
                                 .end       = MHB_END_CORNER};
  test[n++] = (mhb_event_test){.name      = "end of the frequency range",
                               .g         = beyond_frequency,
                               .context   = (void *)t->tracking,
                               .direction = 1,
                               .end       = MHB_END_FREQUENCY};
  mhb_events_range_ends(test + n);
  n += 2;
  if (!peak) test[n++] = (mhb_event_test){.name = "cusp", .g = mhb_fold_test, .special = MHB_FOLD};
  test[n++] = (mhb_event_test){.name = "optimum",
                               .g = by_multiplier(t->tracking) ? frequency_slope : amplitude_slope,
                               .special = MHB_OPTIMUM};
  return n;
}

/* ---- both halves of a curve ---- */

/* Drop the points of a segment from where the parameter turns; first: the segment's first point. */
static void keep_monotone(tracer *t, int first) {
  mhb_branch *branch = &t->store->branch[t->segment];
  int         n      = first > 0 ? first : 1;
  while (n < branch->n_points && t->direction * (branch->value[n] - branch->value[n - 1]) > 0) n++;
  if (n < branch->n_points) branch->n_points = n;
}

/* Amplitude of the output at a point of the segment. */
static double last_amplitude(const tracer *t, int point) {
  return mhb_response_amplitude(t->store, &t->store->branch[t->segment], point,
                                t->tracking->output);
}

/* The unknowns on the far side of a kink, extrapolated from the last point of the curve and solved
 * at a few distances. False: there is no maximum near, for that one did end. */
static bool beyond_kink(tracer *t, double *z, double *value) {
  mhb_arclength      *curve  = t->host.curve;
  mhb_curve_system   *system = curve->system;
  const mhb_tracking *track  = t->tracking;
  const mhb_branch   *branch = &t->store->branch[t->segment];
  const int           last   = branch->n_points - 1;
  static const double away[] = {3e-4, 1e-3, 3e-3, 1e-2};
  const double        from = branch->value[last], a = last_amplitude(t, last);
  const double        omega = SHB_TWO_PI * branch->frequency[last];
  double              x[t->balance->n];
  if (last < 1) return false;
  double rate = SHB_TWO_PI * (branch->frequency[last] - branch->frequency[last - 1]) /
                (from - branch->value[last - 1]);
  for (size_t i = 0; i < sizeof away / sizeof *away; i++) {
    double to = from + t->direction * away[i] * fmax(fabs(from), 0.01 * (track->high - track->low));
    if (to <= track->low || to >= track->high) return false;
    mhb_recorded_motion(branch, last, t->balance, x);
    mhb_curve_point *point = &curve->trial;
    mhb_peak_system_pack(system, x, omega + rate * (to - from), point->x);
    point->value = to;
    if (system->solve_at_value(system, curve->tolerance, point) != MHB_CONVERGED) continue;
    mhb_peak_report report = mhb_peak_system_report(system, point);
    double          moved  = mhb_peak_system_omega(system, point->x) / omega - 1;
    if (report.curvature >= 0 || report.slip_share < LEAST_SLIP) continue;
    if (fabs(report.amplitude / a - 1) > NEIGHBOUR || fabs(moved) > NEIGHBOUR) continue;
    memcpy(z, point->x, sizeof(double) * ((size_t)t->balance->n + 1));
    *value = to;
    return true;
  }
  return false;
}

/* Whether a curve may go on beyond such an end. */
static bool may_be_kink(const tracer *t, mhb_end end) {
  return t->tracking->kind == MHB_TRACK_PEAK &&
         (end == MHB_END_TURNED || end == MHB_END_STALLED || end == MHB_END_TINY_STEPS);
}

static shb_status trace_half(tracer *t, const double *z, double value, int direction, int *segment,
                             mhb_end *end) {
  mhb_curve_system *curve = t->host.curve->system;
  double            further[t->balance->n + 1];
  mhb_seed          seed = {.kind       = MHB_SEED_SOLUTION,
                            .x          = z,
                            .value      = value,
                            .direction  = direction,
                            .skip_first = false};
  *segment               = mhb_response_branch(t->store, MHB_BRANCH_TRACKED);
  t->segment             = *segment;
  t->direction           = direction;
  t->clock               = shb_seconds();
  t->host.max_points     = t->tracking->max_points;
  if (by_multiplier(t->tracking) &&
      mhb_peak_system_choose(curve, z, mhb_peak_system_omega(curve, z), value) != NULL)
    return SHB_OK;
  bool outside = direction > 0 ? value >= t->tracking->high : value <= t->tracking->low;
  if (outside) *end = direction > 0 ? MHB_END_HIGH : MHB_END_LOW;
  if (outside || t->spoilt) return SHB_OK;
  SHB_TRY(mhb_trace_segment(&t->host, &seed, end));
  if (t->tracking->kind == MHB_TRACK_PEAK) keep_monotone(t, 0);
  for (int kinks = 0; kinks < MOST_KINKS && may_be_kink(t, *end); kinks++) {
    const int n = t->store->branch[*segment].n_points;
    if (!beyond_kink(t, further, &seed.value)) break;
    seed.x = further;
    SHB_TRY(mhb_trace_segment(&t->host, &seed, end));
    keep_monotone(t, n);
  }
  return SHB_OK;
}

void mhb_join_halves(mhb_response *response, int branch, const mhb_response *store, int low,
                     int high) {
  const int below = store->branch[low].n_points, above = store->branch[high].n_points;
  const int first = below > 0 ? 1 : 0;
  if (below > 0) mhb_response_copy_points(response, branch, store, low, below - 1, 0);
  if (above > first) mhb_response_copy_points(response, branch, store, high, first, above - 1);
}

bool mhb_is_seeded(const mhb_tracking_seed *seed, double omega, double amplitude) {
  if (seed->reach == 0) return true;
  return fabs(omega / seed->omega - 1) <= ROOM * seed->reach &&
         fabs(amplitude / seed->amplitude - 1) <= AS_SEEN;
}

/* z <- the peak near a seed. False: there is none. */
static bool settle(tracer *t, const mhb_tracking_seed *seed, double *z) {
  mhb_arclength    *curve  = t->host.curve;
  mhb_curve_system *system = curve->system;
  mhb_curve_point  *point  = &curve->trial;
  mhb_peak_system_pack(system, seed->x, seed->omega, point->x);
  point->value = seed->value;
  if (system->solve_at_value(system, curve->tolerance, point) != MHB_CONVERGED) return false;
  mhb_peak_report report = mhb_peak_system_report(system, point);
  memcpy(z, point->x, sizeof(double) * ((size_t)t->balance->n + 1));
  return report.curvature < 0 &&
         mhb_is_seeded(seed, mhb_peak_system_omega(system, z), report.amplitude);
}

static shb_status trace_both(tracer *t, const mhb_tracking_seed *seed, double *z,
                             mhb_response *response, int branch, bool *found,
                             mhb_tracking_end *end) {
  int down, up;
  mhb_peak_system_pack(t->host.curve->system, seed->x, seed->omega, z);
  if (t->tracking->kind == MHB_TRACK_PEAK && !settle(t, seed, z)) return SHB_OK;
  SHB_TRY(trace_half(t, z, seed->value, -1, &down, &end->low));
  if (end->low == MHB_END_CLOSED) { /* the other way round it is the same curve */
    end->high = MHB_END_CLOSED;
    *found    = true;
    mhb_response_copy_points(response, branch, t->store, down, 0,
                             t->store->branch[down].n_points - 1);
    return SHB_OK;
  }
  SHB_TRY(trace_half(t, z, seed->value, 1, &up, &end->high));
  mhb_join_halves(response, branch, t->store, down, up);
  *found = response->branch[branch].n_points > 0;
  return SHB_OK;
}

static shb_status make_curve(tracer *t, double length) {
  const mhb_tracking *tracking = t->tracking;
  mhb_peak_system    *system;
  SHB_TRY(mhb_truncation_create(t->balance, &t->truncation));
  SHB_TRY(mhb_peak_system_create(t->balance, tracking->kind, tracking->output, tracking->parameter,
                                 tracking->frequency[1] - tracking->frequency[0], length, &system));
  mhb_peak_system_measure(mhb_peak_system_base(system), tracking->size);
  if (tracking->low <= 0)
    mhb_peak_system_passes_zero(mhb_peak_system_base(system),
                                NEAR_ZERO * (tracking->high - tracking->low));
  t->host.curve = mhb_arclength_create(mhb_peak_system_base(system), tracking->low, tracking->high);
  if (tracking->kind == MHB_TRACK_PEAK) {
    t->host.curve->tolerance = SETTLED;
    t->host.curve->longest   = LONGEST_STEP;
  }
  return SHB_OK;
}

shb_status mhb_trace_tracked(mhb_balance *balance, const mhb_tracking *tracking,
                             const mhb_tracking_seed *seed, mhb_response *response, int branch,
                             bool *found, mhb_tracking_end *end) {
  mhb_event_test test[MOST_TESTS];
  tracer         t     = {.balance = balance, .tracking = tracking, .store = NULL};
  double        *z     = shb_alloc_zeroed((size_t)balance->n + 1, sizeof *z);
  *end                 = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  *found               = false;
  t.host               = (mhb_segment_host){.estimate       = estimate,
                                            .estimate_event = estimate_event,
                                            .accept         = accept,
                                            .started        = started,
                                            .record         = record,
                                            .test           = test,
                                            .events         = &t.events};
  t.host.n_tests       = make_tests(&t, test);
  t.store              = mhb_response_like(response);
  t.stuck              = shb_alloc_zeroed((size_t)balance->n_pairs, sizeof *t.stuck);
  t.store->n_harmonics = response->branch[branch].n_harmonics;
  shb_status status    = make_curve(&t, mhb_norm(seed->x, balance->n));
  if (status == SHB_OK) status = trace_both(&t, seed, z, response, branch, found, end);
  mhb_events_destroy(&t.events);
  mhb_curve_place_free(&t.start);
  mhb_arclength_destroy(t.host.curve);
  mhb_truncation_destroy(t.truncation);
  mhb_response_destroy(t.store);
  free(t.stuck);
  free(z);
  return status;
}
