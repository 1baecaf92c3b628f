#include "mhb/branches/main_branch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/branches/branch_completion.h"
#include "mhb/continuation/first_solution.h"

enum { MAX_GAPS = 8, MAX_RETURNS = 8, MAX_DETACHED = 4 };

/* Distance in y of two ends between which there is only a kink that no step passes. */
static const double ACROSS_KINK = 1e-2;

/* The branch under way. */
typedef struct {
  mhb_tracer   *tracer;
  mhb_monitor  *monitor;
  mhb_response *response;
  mhb_chain     chain;     /* the main branch so far */
  int           start;     /* link where the curve under way begins */
  bool          from_high; /* that curve begins at the high end of the range */
  bool          stopped;   /* interrupted, or a higher level is needed */
  int           needed;    /* level of the next attempt; 0: this one will do */
  int           n_gaps;    /* places jumped over, and the first of them */
  char          first_gap[96];
  const char   *other_reason;  /* NULL; or a reason in place of that of the end */
  char          no_start[160]; /* the reason of a first solution that was not found */
  double        sought;        /* value at which one is sought */
  double        n0;            /* N, then */
  int           n_detached;
  mhb_chain     detached[MAX_DETACHED];
  mhb_end       detached_end[MAX_DETACHED];
  double       *x; /* [n] of the highest level: a first solution, a recorded point */
} main_branch;

/* Work of each search beyond a curve that has ended, in that of the first. */
static const double SHARE_BEYOND = 0.25;

static const char NOTHING_BEYOND[] = "no solution found beyond a curve that closes or turns back";

static mhb_arclength *curve_of(const main_branch *m) {
  return mhb_tracer_curve(m->tracer);
}

static int n_points(const main_branch *m) {
  return mhb_chain_points(&m->chain, m->tracer->store);
}

static void note_gap(main_branch *m, const char *why, double value) {
  mhb_parameter parameter = mhb_tracer_balance(m->tracer)->parameter;
  if (m->n_gaps++ == 0)
    snprintf(m->first_gap, sizeof m->first_gap, "%s at %.6g %s", why,
             mhb_parameter_shown(parameter, value), mhb_parameter_unit(parameter));
}

static shb_status trace(main_branch *m, const mhb_segment_plan *plan, int *segment, mhb_end *end) {
  mhb_segment_plan next = *plan;
  next.recorded         = n_points(m);
  SHB_TRY(mhb_tracer_trace(m->tracer, &next, segment, end));
  if (*end == MHB_END_HARMONICS) m->needed = mhb_harmonic_levels_needed(m->tracer->levels);
  if (*end == MHB_END_INTERRUPTED || *end == MHB_END_HARMONICS) m->stopped = true;
  return SHB_OK;
}

static void append(main_branch *m, mhb_link link) {
  mhb_chain_insert(&m->chain, m->chain.n, link);
}

/* A search for a first solution is shown. */
static bool go_on(void *context) {
  main_branch *m     = context;
  const double value = mhb_parameter_shown(m->tracer->levels->parameter, m->sought);
  m->stopped = m->stopped || !m->monitor->searching(m->monitor, MHB_SEEKS_FIRST, m->n0, value, 0);
  return !m->stopped;
}

/* Why there is none. */
static void note_no_start(main_branch *m, int fewer) {
  const mhb_balance *b        = mhb_tracer_balance(m->tracer);
  const double       value    = mhb_parameter_shown(b->parameter, m->sought);
  char               more[64] = "";
  if (fewer > 0)
    snprintf(more, sizeof more, "; %d have one: give mhb.harmonics no more, or auto", fewer);
  snprintf(m->no_start, sizeof m->no_start, "no first solution with %d harmonic%s at %.6g %s%s",
           b->m, b->m == 1 ? "" : "s", value, mhb_parameter_unit(b->parameter), more);
  m->other_reason = m->no_start;
}

/* x <- a solution at a value, by the balance in use, with a share of the work of a search. */
static bool first_solution(main_branch *m, double value, double share) {
  mhb_arclength *curve = curve_of(m);
  mhb_balance   *b     = mhb_tracer_balance(m->tracer);
  mhb_watch      watch = {.go_on = go_on, .context = m, .share = share};
  int            iterations;
  mhb_balance_use(b, NULL);
  m->sought = value;
  m->n0     = b->eval->at.n0;
  if (mhb_first_solution_watched(mhb_balance_curve_of(curve)->newton, b, value, curve->tolerance,
                                 &watch, m->x, &iterations) == MHB_CONVERGED)
    return true;
  if (shb_interrupted()) m->stopped = true;
  if (n_points(m) == 0 && !m->other_reason && !m->stopped) note_no_start(m, watch.harmonics);
  return false;
}

/* The links from `from` on do not lead to the high end of the range: they become a branch of their
 * own. */
static shb_status detach(main_branch *m, int from, mhb_end end) {
  mhb_chain *own = &m->detached[m->n_detached];
  for (int i = from; i < m->chain.n; i++) mhb_chain_insert(own, own->n, m->chain.link[i]);
  m->chain.n                       = from;
  m->detached_end[m->n_detached++] = end;
  return SHB_OK;
}

/* The curve has left the range by the low end: follow it outside, and on from where it comes back.
 * *end: MHB_END_LOW if it does not. */
static shb_status trace_from_low_end(main_branch *m, mhb_end *end) {
  int    segment, point;
  double step = curve_of(m)->step;
  mhb_chain_end(&m->chain, m->tracer->store, 1, &segment, &point);
  const mhb_branch *last = &m->tracer->store->branch[segment];
  SHB_TRY(mhb_tracer_recorded(m->tracer, segment, point, m->x));
  mhb_segment_plan plan = {.seed   = {.kind      = MHB_SEED_EXCURSION,
                                      .x         = m->x,
                                      .value     = curve_of(m)->low,
                                      .direction = -1,
                                      .reach     = MHB_EXCURSION_FAR,
                                      .step      = step},
                           .m      = last->harmonics[point],
                           .closes = true,
                           .known  = true};
  SHB_TRY(trace(m, &plan, &segment, end));
  if (*end == MHB_END_NO_START)
    *end = MHB_END_LOW;
  else
    append(m, (mhb_link){.segment = segment});
  return SHB_OK;
}

/* Trace upwards from x; the curve that leaves by the low end goes on where it comes back. */
static shb_status trace_upwards(main_branch *m, double value, int harmonics, bool joins,
                                mhb_end *end) {
  int              segment;
  mhb_segment_plan plan = {.seed = {.x = m->x, .value = value, .direction = 1, .skip_first = joins},
                           .m    = harmonics,
                           .closes = true};
  SHB_TRY(trace(m, &plan, &segment, end));
  if (*end == MHB_END_NO_START) return SHB_OK;
  append(m, (mhb_link){.segment = segment, .joins = joins});
  while (*end == MHB_END_LOW) {
    SHB_TRY(trace_from_low_end(m, end));
    if (*end == MHB_END_LOW) break;
  }
  return SHB_OK;
}

/* Trace both ways from x, a solution at a value beyond a curve that has ended. The segment traced
 * downwards may arrive where the main branch was lost. It may also be a curve of its own, or lead
 * to an end of the range.
 *   found  out  the main branch goes on from here
 *   end    out  why it ends again */
static shb_status trace_both_ways(main_branch *m, double value, const mhb_curve_place *lost,
                                  bool *found, mhb_end *end) {
  int              segment, harmonics = mhb_tracer_balance(m->tracer)->m, from = m->chain.n;
  mhb_end          down;
  mhb_segment_plan plan = {.seed   = {.x = m->x, .value = value, .direction = -1},
                           .m      = harmonics,
                           .closes = lost == NULL,
                           .target = lost};
  SHB_TRY(trace(m, &plan, &segment, &down));
  *found = down != MHB_END_NO_START;
  if (!*found || m->stopped) {
    if (*found) append(m, (mhb_link){.segment = segment, .reversed = true});
    *end = MHB_END_INTERRUPTED;
    return SHB_OK;
  }
  const mhb_curve_point *last    = &curve_of(m)->current;
  bool                   arrived = lost && (down == MHB_END_CLOSED ||
                          mhb_curve_place_distance(lost, curve_of(m), last) <= ACROSS_KINK);
  m->from_high                   = false;
  if (!lost && down == MHB_END_CLOSED && m->n_detached < MAX_DETACHED) {
    append(m, (mhb_link){.segment = segment});
    *found = false;
    return detach(m, from, down);
  }
  if (lost && !arrived) { /* another curve */
    mhb_tracer_forget(m->tracer, segment);
    m->start = from;
    SHB_TRY(trace_upwards(m, value, harmonics, false, end));
    *found = *end != MHB_END_NO_START;
    return SHB_OK;
  }
  mhb_link link = {.segment = segment, .reversed = true};
  if (lost) { /* it is the same curve, and the last point may be there already */
    m->n_gaps--;
    link.joins = true;
    link.drop  = down == MHB_END_CLOSED;
  } else {
    bool leaves = down == MHB_END_LOW || down == MHB_END_HIGH;
    if (!leaves) note_gap(m, mhb_end_text(down), last->value);
    m->start     = from;
    m->from_high = down == MHB_END_HIGH;
  }
  append(m, link);
  SHB_TRY(trace_upwards(m, value, harmonics, true, end));
  *found = *end != MHB_END_NO_START;
  return SHB_OK;
}

/* The curve ended before the high end of the range. Search for the main branch beyond it. *over:
 * the branch has ended, for the reason *end. */
static shb_status go_beyond(main_branch *m, mhb_end *end, bool *over) {
  static const double further[] = {1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.2, 0.4, 0.7};
  mhb_arclength      *curve     = curve_of(m);
  double              span = curve->high - curve->low, high = curve->high;
  mhb_curve_place     lost  = {0};
  bool                found = false, passed = *end == MHB_END_CLOSED || *end == MHB_END_LOW;
  mhb_end             why = *end;
  *over                   = true;
  if (*end == MHB_END_LOW && m->from_high) { /* from end to end, the other way */
    mhb_chain_reverse(&m->chain, m->start);
    *end = MHB_END_HIGH;
    return SHB_OK;
  }
  if (passed && m->n_detached < MAX_DETACHED) {
    SHB_TRY(detach(m, m->start, *end));
  } else if (n_points(m) > 0) {
    note_gap(m, mhb_end_text(*end), curve->current.value);
    if (m->n_gaps > MAX_GAPS) return SHB_OK;
    mhb_curve_place_note(&lost, curve->system, &curve->current, mhb_tracer_same(m->tracer));
    mhb_curve_place_turn(&lost);
  }
  shb_status status = SHB_OK;
  for (int i = 0; i < 8 && !found && !m->stopped && status == SHB_OK && !shb_interrupted(); i++) {
    double value = m->tracer->farthest + further[i] * span;
    if (value >= high) break;
    if (first_solution(m, value, SHARE_BEYOND))
      status = trace_both_ways(m, value, lost.x ? &lost : NULL, &found, end);
  }
  mhb_curve_place_free(&lost);
  *over = !found;
  if (found && m->other_reason == m->no_start) m->other_reason = NULL;
  if (!found) *end = why;
  if (!found && passed) m->other_reason = NOTHING_BEYOND;
  return status;
}

/* From the low end of the range on, piece by piece. *end: why it ended. */
static shb_status trace_across_range(main_branch *m, mhb_end *end) {
  bool over = false;
  *end      = MHB_END_NO_START;
  if (first_solution(m, curve_of(m)->low, 1))
    SHB_TRY(trace_upwards(m, curve_of(m)->low, mhb_tracer_balance(m->tracer)->m, false, end));
  while (!over && !m->stopped) {
    over = *end == MHB_END_HIGH || *end == MHB_END_MAX_POINTS ||
           n_points(m) >= m->tracer->levels->settings->max_points;
    if (!over) SHB_TRY(go_beyond(m, end, &over));
  }
  if (m->stopped) *end = MHB_END_INTERRUPTED;
  return SHB_OK;
}

/* The range is covered. Beyond its ends the curve may turn, and come back as another part of it.
 * end: 1 at the last point of the chain, -1 at the first. */
static shb_status trace_returns(main_branch *m, int end) {
  for (int i = 0; i < MAX_RETURNS && !m->stopped; i++) {
    int     segment, point;
    mhb_end how;
    mhb_chain_end(&m->chain, m->tracer->store, end, &segment, &point);
    SHB_TRY(mhb_tracer_recorded(m->tracer, segment, point, m->x));
    const mhb_arclength *curve     = curve_of(m);
    const mhb_branch    *branch    = &m->tracer->store->branch[segment];
    mhb_parameter        parameter = mhb_tracer_balance(m->tracer)->parameter;
    double               value     = mhb_parameter_value(parameter, branch->value[point]);
    double               slack     = 1e-9 * (curve->high - curve->low);
    bool low = fabs(value - curve->low) <= slack, high = fabs(value - curve->high) <= slack;
    if (!low && !high) break;
    mhb_segment_plan plan = {.seed   = {.kind      = MHB_SEED_EXCURSION,
                                        .x         = m->x,
                                        .value     = low ? curve->low : curve->high,
                                        .direction = low ? -1 : 1,
                                        .reach     = MHB_EXCURSION_NEAR},
                             .m      = branch->harmonics[point],
                             .closes = true};
    SHB_TRY(trace(m, &plan, &segment, &how));
    if (how == MHB_END_NO_START) break;
    mhb_link link = {.segment = segment, .reversed = end < 0};
    mhb_chain_insert(&m->chain, end > 0 ? m->chain.n : 0, link);
    if (how == MHB_END_HIGH || how == MHB_END_LOW || m->stopped) continue;
    if (how != MHB_END_CLOSED) note_gap(m, mhb_end_text(how), curve_of(m)->current.value);
    break;
  }
  return SHB_OK;
}

/* The branch gets what a later run needs to go on with it. */
static void forget_unfinished(main_branch *m) {
  mhb_unfinished_destroy(m->response->branch[0].unfinished);
  m->response->branch[0].unfinished = NULL;
}

static shb_status note_unfinished(main_branch *m) {
  forget_unfinished(m);
  return mhb_tracer_unfinished(m->tracer, &m->response->branch[0].unfinished);
}

/* Publish the curves so far. */
static shb_status publish(void *context) {
  main_branch *m = context;
  int          n_begins, begins[m->chain.n + 2];
  mhb_chain    chain  = {0};
  bool         listed = false;
  if (!m->monitor->is_due(m->monitor, m->response)) return SHB_OK;
  for (int i = 0; i < m->chain.n; i++) {
    mhb_chain_insert(&chain, chain.n, m->chain.link[i]);
    listed = listed || m->chain.link[i].segment == m->tracer->segment;
  }
  if (!listed) mhb_chain_insert(&chain, chain.n, (mhb_link){.segment = m->tracer->segment});
  mhb_chain_join(&chain, m->tracer->store, m->response, 0, begins, &n_begins);
  shb_status status = note_unfinished(m);
  if (status == SHB_OK) status = m->monitor->publish(m->monitor, m->response);
  mhb_chain_free(&chain);
  return status;
}

/* The branches are joined, and their stability is judged. */
static shb_status complete(main_branch *m, mhb_end end, int stable_at) {
  mhb_completion own = {.end          = end,
                        .by_folds     = true,
                        .stable_at    = stable_at,
                        .n_gaps       = m->n_gaps,
                        .first_gap    = m->first_gap,
                        .other_reason = m->other_reason};
  SHB_TRY(mhb_branch_complete(m->tracer, &m->chain, m->response, 0, &own));
  bool covers = m->response->branch[0].complete;
  /* a resumed run traces a complete one no more, nor those beside it: they come first */
  m->response->branch[0].complete = false;
  for (int i = 0; i < m->n_detached; i++) {
    int            index;
    mhb_completion detached = {.end = own.interrupted ? MHB_END_INTERRUPTED : m->detached_end[i]};
    index                   = mhb_response_branch(m->response, MHB_BRANCH_NONLINEAR);
    m->response->branch[index].origin = MHB_FROM_DETACHED;
    m->response->branch[index].main   = 0;
    SHB_TRY(mhb_branch_complete(m->tracer, &m->detached[i], m->response, index, &detached));
    own.interrupted = own.interrupted || detached.interrupted;
  }
  m->response->branch[0].complete = covers && !own.interrupted;
  if (!own.interrupted) forget_unfinished(m);
  return SHB_OK;
}

/* One attempt, with the harmonics of a level or more. *end: why it ended. */
static shb_status attempt(main_branch *m, int *stable_at, mhb_end *end) {
  SHB_TRY(mhb_harmonic_levels_use(m->tracer->levels, m->tracer->levels->least));
  SHB_TRY(trace_across_range(m, end));
  if (*end != MHB_END_HIGH) return SHB_OK;
  SHB_TRY(trace_returns(m, 1));
  const int before = n_points(m);
  SHB_TRY(trace_returns(m, -1));
  *stable_at = n_points(m) - before;
  if (m->stopped) *end = MHB_END_INTERRUPTED;
  return SHB_OK;
}

static void discard(main_branch *m) {
  mhb_tracer_destroy(m->tracer);
  mhb_chain_free(&m->chain);
  for (int i = 0; i < MAX_DETACHED; i++) mhb_chain_free(&m->detached[i]);
  free(m->x);
  *m = (main_branch){.monitor = m->monitor, .response = m->response};
}

static shb_status prepare(main_branch *m, mhb_balance *balance, int least,
                          const mhb_unfinished *earlier) {
  SHB_TRY(mhb_tracer_create(balance, m->response, 0, false, m->monitor, &m->tracer));
  mhb_harmonic_levels *levels = m->tracer->levels;
  m->tracer->levels->least    = least;
  m->tracer->earlier          = earlier;
  m->tracer->publish          = publish;
  m->tracer->context          = m;
  m->x = shb_alloc_zeroed((size_t)mhb_harmonic_levels_most_unknowns(levels), sizeof *m->x);
  return SHB_OK;
}

/* Where an attempt ends without a point the most usual ones are tried. Where those give none either
 * the fewest are taken, however large their estimates are. */
static bool found_nothing(const main_branch *m) {
  return n_points(m) == 0 && m->n_detached == 0 && !m->stopped;
}

/* Attempts, each with more harmonics at least, until none asks for a level that no solution near by
 * has. A curve of few harmonics need not be one of many; no point of it is kept then. */
static shb_status trace_with_enough(main_branch *m, mhb_balance *balance,
                                    const mhb_unfinished *earlier, int *stable_at, mhb_end *end) {
  int  least       = mhb_tracer_least_level(earlier);
  bool accepts_all = false;
  for (bool again = true; again;) {
    *end       = MHB_END_NO_START;
    *stable_at = 0;
    SHB_TRY(prepare(m, balance, least, earlier));
    m->tracer->accepts_all = accepts_all;
    SHB_TRY(attempt(m, stable_at, end));
    const bool nothing = least > 0 && found_nothing(m) && !m->tracer->accepts_all;
    const int  usual   = mhb_harmonic_levels_of(m->tracer->levels, MHB_USUAL_HARMONICS);
    again              = m->needed > least || nothing;
    if (!again) break;
    accepts_all = nothing && least == usual;
    least       = accepts_all ? 0 : nothing ? usual : m->needed;
    earlier     = NULL;
    discard(m);
  }
  return SHB_OK;
}

shb_status mhb_trace_main_branch(mhb_balance *balance, mhb_response *response,
                                 mhb_monitor *monitor) {
  main_branch     m              = {.monitor = monitor, .response = response};
  mhb_end         end            = MHB_END_NO_START;
  int             stable_at      = 0;
  mhb_unfinished *earlier        = response->branch[0].unfinished;
  response->branch[0].unfinished = NULL;
  shb_status status              = trace_with_enough(&m, balance, earlier, &stable_at, &end);
  if (status == SHB_OK) status = note_unfinished(&m);
  if (status == SHB_OK) status = complete(&m, end, stable_at);
  discard(&m);
  mhb_unfinished_destroy(earlier);
  return status;
}
