#include "mhb/balance/truncation_error.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/numerics/fourier.h"
#include "mhb/numerics/tail.h"
#include "mhb/numerics/vector.h"

/* Higher harmonics below this share of the step are not fed back. */
static const double NEGLIGIBLE = 0.2;

/* A longer step of Broyden's method, relative to the vibration, may lead to another solution. */
static const double FAR = 0.1;

/* Distance of the evaluation that measures the curvature, relative to the vibration. */
static const double NEARBY = 0.1;

/* A bend across a step is followed below this part of the step. */
static const double SMALL = 0.5;

/* Residual that GMRES leaves of a step in a ring, relative. */
static const double SOLVED = 1e-2;

/* Unknowns of few pairs with 2m harmonics from which on their step is Broyden's. */
enum { WORTH_BROYDEN = 250 };

/* Error of the products with the receptance of many pairs. The estimate is a few per cent off
 * anyhow, and an error above 1e-5 is one. */
static const double COARSE = 1e-8;

/* The order of a tail is known to this only: between 7 and 31 harmonics it scatters so. */
static const double ORDER_MARGIN = 0.75;

/* The error falls to this part at most where m is doubled: by the first order. */
static const double SLOWEST = 0.5;

/* Times of a period for each harmonic of 2m, and the fewest. */
enum { TIMES_A_HARMONIC = 4, LEAST_TIMES = 32 };

static int least(int a, int b) {
  return a < b ? a : b;
}

static int most(int a, int b) {
  return a > b ? a : b;
}

int mhb_truncation_highest(int m) {
  return most(2 * m, least(most(4 * m, MHB_LEAST_LOOKED_AT), MHB_MOST_LOOKED_AT));
}

shb_status mhb_truncation_create(const mhb_balance *balance, mhb_truncation **out) {
  mhb_truncation *t   = shb_alloc_zeroed(1, sizeof *t);
  int             m   = balance->m;
  int             top = mhb_truncation_highest(m);
  if (balance->receptance->ring) top = 2 * m;
  t->balance            = balance;
  t->settings           = *balance->settings;
  t->settings.harmonics = 2 * m;
  shb_status status =
      mhb_receptance_create_beside(balance->receptance, &t->settings, top, &t->receptance);
  if (status == SHB_OK) status = mhb_balance_create_on(t->receptance, &t->settings, &t->doubled);
  if (status == SHB_OK) {
    t->doubled->negligible = COARSE;
    size_t n               = (size_t)t->doubled->n;
    t->x                   = shb_arena_take(&t->arena, n, sizeof(double));
    t->step                = shb_arena_take(&t->arena, n, sizeof(double));
    t->r                   = shb_arena_take(&t->arena, n, sizeof(double));
    t->trial               = shb_arena_take(&t->arena, n, sizeof(double));
    t->feedback            = shb_arena_take(&t->arena, n, sizeof(double));
    t->before              = shb_arena_take(&t->arena, n, sizeof(double));
    t->n_times             = most(TIMES_A_HARMONIC * t->doubled->m, LEAST_TIMES);
    size_t times           = (size_t)t->n_times;
    t->power               = shb_arena_take(&t->arena, (size_t)t->doubled->m + 1, sizeof(double));
    t->basis  = shb_arena_take(&t->arena, times * (size_t)t->doubled->nb, sizeof(double));
    t->motion = shb_arena_take(&t->arena, times * 3 * (size_t)balance->n_pairs, sizeof(double));
    t->force  = shb_arena_take(&t->arena, 3 * (size_t)mhb_real_size(top), sizeof(double));
  }
  if (status == SHB_OK && !balance->receptance->ring)
    status = mhb_higher_harmonics_create(t->doubled, t->receptance, &t->higher);
  if (status == SHB_OK) {
    t->system = mhb_condensation_create_within(t->doubled, MHB_MOST_DOUBLED);
    if (balance->receptance->ring)
      t->ring = mhb_doubled_ring_create(balance, t->doubled);
    else if (t->system->low_rank || t->doubled->n >= WORTH_BROYDEN)
      t->broyden = mhb_truncation_step_create(balance, t->doubled, t->system->low_rank);
  }
  if (status == SHB_OK && t->system->low_rank)
    status = mhb_contact_evaluator_create(m, top, balance->settings->tolerance, &t->contact);
  if (status != SHB_OK) {
    mhb_truncation_destroy(t);
    return status;
  }
  *out = t;
  return SHB_OK;
}

void mhb_truncation_destroy(mhb_truncation *t) {
  if (!t) return;
  mhb_contact_evaluator_destroy(t->contact);
  mhb_truncation_step_destroy(t->broyden);
  mhb_doubled_ring_destroy(t->ring);
  mhb_condensation_destroy(t->system);
  mhb_higher_harmonics_destroy(t->higher);
  mhb_balance_destroy(t->doubled);
  mhb_receptance_destroy(t->receptance);
  shb_arena_free(&t->arena);
  free(t);
}

/* Rows of nb coefficients into rows of wide ones, or back; the rest is left as it is. */
static void copy_rows(int rows, const double *from, int nb, double *to, int wide) {
  size_t length = sizeof(double) * (size_t)least(nb, wide);
  for (int i = 0; i < rows; i++)
    memcpy(to + (size_t)i * (size_t)wide, from + (size_t)i * (size_t)nb, length);
}

/* The linearisation at t->x is ready for solutions: by GMRES in a ring, else by factors. 0: it is
 * singular, or too large. */
static int factor(mhb_truncation *t) {
  t->by_gmres = t->ring && mhb_doubled_ring_factor(t->ring, t->factors);
  return t->by_gmres || mhb_condensation_factor(t->system, NULL, NULL);
}

/* x[doubled->n] <- its solution. Where GMRES fails factors take its place. 0: it failed. */
static int solve(mhb_truncation *t, double *x) {
  if (!t->by_gmres) return mhb_condensation_solve(t->system, x);
  memcpy(t->r, x, sizeof *x * (size_t)t->doubled->n);
  if (mhb_doubled_ring_solve(t->ring, SOLVED, x)) return 1;
  t->by_gmres = false;
  memcpy(x, t->r, sizeof *x * (size_t)t->doubled->n);
  return mhb_condensation_factor(t->system, NULL, NULL) && mhb_condensation_solve(t->system, x);
}

/* t->trial <- the change of the residual along tau steps beyond the linear one, over tau^2, in the
 * measure of steps: (I + R J)^-1 (r(x + tau step) - r(x)) - tau step. One evaluation nearby gives
 * it. Returns kappa, its part along the step in steps; 0 for both where that fails. The error of
 * GMRES is a part of its solution, so that it solves for the difference itself. */
static double bend(mhb_truncation *t, const double *step) {
  mhb_balance *b      = t->doubled;
  const double length = mhb_norm(step, b->n), size = mhb_balance_vibration(b, t->x);
  const double part   = length > 0 ? fmin(1, NEARBY * size / length) : 1;
  double      *change = t->trial, product = 0;
  for (int i = 0; i < b->n; i++) change[i] = t->x[i] + part * step[i];
  mhb_balance_evaluate(b, change, t->balance->eval->at.omega, t->r, NULL, NULL);
  const bool gmres = t->by_gmres;
  if (gmres) mhb_doubled_ring_product(t->ring, step, change);
  for (int i = 0; i < b->n; i++)
    change[i] = t->r[i] - t->before[i] - (gmres ? part * change[i] : 0);
  if (!(length > 0) || !solve(t, change)) {
    memset(change, 0, sizeof *change * (size_t)b->n);
    return 0;
  }
  for (int i = 0; i < b->n; i++) {
    change[i] = (change[i] - (gmres ? 0 : part * step[i])) / (part * part);
    product += change[i] / length * (step[i] / length);
  }
  return product;
}

/* Smallest positive root tau of -1 + tau + kappa tau^2, or the modulus of complex roots. */
static double first_root(double kappa) {
  double root = 1 + 4 * kappa;
  return root >= 0 ? 2 / (1 + sqrt(root)) : 1 / sqrt(-kappa);
}

/* The step to the root along it, without what the bend there adds across it. */
static void correct_step(mhb_truncation *t) {
  const int    n     = t->doubled->n;
  const double kappa = bend(t, t->step), tau = first_root(kappa), length = mhb_norm(t->step, n);
  double       across = 0;
  for (int i = 0; i < n; i++) {
    t->trial[i] -= kappa * t->step[i];
    across = hypot(across, t->trial[i]);
  }
  const double second = tau * across < SMALL * length ? tau * tau : 0;
  for (int i = 0; i < n; i++) t->step[i] = tau * t->step[i] - second * t->trial[i];
}

/* Whether harmonics above 2m count beside a step; their forces at t->x are set. stiffness: the
 * balance that was linearised. */
static bool higher_count(mhb_truncation *t, const mhb_balance *stiffness, const double *step) {
  if (!t->higher) return false;
  t->higher_size = mhb_higher_harmonics_estimate(t->higher, stiffness, t->doubled->negligible);
  return t->higher_size > NEGLIGIBLE * mhb_norm(step, t->doubled->n);
}

/* step <- the Newton step, or -r where the step does not exist or is too large a system. */
static mhb_truncation_kind set_newton_step(mhb_truncation *t) {
  mhb_balance *b     = t->doubled;
  size_t       bytes = sizeof(double) * (size_t)b->n;
  mhb_balance_linearise(b, t->x, t->balance->eval->at.omega, t->r, NULL);
  memcpy(t->before, t->r, bytes);
  for (int i = 0; i < b->n; i++) t->step[i] = -t->r[i];
  if (!factor(t)) return MHB_TRUNCATION_FIRST_ORDER;
  memcpy(t->trial, t->step, bytes);
  if (!solve(t, t->trial)) return MHB_TRUNCATION_FIRST_ORDER;
  memset(t->feedback, 0, bytes);
  if (t->higher) mhb_higher_harmonics_evaluate(t->higher, b, t->x);
  if (higher_count(t, b, t->trial)) {
    mhb_higher_harmonics_feedback(t->higher, b, b, t->x, t->feedback);
    for (int i = 0; i < b->n; i++) t->trial[i] = -t->r[i] - t->feedback[i];
    mhb_condensation_solve(t->system, t->trial);
  }
  memcpy(t->step, t->trial, bytes);
  correct_step(t);
  return MHB_TRUNCATION_NEWTON;
}

/* The same of few pairs. */
static void evaluate_few(mhb_truncation *t) {
  mhb_balance *d = t->doubled;
  mhb_balance_evaluate(d, t->x, t->balance->eval->at.omega, t->r, NULL, NULL);
  mhb_higher_harmonics_evaluate(t->higher, d, t->x);
}

/* Residual t->r of many pairs at t->x, and the forces of all harmonics that are estimated. Those up
 * to m are the balance's. The motion has m harmonics only, which makes the others cheap. */
static void evaluate_above(mhb_truncation *t) {
  const mhb_balance *b  = t->balance;
  mhb_balance       *d  = t->doubled;
  const int          nb = b->nb, wide = mhb_real_size(t->higher->last);
  memset(d->eval->p, 0, sizeof(double) * (size_t)d->n);
  for (int a = 0; a < b->n_pairs; a++) {
    const bool       moves = b->eval->kind[a] == MHB_PAIR_NONLINEAR;
    double           motion[3 * nb];
    mhb_contact_info info;
    copy_rows(3, t->x + 3 * a * d->nb, d->nb, motion, nb);
    if (moves)
      mhb_contact_force_near(t->contact, &b->law[a], b->eval->info[a].slider, motion, t->force,
                             NULL, &info);
    mhb_higher_harmonics_set_force(t->higher, a, moves ? t->force : NULL);
    if (moves) copy_rows(3, t->force, wide, d->eval->p + 3 * a * d->nb, d->nb);
    copy_rows(3, b->eval->p + 3 * a * nb, nb, d->eval->p + 3 * a * d->nb, d->nb);
  }
  mhb_receptance_set_frequency(d->receptance, b->eval->at.omega);
  mhb_balance_residual_of_many(d, t->x, t->r);
}

/* The same without linearising the doubled balance. false: it failed. */
static bool set_broyden_step(mhb_truncation *t) {
  mhb_truncation_step *by    = t->broyden;
  const size_t         bytes = sizeof(double) * (size_t)t->doubled->n;
  (t->contact ? evaluate_above : evaluate_few)(t);
  memcpy(t->trial, t->doubled->eval->p, bytes); /* the forces at t->x */
  if (!mhb_truncation_step_find(by, t->x, t->r, NULL, t->step)) return false;
  if (mhb_norm(t->step, t->doubled->n) > FAR * mhb_balance_vibration(t->doubled, t->x))
    return false;
  if (!higher_count(t, t->balance, t->step)) return true;
  memcpy(t->doubled->eval->p, t->trial, bytes);
  mhb_higher_harmonics_feedback(t->higher, t->doubled, t->balance, t->x, t->feedback);
  return mhb_truncation_step_find(by, t->x, t->r, t->feedback, t->step);
}

static void set_step(mhb_truncation *t, bool by_broyden) {
  t->doubled->eval->near = true;
  t->by_broyden          = by_broyden && set_broyden_step(t);
  t->kind                = t->by_broyden ? MHB_TRUNCATION_NEWTON : set_newton_step(t);
  t->doubled->eval->near = false;
}

/* Squares of the sizes of harmonics 1..2m of solution and step. With fewer than 8 of them the tail
 * is not known; those above 2m, estimated one by one, do for it. */
static void set_powers(mhb_truncation *t) {
  const mhb_balance *b = t->doubled;
  memset(t->power, 0, sizeof(double) * (size_t)(b->m + 1));
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *x = t->x + row * b->nb, *step = t->step + row * b->nb;
    for (int i = 1; i < b->nb; i++) t->power[(i + 1) / 2] += (x[i] + step[i]) * (x[i] + step[i]);
  }
}

/* The tail of solution and step, its order and what remains of the error with 2m harmonics. */
static mhb_tail set_order(mhb_truncation *t) {
  set_powers(t);
  const mhb_tail tail = mhb_tail_of(t->doubled->m, t->power, ORDER_MARGIN);
  t->order            = tail.order;
  t->remaining        = fmin(SLOWEST, exp2(2 - (tail.order - ORDER_MARGIN)));
  return tail;
}

static void set_basis(mhb_truncation *t) {
  const int nb = t->doubled->nb;
  if (t->basis[0] != 0) return;
  for (int i = 0; i < t->n_times; i++)
    mhb_basis(t->doubled->m, SHB_TWO_PI * i / t->n_times, t->basis + (size_t)i * (size_t)nb, NULL);
}

/* Largest |e(t)| over all axes, e of 2m harmonics. */
static double largest_in_period(mhb_truncation *t, const double *e) {
  const int rows = 3 * t->doubled->n_pairs, nb = t->doubled->nb, n = t->n_times;
  double    top = 0;
  set_basis(t);
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, n, nb, 1, e, nb, t->basis, nb, 0,
              t->motion, n);
  for (int i = 0; i < n; i++) top = fmax(top, cblas_dnrm2(rows, t->motion + i, n));
  return top;
}

/* Told of an error without a bound, as at a resonance without damping: a file holds numbers. */
static const double NO_BOUND = 1e30;

/* Both norms of the error, from the step and the tail; t->trial <- the error up to 2m. size: of the
 * vibration. Returns the first. */
static double set_errors(mhb_truncation *t, double size) {
  const mhb_balance *b       = t->doubled;
  const int          low     = t->balance->nb;
  const bool         knows   = t->kind == MHB_TRUNCATION_NEWTON;
  const mhb_tail     tail    = knows ? set_order(t) : (mhb_tail){.order = INFINITY};
  double             highest = 0;
  for (int i = 0; i < b->n; i++)
    t->trial[i] = t->step[i] * (i % b->nb < low ? 1 / (1 - t->remaining) : 1);
  for (int k = b->m + 1; t->higher && k <= t->higher->last; k++)
    highest += sqrt(mhb_truncation_power(t, k));
  t->largest = fmin(NO_BOUND, (largest_in_period(t, t->trial) + fmax(highest, tail.sum)) / size);
  return fmin(NO_BOUND, hypot(mhb_norm(t->trial, b->n), fmax(t->higher_size, tail.rms)) / size);
}

/* The doubled balance at the point of the balance. Nothing from an estimate before enters. */
static void begin(mhb_truncation *t, const double *x) {
  mhb_balance *b = t->doubled;
  copy_rows(3 * b->n_pairs, x, t->balance->nb, t->x, b->nb);
  memset(t->step, 0, sizeof(double) * (size_t)b->n);
  t->higher_size = t->largest = t->remaining = 0;
  t->order                                   = INFINITY;
  t->kind                                    = MHB_TRUNCATION_NONE;
  mhb_balance_set_operating_point(b, &t->balance->eval->at);
  for (int a = 0; a < b->n_pairs; a++) {
    memcpy(b->eval->info[a].slider, t->balance->eval->info[a].slider, sizeof(double[2]));
    b->eval->kind[a] = t->balance->eval->kind[a];
  }
}

double mhb_truncation_error(mhb_truncation *t, const double *x) {
  const double size = mhb_balance_vibration(t->balance, x);
  begin(t, x);
  if (mhb_balance_is_linear(t->balance)) return 0;
  set_step(t, t->broyden != NULL);
  return size > 0 ? set_errors(t, size) : 0;
}

bool mhb_truncation_solve(mhb_truncation *t, double *change) {
  if (t->by_broyden) return mhb_truncation_step_solve(t->broyden, change);
  if (t->by_gmres) return mhb_doubled_ring_solve_low(t->ring, change);
  return mhb_condensation_solve(t->system, change);
}

/* change[n + 1] <- from t->x to the nearest point of the curve of 2m harmonics, to first order. The
 * motion is in units of `unit`, the value in its own. Of all solutions c + a y of the linearised
 * balance, y along the curve, the shortest is taken. false: singular, or too large. */
static bool find_nearest(mhb_truncation *t, double value, double unit, double *change) {
  mhb_balance  *b = t->doubled;
  const int     n = b->n;
  double        column[n + 1], row[n + 1], along[n + 1];
  mhb_parameter parameter = b->parameter;
  mhb_balance_set_parameter(b, t->balance->parameter);
  b->eval->near = true;
  mhb_balance_linearise(b, t->x, value, t->r, column);
  b->eval->near = false;
  mhb_balance_set_parameter(b, parameter);
  for (int i = 0; i < n; i++) {
    row[i] = t->x[i] / unit;
    column[i] *= fabs(value) / unit;
    change[i] = -t->r[i] / unit;
    along[i]  = 0;
  }
  change[n] = 0;
  row[n] = column[n] = along[n] = 1;
  if (!mhb_condensation_factor(t->system, column, row) ||
      !mhb_condensation_solve(t->system, change) || !mhb_condensation_solve(t->system, along))
    return false;
  const double part = mhb_dot(n + 1, change, along) / mhb_dot(n + 1, along, along);
  for (int i = 0; i <= n; i++) change[i] -= part * along[i];
  return true;
}

/* Whether the linearisation with 2m harmonics takes a border. */
static bool takes_border(const mhb_truncation *t) {
  return !t->ring && !t->system->low_rank;
}

double mhb_truncation_across(mhb_truncation *t, double value, double *shift) {
  const int    n    = t->doubled->n;
  const double unit = mhb_norm(t->x, n), size = mhb_balance_vibration(t->balance, t->x);
  const double order = t->order, remaining = t->remaining;
  double       change[n + 1], *step        = t->step;
  if (t->kind != MHB_TRUNCATION_NEWTON || !takes_border(t) || !(size > 0)) return INFINITY;
  if (!find_nearest(t, value, unit, change)) return INFINITY;
  *shift = fabs(change[n]);
  for (int i = 0; i < n; i++) change[i] *= unit;
  t->step            = change;
  const double error = set_errors(t, size);
  t->step            = step;
  t->order           = order;
  t->remaining       = remaining;
  return error;
}

/* Whether t->step is short enough for the linearisation. */
static bool is_short(const mhb_truncation *t) {
  return mhb_norm(t->step, t->doubled->n) <= FAR * mhb_balance_vibration(t->doubled, t->x);
}

/* t->step <- to the nearest point of the curve. Returns the relative change of the value; NAN: not
 * known. */
static double step_across(mhb_truncation *t, double value) {
  const int    n    = t->doubled->n;
  const double unit = mhb_norm(t->x, n);
  double       change[n + 1];
  if (!takes_border(t) || !(unit > 0) || !find_nearest(t, value, unit, change)) return NAN;
  for (int i = 0; i < n; i++) t->step[i] = unit * change[i];
  t->kind = MHB_TRUNCATION_NEWTON;
  set_order(t);
  return change[n];
}

bool mhb_truncation_correct(mhb_truncation *t, const double *x, double value) {
  mhb_balance  *b         = t->doubled;
  mhb_parameter parameter = b->parameter;
  double        shift     = 0;
  mhb_truncation_error(t, x);
  if (t->kind == MHB_TRUNCATION_FIRST_ORDER || !is_short(t)) shift = step_across(t, value);
  if (isnan(shift) || !is_short(t)) return false;
  for (int i = 0; i < b->n; i++) t->x[i] += t->step[i];
  mhb_balance_set_parameter(b, t->balance->parameter);
  mhb_balance_evaluate(b, t->x, value + shift * fabs(value), t->r, NULL, NULL);
  mhb_balance_set_parameter(b, parameter);
  return true;
}

bool mhb_truncation_linearise(mhb_truncation *t) {
  if (!t->by_broyden) return false;
  set_step(t, false);
  return t->kind == MHB_TRUNCATION_NEWTON;
}

double mhb_truncation_part(mhb_truncation *t, const double *step) {
  return t->kind == MHB_TRUNCATION_NEWTON ? first_root(bend(t, step)) : 1;
}

double mhb_truncation_power(const mhb_truncation *t, int k) {
  const mhb_balance *b = t->doubled;
  if (t->kind == MHB_TRUNCATION_NONE) return 0;
  if (k > b->m)
    return t->kind == MHB_TRUNCATION_NEWTON && t->higher ? mhb_higher_harmonics_power(t->higher, k)
                                                         : 0;
  double sum = 0;
  for (int row = 0; row < 3 * b->n_pairs; row++) {
    const double *a = t->step + (size_t)row * (size_t)b->nb;
    sum += a[2 * k - 1] * a[2 * k - 1] + a[2 * k] * a[2 * k];
  }
  return sum;
}
