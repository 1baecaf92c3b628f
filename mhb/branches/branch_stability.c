#include "mhb/branches/branch_stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/corrector.h"
#include "mhb/continuation/event_location.h"
#include "mhb/floquet/curve_verdicts.h"
#include "mhb/floquet/floquet.h"

/* Up to CHEAP states every point is judged, above if the expected cost of all is within BUDGET. At
 * least LEAST_POINTS slipping points are judged in any case.
 *
 * SUBSTEPS are those to begin with; there are fewer above DEAR states. With 256 instead of 128 the
 * multipliers of the example of 40 blades change by 9e-4 of themselves at most. MAX_STATES leave
 * 5 of its 20 modes dynamic, up to 5 times the highest frequency. Against 11 modes and twice the
 * sub-steps the largest multipliers of 237 points are within 3.0e-3. 6 modes give 3.5e-3. */
enum {
  CHEAP         = 60,
  DEAR          = 120,
  MAX_STATES    = 500,
  SUBSTEPS      = 256,
  SUBSTEPS_DEAR = 128,
  LEAST_POINTS  = 12
};
static const double BUDGET = 0.8, SECONDS_A_CUBE = 1.5e-9, SECONDS_A_STATE = 1e-5;

/* A mistuned ring is integrated over the whole period with the events of all blades: a state and
 * blade squared takes this on top. */
static const double SECONDS_MISTUNED = 5e-7;

/* The largest modulus changes by less than SENSITIVE times the relative change of the motion while
 * contacts keep their transitions. That is ten times the most seen, 0.9 at 60 points of a ring of
 * 96 blades. Where a transition appears it jumps, there by 0.014. Nearer to the border than JUMP
 * the transitions are compared. */
static const double SENSITIVE = 10, JUMP = 0.05;

/* Distances of a modulus from 1: the margin outside that counts as unstable, the accuracy of a
 * located bifurcation, and the end of the search. It is COARSE above DEAR states. A search takes
 * MOST_TRIALS multipliers at most: a test function that jumps is not followed further. */
static const double MARGIN = 1e-3, ON_CIRCLE = 1e-3, NEAR_ENOUGH = 1e-6, COARSE = 5e-4;
enum { MAX_LOCATED = 32, MOST_TRIALS = 24, MOST_TRIALS_DEAR = 4 };

/* The multipliers' verdict on a point. */
typedef struct {
  int    computed;       /* 0: not computed */
  int    verdict;        /* mhb_verdict */
  int    loss;           /* MHB_LOSS_FOLD ... */
  double excess;         /* of the largest modulus over 1 */
  double error;          /* of it, by the harmonics left out */
  int    leaves_complex; /* the largest that is not on the positive axis is outside by the margin */
  double complex_excess; /* its modulus, less 1; NAN: undecided */
  int    bifurcation;    /* where it crosses the circle: MHB_FLIP, MHB_NEIMARK_SACKER */
} point_stability;

struct mhb_branch_stability {
  mhb_balance *balance;
  mhb_floquet *floquet;
  int          states; /* of all modes */
  double      *x, *r;  /* [n] */
  /* the branch at work */
  mhb_tracer      *tracer;
  mhb_response    *response;
  int              branch;
  point_stability *at;      /* [point] */
  int             *decided; /* [point] judged point whose verdict holds here too; -1: none */
  int              n;
  bool            *begins;    /* [point] the curve begins there, or anew after a gap */
  shb_status       published; /* first failure of a publication */
};

/* Number of states of the blade or ring with all its modes, each contact sticking. */
static int count_states(const mhb_balance *b) {
  int blades = b->settings->to_ground || b->receptance->ring ? 1 : b->settings->blades;
  return 2 * blades * (b->receptance->n_modes + b->n_pairs);
}

shb_status mhb_branch_floquet_create(mhb_balance *b, mhb_floquet **floquet) {
  mhb_settings settings = *b->settings;
  settings.harmonics    = 2 * b->m; /* of the solution that tells the error */
  return mhb_floquet_create(b->receptance, &settings,
                            count_states(b) > DEAR ? SUBSTEPS_DEAR : SUBSTEPS, MAX_STATES, floquet);
}

/* x[n] of the last evaluation of the balance. */
static mhb_solution solution_of(mhb_floquet *floquet, const mhb_balance *b, const double *x) {
  const mhb_evaluation *e = b->eval;
  if (b->settings->run_up) mhb_floquet_move(floquet, b->receptance);
  return (mhb_solution){e->at.omega, b->law, e->info, x, e->p, b->m};
}

void mhb_branch_floquet_evaluate(mhb_floquet *floquet, const mhb_balance *b, const double *x,
                                 mhb_multipliers *out) {
  const mhb_solution solution = solution_of(floquet, b, x);
  mhb_floquet_evaluate(floquet, &solution, out);
}

/* Whether the contacts of both pass the same number of transitions. */
static bool has_same_events(const mhb_balance *a, const mhb_balance *b) {
  for (int i = 0; i < a->n_pairs; i++)
    if (a->eval->info[i].n_transitions != b->eval->info[i].n_transitions) return false;
  return true;
}

void mhb_branch_floquet_judge(mhb_floquet *floquet, mhb_balance *b, mhb_truncation *t,
                              const mhb_judged_point *at, mhb_multipliers *out) {
  const double foreseen = SENSITIVE * at->error;
  mhb_branch_floquet_evaluate(floquet, b, at->x, out);
  if (out->reason) return;
  if (mhb_balance_is_linear(b) || mhb_floquet_distance(out) > fmax(foreseen, JUMP)) {
    mhb_floquet_set_error(mhb_balance_is_linear(b) ? 0 : fmax(foreseen, JUMP), out);
    return;
  }
  mhb_balance_linearise(b, at->x, at->value, t->r, NULL);
  /* the step of GMRES depends on them a little, so the point alone must decide on them */
  if (t->factors) mhb_ring_system_factor(t->factors, NULL, NULL);
  if (!mhb_truncation_correct(t, at->x, at->value)) {
    mhb_floquet_set_error(INFINITY, out);
    return;
  }
  const double part = mhb_norm(t->step, t->doubled->n) / mhb_balance_vibration(b, at->x);
  const double most = SENSITIVE * part / (1 - t->remaining);
  if (has_same_events(b, t->doubled) && mhb_floquet_distance(out) > most) {
    mhb_floquet_set_error(most, out);
    return;
  }
  const mhb_solution corrected = solution_of(floquet, t->doubled, t->x);
  mhb_floquet_judge_error(floquet, &corrected, t->remaining, out);
}

double mhb_branch_floquet_bytes(int blades, int pairs, int modes, bool mistuned) {
  return mhb_floquet_bytes(blades, pairs, modes, mistuned, MAX_STATES);
}

shb_status mhb_branch_stability_create(mhb_balance *b, mhb_branch_stability **out) {
  mhb_branch_stability *w = shb_alloc_zeroed(1, sizeof *w);
  w->balance              = b;
  w->states               = count_states(b);
  w->x                    = shb_alloc_zeroed((size_t)b->n, sizeof(double));
  w->r                    = shb_alloc_zeroed((size_t)b->n, sizeof(double));
  shb_status status       = mhb_branch_floquet_create(b, &w->floquet);
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

static void evaluate(mhb_branch_stability *w, const double *x, mhb_multipliers *out) {
  mhb_branch_floquet_evaluate(w->floquet, w->balance, x, out);
}

/* The largest multiplier that is not on the positive axis; -1: none. */
static int largest_complex(const mhb_multipliers *m) {
  for (int i = 0; i < m->n; i++)
    if (cimag(m->multiplier[i]) != 0 || creal(m->multiplier[i]) < 0) return i;
  return -1;
}

static point_stability stability_of(const mhb_multipliers *m) {
  static const int loss[] = {MHB_LOSS_FLIP, MHB_LOSS_FLIP, MHB_LOSS_NEIMARK_SACKER};
  point_stability  out    = {.computed       = 1,
                             .verdict        = (int)m->verdict,
                             .loss           = loss[m->crossing],
                             .excess         = m->largest - 1,
                             .error          = m->error,
                             .complex_excess = NAN};
  int              i      = largest_complex(m);
  if (m->reason) return out;
  if (m->n_fold > 0) out.loss = MHB_LOSS_FOLD;
  out.complex_excess = i < 0 ? -1 : cabs(m->multiplier[i]) - 1;
  out.bifurcation    = i < 0 || cimag(m->multiplier[i]) != 0 ? MHB_NEIMARK_SACKER : MHB_FLIP;
  out.leaves_complex = m->verdict == MHB_UNSTABLE && out.complex_excess > fmax(MARGIN, m->change);
  return out;
}

/* Write the multipliers of a point into the branch. */
static void put(const mhb_branch_stability *w, int point, const mhb_multipliers *m) {
  static const int judged[]       = {MHB_BY_MULTIPLIERS, MHB_JUDGED_MARGINAL, MHB_BY_MULTIPLIERS,
                                     MHB_JUDGED_UNDECIDED};
  mhb_branch      *branch         = branch_of(w);
  int              kept           = w->response->n_multipliers;
  branch->judged[point]           = judged[m->verdict];
  branch->error_multiplier[point] = isfinite(m->error) ? m->error : -1;
  for (int i = 0; i < kept && !m->reason; i++)
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
  const mhb_judged_point at = {w->x, value, branch_of(w)->error_truncation[point]};
  mhb_truncation        *t  = mhb_harmonic_levels_current(w->tracer->levels)->truncation;
  mhb_branch_floquet_judge(w->floquet, w->balance, t, &at, &m);
  w->at[point] = stability_of(&m);
  put(w, point, &m);
  branch_of(w)->seconds[point] += shb_seconds() - started;
  w->published = mhb_monitor_publish_if_due(monitor, w->response);
  return w->published == SHB_OK && monitor->point(monitor, w->response, w->branch, point);
}

/* ---- which points ---- */

/* Whether all contacts stick or are open throughout. The exponents of the last point are used again
 * then, at little cost. In a run-up they change with the speed. */
static bool is_linear_point(const mhb_branch_stability *w, int point) {
  return mhb_response_is_linear(w->response, branch_of(w), point);
}

/* The point where the first output is largest: that of the headline. */
static int highest_output(const mhb_branch_stability *w) {
  double top  = -1;
  int    best = -1;
  for (int i = 0; i < w->n; i++) {
    const double size = mhb_response_output(w->response, branch_of(w), i);
    if (size <= top) continue;
    top  = size;
    best = i;
  }
  return w->at[best].computed ? -1 : best;
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

/* Number of slipping points that the budget allows, by the states integrated and the cells of the
 * ring (bloch.h). */
static int affordable(const mhb_branch_stability *w) {
  int    g      = mhb_floquet_cells(w->floquet);
  double states = mhb_floquet_states(w->floquet);
  double cube   = SECONDS_A_CUBE * states * states * states * (g > 2 ? 2. : 1.) / (g * g);
  double blades = w->balance->receptance->ring ? w->balance->receptance->ring->blades : 0;
  double period = SECONDS_A_STATE + SECONDS_MISTUNED * blades * blades;
  int    n      = (int)(BUDGET / (cube + period * states));
  return n > LEAST_POINTS ? n : LEAST_POINTS;
}

/* Whether every point is judged. The branch alone decides, never the clock, so the result is the
 * same on every machine and for any number of threads. */
static bool judges_all(const mhb_branch_stability *w) {
  int slipping = 0;
  for (int i = 0; i < w->n; i++) slipping += !is_linear_point(w, i);
  return w->states <= CHEAP || w->balance->settings->stability == MHB_STABILITY_ALWAYS ||
         affordable(w) >= slipping;
}

static mhb_stability_kind kind_of(const point_stability *at) {
  if (at->verdict != MHB_UNSTABLE) return MHB_KIND_STABLE;
  return at->loss == MHB_LOSS_FOLD ? MHB_KIND_BEYOND_FOLD : MHB_KIND_MODULATED;
}

/* What is known of the points, for the choice of the next. */
static void set_verdicts(const mhb_branch_stability *w, mhb_curve_verdict *verdict) {
  const int *special = branch_of(w)->special;
  for (int i = 0; i < w->n; i++) {
    const point_stability *at   = &w->at[i];
    bool                   fail = at->computed && at->verdict == MHB_UNDECIDED;
    bool                   fold = special[i] == MHB_FOLD;
    verdict[i]                  = (mhb_curve_verdict){.judged    = at->computed && !fail,
                                                      .undecided = fail,
                                                      .divides   = fold || is_linear_point(w, i),
                                                      .begins    = w->begins[i],
                                                      .wanted    = special[i] == MHB_PEAK,
                                                      .kind      = kind_of(at),
                                                      .excess    = at->excess};
  }
}

/* Slipping points, one after the other, until their neighbours decide the rest or the budget is
 * used. */
static bool judge_some(mhb_branch_stability *w, mhb_curve_verdict *verdict) {
  const int highest = highest_output(w);
  bool      go_on   = highest < 0 || judge_point(w, highest);
  for (int left = affordable(w), first = 1; left > 0 && go_on; left--, first = 0) {
    set_verdicts(w, verdict);
    int i = first ? largest_motion(w) : mhb_curve_verdicts_next(w->n, verdict);
    if (i < 0) break;
    go_on = judge_point(w, i);
  }
  set_verdicts(w, verdict);
  mhb_curve_verdicts_decided(w->n, verdict, w->decided);
  return go_on;
}

static shb_status judge_points(mhb_branch_stability *w, bool *finished) {
  bool go_on = true, all = judges_all(w);
  for (int i = 0; i < w->n; i++) w->decided[i] = -1;
  for (int i = 0; i < w->n && go_on; i++)
    if (all || is_linear_point(w, i)) go_on = judge_point(w, i);
  if (!all && go_on) {
    mhb_curve_verdict *verdict = shb_alloc_zeroed((size_t)w->n + 1, sizeof *verdict);
    go_on                      = judge_some(w, verdict);
    free(verdict);
  }
  *finished = go_on;
  return w->published;
}

/* ---- flips and Neimark-Sacker points ---- */

typedef struct {
  mhb_branch_stability *stability;
  mhb_multipliers       last;
  point_stability       at;
  int                   trials; /* left */
  double                enough;
} search;

static double excess_test(mhb_arclength *curve, const mhb_curve_point *point, void *context) {
  search *s = context;
  (void)curve;
  mhb_balance_use(s->stability->balance, point->evaluation);
  evaluate(s->stability, point->x, &s->last);
  s->at     = stability_of(&s->last);
  bool ends = fabs(s->at.complex_excess) < s->enough || --s->trials <= 0;
  return ends ? 0 : s->at.complex_excess;
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
  bool           dear  = w->states > DEAR;
  search         s     = {.stability = w,
                          .trials    = dear ? MOST_TRIALS_DEAR : MOST_TRIALS,
                          .enough    = dear ? COARSE : NEAR_ENOUGH};
  double         at, chord[curve->n + 1];
  set_point(w, i - 1, &curve->current);
  set_point(w, i, &curve->next);
  for (int k = 0; k < curve->n; k++) chord[k] = curve->next.x[k] - curve->current.x[k];
  chord[curve->n] = curve->next.value - curve->current.value;
  if (!mhb_arclength_set_tangent(curve, chord, &curve->current) ||
      !mhb_arclength_set_tangent(curve, chord, &curve->next) ||
      !mhb_arclength_locate(curve, excess_test, &s, w->at[i - 1].complex_excess,
                            w->at[i].complex_excess, 0, &at) ||
      !(fabs(s.at.complex_excess) < ON_CIRCLE))
    return SHB_OK;
  mhb_harmonic_levels_errors(w->tracer->levels, &curve->trial);
  mhb_harmonic_levels_settle(w->tracer->levels, &curve->trial);
  mhb_record(w->response, w->branch, w->balance, &curve->trial, s.at.bifurcation, 0);
  mhb_response_place(w->response, w->branch, i);
  put(w, i, &s.last);
  memmove(w->at + i + 1, w->at + i, sizeof *w->at * (size_t)(w->n - i));
  memmove(w->decided + i + 1, w->decided + i, sizeof *w->decided * (size_t)(w->n - i));
  for (int k = i + 1; k <= w->n; k++) w->decided[k] += w->decided[k] >= i;
  memmove(w->begins + i + 1, w->begins + i, sizeof *w->begins * (size_t)(w->n - i));
  w->begins[i]  = false;
  w->at[i]      = s.at;
  w->decided[i] = -1;
  w->n++;
  return SHB_OK;
}

/* Whether a complex or negative multiplier is outside the unit circle, or is taken to be. */
static bool is_outside(const mhb_branch_stability *w, int i) {
  const point_stability *at = w->decided[i] < 0 ? &w->at[i] : &w->at[w->decided[i]];
  return at->computed && at->complex_excess > 0;
}

/* Whether one of the points from..to - 1 has such a multiplier outside by more than the margin. The
 * onset of slip brings multipliers close to 1, which are not marked. */
static bool leaves_by_margin(const mhb_branch_stability *w, int from, int to) {
  for (int i = from; i < to; i++)
    if (w->at[i].leaves_complex) return true;
  return false;
}

/* Whether such a multiplier crosses the circle between points i - 1 and i, both judged. */
static bool crosses(const mhb_branch_stability *w, int i) {
  if (i < 1 || i >= w->n || w->begins[i] || !w->at[i].computed || !w->at[i - 1].computed)
    return false;
  return (w->at[i].complex_excess <= 0) != (w->at[i - 1].complex_excess <= 0) &&
         !isnan(w->at[i].complex_excess) && !isnan(w->at[i - 1].complex_excess);
}

/* Mark all bifurcations, from the last point to the first, so that indices before stay valid. */
static shb_status mark_bifurcations(mhb_branch_stability *w) {
  int located = 0, to = w->n;
  while (to > 0 && located + 2 <= MAX_LOCATED) {
    int from = to - 1;
    if (!is_outside(w, from)) {
      to--;
      continue;
    }
    while (from > 0 && is_outside(w, from - 1) && !w->begins[from]) from--;
    int end = to;
    to      = from;
    if (!leaves_by_margin(w, from, end)) continue;
    for (int i = from; i < end; i++) w->at[i].leaves_complex = w->at[i].computed;
    if (crosses(w, end)) SHB_TRY(locate(w, end));
    if (crosses(w, from)) SHB_TRY(locate(w, from));
    located += 2;
  }
  return SHB_OK;
}

/* ---- the verdict ---- */

static void set(mhb_branch *branch, int i, bool stable, int loss, int judged) {
  branch->stable[i] = stable;
  branch->loss[i]   = stable ? MHB_NO_LOSS : loss;
  branch->judged[i] = judged;
}

/* Nearest point with a decisive verdict in direction step; NULL: none before a gap. */
static const point_stability *decisive_beside(const mhb_branch_stability *w, int point, int step) {
  for (int i = point + step; i >= 0 && i < w->n; i += step) {
    if (w->begins[step > 0 ? i : i + 1]) return NULL;
    const point_stability *at = &w->at[i];
    if (at->computed && (at->verdict == MHB_STABLE || at->verdict == MHB_UNSTABLE)) return at;
  }
  return NULL;
}

/* A multiplier at 1 within its accuracy. Such a motion is called stable, unless it is on both sides
 * unstable, or belongs to a stretch outside. */
static void decide_marginal(mhb_branch_stability *w, int i) {
  const point_stability *side[2] = {decisive_beside(w, i, -1), decisive_beside(w, i, 1)};
  int                    n = 0, loss = w->at[i].loss;
  for (int k = 0; k < 2; k++) n += side[k] && side[k]->verdict == MHB_UNSTABLE;
  if (n == 2 && branch_of(w)->special[i] == MHB_FOLD) loss = side[0]->loss;
  set(branch_of(w), i, n < 2 && !w->at[i].leaves_complex, loss, MHB_JUDGED_MARGINAL);
}

static void decide(mhb_branch_stability *w) {
  mhb_branch *branch = branch_of(w);
  for (int i = 0; i < w->n; i++) {
    int                    from = w->decided[i] < 0 ? i : w->decided[i];
    const point_stability *at   = &w->at[from];
    int                    how  = from == i ? branch->judged[i] : MHB_BY_NEIGHBOURS;
    if (!at->computed || at->verdict == MHB_UNDECIDED) continue;
    if (at->verdict == MHB_MARGINAL && from == i) {
      decide_marginal(w, i);
    } else {
      set(branch, i, at->verdict != MHB_UNSTABLE, at->loss, how);
    }
  }
}

/* Whether the curve came back at point i to the end of the range at which point i - 1 left it. Its
 * direction has changed, so an odd number of folds lies outside. */
static bool comes_back(const mhb_branch *branch, int i) {
  return i > 0 && branch->value[i] == branch->value[i - 1] && branch->special[i] == MHB_ORDINARY &&
         branch->special[i - 1] == MHB_ORDINARY;
}

/* One point further from `i` in direction step: whether the number of folds passed changes. */
static bool passes_fold(const mhb_branch *branch, int i, int step) {
  return comes_back(branch, step > 0 ? i : i + 1) ^ (branch->special[i - step] == MHB_FOLD);
}

/* Whether nothing is known of the folds between `i` and the point before it. Of a curve that left
 * the range and came back it is. */
static bool is_cut(const mhb_branch *branch, const bool *gap, int i, int step) {
  int later = step > 0 ? i : i + 1;
  return gap[later] && !comes_back(branch, later);
}

/* Whether the next stable point in direction step is an odd number of folds away: a fold is not
 * known, and nothing follows. */
static bool contradicts(const mhb_branch *branch, const bool *gap, const bool *stable, int from,
                        int step) {
  bool odd = false;
  for (int i = from + step; i >= 0 && i < branch->n_points; i += step) {
    if (is_cut(branch, gap, i, step)) return false;
    odd ^= passes_fold(branch, i, step);
    if (stable[i]) return odd;
  }
  return false;
}

/* Points from a stable one on in direction step, up to the next. Beyond an odd number of folds a
 * multiplier is beyond +1: the point is unstable, judged or not. Beyond an even number none need
 * be: real multipliers that grew out of a pair are no fold. */
static void count_folds(mhb_branch *branch, const bool *gap, const bool *stable, int from,
                        int step) {
  bool odd = false;
  if (contradicts(branch, gap, stable, from, step)) return;
  for (int i = from + step; i >= 0 && i < branch->n_points && !stable[i]; i += step) {
    if (is_cut(branch, gap, i, step)) return;
    odd ^= passes_fold(branch, i, step);
    if (branch->special[i] == MHB_FOLD) continue;
    if (odd && branch->stable[i] < 0) set(branch, i, false, MHB_LOSS_FOLD, MHB_BY_FOLDS);
    if (odd && branch->stable[i] == 0) branch->loss[i] = MHB_LOSS_FOLD;
    if (!odd && branch->loss[i] == MHB_LOSS_FOLD) branch->loss[i] = MHB_LOSS_FLIP;
  }
}

/* Folds on both sides of every stable point [point]. */
static void decide_by_folds(mhb_branch *branch, const bool *gap, const bool *stable) {
  for (int i = 0; i < branch->n_points; i++)
    for (int step = -1; step < 2 && stable[i]; step += 2) count_folds(branch, gap, stable, i, step);
}

/* A fold whose multipliers were not computed, between two sides of one verdict. */
static void decide_folds(mhb_branch *branch) {
  for (int i = 1; i + 1 < branch->n_points; i++) {
    const int *side = &branch->stable[i];
    if (branch->special[i] != MHB_FOLD || *side >= 0 || side[-1] < 0 || side[1] != side[-1])
      continue;
    set(branch, i, side[1] == 1, branch->loss[i - 1], MHB_BY_NEIGHBOURS);
  }
}

static void forget(mhb_branch *branch) {
  for (int i = 0; i < branch->n_points; i++) {
    branch->stable[i] = -1;
    branch->loss[i]   = MHB_NO_LOSS;
    branch->judged[i] = MHB_NOT_JUDGED;
  }
}

/* begins[point] and a further array of flags, all false but for the beginnings.
 * room: points. */
static bool *flags(const int *begins, int n_begins, size_t room) {
  bool *flag = shb_alloc_zeroed(2 * room, sizeof *flag);
  for (int k = 0; k < n_begins; k++) flag[begins[k]] = begins[k] > 0;
  return flag;
}

void mhb_branch_stability_by_folds(mhb_branch *branch, const int *begins, int n_begins,
                                   int stable_at) {
  size_t n                        = (size_t)branch->n_points;
  bool  *flag                     = flags(begins, n_begins, n + 1);
  flag[n + 1 + (size_t)stable_at] = true;
  forget(branch);
  decide_by_folds(branch, flag, flag + n + 1);
  free(flag);
}

/* Verdicts of the points judged, of those that their neighbours decide, and by folds. stable: an
 * array of flags. */
static void decide_all(mhb_branch_stability *w, bool *stable) {
  mhb_branch *branch = branch_of(w);
  decide(w);
  for (int i = 0; i < w->n; i++)
    stable[i] =
        w->at[i].computed && w->at[i].verdict == MHB_STABLE && branch->special[i] != MHB_FOLD;
  decide_by_folds(branch, w->begins, stable);
  decide_folds(branch);
}

shb_status mhb_branch_stability_judge(mhb_branch_stability *w, mhb_tracer *tracer,
                                      mhb_response *response, int index, const int *begins,
                                      int n_begins, bool *finished) {
  w->tracer    = tracer;
  w->response  = response;
  w->branch    = index;
  w->n         = branch_of(w)->n_points;
  size_t room  = (size_t)w->n + MAX_LOCATED;
  w->at        = shb_alloc_zeroed(room, sizeof *w->at);
  w->decided   = shb_alloc_zeroed(room, sizeof *w->decided);
  w->begins    = flags(begins, n_begins, room);
  w->published = SHB_OK;
  forget(branch_of(w));
  shb_status status = judge_points(w, finished);
  if (status == SHB_OK && *finished) status = mark_bifurcations(w);
  if (status == SHB_OK) decide_all(w, w->begins + room);
  free(w->at);
  free(w->decided);
  free(w->begins);
  w->at      = NULL;
  w->decided = NULL;
  w->begins  = NULL;
  return status;
}
