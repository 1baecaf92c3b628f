#include "mhb/branches/branch_stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/progress.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/event_location.h"

/* Up to CHEAP states every point is judged, up to FINE those that the budget a branch allows, by the measured cost; above that
 * with fewer modes and sub-steps. */
enum {
  CHEAP          = 60,
  FINE           = 120,
  FEWER_STATES   = 320,
  SUBSTEPS       = 256,
  FEWER_SUBSTEPS = 32,
  LEAST_POINTS   = 3
};
static const double BUDGET = .5, FEWER_BUDGET = .1, SECONDS_A_CUBE = 4e-9, SECONDS_A_STATE = 1e-5;

/* Beyond the circle in earnest, and on it after a search. */
static const double MARGIN = 1e-3, ON_CIRCLE = 1e-3, NEAR_ENOUGH = 1e-6;
enum { MAX_LOCATED = 32 };

/* What the multipliers said of a point. */
typedef struct {
  int    known;      /* 0: not computed */
  int    verdict;    /* mhb_verdict */
  int    loss;       /* MHB_LOSS_FOLD ... of the largest */
  int    n_unstable; /* beyond the margin */
  int    swings;     /* the largest other than on the positive axis is beyond the margin */
  double swing;      /* its modulus, less 1; NAN: undecided */
  int    turn;       /* what crosses there: MHB_FLIP, MHB_NEIMARK_SACKER */
} look;

struct mhb_branch_stability {
  mhb_balance *residual;
  mhb_floquet *stability;
  int          states, all; /* all: every point of the branch at work */
  double      *x, *r;       /* [n] */
  /* the branch at work */
  mhb_arclength     *path;
  mhb_response      *response;
  int                branch;
  mhb_branch_editor *host;
  look              *look; /* [point] */
  int                n;
};

/* States of the blade or ring with all its modes, each contact sticking. */
static int count_states(const mhb_balance *b) {
  int blades = b->settings->to_ground ? 1 : b->settings->blades;
  return 2 * blades * (b->receptance->n_modes + b->n_pairs);
}

shb_status mhb_branch_stability_create(mhb_balance *b, mhb_branch_stability **out) {
  mhb_branch_stability *j = calloc(1, sizeof *j);
  SHB_CHECK(j, SHB_ERR_IO, "out of memory");
  j->residual = b;
  j->states   = count_states(b);
  int fine    = j->states <= FINE || b->settings->stability == MHB_STABILITY_ALWAYS;
  j->x        = calloc((size_t)b->n, sizeof(double));
  j->r        = calloc((size_t)b->n, sizeof(double));
  shb_status status =
      j->x && j->r ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK)
    status = mhb_floquet_create(b->receptance, b->settings, fine ? SUBSTEPS : FEWER_SUBSTEPS,
                                fine ? 0 : FEWER_STATES, &j->stability);
  if (status != SHB_OK) {
    mhb_branch_stability_destroy(j);
    return status;
  }
  *out = j;
  return SHB_OK;
}

void mhb_branch_stability_destroy(mhb_branch_stability *j) {
  if (!j) return;
  mhb_floquet_destroy(j->stability);
  free(j->x);
  free(j->r);
  free(j);
}

/* ---- one point ---- */

static mhb_branch *branch_of(const mhb_branch_stability *j) {
  return &j->response->branch[j->branch];
}

static double value_of(const mhb_branch_stability *j, int point) {
  return mhb_parameter_value(j->residual->parameter, branch_of(j)->value[point]);
}

/* Multipliers at the solution that the residual was last evaluated at. */
static void evaluate(mhb_branch_stability *j, const double *x, mhb_multipliers *out) {
  const mhb_balance *b        = j->residual;
  mhb_solution       solution = {b->eval->at.omega, b->law, b->eval->info, x, b->eval->p};
  if (b->settings->run_up) mhb_floquet_move(j->stability, b->receptance);
  mhb_floquet_evaluate(j->stability, &solution, out);
}

/* The largest multiplier that is not on the positive axis; -1: none. */
static int largest_swing(const mhb_multipliers *m) {
  for (int i = 0; i < m->n; i++)
    if (cimag(m->multiplier[i]) != 0 || creal(m->multiplier[i]) < 0) return i;
  return -1;
}

static look look_of(const mhb_multipliers *m) {
  static const int loss[] = {MHB_LOSS_FOLD, MHB_LOSS_FLIP, MHB_LOSS_NEIMARK_SACKER};
  look             out    = {.known      = 1,
                             .verdict    = (int)m->verdict,
                             .loss       = loss[m->crossing],
                             .n_unstable = m->n_unstable,
                             .swing      = NAN};
  int              i      = largest_swing(m);
  if (m->verdict == MHB_UNDECIDED) return out;
  out.swing  = i < 0 ? -1 : cabs(m->multiplier[i]) - 1;
  out.turn   = i < 0 || cimag(m->multiplier[i]) != 0 ? MHB_NEIMARK_SACKER : MHB_FLIP;
  out.swings = m->verdict == MHB_UNSTABLE && out.swing > fmax(MARGIN, m->change);
  return out;
}

/* Into the branch; locked by the caller. */
static void put(const mhb_branch_stability *j, int point, const mhb_multipliers *m) {
  static const int judged[] = {MHB_BY_MULTIPLIERS, MHB_MARGINAL_BY_FOLDS, MHB_BY_MULTIPLIERS,
                               MHB_UNDECIDED_BY_FOLDS};
  mhb_branch      *branch   = branch_of(j);
  int              kept     = j->response->n_multipliers;
  branch->judged[point]     = judged[m->verdict];
  for (int i = 0; i < kept && m->verdict != MHB_UNDECIDED; i++)
    branch->multipliers[(size_t)point * (size_t)kept + (size_t)i] = i < m->n ? m->multiplier[i] : 0;
}

/* false: the host wants to stop. */
static bool judge_point(mhb_branch_stability *j, int point) {
  mhb_multipliers m;
  double          started = shb_seconds(), value = value_of(j, point);
  mhb_recorded_motion(branch_of(j), point, j->residual, j->x);
  mhb_balance_evaluate(j->residual, j->x, value, j->r, NULL, NULL);
  evaluate(j, j->x, &m);
  j->look[point] = look_of(&m);
  j->host->lock(j->host, true);
  put(j, point, &m);
  branch_of(j)->seconds[point] += shb_seconds() - started;
  bool go_on = j->host->point(j->host, value);
  j->host->lock(j->host, false);
  return go_on;
}

/* ---- which points ---- */

/* Stuck or open throughout: the exponents are kept from point to point, and cost little; but not where the speed changes. */
static bool is_linear(const mhb_branch_stability *j, int point) {
  if (j->residual->settings->run_up) return false;
  size_t        pairs = (size_t)j->response->n_pairs;
  const double *share = branch_of(j)->state + 3 * (size_t)point * pairs;
  for (size_t a = 0; a < pairs; a++)
    if (share[3 * a] < 1 && share[3 * a + 2] < 1) return false;
  return true;
}

/* Of the points left, the middle one of the longest stretch between judged ones and folds; -1: none. */
static int next_of_few(const mhb_branch_stability *j) {
  const int *special = branch_of(j)->special;
  int        from = 0, longest = 0, best = -1;
  for (int i = 0; i <= j->n; i++) {
    if (i < j->n && !j->look[i].known && special[i] != MHB_FOLD) continue;
    if (i - from > longest) {
      longest = i - from;
      best    = from + longest / 2;
    }
    from = i + 1;
  }
  return best;
}

/* The largest motion at a point that is left; -1: none. */
static int largest_motion(const mhb_branch_stability *j) {
  double top  = -1;
  int    best = -1;
  for (int i = 0; i < j->n; i++) {
    if (j->look[i].known) continue;
    mhb_recorded_motion(branch_of(j), i, j->residual, j->x);
    double size = mhb_norm(j->x, j->residual->n);
    if (size <= top) continue;
    top  = size;
    best = i;
  }
  return best;
}

/* Points that the budget allows, by the states that are integrated and the cells of the ring that share them (bloch.h). */
static int affordable(const mhb_branch_stability *j) {
  int    few = j->states > FINE, g = mhb_floquet_cells(j->stability);
  double states = few && j->states > FEWER_STATES ? FEWER_STATES : j->states;
  double cube   = SECONDS_A_CUBE * states * states * states * (g > 2 ? 2. : 1.) / (g * g);
  int    n      = (int)((few ? FEWER_BUDGET : BUDGET) / (cube + SECONDS_A_STATE * states));
  return n > LEAST_POINTS ? n : LEAST_POINTS;
}

/* Decided by the branch alone, never by the clock: the same on every machine and for any number of threads. */
static int judges_all(const mhb_branch_stability *j) {
  return j->states <= CHEAP || j->residual->settings->stability == MHB_STABILITY_ALWAYS ||
         (j->states <= FINE && affordable(j) >= j->n);
}

static bool judge_points(mhb_branch_stability *j) {
  bool go_on = true;
  for (int i = 0; i < j->n && go_on; i++)
    if (j->all || is_linear(j, i)) go_on = judge_point(j, i);
  if (j->all) return go_on;
  for (int left = affordable(j), first = 1; left > 0 && go_on; left--, first = 0) {
    int i = first ? largest_motion(j) : next_of_few(j);
    if (i < 0) break;
    go_on = judge_point(j, i);
  }
  return go_on;
}

/* ---- flips and Neimark-Sacker points ---- */

typedef struct {
  mhb_branch_stability *judge;
  mhb_multipliers       last;
  look                  look;
} search;

static double swing_indicator(const mhb_arclength *path, const mhb_curve_point *point,
                              void *context) {
  search *s = context;
  (void)path;
  evaluate(s->judge, point->x, &s->last);
  s->look = look_of(&s->last);
  return fabs(s->look.swing) < NEAR_ENOUGH ? 0 : s->look.swing;
}

/* Where the swing passes 1 between points i - 1 and i; inserted there. A jump across 1 is not marked. */
static shb_status locate(mhb_branch_stability *j, int i) {
  mhb_arclength *path = j->path;
  search         s    = {.judge = j};
  double         at;
  mhb_recorded_motion(branch_of(j), i - 1, j->residual, path->now.x);
  mhb_recorded_motion(branch_of(j), i, j->residual, path->next.x);
  path->now.value  = value_of(j, i - 1);
  path->next.value = value_of(j, i);
  if (!mhb_arclength_locate(path, swing_indicator, &s, j->look[i - 1].swing, j->look[i].swing,
                            &at) ||
      !(fabs(s.look.swing) < ON_CIRCLE))
    return SHB_OK;
  int turn = s.look.turn;
  SHB_TRY(j->host->insert(j->host, &path->probe, turn, i));
  j->host->lock(j->host, true);
  put(j, i, &s.last);
  j->host->lock(j->host, false);
  memmove(j->look + i + 1, j->look + i, sizeof *j->look * (size_t)(j->n - i));
  j->look[i] = s.look;
  j->n++;
  return SHB_OK;
}

static bool begins(const int *first, int n_first, int point) {
  for (int k = 0; k < n_first; k++)
    if (first[k] == point) return true;
  return false;
}

/* Points first..last - 1 in a row have a swing above 1, one of them well above. Slip onset brings multipliers close to 1: not
 * marked. */
static bool is_in_earnest(const mhb_branch_stability *j, int from, int to) {
  for (int i = from; i < to; i++)
    if (j->look[i].swings) return true;
  return false;
}

/* From the end, so that places before stay valid. */
static shb_status mark_turns(mhb_branch_stability *j, const int *first, int n_first) {
  int located = 0, to = j->n;
  while (to > 0 && located + 2 <= MAX_LOCATED) {
    int from = to - 1;
    if (!(j->look[from].swing > 0) || !j->look[from].known) {
      to--;
      continue;
    }
    while (from > 0 && j->look[from - 1].known && j->look[from - 1].swing > 0 &&
           !begins(first, n_first, from))
      from--;
    if (is_in_earnest(j, from, to)) {
      bool ends   = to < j->n && j->look[to].known && j->look[to].swing <= 0;
      bool starts = from > 0 && j->look[from - 1].known && j->look[from - 1].swing <= 0;
      for (int i = from; i < to; i++) j->look[i].swings = 1;
      if (ends && !begins(first, n_first, to)) SHB_TRY(locate(j, to));
      if (starts && !begins(first, n_first, from)) SHB_TRY(locate(j, from));
      located += 2;
    }
    to = from;
  }
  return SHB_OK;
}

/* ---- the verdict ---- */

/* Point i is where the curve came back to the end of the range at which point i - 1 left it. Its direction has changed: an odd number of
 * folds lies outside. */
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

/* looks: NULL, or [point]. */
static void decide(mhb_branch *branch, const look *looks, int stable_at) {
  int n_unstable = parity(branch, stable_at), loss = n_unstable ? MHB_LOSS_FOLD : MHB_NO_LOSS;
  for (int i = 0; i < branch->n_points; i++) {
    if (comes_back(branch, i)) {
      if (n_unstable == 0) loss = MHB_LOSS_FOLD;
      n_unstable = n_unstable == 0 ? 1 : n_unstable == 1 ? 0 : n_unstable;
    }
    const look *l = looks && looks[i].known ? &looks[i] : NULL;
    if (l && (l->verdict == MHB_STABLE || l->verdict == MHB_UNSTABLE)) {
      n_unstable = l->verdict == MHB_STABLE ? 0 : l->n_unstable;
      loss       = l->loss;
    }
    bool swings       = l && l->swings; /* marginal, between a crossing and a point beyond doubt */
    branch->stable[i] = n_unstable == 0 && !swings;
    branch->loss[i]   = branch->stable[i] ? MHB_NO_LOSS : n_unstable ? loss : l->loss;
    if (branch->special[i] != MHB_FOLD) continue;
    if (n_unstable == 0) loss = MHB_LOSS_FOLD;
    n_unstable = n_unstable == 0 ? 1 : n_unstable == 1 ? 0 : n_unstable;
  }
}

void mhb_branch_stability_by_folds(mhb_branch *branch, int stable_at) {
  decide(branch, NULL, stable_at);
}

shb_status mhb_branch_stability_judge(mhb_branch_stability *j, mhb_arclength *path,
                                      mhb_response *response, int index, const int *first,
                                      int n_first, mhb_branch_editor *host, bool *finished) {
  j->path     = path;
  j->response = response;
  j->branch   = index;
  j->host     = host;
  j->n        = branch_of(j)->n_points;
  j->look     = calloc((size_t)j->n + MAX_LOCATED, sizeof *j->look);
  SHB_CHECK(j->look, SHB_ERR_IO, "out of memory");
  j->all            = judges_all(j);
  *finished         = judge_points(j);
  shb_status status = *finished && j->all ? mark_turns(j, first, n_first) : SHB_OK;
  host->lock(host, true);
  decide(branch_of(j), j->look, host->stable_at);
  host->lock(host, false);
  free(j->look);
  j->look = NULL;
  return status;
}
