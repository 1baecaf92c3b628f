#include "mhb/continuation/segment.h"

#include <math.h>
#include <string.h>

#include "mhb/continuation/corrector.h"
#include "mhb/response/response.h"

/* A segment whose steps stay below TINY_STEP this often has stalled. */
static const double TINY_STEP = 2e-3;
enum { MAX_TINY_STEPS = 150, MAX_SHORTER = 5 };

/* current <- where the seed starts. *end: MHB_END_NO_START if that is nowhere. */
static void start(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end) {
  mhb_arclength *curve = host->curve;
  int            out   = seed->direction;
  bool           found = false;
  switch (seed->kind) {
    case MHB_SEED_SOLUTION:
      found = mhb_arclength_start(curve, seed->x, seed->value, out) == MHB_CONVERGED;
      break;
    case MHB_SEED_CROSSING:
      found = mhb_arclength_depart(curve, seed->x, seed->value, seed->along) == MHB_CONVERGED;
      break;
    case MHB_SEED_EXCURSION:
      found = mhb_arclength_start(curve, seed->x, seed->value, out) == MHB_CONVERGED;
      if (seed->step > 0) curve->step = seed->step;
      found = found && mhb_arclength_excursion(curve, out, seed->reach);
      if (found) mhb_arclength_advance(curve);
      break;
    case MHB_SEED_UNDER_WAY:
      found = true;
      break;
  }
  *end = found ? MHB_END_NONE : MHB_END_NO_START;
}

/* The crossing itself is the first point of a segment that leaves another curve. */
static shb_status record_crossing(mhb_segment_host *host, const mhb_seed *seed, bool *go_on) {
  mhb_curve_point *crossing = &host->curve->trial;
  memcpy(crossing->x, seed->x, sizeof(double) * (size_t)host->curve->n);
  crossing->value      = seed->value;
  crossing->iterations = 0;
  mhb_arclength_measure(host->curve, crossing);
  host->estimate_event(host, crossing);
  return host->record(host, crossing, MHB_ORDINARY, go_on);
}

/* The first point, at a level that suffices. */
static shb_status begin_segment(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end,
                                bool *go_on) {
  start(host, seed, end);
  if (*end != MHB_END_NONE) return SHB_OK;
  if (host->started) SHB_TRY(host->started(host, seed, end));
  if (*end != MHB_END_NONE) return SHB_OK;
  if (seed->kind == MHB_SEED_CROSSING) SHB_TRY(record_crossing(host, seed, go_on));
  for (bool raised = true; raised;) SHB_TRY(host->estimate(host, &host->curve->current, &raised));
  if (host->out_of_reach) {
    *end = MHB_END_HARMONICS;
    return SHB_OK;
  }
  mhb_events_begin(host->curve, host->n_tests, host->test);
  return seed->skip_first ? SHB_OK : host->record(host, &host->curve->current, MHB_ORDINARY, go_on);
}

/* Predictor and corrector, again from current as long as the harmonics at next do not suffice. */
static shb_status sufficient_step(mhb_segment_host *host, mhb_arclength_outcome *outcome) {
  for (bool raised = true; raised;) {
    *outcome = mhb_arclength_step(host->curve);
    if (*outcome == MHB_ARCLENGTH_STALLED) return SHB_OK;
    SHB_TRY(host->estimate(host, &host->curve->next, &raised));
    if (raised) mhb_events_begin(host->curve, host->n_tests, host->test);
  }
  return SHB_OK;
}

static double step_length(const mhb_arclength *curve) {
  double chord[curve->n + 1];
  for (int i = 0; i < curve->n; i++) chord[i] = curve->next.x[i] - curve->current.x[i];
  chord[curve->n] = curve->next.value - curve->current.value;
  return sqrt(mhb_arclength_inner(curve, mhb_arclength_unit(curve), chord, chord));
}

/* A step and its events; shorter, where it hides a pair of folds. */
static shb_status located_step(mhb_segment_host *host, mhb_end *end) {
  double whole = 0, part = 0;
  for (int shorter = 0; shorter <= MAX_SHORTER + 1; shorter++) {
    mhb_arclength_outcome outcome;
    if (shorter > 0) host->curve->step = shorter <= MAX_SHORTER ? (part *= 0.25) : whole;
    SHB_TRY(sufficient_step(host, &outcome));
    *end = host->out_of_reach ? MHB_END_HARMONICS : MHB_END_STALLED;
    if (host->out_of_reach) return SHB_OK;
    if (outcome == MHB_ARCLENGTH_STALLED) {
      if (shorter == 0 || shorter > MAX_SHORTER) return SHB_OK;
      continue;
    }
    mhb_events_locate(host->curve, host->n_tests, host->test, host->events, end);
    if (*end != MHB_END_NONE && *end != MHB_END_HIGH && *end != MHB_END_LOW)
      host->estimate_event(host, &host->curve->next); /* it has moved */
    if (*end != MHB_END_NONE || !mhb_events_miss_fold(host->curve, host->events)) return SHB_OK;
    if (shorter == 0) whole = part = step_length(host->curve);
  }
  return SHB_OK;
}

/* The same with more harmonics where those of the step do not suffice at an event. */
static shb_status step_with_events(mhb_segment_host *host, mhb_end *end) {
  for (bool raised = true; raised;) {
    SHB_TRY(located_step(host, end));
    raised = false;
    if (*end == MHB_END_STALLED || *end == MHB_END_HARMONICS) return SHB_OK;
    for (int i = 0; i < host->events->n && host->estimate_between && !raised; i++)
      SHB_TRY(host->estimate_between(host, host->events->event[i].point, &raised));
    if (raised) mhb_events_begin(host->curve, host->n_tests, host->test);
  }
  return SHB_OK;
}

/* Record the events of the step, and then next. */
static shb_status record_step(mhb_segment_host *host, bool *go_on) {
  const mhb_events *events = host->events;
  for (int i = 0; i < events->n; i++) {
    if (!host->estimate_between) host->estimate_event(host, events->event[i].point);
    SHB_TRY(host->record(host, events->event[i].point, events->event[i].test->special, go_on));
    host->n_points++;
  }
  int special = events->fold_not_located ? MHB_FOLD : MHB_ORDINARY; /* as near as it is known */
  host->n_points++;
  return host->record(host, &host->curve->next, special, go_on);
}

shb_status mhb_trace_segment(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end) {
  bool go_on = true;
  *end       = MHB_END_NONE;
  if (seed->kind != MHB_SEED_UNDER_WAY) {
    host->n_tiny       = 0;
    host->n_points     = seed->skip_first ? 0 : seed->kind == MHB_SEED_CROSSING ? 2 : 1;
    host->out_of_reach = false;
    SHB_TRY(begin_segment(host, seed, end, &go_on));
  }
  while (*end == MHB_END_NONE && go_on) {
    if (host->n_points >= host->max_points) {
      *end = MHB_END_MAX_POINTS;
      break;
    }
    if (host->before_step) SHB_TRY(host->before_step(host));
    if (host->limit_step) host->limit_step(host);
    SHB_TRY(step_with_events(host, end));
    if (*end == MHB_END_STALLED || *end == MHB_END_HARMONICS) break;
    SHB_TRY(record_step(host, &go_on));
    mhb_arclength_advance(host->curve);
    mhb_events_advance(host->n_tests, host->test);
    host->n_tiny = host->curve->step < TINY_STEP ? host->n_tiny + 1 : 0;
    if (*end == MHB_END_NONE && host->n_tiny > MAX_TINY_STEPS) *end = MHB_END_TINY_STEPS;
    if (*end != MHB_END_NONE) break;
    bool moved; /* also when interrupted: a later run goes on from here */
    SHB_TRY(host->accept(host, &moved));
    if (moved) mhb_events_begin(host->curve, host->n_tests, host->test);
  }
  host->reached = *end;
  if (!go_on) *end = MHB_END_INTERRUPTED;
  return SHB_OK;
}
