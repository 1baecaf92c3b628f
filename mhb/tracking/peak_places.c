#include "mhb/tracking/peak_places.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/base/clock.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/base/root.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"

/* Brackets of q end at these lengths, relative. The second where the end of the peak is known less
 * well. */
static const double EXACT_VALUE = 1e-9, EXACT_END = 1e-6;

/* The amplitude between two points of a branch is linear to within this. */
static const double STRAIGHT = 3e-5;

enum { LEAST_PARTS = 32 };

typedef struct {
  mhb_peak_family *family;
  mhb_truncation  *truncation;
  mhb_curve_point  point; /* x, r and evaluation are in use */
  mhb_response    *store;
  int              segment;
  double           clock;
} tracer;

mhb_peak_place mhb_peak_place_at(const mhb_peak_place *from, double value) {
  mhb_peak_place to = *from;
  to.value          = value;
  to.omega += from->rate * (value - from->value);
  return to;
}

/* Append a place, if it balances. */
static shb_status record(tracer *t, const mhb_peak_place *at, int special, bool *balanced) {
  mhb_balance *b   = t->family->balance;
  double       now = shb_seconds();
  *balanced        = t->family->balance_at(t->family, at, &t->point);
  if (!*balanced) return SHB_OK;
  t->point.truncation      = mhb_truncation_error(t->truncation, t->point.x);
  t->point.truncation_kind = (int)t->truncation->kind;
  mhb_balance_set_parameter(b, t->family->tracking->parameter);
  mhb_record(t->store, t->segment, b, &t->point, special, now - t->clock);
  t->clock = now;
  return SHB_OK;
}

/* The last value at which there is a peak, between one with and one without: a root where the
 * margin is known, else by bisection. Places near by are predicted better.
 *   *ended  out  false: from there the peak is found at the value without, too */
static mhb_peak_place last_peak(tracer *t, mhb_peak_place with, const mhb_peak_place *beyond,
                                mhb_end *why, bool *ended) {
  double   without = beyond->value, exact = fmax(fabs(with.value), fabs(without));
  mhb_end  reason;
  shb_root root;
  bool     known =
      with.margin > 0 && beyond->margin < 0 &&
      shb_root_start(&root, with.value, with.margin, without, beyond->margin, EXACT_VALUE * exact);
  while (fabs(without - with.value) > (known ? EXACT_VALUE : EXACT_END) * exact) {
    mhb_peak_place middle =
        mhb_peak_place_at(&with, known ? shb_root_next(&root) : 0.5 * (with.value + without));
    const bool peak = t->family->is_peak(t->family, &middle, &reason);
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
  mhb_peak_place again = mhb_peak_place_at(&with, beyond->value);
  *ended               = known || !t->family->is_peak(t->family, &again, &reason);
  return *ended ? with : again;
}

/* Where the amplitude is stationary between two places. */
static shb_status record_optimum(tracer *t, const mhb_peak_place *from, const mhb_peak_place *to,
                                 bool *balanced) {
  shb_root       root;
  mhb_peak_place at = *from;
  mhb_end        unused;
  double         exact = EXACT_VALUE * fmax(fabs(from->value), fabs(to->value));
  if (from->slope * to->slope >= 0) return SHB_OK;
  if (!shb_root_start(&root, from->value, from->slope, to->value, to->slope, exact)) return SHB_OK;
  while (!shb_root_done(&root)) {
    at = mhb_peak_place_at(from, shb_root_next(&root));
    if (t->family->is_peak(t->family, &at, &unused))
      shb_root_found(&root, at.value, at.slope);
    else if (!shb_root_failed(&root))
      return SHB_OK;
  }
  return record(t, &at, MHB_OPTIMUM, balanced);
}

/* From a place to the end of the range in a direction. The first place is recorded. */
static shb_status trace_half(tracer *t, mhb_peak_place from, int direction, mhb_end *end) {
  const mhb_tracking *tracking = t->family->tracking;
  double              range = tracking->high - tracking->low, step = range / (2 * LEAST_PARTS);
  double              edge = direction > 0 ? tracking->high : tracking->low;
  bool                balanced;
  t->segment = mhb_response_branch(t->store, MHB_BRANCH_TRACKED);
  SHB_TRY(record(t, &from, MHB_ORDINARY, &balanced));
  *end = balanced ? MHB_END_NONE : MHB_END_NO_START;
  while (*end == MHB_END_NONE) {
    mhb_end why;
    step = fmin(step, fmin(range / LEAST_PARTS, fmax(0.15 * fabs(from.value), 1e-3 * range)));
    bool           last = step >= direction * (edge - from.value);
    mhb_peak_place to   = mhb_peak_place_at(&from, last ? edge : from.value + direction * step);
    if (from.value == edge || shb_interrupted()) {
      *end = from.value != edge ? MHB_END_INTERRUPTED : direction > 0 ? MHB_END_HIGH : MHB_END_LOW;
      break;
    }
    bool   peak = t->family->is_peak(t->family, &to, &why);
    double bent = fabs(to.slope - from.slope) * fabs(to.value - from.value) / 8;
    if (peak && bent > STRAIGHT * to.amplitude && step > 1e-4 * range) {
      step = 0.5 * fabs(to.value - from.value);
      continue;
    }
    bool ended = false;
    if (!peak) {
      const mhb_peak_place beyond = to;
      to                          = last_peak(t, from, &beyond, &why, &ended);
    }
    SHB_TRY(record_optimum(t, &from, &to, &balanced));
    if (to.value != from.value) SHB_TRY(record(t, &to, MHB_ORDINARY, &balanced));
    if (ended) *end = why;
    if (!balanced) *end = MHB_END_STALLED;
    if (t->store->branch[t->segment].n_points >= tracking->max_points) *end = MHB_END_MAX_POINTS;
    if (bent < 0.25 * STRAIGHT * to.amplitude) step *= 2;
    from = to;
  }
  return SHB_OK;
}

static shb_status trace_both(tracer *t, const mhb_peak_place *first, mhb_response *response,
                             int branch, bool *found, mhb_tracking_end *end) {
  SHB_TRY(trace_half(t, *first, -1, &end->low));
  int down = t->segment;
  SHB_TRY(trace_half(t, *first, 1, &end->high));
  *found = t->store->branch[down].n_points > 0;
  if (*found) mhb_join_halves(response, branch, t->store, down, t->segment);
  return SHB_OK;
}

static shb_status make(tracer *t, const mhb_response *response, int branch) {
  size_t n              = (size_t)t->family->balance->n;
  t->point.x            = shb_alloc_zeroed(n, sizeof(double));
  t->point.r            = shb_alloc_zeroed(n, sizeof(double));
  t->store              = mhb_response_like(response);
  t->store->n_harmonics = response->branch[branch].n_harmonics;
  SHB_TRY(mhb_truncation_create(t->family->balance, &t->truncation));
  t->point.evaluation = mhb_evaluation_create(t->family->balance);
  return SHB_OK;
}

shb_status mhb_trace_peak_places(mhb_peak_family *family, const mhb_peak_place *first,
                                 mhb_response *response, int branch, bool *found,
                                 mhb_tracking_end *end) {
  tracer t          = {.family = family, .clock = shb_seconds()};
  *found            = false;
  *end              = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  shb_status status = make(&t, response, branch);
  if (status == SHB_OK) {
    mhb_balance_use(family->balance, t.point.evaluation);
    status = trace_both(&t, first, response, branch, found, end);
    mhb_balance_use(family->balance, NULL);
  }
  mhb_evaluation_destroy(t.point.evaluation);
  mhb_truncation_destroy(t.truncation);
  mhb_response_destroy(t.store);
  free(t.point.r);
  free(t.point.x);
  return status;
}
