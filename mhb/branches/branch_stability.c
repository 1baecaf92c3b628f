#include "mhb/branches/branch_stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/event_location.h"
#include "mhb/floquet/floquet.h"

/* Up to CHEAP states every point is judged. Up to FINE states the budget of a branch decides, in
 * seconds of expected cost. Above that there are fewer modes and sub-steps. */
enum {
  CHEAP          = 60,
  FINE           = 120,
  FEWER_STATES   = 320,
  SUBSTEPS       = 256,
  FEWER_SUBSTEPS = 32,
  LEAST_POINTS   = 3
};
static const double BUDGET = 0.5, FEWER_BUDGET = 0.1, SECONDS_A_CUBE = 4e-9, SECONDS_A_STATE = 1e-5;

/* Distances of a modulus from 1: the margin outside that counts as unstable, the accuracy of a
 * located bifurcation, and the end of the search. */
static const double MARGIN = 1e-3, ON_CIRCLE = 1e-3, NEAR_ENOUGH = 1e-6;
enum { MAX_LOCATED = 32 };

/* The verdict of the multipliers on a point. */
typedef struct {
  int    computed;       /* 0: not computed */
  int    verdict;        /* mhb_verdict */
  int    loss;           /* MHB_LOSS_FOLD ... of the largest */
  int    n_unstable;     /* outside the unit circle by more than the margin */
  int    leaves_complex; /* the largest that is not on the positive axis is outside by the margin */
  double complex_excess; /* its modulus, less 1; NAN: undecided */
  int    bifurcation;    /* where it crosses the circle: MHB_FLIP, MHB_NEIMARK_SACKER */
} point_stability;

struct mhb_branch_stability {
  mhb_balance *balance;
  mhb_floquet *floquet;
  int          states, judges_all; /* judges_all: every point of the branch at work is judged */
  double      *x, *r;              /* [n] */
  /* the branch at work */
  mhb_tracer      *tracer;
  mhb_response    *response;
  int              branch;
  point_stability *at; /* [point] */
  int              n;
  shb_status       published; /* first failure of a publication */
};

/* Number of states of the blade or ring with all its modes, each contact sticking. */
static int count_states(const mhb_balance *b) {
  int blades = b->settings->to_ground ? 1 : b->settings->blades;
  return 2 * blades * (b->receptance->n_modes + b->n_pairs);
}

shb_status mhb_branch_stability_create(mhb_balance *b, mhb_branch_stability **out) {
  mhb_branch_stability *w = calloc(1, sizeof *w);
  SHB_CHECK(w, SHB_ERR_IO, "out of memory");
  w->balance = b;
  w->states  = count_states(b);
  int fine   = w->states <= FINE || b->settings->stability == MHB_STABILITY_ALWAYS;
  w->x       = calloc((size_t)b->n, sizeof(double));
  w->r       = calloc((size_t)b->n, sizeof(double));
  shb_status status =
      w->x && w->r ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK)
    status = mhb_floquet_create(b->receptance, b->settings, fine ? SUBSTEPS : FEWER_SUBSTEPS,
                                fine ? 0 : FEWER_STATES, &w->floquet);
  if (status != SHB_OK) {
    mhb_branch_stability_destroy(w);
    return status;
  }
  *out = w;
  return SHB_OK;
}

void mhb_branch_stability_destroy(mhb_branch_stability *w) {
  if (!w) return;
  mhb_floquet_destroy(w->floquet);
  free(w->x);
  free(w->r);
  free(w);
}

/* ---- one point ---- */

static mhb_branch *branch_of(const mhb_branch_stability *w) {
  return &w->response->branch[w->branch];
}

static double value_of(const mhb_branch_stability *w, int point) {
  return mhb_parameter_value(w->balance->parameter, branch_of(w)->value[point]);
}

/* Multipliers at the solution of the last evaluation of the balance. */
static void evaluate(mhb_branch_stability *w, const double *x, mhb_multipliers *out) {
  const mhb_balance    *b        = w->balance;
  const mhb_evaluation *e        = b->eval;
  mhb_solution          solution = {e->at.omega, b->law, e->info, x, e->p};
  if (b->settings->run_up) mhb_floquet_move(w->floquet, b->receptance);
  mhb_floquet_evaluate(w->floquet, &solution, out);
}

/* The largest multiplier that is not on the positive axis; -1: none. */
static int largest_complex(const mhb_multipliers *m) {
  for (int i = 0; i < m->n; i++)
    if (cimag(m->multiplier[i]) != 0 || creal(m->multiplier[i]) < 0) return i;
  return -1;
}

static point_stability stability_of(const mhb_multipliers *m) {
  static const int loss[] = {MHB_LOSS_FOLD, MHB_LOSS_FLIP, MHB_LOSS_NEIMARK_SACKER};
  point_stability  out    = {.computed       = 1,
                             .verdict        = (int)m->verdict,
                             .loss           = loss[m->crossing],
                             .n_unstable     = m->n_unstable,
                             .complex_excess = NAN};
  int              i      = largest_complex(m);
  if (m->verdict == MHB_UNDECIDED) return out;
  out.complex_excess = i < 0 ? -1 : cabs(m->multiplier[i]) - 1;
  out.bifurcation    = i < 0 || cimag(m->multiplier[i]) != 0 ? MHB_NEIMARK_SACKER : MHB_FLIP;
  out.leaves_complex = m->verdict == MHB_UNSTABLE && out.complex_excess > fmax(MARGIN, m->change);
  return out;
}

/* Write the multipliers of a point into the branch. */
static void put(const mhb_branch_stability *w, int point, const mhb_multipliers *m) {
  static const int judged[] = {MHB_BY_MULTIPLIERS, MHB_MARGINAL_BY_FOLDS, MHB_BY_MULTIPLIERS,
                               MHB_UNDECIDED_BY_FOLDS};
  mhb_branch      *branch   = branch_of(w);
  int              kept     = w->response->n_multipliers;
  branch->judged[point]     = judged[m->verdict];
  for (int i = 0; i < kept && m->verdict != MHB_UNDECIDED; i++)
    branch->multipliers[(size_t)point * (size_t)kept + (size_t)i] = i < m->n ? m->multiplier[i] : 0;
}

/* Judge a point by its multipliers. false: the monitor stops the work, or publication fails. */
static bool judge_point(mhb_branch_stability *w, int point) {
  mhb_multipliers m;
  mhb_monitor    *monitor = w->tracer->monitor;
  double          started = shb_seconds(), value = value_of(w, point);
  mhb_balance_use(w->balance, NULL);
  mhb_recorded_motion(branch_of(w), point, w->balance, w->x);
  mhb_balance_evaluate(w->balance, w->x, value, w->r, NULL, NULL);
  evaluate(w, w->x, &m);
  w->at[point] = stability_of(&m);
  put(w, point, &m);
  branch_of(w)->seconds[point] += shb_seconds() - started;
  w->published = mhb_monitor_publish_if_due(monitor, w->response);
  return w->published == SHB_OK && monitor->point(monitor, w->response, w->branch, point);
}

/* ---- which points ---- */

/* Whether all contacts stick or are open throughout. The exponents of the last point are used again
 * then, at little cost. In a run-up they change with the speed. */
static bool is_linear(const mhb_branch_stability *w, int point) {
  if (w->balance->settings->run_up) return false;
  size_t        pairs = (size_t)w->response->n_pairs;
  const double *share = branch_of(w)->state + 3 * (size_t)point * pairs;
  for (size_t a = 0; a < pairs; a++)
    if (share[3 * a] < 1 && share[3 * a + 2] < 1) return false;
  return true;
}

/* The middle point of the longest stretch without judged points and folds; -1: none. */
static int next_of_few(const mhb_branch_stability *w) {
  const int *special = branch_of(w)->special;
  int        from = 0, longest = 0, best = -1;
  for (int i = 0; i <= w->n; i++) {
    if (i < w->n && !w->at[i].computed && special[i] != MHB_FOLD) continue;
    if (i - from > longest) {
      longest = i - from;
      best    = from + longest / 2;
    }
    from = i + 1;
  }
  return best;
}

/* The point of the largest motion that is not judged yet; -1: none. */
static int largest_motion(const mhb_branch_stability *w) {
  double top  = -1;
  int    best = -1;
  for (int i = 0; i < w->n; i++) {
    if (w->at[i].computed) continue;
    mhb_recorded_motion(branch_of(w), i, w->balance, w->x);
    double size = mhb_norm(w->x, w->balance->n);
    if (size <= top) continue;
    top  = size;
    best = i;
  }
  return best;
}

/* Number of points that the budget allows, by the states integrated and the cells of the ring
 * (bloch.h). */
static int affordable(const mhb_branch_stability *w) {
  int    few = w->states > FINE, g = mhb_floquet_cells(w->floquet);
  double states = few && w->states > FEWER_STATES ? FEWER_STATES : w->states;
  double cube   = SECONDS_A_CUBE * states * states * states * (g > 2 ? 2. : 1.) / (g * g);
  int    n      = (int)((few ? FEWER_BUDGET : BUDGET) / (cube + SECONDS_A_STATE * states));
  return n > LEAST_POINTS ? n : LEAST_POINTS;
}

/* Whether every point is judged. The branch alone decides, never the clock, so the result is the
 * same on every machine and for any number of threads. */
static int judges_all(const mhb_branch_stability *w) {
  return w->states <= CHEAP || w->balance->settings->stability == MHB_STABILITY_ALWAYS ||
         (w->states <= FINE && affordable(w) >= w->n);
}

static bool judge_points(mhb_branch_stability *w) {
  bool go_on = true;
  for (int i = 0; i < w->n && go_on; i++)
    if (w->judges_all || is_linear(w, i)) go_on = judge_point(w, i);
  if (w->judges_all) return go_on;
  for (int left = affordable(w), first = 1; left > 0 && go_on; left--, first = 0) {
    int i = first ? largest_motion(w) : next_of_few(w);
    if (i < 0) break;
    go_on = judge_point(w, i);
  }
  return go_on;
}

/* ---- flips and Neimark-Sacker points ---- */

typedef struct {
  mhb_branch_stability *stability;
  mhb_multipliers       last;
  point_stability       at;
} search;

static double excess_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  search *s = context;
  (void)curve;
  mhb_balance_use(s->stability->balance, point->evaluation);
  evaluate(s->stability, point->x, &s->last);
  s->at = stability_of(&s->last);
  return fabs(s->at.complex_excess) < NEAR_ENOUGH ? 0 : s->at.complex_excess;
}

/* A recorded point, linearised. */
static void set_point(mhb_branch_stability *w, int i, mhb_curve_point *point) {
  mhb_recorded_motion(branch_of(w), i, w->balance, point->x);
  point->value = value_of(w, i);
  mhb_arclength_measure(mhb_tracer_curve(w->tracer), point);
}

/* Locate the place where the excess passes 0 between points i - 1 and i, and insert it there. A
 * jump across 0 is not marked. */
static shb_status locate(mhb_branch_stability *w, int i) {
  mhb_arclength *curve = mhb_tracer_curve(w->tracer);
  search         s     = {.stability = w};
  double         at, chord[curve->n + 1];
  set_point(w, i - 1, &curve->current);
  set_point(w, i, &curve->next);
  for (int k = 0; k < curve->n; k++) chord[k] = curve->next.x[k] - curve->current.x[k];
  chord[curve->n] = curve->next.value - curve->current.value;
  if (!mhb_arclength_set_tangent(curve, chord, &curve->current) ||
      !mhb_arclength_set_tangent(curve, chord, &curve->next) ||
      !mhb_arclength_locate(curve, excess_test, &s, w->at[i - 1].complex_excess,
                            w->at[i].complex_excess, &at) ||
      !(fabs(s.at.complex_excess) < ON_CIRCLE))
    return SHB_OK;
  mhb_harmonic_levels_errors(w->tracer->levels, &curve->trial);
  SHB_TRY(mhb_record(w->response, w->branch, w->balance, &curve->trial, s.at.bifurcation, 0));
  mhb_response_place(w->response, w->branch, i);
  put(w, i, &s.last);
  memmove(w->at + i + 1, w->at + i, sizeof *w->at * (size_t)(w->n - i));
  w->at[i] = s.at;
  w->n++;
  return SHB_OK;
}

static bool begins(const int *first, int n_first, int point) {
  for (int k = 0; k < n_first; k++)
    if (first[k] == point) return true;
  return false;
}

/* Whether one of the points from..to - 1 has a complex or negative multiplier outside the unit
 * circle by more than the margin. The onset of slip brings multipliers close to 1, which are not
 * marked. */
static bool leaves_by_margin(const mhb_branch_stability *w, int from, int to) {
  for (int i = from; i < to; i++)
    if (w->at[i].leaves_complex) return true;
  return false;
}

/* Mark all bifurcations, from the last point to the first, so that indices before stay valid. */
static shb_status mark_bifurcations(mhb_branch_stability *w, const int *first, int n_first) {
  int located = 0, to = w->n;
  while (to > 0 && located + 2 <= MAX_LOCATED) {
    int from = to - 1;
    if (!(w->at[from].complex_excess > 0) || !w->at[from].computed) {
      to--;
      continue;
    }
    while (from > 0 && w->at[from - 1].computed && w->at[from - 1].complex_excess > 0 &&
           !begins(first, n_first, from))
      from--;
    int end = to;
    to      = from;
    if (!leaves_by_margin(w, from, end)) continue;
    bool ends   = end < w->n && w->at[end].computed && w->at[end].complex_excess <= 0;
    bool starts = from > 0 && w->at[from - 1].computed && w->at[from - 1].complex_excess <= 0;
    for (int i = from; i < end; i++) w->at[i].leaves_complex = 1;
    if (ends && !begins(first, n_first, end)) SHB_TRY(locate(w, end));
    if (starts && !begins(first, n_first, from)) SHB_TRY(locate(w, from));
    located += 2;
  }
  return SHB_OK;
}

/* ---- the verdict ---- */

/* Whether the curve came back at point i to the end of the range at which point i - 1 left it. Its
 * direction has changed, so an odd number of folds lies outside. */
static bool comes_back(const mhb_branch *branch, int i) {
  return i > 0 && branch->value[i] == branch->value[i - 1] && branch->special[i] == MHB_ORDINARY &&
         branch->special[i - 1] == MHB_ORDINARY;
}

/* Number of folds between the beginning and point `to`, modulo 2. */
static int parity(const mhb_branch *branch, int to) {
  int odd = 0;
  for (int i = 1; i <= to && i < branch->n_points; i++)
    odd ^= (branch->special[i - 1] == MHB_FOLD) ^ comes_back(branch, i);
  return odd;
}

/* Stability and loss of every point. at: [point] verdicts of multipliers, or NULL. */
static void decide(mhb_branch *branch, const point_stability *at, int stable_at) {
  int n_unstable = parity(branch, stable_at), loss = n_unstable ? MHB_LOSS_FOLD : MHB_NO_LOSS;
  for (int i = 0; i < branch->n_points; i++) {
    if (comes_back(branch, i)) {
      if (n_unstable == 0) loss = MHB_LOSS_FOLD;
      n_unstable = n_unstable == 0 ? 1 : n_unstable == 1 ? 0 : n_unstable;
    }
    const point_stability *l = at && at[i].computed ? &at[i] : NULL;
    if (l && (l->verdict == MHB_STABLE || l->verdict == MHB_UNSTABLE)) {
      n_unstable = l->verdict == MHB_STABLE ? 0 : l->n_unstable;
      loss       = l->loss;
    }
    bool leaves =
        l && l->leaves_complex; /* marginal, between a crossing and a point outside by the margin */
    branch->stable[i] = n_unstable == 0 && !leaves;
    branch->loss[i]   = branch->stable[i] ? MHB_NO_LOSS : n_unstable ? loss : l->loss;
    if (branch->special[i] != MHB_FOLD) continue;
    if (n_unstable == 0) loss = MHB_LOSS_FOLD;
    n_unstable = n_unstable == 0 ? 1 : n_unstable == 1 ? 0 : n_unstable;
  }
}

void mhb_branch_stability_by_folds(mhb_branch *branch, int stable_at) {
  decide(branch, NULL, stable_at);
}

shb_status mhb_branch_stability_judge(mhb_branch_stability *w, mhb_tracer *tracer,
                                      mhb_response *response, int index, const int *begins,
                                      int n_begins, int stable_at, bool *finished) {
  w->tracer   = tracer;
  w->response = response;
  w->branch   = index;
  w->n        = branch_of(w)->n_points;
  w->at       = calloc((size_t)w->n + MAX_LOCATED, sizeof *w->at);
  SHB_CHECK(w->at, SHB_ERR_IO, "out of memory");
  w->judges_all     = judges_all(w);
  w->published      = SHB_OK;
  *finished         = judge_points(w);
  shb_status status = w->published;
  if (*finished && w->judges_all) status = mark_bifurcations(w, begins, n_begins);
  decide(branch_of(w), w->at, stable_at);
  free(w->at);
  w->at = NULL;
  return status;
}
