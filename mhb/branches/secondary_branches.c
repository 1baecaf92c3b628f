#include "mhb/branches/secondary_branches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/balance/subharmonics.h"
#include "mhb/branches/branch_completion.h"
#include "mhb/branches/period_doubling.h"
#include "mhb/numerics/fourier.h"
#include "mhb/search/multistart.h"

static const double TOLERANCE = 1e-10;

/* A flip leads to a doubled branch where the smallest singular value of the doubled balance is
 * below this. Else the flip does not have the form of the wave. */
static const double SINGULAR = 0.1;

/* A doubled branch that ends this near, relative to the value and to the motion, is the one that
 * leaves here. */
static const double SAME_VALUE = 2e-3, SAME_MOTION = 3e-2;

enum {
  MAX_SECONDARY    = 24, /* branches beside a main one */
  RING_POINTS      = 10, /* of all curves that are found in a ring, in those of the main one */
  SEARCH_HARMONICS = 7,  /* times the order, with harmonics: auto */
  N_PLACES         = 6,  /* values searched at, unless given */
  LEAST_POINTS     = 10, /* fewer tell nothing of a curve */
  MAX_PROBLEMS     = 16  /* orders */
};

static const char USED_UP[] = "the points of searches are used up: ten times the main curve's";

/* The balance of one order. */
typedef struct {
  int              order; /* in all: times the main branch's */
  mhb_settings     settings;
  mhb_balance     *balance;
  mhb_newton      *newton;
  mhb_solution_set known; /* solutions at the value at hand */
} subharmonic_problem;

typedef struct {
  const modal_model   *model;
  const mhb_settings  *settings;
  mhb_response        *response;
  mhb_monitor         *monitor;
  int                  n_problems;
  subharmonic_problem *problem[MAX_PROBLEMS];
  int                  points;   /* traced by searches */
  int                  untraced; /* motions that were found, whose curves were not traced */
  bool                 go_on;
} branch_search;

bool mhb_secondary_branches_wanted(const mhb_settings *s) {
  return s->search.starts > 0 || (s->flips && mhb_judges_stability(s));
}

static mhb_branch *branch_at(const branch_search *h, int index) {
  return &h->response->branch[index];
}

/* ---- the balance of an order ---- */

static void problem_destroy(subharmonic_problem *s) {
  mhb_solution_set_free(&s->known);
  mhb_newton_destroy(s->newton);
  mhb_balance_destroy(s->balance);
  free(s);
}

/* Harmonics that a branch of this order has room for from the start. */
static int usual_harmonics(const branch_search *h, const subharmonic_problem *s) {
  int m[MHB_MAX_LEVELS], n = mhb_harmonic_levels_ladder(h->model, &s->settings, m);
  return mhb_harmonic_levels_usual(n, m);
}

static int search_harmonics(const branch_search *h, const subharmonic_problem *s) {
  int m[MHB_MAX_LEVELS], n = mhb_harmonic_levels_ladder(h->model, &s->settings, m), i = 0;
  if (!(s->settings.motion_tolerance > 0)) return m[0];
  while (i + 1 < n && m[i] < SEARCH_HARMONICS * s->order) i++;
  return m[i];
}

/* SHB_ERR_INPUT: a wave of that many periods does not close around the ring. */
static shb_status problem_fill(branch_search *h, subharmonic_problem *s) {
  const mhb_settings *asked = h->settings;
  s->settings               = *asked;
  s->settings.subharmonics  = s->order;
  s->settings.harmonics     = asked->harmonics * s->order / asked->subharmonics;
  s->settings.harmonics     = search_harmonics(h, s);
  SHB_TRY(mhb_balance_create(h->model, &s->settings, &s->balance));
  mhb_balance_set_preload(s->balance, branch_at(h, 0)->n0[0]);
  mhb_balance_set_parameter(s->balance, asked->parameter);
  s->newton = mhb_newton_create(s->balance->n);
  return SHB_OK;
}

/* *out: NULL if there is no such wave. */
static shb_status problem_of(branch_search *h, int order, subharmonic_problem **out) {
  *out = NULL;
  for (int i = 0; i < h->n_problems; i++)
    if (h->problem[i]->order == order) *out = h->problem[i];
  if (*out || h->n_problems == MAX_PROBLEMS) return SHB_OK;
  subharmonic_problem *s = shb_alloc_zeroed(1, sizeof *s);
  s->order               = order;
  shb_status status      = problem_fill(h, s);
  if (status != SHB_OK) problem_destroy(s);
  if (status == SHB_ERR_INPUT) return SHB_OK;
  SHB_TRY(status);
  h->problem[h->n_problems++] = *out = s;
  return SHB_OK;
}

/* ---- solutions of recorded branches ---- */

/* Interpolate between point i and the next, as a solution of the problem's order. The order of the
 * branch divides that. */
static void interpolate(const branch_search *h, const mhb_branch *b, int i, double share,
                        const subharmonic_problem *s, double *x) {
  int    rows = 3 * h->response->n_pairs, m = b->n_harmonics, nb = mhb_real_size(m);
  int    next = i + 1 < b->n_points ? i + 1 : i;
  double own[rows * nb];
  for (int row = 0; row < rows; row++) {
    const double complex *a =
        b->motion + ((size_t)i * (size_t)rows + (size_t)row) * (size_t)(m + 1);
    const double complex *c =
        b->motion + ((size_t)next * (size_t)rows + (size_t)row) * (size_t)(m + 1);
    double complex A[m + 1];
    for (int k = 0; k <= m; k++) A[k] = (1 - share) * a[k] + share * c[k];
    mhb_to_real(m, A, own + row * nb);
  }
  mhb_subharmonic_embed(rows, own, m, s->order / b->order, x, s->balance->m);
}

/* A point's value of the parameter, as the residual takes it. */
static double value_at(const branch_search *h, const mhb_branch *b, int point) {
  return mhb_parameter_value(h->settings->parameter, b->value[point]);
}

/* The branch crosses a value between points i and i + 1. The solution there becomes known. */
static void add_crossing(const branch_search *h, const mhb_branch *b, int i, double share,
                         subharmonic_problem *s, double value) {
  const double shares[] = {share, 0, 1};
  double       x[s->balance->n];
  int          iterations;
  for (int k = 0; k < 3; k++) {
    interpolate(h, b, i, shares[k], s, x);
    if (mhb_newton_solve(s->newton, s->balance, value, TOLERANCE, x, &iterations) != MHB_CONVERGED)
      continue;
    mhb_solution_set_add_copies(&s->known, s->balance, x);
    return;
  }
}

static void add_crossings(const branch_search *h, const mhb_branch *b, subharmonic_problem *s,
                          double value) {
  if (s->order % b->order) return;
  for (int i = 0; i + 1 < b->n_points; i++) {
    double from = value_at(h, b, i) - value, to = value_at(h, b, i + 1) - value;
    if (from * to > 0 || (from == 0 && to == 0)) continue;
    add_crossing(h, b, i, from / (from - to), s, value);
  }
}

/* Collect the known solutions at a value, of all branches but one (-1: of all). Those detached from
 * the main one count too. */
static void collect_known(const branch_search *h, subharmonic_problem *s, double value, int but) {
  s->known.n_solutions = 0;
  for (int i = 0; i < h->response->n_branches; i++)
    if (i != but) add_crossings(h, branch_at(h, i), s, value);
}

/* ---- tracing ---- */

static void append(branch_search *h, const subharmonic_problem *s, mhb_origin origin, int *index) {
  *index         = mhb_response_branch(h->response, MHB_BRANCH_NONLINEAR);
  mhb_branch *b  = branch_at(h, *index);
  b->origin      = origin;
  b->order       = s->order;
  b->n_harmonics = usual_harmonics(h, s);
  b->main        = 0;
}

/* Points that a curve may have. In a ring curves wander from blade to blade, nearly without end.
 * All that searches find share a budget there. */
static int points_left(const branch_search *h) {
  const int most = h->settings->max_points;
  if (!h->settings->ring) return most;
  const int left = RING_POINTS * branch_at(h, 0)->n_points - h->points;
  return left < most ? left : most;
}

/* Trace a curve both ways from a solution, until it closes, leaves the range or meets one of lower
 * order. From a crossing, trace it one way.
 *   shortened         in   why there are no more points, or NULL
 *   none              out  there is no such curve, or none with these harmonics */
static shb_status trace_both_ways(mhb_tracer *tracer, const mhb_seed *seed, mhb_response *response,
                                  int index, const char *shortened, bool *none, bool *interrupted) {
  mhb_chain        chain = {0};
  int              up, down;
  mhb_end          end, other = MHB_END_NO_START;
  mhb_segment_plan plan = {.seed = *seed, .m = mhb_tracer_balance(tracer)->m, .closes = true};
  SHB_TRY(mhb_tracer_trace(tracer, &plan, &up, &end));
  *none = end == MHB_END_NO_START || end == MHB_END_HARMONICS;
  if (*none) return SHB_OK;
  bool       both   = end != MHB_END_CLOSED && end != MHB_END_INTERRUPTED && !seed->along;
  shb_status status = SHB_OK;
  mhb_chain_insert(&chain, 0, (mhb_link){.segment = up, .reversed = both});
  if (both) {
    plan.seed.direction  = -seed->direction;
    plan.seed.skip_first = true;
    plan.closes          = false;
    plan.recorded        = mhb_chain_points(&chain, tracer->store);
    status               = mhb_tracer_trace(tracer, &plan, &down, &other);
    *none                = other == MHB_END_HARMONICS;
    if (status == SHB_OK && other != MHB_END_NO_START)
      mhb_chain_insert(&chain, 1, (mhb_link){.segment = down, .joins = true});
    bool first_ended = end == MHB_END_HIGH || end == MHB_END_LOW || end == MHB_END_JOINED;
    if (other == MHB_END_INTERRUPTED || (other != MHB_END_NO_START && first_ended)) end = other;
  }
  if (end == MHB_END_LOW) end = MHB_END_HIGH; /* either end of the range will do */
  mhb_completion completion = {.end = end};
  if (end == MHB_END_MAX_POINTS && response->branch[index].origin == MHB_FROM_SEARCH)
    completion.other_reason = shortened;
  if (status == SHB_OK && !*none)
    status = mhb_branch_complete(tracer, &chain, response, index, &completion);
  *interrupted = completion.interrupted;
  mhb_chain_free(&chain);
  return status;
}

/* Publish the branches so far. */
static shb_status publish(void *context) {
  const branch_search *h = context;
  return mhb_monitor_publish_if_due(h->monitor, h->response);
}

/* The same by attempts, each with more harmonics at least, until none asks for a level that no
 * solution near by has. With the most of them there is no such curve. */
static shb_status trace_with_enough(branch_search *h, const subharmonic_problem *s,
                                    const mhb_seed *seed, int index, const char *shortened,
                                    bool *none, bool *interrupted) {
  int least = 0;
  for (bool again = true; again;) {
    mhb_tracer *tracer;
    SHB_TRY(mhb_tracer_create(s->balance, h->response, index, true, h->monitor, &tracer));
    tracer->publish       = publish;
    tracer->context       = h;
    tracer->levels->least = least;
    const shb_status status =
        trace_both_ways(tracer, seed, h->response, index, shortened, none, interrupted);
    const int needed = mhb_harmonic_levels_needed(tracer->levels);
    again            = tracer->host.out_of_reach && needed > least;
    least            = needed;
    mhb_tracer_destroy(tracer);
    SHB_TRY(status);
  }
  return SHB_OK;
}

/* Of the middle half of a branch, the point where the parameter changes fastest. At a fold a
 * solution is known to the root of the tolerance only. */
static int middle_point(const mhb_branch *b) {
  int    best = b->n_points / 2;
  double most = -1;
  for (int i = b->n_points / 4 + 1; i + 1 < b->n_points && i < 3 * b->n_points / 4; i++) {
    const double rate =
        fmin(fabs(b->value[i + 1] - b->value[i]), fabs(b->value[i] - b->value[i - 1]));
    if (rate > most) best = i;
    most = fmax(most, rate);
  }
  return best;
}

/* Whether the middle of a branch lies on another one. The branch then ran into that one, or is that
 * one, traced from its other end. */
static shb_status is_another(branch_search *h, subharmonic_problem *s, int index, bool *another) {
  const mhb_branch *b     = branch_at(h, index);
  int               point = middle_point(b), iterations;
  double            value = value_at(h, b, point), x[s->balance->n];
  interpolate(h, b, point, 0, s, x);
  *another = false;
  if (mhb_newton_solve(s->newton, s->balance, value, TOLERANCE, x, &iterations) != MHB_CONVERGED)
    return SHB_OK;
  collect_known(h, s, value, index);
  *another = mhb_solution_set_has(&s->known, x);
  return SHB_OK;
}

/* Trace the branch of a seed; it is kept unless it is another one. */
static shb_status trace(branch_search *h, subharmonic_problem *s, mhb_origin origin,
                        const mhb_seed *seed) {
  int        index;
  bool       none = true, interrupted = false, another = false;
  const bool searched = origin == MHB_FROM_SEARCH;
  const int  most     = searched ? points_left(h) : h->settings->max_points;
  if (h->response->n_branches > MAX_SECONDARY || most < LEAST_POINTS) {
    h->untraced += searched;
    branch_at(h, 0)->flips_untraced += !searched;
    return SHB_OK;
  }
  s->settings.max_points = most;
  append(h, s, origin, &index);
  const char *shortened = most < h->settings->max_points ? USED_UP : NULL;
  shb_status  status    = trace_with_enough(h, s, seed, index, shortened, &none, &interrupted);
  if (interrupted) h->go_on = false;
  if (searched) h->points += branch_at(h, index)->n_points;
  if (status == SHB_OK && !none && h->go_on) status = is_another(h, s, index, &another);
  if (another) branch_at(h, index)->n_points = 0; /* dropped at the end: others keep their places */
  return status;
}

/* ---- doubled periods ---- */

/* Whether a doubled branch that was followed ends at the motion x. */
static bool is_traced(const branch_search *h, subharmonic_problem *s, const double *x,
                      double value) {
  double end[s->balance->n], size = mhb_norm(x, s->balance->n);
  for (int i = 1; i < h->response->n_branches; i++) {
    const mhb_branch *b = branch_at(h, i);
    if (b->origin != MHB_FROM_FLIP || b->n_points == 0) continue;
    if (fabs(value_at(h, b, b->n_points - 1) - value) > SAME_VALUE * fabs(value)) continue;
    interpolate(h, b, b->n_points - 1, 0, s, end);
    for (int k = 0; k < s->balance->n; k++) end[k] -= x[k];
    if (mhb_norm(end, s->balance->n) < SAME_MOTION * size) return true;
  }
  return false;
}

static shb_status trace_flip(branch_search *h, subharmonic_problem *s, int point) {
  const mhb_branch *main  = branch_at(h, 0);
  int               n     = s->balance->n, iterations;
  double            value = value_at(h, main, point), least;
  double            x[n], part[n], along[n];
  interpolate(h, main, point, 0, s, x);
  if (is_traced(h, s, x, value)) return SHB_OK;
  if (mhb_newton_solve(s->newton, s->balance, value, TOLERANCE, x, &iterations) != MHB_CONVERGED)
    return SHB_OK;
  mhb_subharmonic_component(s->balance, x, s->order / 2, part);
  for (int i = 0; i < n; i++) x[i] -= part[i];
  mhb_period_doubling_direction(s->balance, x, value, along, &least);
  if (!(least < SINGULAR)) return SHB_OK;
  return trace(h, s, MHB_FROM_FLIP,
               &(mhb_seed){.kind = MHB_SEED_CROSSING, .x = x, .value = value, .along = along});
}

static shb_status trace_flips(branch_search *h) {
  subharmonic_problem *s = NULL;
  for (int i = 0; h->go_on && i < branch_at(h, 0)->n_points; i++) {
    if (branch_at(h, 0)->special[i] != MHB_FLIP) continue;
    if (!s) SHB_TRY(problem_of(h, 2 * h->settings->subharmonics, &s));
    if (!s) return SHB_OK;
    SHB_TRY(trace_flip(h, s, i));
  }
  return SHB_OK;
}

/* ---- search ---- */

/* Trace a solution that was found as one of its lowest order, among the multiples of the main
 * branch's order. */
static shb_status trace_found(branch_search *h, subharmonic_problem *s, const double *x,
                              double value) {
  int least = mhb_subharmonic_period(s->balance, x), base = h->settings->subharmonics, order = base;
  subharmonic_problem *own = s;
  while (order < s->order && (s->order % order || order % least)) order += base;
  if (order < s->order) SHB_TRY(problem_of(h, order, &own));
  if (!own) return SHB_OK;
  double narrow[own->balance->n];
  mhb_subharmonic_restrict(3 * s->balance->n_pairs, x, s->balance->m, s->order / order, narrow,
                           own->balance->m);
  return trace(h, own, MHB_FROM_SEARCH, &(mhb_seed){.x = narrow, .value = value, .direction = 1});
}

/* The size of motions that the contact responds to: the gap or the approach at rest, or that of the
 * known branches. */
static double expected_size(const branch_search *h, const subharmonic_problem *s) {
  const mhb_settings *c   = h->settings;
  double              top = c->kv > 0 ? fabs(branch_at(h, 0)->n0[0]) / c->kv : 0;
  for (int f = 0; f < s->known.n_solutions; f++) {
    double most = 0;
    for (int i = 0; i < s->known.n; i++) most = fmax(most, fabs(s->known.x[f * s->known.n + i]));
    top = fmax(top, most);
  }
  return top;
}

static bool go_on_searching(branch_search *h, double value, double share) {
  double shown = mhb_parameter_shown(h->settings->parameter, value);
  h->go_on = h->go_on && h->monitor->searching(h->monitor, MHB_SEEKS_OTHERS, branch_at(h, 0)->n0[0],
                                               shown, share);
  return h->go_on;
}

static int n_branches(const branch_search *h) {
  int n = 0;
  for (int i = 0; i < h->response->n_branches; i++) n += branch_at(h, i)->n_points > 0;
  return n;
}

/* Make random starts at a value, trace what they lead to, and note the search.
 *   size   of the motions, m; 0: nothing is to be expected
 *   share  of the work that is done */
static shb_status search_at(branch_search *h, subharmonic_problem *s, double value, double size,
                            int starts, unsigned long long seed, double share) {
  static const double sizes[]  = {1, 2, 4, 0.5};
  const int           seeded   = (int)seed;
  const int           untraced = h->untraced;
  int                 before = n_branches(h), done = 0;
  double              x[s->balance->n];
  for (; size > 0 && done < starts && go_on_searching(h, value, share); done++) {
    bool is_new;
    SHB_TRY(publish(h));
    mhb_multistart_once(s->newton, s->balance, value, size * sizes[done % 4], &seed, &s->known, x,
                        &is_new);
    if (!is_new) continue;
    SHB_TRY(trace_found(h, s, x, value));
    collect_known(h, s, value, -1);
    /* whether it was traced or not */
    mhb_solution_set_add_copies(&s->known, s->balance, x);
  }
  mhb_search made = {.value    = mhb_parameter_shown(h->settings->parameter, value),
                     .order    = s->order,
                     .starts   = done,
                     .seed     = seeded,
                     .found    = n_branches(h) - before,
                     .untraced = h->untraced - untraced};
  mhb_response_note_search(branch_at(h, 0), &made);
  return SHB_OK;
}

/* Value number i of the search: given, or even over the range. */
static double value_of_search(const mhb_settings *s, int i) {
  double low = mhb_parameter_end(s, s->parameter, 0), high = mhb_parameter_end(s, s->parameter, 1);
  if (s->search.n_at > 0) return mhb_parameter_value(s->parameter, s->search.at[i]);
  return low + (i + 0.5) / N_PLACES * (high - low);
}

static shb_status search_everywhere(branch_search *h) {
  const mhb_search_settings *c = &h->settings->search;
  int                        n = c->n_at ? c->n_at : N_PLACES;
  for (int o = 0; c->starts > 0 && o < c->n_orders && h->go_on; o++) {
    subharmonic_problem *s;
    SHB_TRY(problem_of(h, c->order[o] * h->settings->subharmonics, &s));
    for (int i = 0; s && i < n && h->go_on; i++) {
      double value = value_of_search(h->settings, i);
      collect_known(h, s, value, -1);
      SHB_TRY(search_at(h, s, value, expected_size(h, s), c->starts,
                        (unsigned long long)(1000 * c->order[o] + i + 1),
                        (double)(o * n + i) / (c->n_orders * n)));
    }
  }
  return SHB_OK;
}

/* The size of motions at a value: that of the open limit counts too. A branch beside the main one
 * is often near it. */
static double size_at(const branch_search *h, subharmonic_problem *s, double value) {
  double x[s->balance->n], top = expected_size(h, s);
  if (mhb_balance_linear_limit(s->balance, value, 0, x) != SHB_OK) return top;
  for (int i = 0; i < s->balance->n; i++)
    if (isfinite(x[i])) top = fmax(top, fabs(x[i]));
  return top;
}

static shb_status search_values(branch_search *h, int n, const double *value, int starts) {
  subharmonic_problem *s;
  SHB_TRY(problem_of(h, h->settings->subharmonics, &s));
  for (int i = 0; s && i < n && h->go_on; i++) {
    double at = mhb_parameter_value(h->settings->parameter, value[i]);
    collect_known(h, s, at, -1);
    SHB_TRY(
        search_at(h, s, at, size_at(h, s, at), starts, (unsigned long long)(i + 1), (double)i / n));
  }
  return SHB_OK;
}

shb_status mhb_secondary_branches(const modal_model *model, const mhb_settings *settings,
                                  mhb_response *response, mhb_monitor *monitor) {
  branch_search h                  = {.model    = model,
                                      .settings = settings,
                                      .response = response,
                                      .monitor  = monitor,
                                      .go_on    = true};
  shb_status    status             = SHB_OK;
  branch_at(&h, 0)->flips_untraced = 0;
  if (branch_at(&h, 0)->n_points > 0) {
    if (settings->flips) status = trace_flips(&h);
    if (status == SHB_OK) status = search_everywhere(&h);
  }
  if (status == SHB_OK && h.go_on) branch_at(&h, 0)->searched = true;
  for (int i = 0; i < h.n_problems; i++) problem_destroy(h.problem[i]);
  return status;
}

/* An interrupted search leaves nothing: a resumed run makes it anew. */
static void drop_from(mhb_response *response, int first, int n_searches) {
  bool drop[response->n_branches];
  for (int i = 0; i < response->n_branches; i++) drop[i] = i >= first;
  mhb_response_drop(response, drop);
  response->branch[0].n_searches = n_searches;
}

shb_status mhb_secondary_branches_at(const modal_model *model, const mhb_settings *settings,
                                     mhb_response *response, int n, const double *value, int starts,
                                     mhb_monitor *monitor) {
  branch_search h      = {.model    = model,
                          .settings = settings,
                          .response = response,
                          .monitor  = monitor,
                          .go_on    = true};
  int           before = response->n_branches, searches = response->branch[0].n_searches;
  shb_status    status = search_values(&h, n, value, starts);
  if (!h.go_on) drop_from(response, before, searches);
  for (int i = 0; i < h.n_problems; i++) problem_destroy(h.problem[i]);
  return status;
}
