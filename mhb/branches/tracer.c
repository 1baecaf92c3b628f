#include "mhb/branches/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/balance/subharmonics.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/outputs.h"
#include "mhb/search/ring_symmetry.h"

/* A curve has closed if it comes this near to its start, relative to the motion. */
static const double SAME = 1e-5;

/* A solution is this many times as far from the exact one as its residual is large, at most. Closed
 * curves in outline came back to within 2.2 residuals of their start (100 of the designs of
 * cases/robust_preload). */
static const double MOVED = 20;

/* A recorded point is known if its motion is within so many of the distance above. */
static const double KNOWN = 10;

/* Of the motion: the part of higher order where the curve meets another. */
static const double VANISHED = 2e-3;

/* Of the motion: a part of higher order that is round-off. Its rate has no sign. */
static const double ROUND_OFF = 1e-9;

static mhb_tracer *of(mhb_segment_host *host) {
  return (mhb_tracer *)host;
}

mhb_arclength *mhb_tracer_curve(const mhb_tracer *t) {
  return mhb_harmonic_levels_current(t->levels)->curve;
}

mhb_balance *mhb_tracer_balance(const mhb_tracer *t) {
  return mhb_harmonic_levels_current(t->levels)->balance;
}

double mhb_tracer_same(const mhb_tracer *t) {
  const mhb_arclength *curve = mhb_tracer_curve(t);
  double error = fmax(20 * t->levels->settings->motion_tolerance, MOVED * curve->tolerance);
  return fmax(SAME, error);
}

/* The level in use is the host's. */
static void use_level(mhb_tracer *t) {
  mhb_harmonic_level *level = mhb_harmonic_levels_current(t->levels);
  t->host.curve             = level->curve;
  t->host.events            = &level->events;
}

/* ---- what segments ask for ---- */

/* Where the segment is to end by its motion: at a place, or nowhere. */
static void return_to(mhb_tracer *t, const mhb_curve_place *place) {
  for (int j = 0; j < t->host.curve->system->copies; j++) {
    mhb_curve_return at = {place, j};
    /* the test function of a copy that is the place would begin with a zero of any sign */
    t->returns[j] = place && mhb_curve_return_repeats(&at) ? (mhb_curve_return){NULL, j} : at;
  }
}

/* The curve starts at its current point, and ends where it comes back. */
static shb_status note_start(mhb_tracer *t) {
  mhb_arclength *curve = t->host.curve;
  mhb_curve_place_note(&t->start, curve->system, &curve->current, mhb_tracer_same(t));
  return_to(t, &t->start);
  return SHB_OK;
}

static shb_status estimate(mhb_segment_host *host, mhb_curve_point *point, bool *raised) {
  mhb_tracer *t        = of(host);
  bool        is_start = point == &host->curve->current;
  *raised              = false;
  mhb_harmonic_levels_estimate(t->levels, point);
  if (is_start) mhb_harmonic_levels_accept(t->levels);
  int higher = mhb_harmonic_levels_higher(t->levels);
  if (higher < 0) return SHB_OK;
  SHB_TRY(mhb_harmonic_levels_move(t->levels, higher, is_start, raised));
  use_level(t);
  if (!*raised) mhb_harmonic_levels_settle(t->levels, point);
  host->out_of_reach = !*raised && !t->accepts_all && !mhb_harmonic_levels_all_usual(t->levels) &&
                       !(point->truncation <= t->levels->settings->motion_tolerance);
  return *raised && is_start && t->returns_to_start ? note_start(t) : SHB_OK;
}

static void estimate_event(mhb_segment_host *host, mhb_curve_point *point) {
  mhb_harmonic_levels_errors(of(host)->levels, point);
  mhb_harmonic_levels_settle(of(host)->levels, point);
}

static shb_status estimate_between(mhb_segment_host *host, mhb_curve_point *point, bool *raised) {
  mhb_tracer *t     = of(host);
  const int   level = mhb_harmonic_levels_of_event(t->levels, point);
  *raised           = false;
  if (level < 0) return SHB_OK;
  SHB_TRY(mhb_harmonic_levels_move(t->levels, level, false, raised));
  use_level(t);
  return SHB_OK;
}

static shb_status accept(mhb_segment_host *host, bool *moved) {
  mhb_tracer *t = of(host);
  *moved        = false;
  mhb_harmonic_levels_accept(t->levels);
  int lower = mhb_harmonic_levels_lower(t->levels);
  if (lower < 0) return SHB_OK;
  SHB_TRY(mhb_harmonic_levels_move(t->levels, lower, false, moved));
  use_level(t);
  return SHB_OK;
}

/* Whether the recorded motion at a point is that of the curve's current point. */
static bool is_recorded_at(const mhb_tracer *t, const mhb_branch *branch, int point) {
  const mhb_balance    *b = mhb_tracer_balance(t);
  const double         *x = mhb_tracer_curve(t)->current.x;
  int                   K = branch->n_harmonics + 1, rows = 3 * b->n_pairs;
  const double complex *A    = branch->motion + (size_t)point * (size_t)rows * (size_t)K;
  double                away = 0, size = 0;
  for (int row = 0; row < rows; row++)
    for (int k = 0; k < K || k <= b->m; k++) {
      const double  *a    = x + (size_t)row * (size_t)b->nb;
      double complex here = k > b->m ? 0 : k ? CMPLX(a[2 * k - 1], a[2 * k]) : a[0];
      double complex then = k < K ? A[row * K + k] : 0;
      away += pow(cabs(here - then), 2);
      size += pow(cabs(here), 2);
    }
  return sqrt(away) <= KNOWN * mhb_tracer_same(t) * sqrt(size);
}

/* Whether the curve's current point, on an end of the range, is recorded in some segment. */
static bool is_recorded(const mhb_tracer *t) {
  double value =
      mhb_parameter_shown(mhb_tracer_balance(t)->parameter, mhb_tracer_curve(t)->current.value);
  for (int i = 0; i < t->store->n_branches; i++) {
    const mhb_branch *branch = &t->store->branch[i];
    for (int p = 0; p < branch->n_points; p++)
      if (fabs(branch->value[p] - value) <= 1e-12 * fabs(value) && is_recorded_at(t, branch, p))
        return true;
  }
  return false;
}

/* A curve of waves in a ring has no part beside them but round-off. */
static bool is_beside_wave(const mhb_balance *b, const double *x) {
  if (!mhb_ring_has_waves(b)) return false;
  double part[b->n];
  mhb_ring_beside_wave(b, x, part);
  return mhb_norm(part, b->n) > VANISHED * mhb_norm(x, b->n);
}

/* Decide where the segment ends by its motion. That is at its own start, at a target, at the start
 * of the curve that it continues, or nowhere. */
static shb_status started(mhb_segment_host *host, const mhb_seed *seed, mhb_end *end) {
  mhb_tracer             *t     = of(host);
  const mhb_curve_point  *first = &host->curve->current;
  const mhb_segment_plan *plan  = &t->plan;
  bool                    begins =
      seed->kind == MHB_SEED_SOLUTION || (seed->kind == MHB_SEED_EXCURSION && !plan->known);
  t->returns_to_start = begins && plan->closes && !plan->target;
  if (seed->kind == MHB_SEED_EXCURSION && !plan->known && is_recorded(t)) {
    *end = MHB_END_NO_START;
    return SHB_OK;
  }
  if (begins) SHB_TRY(note_start(t));
  t->is_beside_wave = t->joins && is_beside_wave(mhb_tracer_balance(t), first->x);
  if (seed->kind == MHB_SEED_CROSSING) mhb_curve_place_free(&t->start);
  const mhb_curve_place *place = plan->target ? plan->target : plan->closes ? &t->start : NULL;
  if (place && !place->x) place = NULL;
  return_to(t, place);
  if (seed->kind == MHB_SEED_SOLUTION) t->farthest = fmax(t->farthest, seed->value);
  if (seed->kind == MHB_SEED_EXCURSION && plan->known && place &&
      mhb_curve_place_distance(place, host->curve, first) <= place->tolerance)
    *end = MHB_END_CLOSED;
  return SHB_OK;
}

static shb_status record(mhb_segment_host *host, mhb_curve_point *point, int special, bool *go_on) {
  mhb_tracer *t   = of(host);
  double      now = shb_seconds();
  mhb_record(t->store, t->segment, mhb_tracer_balance(t), point, special, now - t->clock);
  const mhb_branch *branch                    = &t->store->branch[t->segment];
  branch->error_spatial[branch->n_points - 1] = mhb_harmonic_levels_spatial(t->levels, point);
  if (special == MHB_ORDINARY) t->farthest = fmax(t->farthest, point->value);
  if (!t->monitor->point(t->monitor, t->store, t->segment, branch->n_points - 1)) *go_on = false;
  t->clock = shb_seconds();
  return SHB_OK;
}

static shb_status before_step(mhb_segment_host *host) {
  mhb_tracer *t   = of(host);
  t->host.reached = MHB_END_NONE;
  if (!t->publish) return SHB_OK;
  SHB_TRY(t->publish(t->context));
  t->clock = shb_seconds();
  return SHB_OK;
}

/* ---- the table of events ---- */

/* Without a place the curve is ahead of it. */
static double ahead_of_place(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const mhb_curve_return *at = context;
  return at->place ? mhb_curve_return_ahead(curve, point, context) : 1;
}

static double slope_of_output(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  return mhb_output_slope(mhb_curve_balance(curve), point, *(const int *)context);
}

/* Part of a motion x that a motion of higher symmetry does not have. With d < nu, d dividing nu, it
 * does not repeat after d periods. With d = nu it is beside the wave of a ring. */
static void part_of(const mhb_balance *b, const double *x, int d, double *part) {
  if (d < b->receptance->nu)
    mhb_subharmonic_component(b, x, d, part);
  else
    mhb_ring_beside_wave(b, x, part);
}

/* Whether that part may vanish. */
static bool has_part(const mhb_tracer *t, const mhb_balance *b, int d) {
  const int nu = b->receptance->nu;
  return d < nu ? nu % d == 0 : t->is_beside_wave;
}

/* Size |z| of that part, and the rate z.dz/|z| of the size along the tangent. */
static double size_of_part(const mhb_balance *b, const mhb_curve_point *point, int d,
                           double *rate) {
  double z[b->n], dz[b->n];
  part_of(b, point->x, d, z);
  part_of(b, point->tangent, d, dz);
  double size = mhb_norm(z, b->n);
  *rate       = 0;
  for (int i = 0; i < b->n && size > 0; i++) *rate += z[i] * dz[i] / size;
  return size;
}

/* Where such a part vanishes the curve meets one of higher symmetry, or its own copy. The test
 * function is VANISHED less the smallest part that falls or is 0, relative to the motion. */
static double vanished(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  const mhb_tracer  *t    = context;
  const mhb_balance *b    = mhb_curve_balance(curve);
  double             size = mhb_norm(point->x, b->n), most = -1;
  for (int d = 1; d <= b->receptance->nu; d++) {
    if (!has_part(t, b, d)) continue;
    double rate, part = size_of_part(b, point, d, &rate);
    if (rate < 0 || part <= ROUND_OFF * size) most = fmax(most, VANISHED - part / size);
  }
  return most;
}

/* Keep the step short of the place where a part vanishes. */
static void limit_step(mhb_segment_host *host) {
  const mhb_balance     *b     = mhb_curve_balance(host->curve);
  const mhb_curve_point *point = &host->curve->current;
  double                 least = ROUND_OFF * mhb_norm(point->x, b->n);
  for (int d = 1; d <= b->receptance->nu; d++) {
    if (!has_part(of(host), b, d)) continue;
    double rate, part = size_of_part(b, point, d, &rate);
    if (rate < 0 && part > least && part / -rate < 2 * host->curve->step)
      host->curve->step = 0.5 * part / -rate;
  }
}

static void make_tests(mhb_tracer *t, const mhb_balance *b) {
  int copies = mhb_motion_copies(b), n = 0;
  int outputs          = b->settings->outline ? 0 : mhb_outputs(b);
  t->returns           = shb_alloc_zeroed((size_t)copies, sizeof *t->returns);
  t->output            = shb_alloc_zeroed((size_t)outputs, sizeof *t->output);
  t->host.test         = shb_alloc_zeroed((size_t)(copies + outputs) + 4, sizeof *t->host.test);
  mhb_event_test *test = t->host.test;
  for (int j = 0; j < copies; j++)
    test[n++] = (mhb_event_test){.name      = "closed curve",
                                 .g         = ahead_of_place,
                                 .context   = &t->returns[j],
                                 .direction = 1,
                                 .is_near   = mhb_curve_return_is_near,
                                 .accept    = mhb_curve_return_arrived,
                                 .end       = MHB_END_CLOSED};
  mhb_events_range_ends(test + n);
  n += 2;
  if (t->joins)
    test[n++] = (mhb_event_test){.name      = "curve of higher symmetry",
                                 .g         = vanished,
                                 .context   = t,
                                 .direction = 1,
                                 .at_next   = true,
                                 .end       = MHB_END_JOINED};
  test[n++] = (mhb_event_test){.name = "fold", .g = mhb_fold_test, .special = MHB_FOLD};
  for (int o = 0; o < outputs; o++) {
    t->output[o] = o;
    test[n++]    = (mhb_event_test){.name      = "peak",
                                    .g         = slope_of_output,
                                    .context   = &t->output[o],
                                    .direction = -1,
                                    .special   = MHB_PEAK};
  }
  t->host.n_tests = n;
}

/* ---- states of segments ---- */

static void pass_place(mhb_trace_state *s, mhb_curve_place *p) {
  enum { MOST = 10000000 };
  int rows = p->rows, length = p->row_length, copies = p->copies;
  mhb_trace_state_code(s, &rows, 0, MOST);
  mhb_trace_state_code(s, &length, 0, MOST);
  mhb_trace_state_code(s, &copies, 0, MOST);
  size_t n = (size_t)rows * (size_t)length * (size_t)copies;
  if (s->reads) {
    mhb_curve_place_free(p);
    if (n > s->n) s->failed = true;
    if (s->failed || n == 0) return;
    *p = (mhb_curve_place){.rows       = rows,
                           .row_length = length,
                           .copies     = copies,
                           .x          = shb_alloc_zeroed(n, sizeof(double)),
                           .tangent    = shb_alloc_zeroed(n, sizeof(double))};
  }
  if (n == 0) return;
  mhb_trace_state_numbers(s, p->x, n);
  mhb_trace_state_numbers(s, p->tangent, n);
  mhb_trace_state_numbers(s, &p->value, 1);
  mhb_trace_state_numbers(s, &p->rate, 1);
  mhb_trace_state_numbers(s, &p->size, 1);
  mhb_trace_state_numbers(s, &p->tolerance, 1);
}

/* What a curve keeps from one segment to the next. */
static void pass_memory(mhb_trace_state *s, mhb_arclength *curve) {
  mhb_resonances *resonances = &mhb_balance_curve_of(curve)->resonances;
  mhb_trace_state_numbers(s, &curve->amplitude_at_rest, 1);
  mhb_trace_state_numbers(s, &curve->parameter_scale, 1);
  for (int i = 0; i < resonances->n; i++) mhb_trace_state_flag(s, &resonances->at[i].significant);
}

static void pass_current(mhb_trace_state *s, mhb_arclength *curve) {
  mhb_curve_point *p = &curve->current;
  mhb_trace_state_numbers(s, &curve->step, 1);
  mhb_trace_state_whole(s, &curve->orientation);
  mhb_trace_state_whole(s, &curve->n_reversed);
  mhb_trace_state_numbers(s, p->x, (size_t)curve->n);
  mhb_trace_state_numbers(s, &p->value, 1);
  mhb_trace_state_numbers(s, p->tangent, (size_t)curve->n + 1);
  mhb_trace_state_whole(s, &p->orientation);
  mhb_trace_state_whole(s, &p->iterations);
  mhb_trace_state_numbers(s, &p->residual, 1);
  mhb_trace_state_numbers(s, &p->truncation, 1);
  mhb_trace_state_numbers(s, &p->truncation_max, 1);
  mhb_trace_state_numbers(s, &p->modal, 1);
  mhb_trace_state_whole(s, &p->truncation_kind);
  mhb_trace_state_numbers(s, &curve->former_step, 1);
  if (curve->former_step > 0)
    mhb_trace_state_numbers(s, curve->former_tangent, (size_t)curve->n + 1);
}

static shb_status pass_levels(mhb_trace_state *s, mhb_harmonic_levels *h) {
  int at = h->at, highest = h->highest;
  mhb_trace_state_code(s, &h->least, 0, h->n - 1);
  for (int i = 0; i < h->n && !s->failed; i++) {
    bool made = h->level[i] != NULL;
    mhb_trace_state_flag(s, &made);
    if (!made || s->failed) continue;
    SHB_TRY(mhb_harmonic_levels_use(h, i)); /* makes it */
    pass_memory(s, h->level[i]->curve);
  }
  mhb_trace_state_code(s, &at, 0, h->n - 1);
  mhb_trace_state_code(s, &highest, 0, h->n - 1);
  mhb_trace_state_code(s, &h->wanted, 0, h->n - 1);
  mhb_trace_state_flag(s, &h->linear);
  mhb_trace_state_flag(s, &h->from_linear);
  mhb_trace_state_whole(s, &h->n_lower_wanted);
  SHB_TRY(mhb_harmonic_levels_use(h, at));
  h->highest = highest;
  return SHB_OK;
}

/* All that determines what follows the last point of the segment in use. */
static shb_status pass_state(mhb_trace_state *s, mhb_tracer *t) {
  int end = (int)t->host.reached;
  SHB_TRY(pass_levels(s, t->levels));
  use_level(t);
  pass_current(s, t->host.curve);
  mhb_trace_state_flag(s, &t->accepts_all);
  pass_place(s, &t->start);
  mhb_trace_state_flag(s, &t->returns_to_start);
  mhb_trace_state_numbers(s, &t->farthest, 1);
  for (int i = 0; i < t->host.n_tests; i++)
    mhb_trace_state_numbers(s, &t->host.test[i].value_current, 1);
  mhb_trace_state_whole(s, &t->host.n_points);
  mhb_trace_state_whole(s, &t->host.n_tiny);
  mhb_trace_state_code(s, &end, 0, MHB_N_ENDS - 1);
  t->host.reached = (mhb_end)end;
  return SHB_OK;
}

int mhb_tracer_least_level(const mhb_unfinished *earlier) {
  if (!earlier || earlier->n == 0) return 0;
  mhb_trace_state first = earlier->state[0];
  int             least = 0;
  first.at              = 0;
  first.reads           = true;
  mhb_trace_state_code(&first, &least, 0, MHB_MAX_LEVELS - 1);
  return least;
}

/* The state of the last segment. */
static shb_status keep_state(mhb_tracer *t) {
  t->state               = shb_realloc(t->state, (size_t)t->n_states + 1, sizeof *t->state);
  mhb_trace_state *state = &t->state[t->n_states++];
  *state                 = (mhb_trace_state){0};
  return pass_state(state, t);
}

/* The points and the state of a segment of the earlier run. */
static shb_status take_segment(mhb_tracer *t, int i) {
  const mhb_response *segments = t->earlier->segments;
  const mhb_branch   *from     = &segments->branch[i];
  mhb_trace_state     state    = t->earlier->state[i];
  state.at                     = 0;
  state.reads                  = true;
  if (from->n_points > 0) mhb_response_copy_points(t->store, i, segments, i, 0, from->n_points - 1);
  SHB_TRY(pass_state(&state, t));
  SHB_CHECK(!state.failed && state.at == state.n, SHB_ERR_INPUT,
            "the curve under way of the earlier response file does not fit; run with --force");
  return SHB_OK;
}

/* A segment goes on from the curve's current point: what a state leaves out. */
static shb_status go_on_from_current(mhb_tracer *t) {
  mhb_arclength         *curve = t->host.curve;
  const mhb_curve_place *place = t->plan.target   ? t->plan.target
                                 : t->plan.closes ? &t->start
                                                  : NULL;
  curve->system->linearise(curve->system, &curve->current);
  return_to(t, place && place->x ? place : NULL);
  return SHB_OK;
}

/* ---- the tracer ---- */

shb_status mhb_tracer_create(mhb_balance *balance, const mhb_response *response, int branch,
                             bool joins, mhb_monitor *monitor, mhb_tracer **out) {
  mhb_tracer *t = shb_alloc_zeroed(1, sizeof *t);
  t->host       = (mhb_segment_host){.estimate         = estimate,
                                     .estimate_event   = estimate_event,
                                     .estimate_between = estimate_between,
                                     .accept           = accept,
                                     .started          = started,
                                     .before_step      = before_step,
                                     .record           = record};
  t->monitor    = monitor;
  t->segment    = -1;
  t->joins      = joins;
  t->clock      = shb_seconds();
  t->farthest   = mhb_parameter_end(balance->settings, balance->parameter, 0);
  t->store      = mhb_response_like(response);
  make_tests(t, balance);
  const shb_status status = mhb_harmonic_levels_create(balance, &t->levels);
  if (status != SHB_OK) {
    mhb_tracer_destroy(t);
    return status;
  }
  t->store->n_harmonics  = response->branch[branch].n_harmonics;
  t->store->subharmonics = response->branch[branch].order;
  if (joins) t->host.limit_step = limit_step;
  *out = t;
  return SHB_OK;
}

void mhb_tracer_destroy(mhb_tracer *t) {
  if (!t) return;
  mhb_harmonic_levels_destroy(t->levels);
  mhb_response_destroy(t->store);
  mhb_curve_place_free(&t->start);
  for (int i = 0; i < t->n_states; i++) mhb_trace_state_free(&t->state[i]);
  free(t->state);
  free(t->returns);
  free(t->output);
  free(t->host.test);
  free(t);
}

shb_status mhb_tracer_trace(mhb_tracer *t, const mhb_segment_plan *plan, int *segment,
                            mhb_end *end) {
  const mhb_settings *settings = t->levels->settings;
  *segment                     = mhb_response_branch(t->store, MHB_BRANCH_NONLINEAR);
  SHB_TRY(mhb_harmonic_levels_use(t->levels, mhb_harmonic_levels_of(t->levels, plan->m)));
  use_level(t);
  t->plan            = *plan;
  t->segment         = *segment;
  t->host.max_points = settings->max_points - plan->recorded;
  mhb_seed seed      = plan->seed;
  if (t->earlier && *segment < t->earlier->n) {
    SHB_TRY(take_segment(t, *segment));
    *end      = t->host.reached;
    seed.kind = MHB_SEED_UNDER_WAY;
    if (*end == MHB_END_NONE) SHB_TRY(go_on_from_current(t));
  }
  bool traced = seed.kind == MHB_SEED_UNDER_WAY && *end != MHB_END_NONE;
  if (!traced) SHB_TRY(mhb_trace_segment(&t->host, &seed, end));
  return keep_state(t);
}

shb_status mhb_tracer_unfinished(mhb_tracer *t, mhb_unfinished **out) {
  bool under_way = t->n_states <= t->segment;
  if (under_way) SHB_TRY(keep_state(t));
  *out = mhb_unfinished_copy(t->store, t->n_states, t->state);
  if (under_way) mhb_trace_state_free(&t->state[--t->n_states]);
  return SHB_OK;
}

void mhb_tracer_forget(mhb_tracer *t, int segment) {
  t->store->branch[segment].n_points = 0;
}

shb_status mhb_tracer_recorded(mhb_tracer *t, int segment, int point, double *x) {
  const mhb_branch *branch = &t->store->branch[segment];
  SHB_TRY(mhb_harmonic_levels_use(t->levels,
                                  mhb_harmonic_levels_of(t->levels, branch->harmonics[point])));
  mhb_recorded_motion(branch, point, mhb_tracer_balance(t), x);
  return SHB_OK;
}
