#include "mhb/tracking/corner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mesh/base/root.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/record.h"

/* Relative steps of the differences in omega and q. */
static const double OMEGA_STEP = 1e-5, VALUE_STEP = 1e-3;

/* Brackets of omega and of q end at these lengths, relative. */
static const double EXACT_OMEGA = 1e-14, EXACT_PEAK = 1e-11, EXACT_VALUE = 1e-9;

/* The same where the slipping side, known less well, ends the peak. */
static const double EXACT_END = 1e-6;

/* How far a root is sought from its guess, relative. */
static const double REACH = 0.02;

/* The secant method's first step, and its longest, relative. */
static const double SECANT = 1e-6, NEARBY = 2e-3;

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

/* A grid of phases resolves the highest harmonic of the stuck motion by so many points. */
enum { PER_PERIOD = 24, MOST_GRID = 96, MOST_MEANS = 100, LEAST_PARTS = 32, MOST_SECANTS = 8 };

/* ---- two discs that touch ---- */

/* Friction force f without its mean and normal force n at a phase, with two derivatives. */
typedef struct {
  double f[2], df[2], ddf[2], n, dn, ddn;
} forces;

static void component(const double *a, int m, double t, double mean, double out[3]) {
  out[0] = mean;
  out[1] = out[2] = 0;
  for (int k = 1; k <= m; k++) {
    double re = a[2 * k - 1], im = a[2 * k];
    if (re == 0 && im == 0) continue;
    double c = cos(k * t), s = sin(k * t), here = re * c - im * s;
    out[0] += here;
    out[1] -= k * (re * s + im * c);
    out[2] -= k * k * here;
  }
}

static forces forces_at(const mhb_balance *b, const double *x, double t) {
  const mhb_law *law = &b->law[0];
  double         u[3][3];
  for (int axis = 0; axis < 3; axis++)
    component(x + axis * b->nb, b->m, t, axis == 0 ? x[0] : 0, u[axis]);
  return (forces){
      .f   = {law->ku[0] * u[1][0] + law->ku[1] * u[2][0],
              law->ku[1] * u[1][0] + law->ku[2] * u[2][0]},
      .df  = {law->ku[0] * u[1][1] + law->ku[1] * u[2][1],
              law->ku[1] * u[1][1] + law->ku[2] * u[2][1]},
      .ddf = {law->ku[0] * u[1][2] + law->ku[1] * u[2][2],
              law->ku[1] * u[1][2] + law->ku[2] * u[2][2]},
      .n   = law->n0 + law->kv * u[0][0],
      .dn  = law->kv * u[0][1],
      .ddn = law->kv * u[0][2],
  };
}

static double distance(const forces *a, const forces *b, double mu) {
  const double d[2] = {a->f[0] - b->f[0], a->f[1] - b->f[1]};
  return 0.5 * (sqrt(d[0] * d[0] + d[1] * d[1]) - mu * (a->n + b->n));
}

/* The highest harmonic of a stuck motion: that of the load. 1 at least. */
static int highest_harmonic(const mhb_balance *b, const double *x) {
  int most = 1;
  for (int axis = 0; axis < 3; axis++)
    for (int k = b->m; k > most; k--)
      if (x[axis * b->nb + 2 * k - 1] != 0 || x[axis * b->nb + 2 * k] != 0) most = k;
  return most;
}

/* The phases of the largest distance on a grid. */
static void search_times(const mhb_balance *b, const double *x, double time[2]) {
  forces    at[MOST_GRID];
  double    best = -INFINITY;
  const int fine = PER_PERIOD * highest_harmonic(b, x), n = fine < MOST_GRID ? fine : MOST_GRID;
  for (int i = 0; i < n; i++) at[i] = forces_at(b, x, SHB_TWO_PI * i / n);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) {
      double d = distance(&at[i], &at[j], b->law[0].mu);
      if (d <= best) continue;
      best    = d;
      time[0] = SHB_TWO_PI * i / n;
      time[1] = SHB_TWO_PI * j / n;
    }
}

/* Newton's method for the phases of the largest distance, from near ones. */
static void refine_times(const mhb_balance *b, const double *x, double time[2]) {
  double mu = b->law[0].mu;
  for (int i = 0; i < 20; i++) {
    forces a = forces_at(b, x, time[0]), c = forces_at(b, x, time[1]);
    double d[2] = {a.f[0] - c.f[0], a.f[1] - c.f[1]}, size = hypot(d[0], d[1]);
    if (size == 0) return;
    double e[2] = {d[0] / size, d[1] / size};
    double qa = e[0] * a.df[1] - e[1] * a.df[0], qc = e[0] * c.df[1] - e[1] * c.df[0];
    double ga  = e[0] * a.df[0] + e[1] * a.df[1] - mu * a.dn;
    double gc  = -(e[0] * c.df[0] + e[1] * c.df[1]) - mu * c.dn;
    double haa = e[0] * a.ddf[0] + e[1] * a.ddf[1] - mu * a.ddn + qa * qa / size;
    double hcc = -(e[0] * c.ddf[0] + e[1] * c.ddf[1]) - mu * c.ddn + qc * qc / size;
    double hac = -qa * qc / size, det = haa * hcc - hac * hac;
    if (!(haa < 0 && det > 0)) return;
    double da = -(hcc * ga - hac * gc) / det, dc = -(haa * gc - hac * ga) / det;
    double most = fmax(fabs(da), fabs(dc)), limit = fmin(1, 0.05 / fmax(most, 1e-300));
    time[0] += limit * da;
    time[1] += limit * dc;
    if (most < 1e-15) return;
  }
}

/* ---- the stuck response ---- */

static void go_to(mhb_balance *b, const mhb_tracking *tracking, double value) {
  mhb_balance_set_parameter(b, tracking->parameter);
  mhb_balance_set_value(b, value);
  mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
}

static double output_at(mhb_balance *b, const mhb_tracking *tracking, const double *x) {
  double         by_x[b->n];
  double complex weight[3 * b->n_pairs];
  mhb_amplitude  a = {.by_x = by_x, .weight = weight, .size = tracking->size};
  mhb_output_amplitude(b, x, tracking->output, &a);
  return a.amplitude;
}

/* Mean of the motion with mean friction c, from that without: the normal spring holds v_0. */
static void shift_mean(const mhb_balance *b, const double without[3], const double c[2],
                       double *x) {
  const double complex *R  = b->receptance->R; /* harmonic 0 */
  double                kv = b->law[0].kv;
  double                dv = -(creal(R[1]) * c[0] + creal(R[2]) * c[1]) / (1 + creal(R[0]) * kv);
  x[0]                     = without[0] + dv;
  for (int i = 1; i < 3; i++)
    x[i * b->nb] = without[i] - (creal(R[3 * i]) * kv * dv + creal(R[3 * i + 1]) * c[0] +
                                 creal(R[3 * i + 2]) * c[1]);
}

/* The touching mean friction, and the means that it gives. */
static void touch(const mhb_balance *b, double *x, mhb_stuck_state *state) {
  const double mu = b->law[0].mu, without[3] = {x[0], x[b->nb], x[2 * b->nb]};
  double       before = 0;
  search_times(b, x, state->time);
  for (int i = 0; i < MOST_MEANS; i++) {
    refine_times(b, x, state->time);
    forces p = forces_at(b, x, state->time[0]), q = forces_at(b, x, state->time[1]);
    double size = hypot(p.f[0] - q.f[0], p.f[1] - q.f[1]), change;
    for (int k = 0; k < 2; k++) {
      double e           = size > 0 ? (p.f[k] - q.f[k]) / size : 0;
      state->friction[k] = -0.5 * (p.f[k] + q.f[k]) + 0.5 * mu * (p.n - q.n) * e;
    }
    state->onset = distance(&p, &q, mu);
    shift_mean(b, without, state->friction, x);
    change = fabs(x[0] - before);
    before = x[0];
    if (i > 0 && change <= 1e-15 * (fabs(p.n) + fabs(q.n)) / fmax(b->law[0].kv, 1e-300)) return;
  }
}

shb_status mhb_stuck_response(mhb_balance *b, const mhb_tracking *tracking, double omega,
                              double value, double *x, mhb_stuck_state *state) {
  go_to(b, tracking, value);
  SHB_TRY(mhb_balance_linear_limit(b, omega, 1, x));
  state->amplitude = output_at(b, tracking, x);
  touch(b, x, state);
  return SHB_OK;
}

/* ---- derivatives by (omega, q) ---- */

typedef struct {
  mhb_balance        *balance;
  const mhb_tracking *tracking;
  bool                stuck; /* a stuck peak; else a corner */
  double             *x;     /* [n] */
} stuck_curve;

/* A and h. NAN: singular. */
static mhb_stuck_state state_at(const stuck_curve *s, double omega, double value) {
  mhb_stuck_state state = {NAN, NAN, {0}, {0}};
  if (mhb_stuck_response(s->balance, s->tracking, omega, value, s->x, &state) != SHB_OK)
    state.amplitude = state.onset = NAN;
  return state;
}

/* Derivatives of A and h by omega (axis 0) or q (axis 1). */
static void gradient(const stuck_curve *s, double omega, double value, int axis, double *by_a,
                     double *by_h) {
  static const double place[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
  double              range = s->tracking->high - s->tracking->low;
  double step = axis ? VALUE_STEP * fmax(fabs(value), 1e-2 * range) : OMEGA_STEP * omega;
  *by_a = *by_h = 0;
  for (int i = 0; i < 4; i++) {
    double          move = place[i] * step;
    mhb_stuck_state at   = state_at(s, axis ? omega : omega + move, axis ? value + move : value);
    *by_a += weight[i] * at.amplitude / (12 * step);
    *by_h += weight[i] * at.onset / (12 * step);
  }
}

/* What is zero at the point: h, or dA/domega of a stuck peak. */
static double condition(const stuck_curve *s, double omega, double value) {
  double slope, unused;
  if (!s->stuck) return state_at(s, omega, value).onset;
  gradient(s, omega, value, 0, &slope, &unused);
  return slope;
}

/* The root by the secant method, from a guess so near that it converges at once. */
static bool solve_near(const stuck_curve *s, double value, int sense, double first, double *omega) {
  const double exact = (s->stuck ? EXACT_PEAK : EXACT_OMEGA) * *omega;
  double       from = *omega, f = first, at = from * (1 + SECANT), most = INFINITY;
  for (int i = 0; i < MOST_SECANTS; i++) {
    const double g = condition(s, at, value), slope = (g - f) / (at - from);
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

/* The root of the condition nearest to *omega at which it has the sign of sense above. 0: either
 * sense. */
static bool solve(const stuck_curve *s, double value, int sense, double *omega) {
  double centre = *omega, at[2] = {centre, centre}, f[2], first = condition(s, centre, value);
  f[0] = f[1] = first;
  if (!isfinite(first)) return false;
  if (solve_near(s, value, sense, first, omega)) return true;
  for (double away = 1e-8; away < REACH; away *= 3)
    for (int side = 0; side < 2; side++) {
      double to = centre * (side ? 1 + away : 1 - away), g = condition(s, to, value);
      if (!isfinite(g)) return false;
      int      rises = (side ? g - f[1] : f[0] - g) > 0 ? 1 : -1;
      shb_root root;
      bool     bracket = (sense == 0 || rises == sense) &&
                     shb_root_start(&root, at[side], f[side], to, g,
                                    (s->stuck ? EXACT_PEAK : EXACT_OMEGA) * centre);
      at[side] = to;
      f[side]  = g;
      if (!bracket) continue;
      while (!shb_root_done(&root)) {
        double next = shb_root_next(&root);
        shb_root_found(&root, next, condition(s, next, value));
      }
      *omega = 0.5 * (root.x[0] + root.x[1]);
      return true;
    }
  return false;
}

bool mhb_corner_at(mhb_balance *balance, const mhb_tracking *tracking, bool stuck, double value,
                   double *omega, double *x, double *amplitude) {
  stuck_curve s = {balance, tracking, stuck, x};
  if (balance->n_pairs != 1 || !solve(&s, value, stuck ? -1 : 0, omega)) return false;
  *amplitude = state_at(&s, *omega, value).amplitude;
  return true;
}

double mhb_corner_slope(mhb_balance *balance, const mhb_tracking *tracking, bool stuck,
                        double omega, double value, double *x) {
  stuck_curve s = {balance, tracking, stuck, x};
  double      a[2], h[2];
  gradient(&s, omega, value, 0, &a[0], &h[0]);
  gradient(&s, omega, value, 1, &a[1], &h[1]);
  state_at(&s, omega, value);
  return stuck ? a[1] : a[1] - a[0] * h[1] / h[0];
}

/* ---- along the parameter ---- */

typedef struct {
  stuck_curve     s;
  mhb_newton     *newton;
  mhb_truncation *truncation;
  mhb_curve_point point; /* x, r and evaluation are in use */
  mhb_response   *store;
  int             segment, sense;
  double          clock;
} tracer;

typedef struct {
  double value, omega, amplitude, slope; /* slope: dA/dq along the curve */
  double rate;                           /* domega/dq, 0 of a stuck peak */
  double margin; /* it is 0 where the peak moves to the other side of the corner, and < 0 beyond;
                  * NAN: not known */
} place;

/* Amplitude of the slipping side beside a corner whose motion is in s.x, or NAN. The nearest
 * distance at which Newton's method finds it. */
static double slipping_side(tracer *t, const place *at) {
  mhb_balance *b = t->s.balance;
  int          iterations;
  go_to(b, t->s.tracking, at->value);
  for (int i = 0; i < N_BESIDE; i++) {
    double omega = at->omega * (1 + t->sense * BESIDE[i]);
    /* the touching motion itself does not slip, this one does */
    state_at(&t->s, omega, at->value);
    memcpy(t->point.x, t->s.x, sizeof(double) * (size_t)b->n);
    mhb_reason reason = mhb_newton_solve(t->newton, b, omega, SETTLED, t->point.x, &iterations);
    double     a      = output_at(b, t->s.tracking, t->point.x);
    if (reason == MHB_CONVERGED && fabs(a - at->amplitude) <= NEIGHBOUR * at->amplitude) return a;
  }
  return NAN;
}

/* Whether there is a peak at a value near at->omega; fills the place.
 *   why  out  what it is instead */
static bool is_peak(tracer *t, place *at, mhb_end *why) {
  const mhb_tracking *tracking = t->s.tracking;
  double              a[2], h[2];
  *why       = MHB_END_TURNED;
  at->margin = NAN;
  if (!solve(&t->s, at->value, t->sense, &at->omega)) return false;
  gradient(&t->s, at->omega, at->value, 0, &a[0], &h[0]);
  gradient(&t->s, at->omega, at->value, 1, &a[1], &h[1]);
  mhb_stuck_state state = state_at(&t->s, at->omega, at->value);
  at->amplitude         = state.amplitude;
  at->rate              = t->s.stuck ? 0 : -h[1] / h[0];
  at->slope             = t->s.stuck ? a[1] : a[1] + a[0] * at->rate;
  /* n0 and mu do not reach a stuck motion: what remains is round-off */
  if (fabs(at->slope) * (tracking->high - tracking->low) < 1e-9 * at->amplitude) at->slope = 0;
  *why = MHB_END_FREQUENCY;
  if (at->omega < tracking->frequency[0] || at->omega > tracking->frequency[1]) return false;
  *why       = MHB_END_CORNER;
  at->margin = t->s.stuck ? -state.onset : a[0] * copysign(1, h[0]);
  if (at->margin <= 0) return false; /* it slips; the amplitude rises into the stuck side */
  if (t->s.stuck) return true;
  *why         = MHB_END_TURNED;
  double aside = slipping_side(t, at);
  return aside < at->amplitude;
}

static void linearise(tracer *t, const place *at) {
  mhb_balance *b = t->s.balance;
  mhb_balance_linearise(b, t->point.x, at->omega, t->point.r, NULL);
  t->point.residual = mhb_norm(t->point.r, b->n) / mhb_balance_vibration(b, t->point.x);
}

/* x of the point <- the motion at a place; r and the evaluation follow. Off the corner the mean
 * friction is the least admissible one, and Newton's method finds the means. */
static bool balance_at(tracer *t, const place *at) {
  mhb_balance *b = t->s.balance;
  state_at(&t->s, at->omega, at->value);
  memcpy(t->point.x, t->s.x, sizeof(double) * (size_t)b->n);
  go_to(b, t->s.tracking, at->value);
  t->point.value = at->value;
  linearise(t, at);
  t->point.iterations = 0;
  if (t->s.stuck && t->point.residual > SETTLED_MEANS) {
    mhb_newton_solve(t->newton, b, at->omega, SETTLED_MEANS, t->point.x, &t->point.iterations);
    linearise(t, at);
  }
  return t->point.residual <= BALANCED;
}

/* Append a place. *balanced false: more than two discs touch, or the pair slips. */
static shb_status record(tracer *t, const place *at, int special, bool *balanced) {
  mhb_balance *b   = t->s.balance;
  double       now = shb_seconds();
  *balanced        = balance_at(t, at);
  if (!*balanced) return SHB_OK;
  t->point.truncation      = mhb_truncation_error(t->truncation, t->point.x);
  t->point.truncation_kind = (int)t->truncation->kind;
  mhb_balance_set_parameter(b, t->s.tracking->parameter);
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
  const mhb_tracking *tracking = t->s.tracking;
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

/* The seed as a corner, or else as a stuck peak. */
static bool start(tracer *t, const mhb_tracking_seed *seed, place *at) {
  mhb_end unused;
  for (int stuck = 0; stuck < 2; stuck++) {
    double a, h;
    *at        = (place){.value = seed->value, .omega = seed->omega};
    t->s.stuck = stuck;
    t->sense   = stuck ? -1 : 0;
    if (!solve(&t->s, at->value, t->sense, &at->omega)) continue;
    gradient(&t->s, at->omega, at->value, 0, &a, &h);
    if (!stuck) t->sense = h > 0 ? 1 : -1;
    if (is_peak(t, at, &unused) && mhb_is_seeded(seed, at->omega, at->amplitude)) return true;
  }
  return false;
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
  size_t n   = (size_t)t->s.balance->n;
  t->s.x     = calloc(n, sizeof(double));
  t->point.x = calloc(n, sizeof(double));
  t->point.r = calloc(n, sizeof(double));
  t->store   = mhb_response_like(response);
  SHB_CHECK(t->s.x && t->point.x && t->point.r && t->store, SHB_ERR_IO, "out of memory");
  t->store->n_harmonics = response->branch[branch].n_harmonics;
  SHB_TRY(mhb_newton_create((int)n, &t->newton));
  SHB_TRY(mhb_newton_bind(t->newton, t->s.balance));
  SHB_TRY(mhb_truncation_create(t->s.balance, &t->truncation));
  return mhb_evaluation_create(t->s.balance, &t->point.evaluation);
}

shb_status mhb_trace_corner(mhb_balance *balance, const mhb_tracking *tracking,
                            const mhb_tracking_seed *seed, mhb_response *response, int branch,
                            bool *found, mhb_tracking_end *end) {
  tracer t = {.s = {.balance = balance, .tracking = tracking}};
  place  at;
  *found = false;
  *end   = (mhb_tracking_end){MHB_END_NO_START, MHB_END_NO_START};
  if (balance->n_pairs != 1 || tracking->kind != MHB_TRACK_PEAK) return SHB_OK;
  shb_status status = make(&t, response, branch);
  if (status == SHB_OK) {
    mhb_balance_use(balance, t.point.evaluation);
    t.clock = shb_seconds();
    if (start(&t, seed, &at)) status = trace_both(&t, &at, response, branch, found, end);
    mhb_balance_use(balance, NULL);
  }
  mhb_evaluation_destroy(t.point.evaluation);
  mhb_truncation_destroy(t.truncation);
  mhb_newton_destroy(t.newton);
  mhb_response_destroy(t.store);
  free(t.point.r);
  free(t.point.x);
  free(t.s.x);
  return status;
}
