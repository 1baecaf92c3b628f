#include "mhb/tracking/corner_point.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/base/root.h"
#include "mhb/contact/slip_onset.h"
#include "mhb/numerics/vector.h"

/* Brackets of omega end at these lengths, relative. */
static const double EXACT_OMEGA = 1e-14, EXACT_PEAK = 1e-11;

/* How far a root is sought from its guess, relative. */
static const double REACH = 0.02;

/* The secant method's first step, and the longest step of both methods, relative. */
static const double SECANT = 1e-6, NEARBY = 2e-3;

/* Newton's method at fixed omega ends at SOLVED. Where round-off ends it earlier, ALMOST
 * will do. */
static const double SOLVED = 1e-12, ALMOST = 1e-9;

/* Newton's method for a corner ends at this relative step. */
static const double LAST_STEP = 1e-12;

/* Relative step of the difference in a parameter of the law. */
static const double VALUE_STEP = 1e-3;

/* Pairs whose h differ by less than this share of the limit are alike. */
static const double ALIKE = 1e-7;

/* Stuck motions are followed from this distance on the stuck side, relative. A corner overhangs if
 * they go on beyond it by OVERHANG. Their end is bracketed to OVERHANG_ENDS. */
static const double APPROACH = 1e-3, OVERHANG = 5e-8, OVERHANG_ENDS = 1e-10;

enum { MOST_SECANTS = 8, MOST_NEWTON = 15 };

static size_t block_of(const mhb_balance *b) {
  return 3 * (size_t)b->nb;
}

static mhb_slip_onset onset_of(const mhb_balance *b, const double *x, int pair) {
  mhb_slip_onset onset;
  mhb_slip_onset_find(&b->law[pair], b->m, x + (size_t)pair * block_of(b), &onset);
  return onset;
}

/* ---- which pairs touch ---- */

/* The pairs of a set as near to slip as one of them. */
static void take_alike(mhb_corner *c, const bool *of, int pair) {
  const mhb_balance   *b  = c->balance;
  const mhb_slip_onset at = onset_of(b, c->x, pair);
  for (int a = 0; a < b->n_pairs; a++) {
    c->touching[a] = a == pair;
    if (!c->touching[a] && of[a])
      c->touching[a] = fabs(onset_of(b, c->x, a).h - at.h) <= ALIKE * fabs(at.limit);
  }
}

/* The pair of a set with the largest h at c->x. */
static int nearest_to_slip(const mhb_corner *c, const bool *of, double *h) {
  int best = -1;
  *h       = -INFINITY;
  for (int a = 0; a < c->balance->n_pairs; a++) {
    if (!of[a]) continue;
    const double here = onset_of(c->balance, c->x, a).h;
    if (best >= 0 && here <= *h) continue;
    *h   = here;
    best = a;
  }
  return best;
}

/* A pair is open throughout. */
static bool is_open(const mhb_balance *b, const double *x, int pair) {
  const mhb_law *law       = &b->law[pair];
  const double  *v         = x + (size_t)pair * block_of(b);
  double         vibration = 0;
  for (int k = 1; k <= b->m; k++) vibration += hypot(v[2 * k - 1], v[2 * k]);
  return law->n0 + law->kv * (v[0] + vibration) <= 0;
}

int mhb_corner_candidates(const mhb_corner *c, double value, const double *x, double share,
                          int *pair) {
  mhb_balance *b = c->balance;
  double       h[b->n_pairs], limit[b->n_pairs];
  int          n = 0;
  mhb_balance_go_to(b, c->tracking->parameter, value);
  for (int a = 0; a < b->n_pairs; a++) {
    if (is_open(b, x, a)) continue;
    const mhb_slip_onset at = onset_of(b, x, a);
    if (!(fabs(at.h) <= share * fabs(at.limit))) continue;
    bool alike = false;
    for (int i = 0; i < n && !alike; i++) alike = fabs(at.h - h[pair[i]]) <= ALIKE * limit[pair[i]];
    if (alike) continue;
    h[a]     = at.h;
    limit[a] = fabs(at.limit);
    int to   = n++;
    for (; to > 0 && fabs(h[a]) * limit[pair[to - 1]] < fabs(h[pair[to - 1]]) * limit[a]; to--)
      pair[to] = pair[to - 1];
    pair[to] = a;
  }
  return n;
}

void mhb_corner_take(mhb_corner *c, int pair, double value, const double *x) {
  mhb_balance *b = c->balance;
  mhb_balance_go_to(b, c->tracking->parameter, value);
  memmove(c->x, x, sizeof *x * (size_t)b->n);
  c->stuck = pair < 0;
  for (int a = 0; a < b->n_pairs; a++) c->closed[a] = !is_open(b, x, a);
  if (!c->stuck) take_alike(c, c->closed, pair);
}

/* ---- at one (omega, q) ---- */

/* Newton's method at fixed omega. False: the motion is as before. */
static bool settle(mhb_corner *c, double omega) {
  mhb_balance *b = c->balance;
  int          iterations;
  memcpy(c->kept, c->x, sizeof *c->x * (size_t)b->n);
  b->touching       = c->touching;
  mhb_reason reason = mhb_newton_solve(c->newton, b, omega, SOLVED, c->x, &iterations);
  b->touching       = NULL;
  if (reason == MHB_CONVERGED) return true;
  if (reason != MHB_SINGULAR && mhb_norm(c->newton->r, b->n) <= ALMOST * mhb_norm(c->x, b->n))
    return true;
  memcpy(c->x, c->kept, sizeof *c->x * (size_t)b->n);
  return false;
}

/* All pairs that are not open stick. Of those the one nearest to slip touches; the others have the
 * least mean friction of their own law. */
static bool settle_stuck(mhb_corner *c, double omega) {
  const mhb_balance *b = c->balance;
  double             h;
  memcpy(c->touching, c->closed, sizeof *c->closed * (size_t)b->n_pairs);
  if (!settle(c, omega)) return false;
  const int nearest = nearest_to_slip(c, c->closed, &h);
  if (nearest < 0) return false;
  bool several = false;
  for (int a = 0; a < b->n_pairs; a++) several = several || (c->closed[a] && a != nearest);
  if (!several) return true;
  take_alike(c, c->closed, nearest);
  if (settle(c, omega)) return true;
  memcpy(c->touching, c->closed, sizeof *c->closed * (size_t)b->n_pairs);
  return settle(c, omega);
}

/* The output's amplitude and its gradient at the point that was evaluated last. */
static mhb_amplitude output_at(mhb_corner *c) {
  mhb_amplitude a = {.by_x = c->by_x, .weight = c->weight, .size = c->tracking->size};
  mhb_output_amplitude(c->balance, c->x, c->tracking->output, &a);
  return a;
}

mhb_corner_state mhb_corner_evaluate(mhb_corner *c, double omega, double value) {
  mhb_corner_state state = {NAN, NAN, NAN, NAN, NAN, NAN};
  mhb_balance_go_to(c->balance, c->tracking->parameter, value);
  if (!(c->stuck ? settle_stuck(c, omega) : settle(c, omega))) return state;
  state.amplitude = output_at(c).amplitude;
  nearest_to_slip(c, c->touching, &state.onset);
  return state;
}

/* v[n] <- r~_x^-1 v */
static void solve_linear(const mhb_corner *c, double *v) {
  const lapack_int n = c->balance->n;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, c->jacobian, n, c->pivot, v, n);
}

/* h_q at fixed x. */
static double onset_by(mhb_corner *c, mhb_parameter parameter, int pair) {
  static const double place[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  mhb_balance        *b     = c->balance;
  const double        value = mhb_parameter_get(&b->eval->at, parameter);
  const double        range = c->tracking->high - c->tracking->low;
  const double        step  = VALUE_STEP * fmax(fabs(value), 1e-2 * range);
  double              sum   = 0;
  if (step == 0) return 0;
  for (int i = 0; i < 4; i++) {
    mhb_balance_go_to(b, parameter, value + place[i] * step);
    sum += weight[i] * onset_of(b, c->x, pair).h / (12 * step);
  }
  mhb_balance_go_to(b, parameter, value);
  return sum;
}

/* x_q <- of a parameter, into c->by_value. Returns A_q at fixed x. */
static double by_parameter(mhb_corner *c, mhb_parameter parameter, const mhb_amplitude *a) {
  mhb_balance *b = c->balance;
  mhb_balance_slope(b, c->x, parameter, c->by_value);
  solve_linear(c, c->by_value);
  for (int i = 0; i < b->n; i++) c->by_value[i] = -c->by_value[i];
  return mhb_amplitude_by_parameter(b, a, parameter, b->eval->by_parameter);
}

/* Linearise at c->x, which need not solve the balance: r~ <- the Newton step r~_x^-1 r~. */
static mhb_corner_state linearise(mhb_corner *c, double omega, double value) {
  mhb_balance     *b     = c->balance;
  const int        n     = b->n;
  mhb_corner_state state = {NAN, NAN, NAN, NAN, NAN, NAN};
  mhb_balance_go_to(b, c->tracking->parameter, value);
  b->touching = c->touching;
  mhb_balance_evaluate(b, c->x, omega, c->r, c->jacobian, c->by_omega);
  b->touching = NULL;
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, c->jacobian, n, c->pivot) != 0) return state;
  solve_linear(c, c->r);
  solve_linear(c, c->by_omega);
  for (int i = 0; i < n; i++) c->by_omega[i] = -c->by_omega[i];
  const mhb_amplitude a   = output_at(c);
  const double        a_q = by_parameter(c, c->tracking->parameter, &a);
  state.amplitude         = a.amplitude;
  state.by_omega          = a.by_omega + mhb_dot(n, c->by_x, c->by_omega);
  state.by_value          = a_q + mhb_dot(n, c->by_x, c->by_value);
  const int    nearest    = nearest_to_slip(c, c->touching, &state.onset);
  const size_t block = block_of(b), at    = (size_t)nearest * block;
  double unused[2][block], *const rows[2] = {unused[0], unused[1]};
  const mhb_slip_onset onset = onset_of(b, c->x, nearest);
  mhb_slip_onset_gradient(&b->law[nearest], b->m, c->x + at, &onset, c->onset_by_x, rows);
  state.onset_by_omega = mhb_dot((int)block, c->onset_by_x, c->by_omega + at);
  state.onset_by_value = onset_by(c, c->tracking->parameter, nearest) +
                         mhb_dot((int)block, c->onset_by_x, c->by_value + at);
  return state;
}

mhb_corner_state mhb_corner_linearise(mhb_corner *c, double omega, double value) {
  const mhb_corner_state failed = mhb_corner_evaluate(c, omega, value);
  return isfinite(failed.amplitude) ? linearise(c, omega, value) : failed;
}

double mhb_corner_derivative(mhb_corner *c, const mhb_corner_state *state, double omega,
                             mhb_parameter parameter, bool damping) {
  mhb_balance *b = c->balance;
  double       h, h_q = 0, a_q;
  const int    nearest = nearest_to_slip(c, c->touching, &h);
  const size_t block = block_of(b), at = (size_t)nearest * block;
  b->touching = c->touching;
  mhb_balance_linearise(b, c->x, omega, c->r, NULL);
  b->touching           = NULL;
  const mhb_amplitude a = output_at(c);
  if (damping) {
    memset(c->by_value, 0, sizeof *c->by_value * (size_t)b->n);
    mhb_slope_by_damping(b, c->by_value);
    solve_linear(c, c->by_value);
    for (int i = 0; i < b->n; i++) c->by_value[i] = -c->by_value[i];
    a_q = a.by_damping;
  } else {
    a_q = by_parameter(c, parameter, &a);
    if (parameter != MHB_IN_SCALE) h_q = onset_by(c, parameter, nearest);
  }
  a_q += mhb_dot(b->n, c->by_x, c->by_value);
  h_q += mhb_dot((int)block, c->onset_by_x, c->by_value + at);
  return c->stuck ? a_q : a_q - state->by_omega * h_q / state->onset_by_omega;
}

/* Every pair has its own law, and those of J stick at the motion that was evaluated last. */
static bool all_stick(const mhb_corner *c) {
  for (int a = 0; a < c->balance->n_pairs; a++)
    if (c->touching[a] && c->balance->eval->kind[a] == MHB_PAIR_NONLINEAR) return false;
  return true;
}

/* x <- the stuck motion at omega, from one near by. False: x is as before. */
static bool stuck_at(mhb_corner *c, double omega, double *x) {
  const size_t size = sizeof *x * (size_t)c->balance->n;
  double       from[c->balance->n];
  int          iterations;
  memcpy(from, x, size);
  if (mhb_newton_solve(c->newton, c->balance, omega, ALMOST, x, &iterations) == MHB_CONVERGED &&
      all_stick(c))
    return true;
  memcpy(x, from, size);
  return false;
}

bool mhb_corner_overhangs(mhb_corner *c, double omega, double value, int sense, double *x,
                          double *end) {
  const size_t size = sizeof *x * (size_t)c->balance->n;
  double       corner[c->balance->n], with = OVERHANG, without = INFINITY;
  memcpy(corner, c->x, size);
  bool found = isfinite(mhb_corner_evaluate(c, omega * (1 - sense * APPROACH), value).amplitude);
  memcpy(x, c->x, size);
  memcpy(c->x, corner, size);
  for (double away = APPROACH; away >= OVERHANG && found; away /= 10)
    found = stuck_at(c, omega * (1 - sense * away), x);
  if (!found || !stuck_at(c, omega * (1 + sense * with), x)) return false;
  while (without - with > OVERHANG_ENDS && with < REACH) {
    const double to = isfinite(without) ? 0.5 * (with + without) : 2 * with;
    if (stuck_at(c, omega * (1 + sense * to), x))
      with = to;
    else
      without = to;
  }
  *end = omega * (1 + sense * with);
  mhb_balance_linearise(c->balance, x, *end, c->r, NULL);
  return true;
}

/* ---- the root in omega ---- */

/* What is zero at the point: h, or dA/domega of a stuck peak. */
static double condition(mhb_corner *c, double omega, double value) {
  return c->stuck ? mhb_corner_linearise(c, omega, value).by_omega
                  : mhb_corner_evaluate(c, omega, value).onset;
}

/* Newton's method for motion and frequency of a corner together, from a near guess. */
static bool newton(mhb_corner *c, double value, int sense, double *omega) {
  const int n    = c->balance->n;
  double    most = INFINITY, at = *omega;
  for (int i = 0; i < MOST_NEWTON; i++) {
    const mhb_corner_state s     = linearise(c, at, value);
    const size_t           block = block_of(c->balance);
    double                 unused;
    const int              pair = nearest_to_slip(c, c->touching, &unused);
    if (!isfinite(s.onset_by_omega)) return false;
    const double left  = s.onset - mhb_dot((int)block, c->onset_by_x, c->r + (size_t)pair * block);
    const double step  = -left / s.onset_by_omega;
    double       moved = 0, size = mhb_norm(c->x, n);
    if (!isfinite(step) || fabs(step) > 2 * NEARBY * at) return false;
    for (int j = 0; j < n; j++) {
      const double change = c->by_omega[j] * step - c->r[j];
      c->x[j] += change;
      moved += change * change;
    }
    at += step;
    const double relative = fmax(fabs(step) / at, sqrt(moved) / size);
    if (relative <= LAST_STEP || (i > 2 && relative <= 1e-10 && relative > 0.5 * most)) {
      if (sense != 0 && !(sense * s.onset_by_omega > 0)) return false;
      *omega = at;
      return true;
    }
    if (i > 3 && relative > 0.7 * most) return false;
    most = relative;
  }
  return false;
}

/* The root by the secant method, from a guess so near that it converges at once. */
static bool secant(mhb_corner *c, double value, int sense, double first, double *omega) {
  const double exact = (c->stuck ? EXACT_PEAK : EXACT_OMEGA) * *omega;
  double       from = *omega, f = first, at = from * (1 + SECANT), most = INFINITY;
  for (int i = 0; i < MOST_SECANTS; i++) {
    const double g = condition(c, at, value), slope = (g - f) / (at - from);
    if (sense != 0 && !(sense * slope > 0)) return false;
    const double step = -g / slope;
    if (!isfinite(step) || fabs(step) > 0.5 * most) return false;
    most = i > 0 ? fabs(step) : fmin(NEARBY * *omega, 4 * fabs(step));
    if (fabs(step) > NEARBY * *omega) return false;
    from = at;
    f    = g;
    at += step;
    if (fabs(step) <= exact || g == 0) {
      *omega = at;
      return true;
    }
  }
  return false;
}

/* The nearest root in a bracket that grows both ways; both motions at its ends are kept.
 *   start  in  [n] motion at the guess */
static bool bracketed(mhb_corner *c, double value, int sense, double *omega, const double *start) {
  const size_t size   = sizeof(double) * (size_t)c->balance->n;
  const double centre = *omega;
  double       at[2]  = {centre, centre}, f[2], end[2][c->balance->n];
  f[0] = f[1] = condition(c, centre, value);
  if (!isfinite(f[0])) return false;
  for (int side = 0; side < 2; side++) memcpy(end[side], start, size);
  for (double away = 1e-8; away < REACH; away *= 3)
    for (int side = 0; side < 2; side++) {
      const double to = centre * (side ? 1 + away : 1 - away);
      memcpy(c->x, end[side], size);
      const double g = condition(c, to, value);
      if (!isfinite(g)) return false;
      memcpy(end[side], c->x, size);
      int      rises = (side ? g - f[1] : f[0] - g) > 0 ? 1 : -1;
      shb_root root;
      bool     bracket = (sense == 0 || rises == sense) &&
                     shb_root_start(&root, at[side], f[side], to, g,
                                    (c->stuck ? EXACT_PEAK : EXACT_OMEGA) * centre);
      at[side] = to;
      f[side]  = g;
      if (!bracket) continue;
      while (!shb_root_done(&root)) {
        double next = shb_root_next(&root);
        shb_root_found(&root, next, condition(c, next, value));
      }
      *omega = 0.5 * (root.x[0] + root.x[1]);
      return true;
    }
  return false;
}

bool mhb_corner_solve(mhb_corner *c, double value, int sense, double *omega) {
  const size_t size = sizeof(double) * (size_t)c->balance->n;
  double       start[c->balance->n];
  const double guess = *omega;
  memcpy(start, c->x, size);
  if (c->stuck) {
    const double first = condition(c, guess, value);
    if (!isfinite(first)) return false;
    if (secant(c, value, sense, first, omega)) return true;
  } else if (newton(c, value, sense, omega) && fabs(*omega / guess - 1) <= REACH) {
    return true;
  }
  *omega = guess;
  memcpy(c->x, start, size);
  if (bracketed(c, value, sense, omega, start)) return true;
  memcpy(c->x, start, size);
  return false;
}

/* ---- creation ---- */

mhb_corner *mhb_corner_create(mhb_balance *balance, const mhb_tracking *tracking) {
  mhb_corner  *c = shb_alloc_zeroed(1, sizeof *c);
  const size_t n = (size_t)balance->n, pairs = (size_t)balance->n_pairs;
  c->balance         = balance;
  c->tracking        = tracking;
  double **vectors[] = {&c->x,        &c->r,    &c->kept,      &c->by_omega,
                        &c->by_value, &c->by_x, &c->onset_by_x};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    *vectors[i] = shb_arena_take(&c->arena, n, sizeof(double));
  c->jacobian = shb_arena_take(&c->arena, n * n, sizeof(double));
  c->pivot    = shb_arena_take(&c->arena, n, sizeof *c->pivot);
  c->weight   = shb_arena_take(&c->arena, mhb_amplitude_weights(balance), sizeof *c->weight);
  c->touching = shb_arena_take(&c->arena, pairs, sizeof *c->touching);
  c->closed   = shb_arena_take(&c->arena, pairs, sizeof *c->closed);
  c->newton   = mhb_newton_create((int)n);
  mhb_newton_bind(c->newton, balance);
  return c;
}

void mhb_corner_destroy(mhb_corner *c) {
  if (!c) return;
  mhb_newton_destroy(c->newton);
  shb_arena_free(&c->arena);
  free(c);
}
