#include "mhb/tracking/corner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/progress.h"
#include "mesh/base/root.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"
#include "mhb/tracking/corner_point.h"

/* Brackets of q end at these lengths, relative. The second where the slipping side, known less
 * well, ends the peak. */
static const double EXACT_VALUE = 1e-9, EXACT_END = 1e-6;

/* A seed may be near a corner of a pair whose h is this part of its friction limit at most. */
static const double CANDIDATE = 0.4;

/* The slipping side is judged at the first of these distances from the corner, relative, at which
 * Newton's method converges to SETTLED. There the amplitude differs from that of the corner by no
 * more than NEIGHBOUR, or it is another solution. */
enum { N_BESIDE = 4 };
static const double BESIDE[N_BESIDE] = {1e-5, 1e-4, 3e-4, 1e-3}, SETTLED = 1e-8, NEIGHBOUR = 1e-2;

/* The amplitude between two points of a branch is linear to within this. */
static const double STRAIGHT = 3e-5;

/* A point whose residual is larger is none: more than two discs touch. At a corner the residual is
 * of the order of the root of round-off, for two circles touch. The means of a stuck motion
 * are iterated to SETTLED_MEANS. */
static const double BALANCED = 1e-5, SETTLED_MEANS = 1e-12;

enum { LEAST_PARTS = 32 };

/* ---- along the parameter ---- */

typedef struct {
  mhb_corner     *at;
  mhb_truncation *truncation;
  mhb_curve_point point; /* x, r and evaluation are in use */
  mhb_response   *store;
  int             segment, sense;
  double          clock;
} tracer;

typedef struct {
  double value, omega, amplitude, slope; /* slope: dA/dq along the curve */
  double peak;   /* rad/s: omega, or where the stuck motions that overhang a corner end */
  double rate;   /* domega/dq, 0 of a stuck peak */
  double margin; /* it is 0 where the peak moves to the other side of the corner, and < 0 beyond;
                  * NAN: not known */
} place;

/* Amplitude of the output at a motion that was evaluated last. */
static double output_of(tracer *t, const double *x) {
  mhb_corner   *c = t->at;
  mhb_amplitude a = {.by_x = c->by_x, .weight = c->weight, .size = c->tracking->size};
  mhb_output_amplitude(c->balance, x, c->tracking->output, &a);
  return a.amplitude;
}

/* Amplitude of the slipping side beside a corner, or NAN. The nearest distance at which Newton's
 * method finds it, with every pair's own law. The corner's motion stays. */
static double slipping_side(tracer *t, const place *at) {
  mhb_corner  *c = t->at;
  mhb_balance *b = c->balance;
  double       start[b->n];
  memcpy(start, c->x, sizeof start);
  for (int i = 0; i < N_BESIDE; i++) {
    const double omega = at->omega * (1 + t->sense * BESIDE[i]);
    int          iterations;
    /* the touching motion itself does not slip, this one does */
    mhb_corner_evaluate(c, omega, at->value);
    memcpy(t->point.x, c->x, sizeof start);
    memcpy(c->x, start, sizeof start);
    mhb_reason   reason = mhb_newton_solve(c->newton, b, omega, SETTLED, t->point.x, &iterations);
    const double a      = output_of(t, t->point.x);
    if (reason == MHB_CONVERGED && fabs(a - at->amplitude) <= NEIGHBOUR * at->amplitude) return a;
  }
  return NAN;
}

/* Whether there is a peak at a value near at->omega; fills the place.
 *   why  out  what it is instead */
static bool is_peak(tracer *t, place *at, mhb_end *why) {
  mhb_corner         *c        = t->at;
  const mhb_tracking *tracking = c->tracking;
  *why                         = MHB_END_TURNED;
  at->margin                   = NAN;
  if (!mhb_corner_solve(c, at->value, t->sense, &at->omega)) return false;
  const mhb_corner_state s = mhb_corner_linearise(c, at->omega, at->value);
  if (!isfinite(s.by_value)) return false;
  at->amplitude = s.amplitude;
  at->rate      = c->stuck ? 0 : -s.onset_by_value / s.onset_by_omega;
  at->slope     = c->stuck ? s.by_value : s.by_value + s.by_omega * at->rate;
  /* n0 and mu do not reach a stuck motion: what remains is round-off */
  if (fabs(at->slope) * (tracking->high - tracking->low) < 1e-9 * at->amplitude) at->slope = 0;
  *why = MHB_END_FREQUENCY;
  if (at->omega < tracking->frequency[0] || at->omega > tracking->frequency[1]) return false;
  *why       = MHB_END_CORNER;
  at->peak   = at->omega;
  at->margin = c->stuck ? -s.onset : s.by_omega * copysign(1, s.onset_by_omega);
  if (at->margin <= 0) return false; /* it slips; the amplitude rises into the stuck side */
  if (c->stuck) return true;
  *why = MHB_END_TURNED;
  if (!(slipping_side(t, at) < at->amplitude)) return false;
  if (mhb_corner_overhangs(c, at->omega, at->value, t->sense, t->point.x, &at->peak))
    at->amplitude = output_of(t, t->point.x);
  else
    at->peak = at->omega;
  return true;
}

static void linearise(tracer *t, const place *at) {
  mhb_balance *b = t->at->balance;
  mhb_balance_linearise(b, t->point.x, at->peak, t->point.r, NULL);
  t->point.residual = mhb_norm(t->point.r, b->n) / mhb_balance_vibration(b, t->point.x);
}

/* x of the point <- the motion at a place; r and the evaluation follow, with every pair's own law.
 * Off the corner the mean friction is the least admissible one, and Newton's method finds the
 * means. */
static bool balance_at(tracer *t, const place *at) {
  mhb_corner  *c = t->at;
  mhb_balance *b = c->balance;
  mhb_corner_evaluate(c, at->omega, at->value);
  double unused;
  if (at->peak == at->omega ||
      !mhb_corner_overhangs(c, at->omega, at->value, t->sense, t->point.x, &unused))
    memcpy(t->point.x, c->x, sizeof(double) * (size_t)b->n);
  t->point.value = at->value;
  linearise(t, at);
  t->point.iterations = 0;
  if (c->stuck && t->point.residual > SETTLED_MEANS) {
    mhb_newton_solve(c->newton, b, at->peak, SETTLED_MEANS, t->point.x, &t->point.iterations);
    linearise(t, at);
  }
  return t->point.residual <= BALANCED;
}

/* Append a place. *balanced false: more than two discs touch, or the pair slips. */
static shb_status record(tracer *t, const place *at, int special, bool *balanced) {
  mhb_balance *b   = t->at->balance;
  double       now = shb_seconds();
  *balanced        = balance_at(t, at);
  if (!*balanced) return SHB_OK;
  t->point.truncation      = mhb_truncation_error(t->truncation, t->point.x);
  t->point.truncation_kind = (int)t->truncation->kind;
  mhb_balance_set_parameter(b, t->at->tracking->parameter);
  SHB_TRY(mhb_record(t->store, t->segment, b, &t->point, special, now - t->clock));
  t->clock = now;
  return SHB_OK;
}

static place predicted(const place *from, double value) {
  place to = *from;
  to.value = value;
  to.omega += from->rate * (value - from->value);
  return to;
}

/* The last value at which there is a peak, between one with and one without: a root where the
 * margin is known, else by bisection. */
static place last_peak(tracer *t, place with, const place *beyond, mhb_end *why) {
  double   without = beyond->value, exact = fmax(fabs(with.value), fabs(without));
  mhb_end  reason;
  shb_root root;
  bool     known =
      with.margin > 0 && beyond->margin < 0 &&
      shb_root_start(&root, with.value, with.margin, without, beyond->margin, EXACT_VALUE * exact);
  while (fabs(without - with.value) > (known ? EXACT_VALUE : EXACT_END) * exact) {
    place middle    = predicted(&with, known ? shb_root_next(&root) : 0.5 * (with.value + without));
    const bool peak = is_peak(t, &middle, &reason);
    known           = known && peak == (middle.margin > 0) && middle.margin != 0;
    if (known) shb_root_found(&root, middle.value, middle.margin);
    if (peak) {
      with = middle;
    } else {
      without = middle.value;
      *why    = reason;
    }
    if (known && shb_root_done(&root)) break;
  }
  return with;
}

/* Where the amplitude is stationary between two places. */
static shb_status record_optimum(tracer *t, const place *from, const place *to, bool *balanced) {
  shb_root root;
  place    at = *from;
  mhb_end  unused;
  double   exact = EXACT_VALUE * fmax(fabs(from->value), fabs(to->value));
  if (from->slope * to->slope >= 0) return SHB_OK;
  if (!shb_root_start(&root, from->value, from->slope, to->value, to->slope, exact)) return SHB_OK;
  while (!shb_root_done(&root)) {
    at = predicted(from, shb_root_next(&root));
    if (is_peak(t, &at, &unused))
      shb_root_found(&root, at.value, at.slope);
    else if (!shb_root_failed(&root))
      return SHB_OK;
  }
  return record(t, &at, MHB_OPTIMUM, balanced);
}

/* From a place to the end of the range in a direction. The first place is recorded. */
static shb_status trace_half(tracer *t, place from, int direction, mhb_end *end) {
  const mhb_tracking *tracking = t->at->tracking;
  double              range = tracking->high - tracking->low, step = range / (2 * LEAST_PARTS);
  double              edge = direction > 0 ? tracking->high : tracking->low;
  bool                balanced;
  SHB_TRY(mhb_response_branch(t->store, MHB_BRANCH_TRACKED, &t->segment));
  SHB_TRY(record(t, &from, MHB_ORDINARY, &balanced));
  *end = balanced ? MHB_END_NONE : MHB_END_NO_START;
  while (*end == MHB_END_NONE) {
    mhb_end why;
    step       = fmin(step, fmin(range / LEAST_PARTS, fmax(0.15 * fabs(from.value), 1e-3 * range)));
    bool  last = step >= direction * (edge - from.value);
    place to   = predicted(&from, last ? edge : from.value + direction * step);
    if (from.value == edge || shb_interrupted()) {
      *end = from.value != edge ? MHB_END_INTERRUPTED : direction > 0 ? MHB_END_HIGH : MHB_END_LOW;
      break;
    }
    bool   peak = is_peak(t, &to, &why);
    double bent = fabs(to.slope - from.slope) * fabs(to.value - from.value) / 8;
    if (peak && bent > STRAIGHT * to.amplitude && step > 1e-4 * range) {
      step = 0.5 * fabs(to.value - from.value);
      continue;
    }
    if (!peak) {
      const place beyond = to;
      to                 = last_peak(t, from, &beyond, &why);
    }
    SHB_TRY(record_optimum(t, &from, &to, &balanced));
    if (to.value != from.value) SHB_TRY(record(t, &to, MHB_ORDINARY, &balanced));
    if (!peak) *end = why;
    if (!balanced) *end = MHB_END_STALLED;
    if (t->store->branch[t->segment].n_points >= tracking->max_points) *end = MHB_END_MAX_POINTS;
    if (bent < 0.25 * STRAIGHT * to.amplitude) step *= 2;
    from = to;
  }
  return SHB_OK;
}

/* The seed as a corner of a pair, or (pair < 0) as a stuck peak. */
static bool start_as(tracer *t, const mhb_tracking_seed *seed, int pair, place *at) {
  mhb_end unused;
  *at = (place){.value = seed->value, .omega = seed->omega};
  mhb_corner_take(t->at, pair, seed->value, seed->x);
  t->sense = pair < 0 ? -1 : 0;
  if (!mhb_corner_solve(t->at, at->value, t->sense, &at->omega)) return false;
  const mhb_corner_state s = mhb_corner_linearise(t->at, at->omega, at->value);
  if (pair >= 0) t->sense = s.onset_by_omega > 0 ? 1 : -1;
  return is_peak(t, at, &unused) && mhb_is_seeded(seed, at->omega, at->amplitude);
}

/* The seed as a corner of one of the pairs near their limit, or else as a stuck peak. */
static bool start(tracer *t, const mhb_tracking_seed *seed, place *at) {
  const int    n_pairs = t->at->balance->n_pairs;
  int          pair[n_pairs];
  const double share = n_pairs == 1 ? INFINITY : CANDIDATE;
  const int    n     = mhb_corner_candidates(t->at, seed->value, seed->x, share, pair);
  for (int i = 0; i < n; i++)
    if (start_as(t, seed, pair[i], at)) return true;
  return start_as(t, seed, -1, at);
}

static shb_status trace_both(tracer *t, const place *at, mhb_response *response, int branch,
                             bool *found, mhb_tracking_end *end) {
  SHB_TRY(trace_half(t, *at, -1, &end->low));
  int down = t->segment;
  SHB_TRY(trace_half(t, *at, 1, &end->high));
  *found = t->store->branch[down].n_points > 0;
  return *found ? mhb_join_halves(response, branch, t->store, down, t->segment) : SHB_OK;
}

static shb_status make(tracer *t, const mhb_response *response, int branch) {
  size_t n   = (size_t)t->at->balance->n;
  t->point.x = calloc(n, sizeof(double));
  t->point.r = calloc(n, sizeof(double));
  t->store   = mhb_response_like(response);
  SHB_CHECK(t->point.x && t->point.r && t->store, SHB_ERR_IO, "out of memory");
  t->store->n_harmonics = response->branch[branch].n_harmonics;
  SHB_TRY(mhb_truncation_create(t->at->balance, &t->truncation));
  return mhb_evaluation_create(t->at->balance, &t->point.evaluation);
}

shb_status mhb_trace_corner(mhb_balance *balance, const mhb_tracking *tracking,
                            const mhb_tracking_seed *seed, mhb_response *response, int branch,
                            bool *found, mhb_tracking_end *end) {
  tracer t = {0};
  place  at;
  *found = false;
  *end   = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  if (tracking->kind != MHB_TRACK_PEAK) return SHB_OK;
  SHB_TRY(mhb_corner_create(balance, tracking, &t.at));
  shb_status status = make(&t, response, branch);
  if (status == SHB_OK) {
    mhb_balance_use(balance, t.point.evaluation);
    t.clock = shb_seconds();
    if (start(&t, seed, &at)) status = trace_both(&t, &at, response, branch, found, end);
    mhb_balance_use(balance, NULL);
  }
  mhb_evaluation_destroy(t.point.evaluation);
  mhb_truncation_destroy(t.truncation);
  mhb_corner_destroy(t.at);
  mhb_response_destroy(t.store);
  free(t.point.r);
  free(t.point.x);
  return status;
}
