#include "mhb/balance/truncation_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/numerics/fourier.h"
#include "mhb/numerics/vector.h"

/* Higher harmonics below this share of the step are not fed back. */
static const double NEGLIGIBLE = 0.1;

/* Distance of the evaluation that measures the curvature, relative to the vibration. */
static const double NEARBY = 0.1;

/* Error of the products with the receptance of many pairs. The estimate is a few per cent off
 * anyhow, and an error above 1e-5 is one. */
static const double COARSE = 1e-8;

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
  mhb_truncation *t = calloc(1, sizeof *t);
  SHB_CHECK(t, SHB_ERR_IO, "out of memory");
  int m   = balance->m;
  int top = mhb_truncation_highest(m);
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
    if (t->arena.failed) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  if (status == SHB_OK && balance->receptance->ring)
    status = mhb_ring_truncation_create(balance, t->doubled, &t->ring);
  if (status == SHB_OK && !balance->receptance->ring)
    status = mhb_higher_harmonics_create(t->doubled, t->receptance, &t->higher);
  if (status == SHB_OK)
    status = mhb_condensation_create_within(t->doubled, MHB_MOST_DOUBLED, &t->system);
  if (status != SHB_OK) {
    mhb_truncation_destroy(t);
    return status;
  }
  *out = t;
  return SHB_OK;
}

void mhb_truncation_destroy(mhb_truncation *t) {
  if (!t) return;
  mhb_condensation_destroy(t->system);
  mhb_higher_harmonics_destroy(t->higher);
  mhb_ring_truncation_destroy(t->ring);
  mhb_balance_destroy(t->doubled);
  mhb_receptance_destroy(t->receptance);
  shb_arena_free(&t->arena);
  free(t);
}

/* Rows of nb coefficients into rows of wide ones, or back; the rest is left as it is. */
static void copy_rows(int rows, const double *from, int nb, double *to, int wide) {
  size_t length = sizeof(double) * (size_t)(nb < wide ? nb : wide);
  for (int i = 0; i < rows; i++)
    memcpy(to + (size_t)i * (size_t)wide, from + (size_t)i * (size_t)nb, length);
}

/* kappa of the residual along a step, -1 + tau + kappa tau^2 in units of the step, from one more
 * evaluation nearby. The residual of the solution is that of delta / part. */
static double curvature(mhb_truncation *t, const double *step, double length, double size) {
  mhb_balance *b    = t->doubled;
  double       part = fmin(1, NEARBY * size / length), product = 0;
  for (int i = 0; i < b->n; i++) t->trial[i] = t->x[i] + part * step[i];
  double *r = t->trial;
  mhb_balance_evaluate(b, t->trial, t->balance->eval->at.omega, t->r, NULL, NULL);
  for (int i = 0; i < b->n; i++) r[i] = t->r[i] + t->feedback[i];
  if (!mhb_condensation_solve(t->system, r)) return 0;
  for (int i = 0; i < b->n; i++)
    product += (r[i] + t->step[i] / t->part - part * step[i]) / length * (step[i] / length);
  return product / (part * part);
}

/* Smallest positive root tau of -1 + tau + kappa tau^2, or the modulus of complex roots. */
static double first_root(double kappa) {
  double root = 1 + 4 * kappa;
  return root >= 0 ? 2 / (1 + sqrt(root)) : 1 / sqrt(-kappa);
}

double mhb_truncation_part(mhb_truncation *t, const double *step) {
  double length = mhb_norm(step, t->doubled->n), size = mhb_balance_vibration(t->doubled, t->x);
  return length > 0 ? first_root(curvature(t, step, length, size)) : 1;
}

static void scale_step(mhb_truncation *t) {
  t->part     = 1;
  double part = mhb_truncation_part(t, t->step);
  for (int i = 0; i < t->doubled->n; i++) t->step[i] *= part;
  t->part = part;
}

/* step <- the Newton step, or -r where the step does not exist or is too large a system. */
static mhb_truncation_kind set_step(mhb_truncation *t) {
  mhb_balance *b     = t->doubled;
  double       omega = t->balance->eval->at.omega;
  size_t       bytes = sizeof(double) * (size_t)b->n;
  mhb_balance_linearise(b, t->x, omega, t->r, NULL);
  for (int i = 0; i < b->n; i++) t->step[i] = -t->r[i];
  if (!mhb_condensation_factor(t->system, NULL, NULL)) return MHB_TRUNCATION_FIRST_ORDER;
  memcpy(t->trial, t->step, bytes);
  if (!mhb_condensation_solve(t->system, t->trial)) return MHB_TRUNCATION_FIRST_ORDER;
  memset(t->feedback, 0, bytes);
  double length  = mhb_norm(t->trial, b->n);
  t->higher_size = t->higher ? mhb_higher_harmonics_estimate(t->higher, b, t->x) : 0;
  if (t->higher_size > NEGLIGIBLE * length) {
    mhb_higher_harmonics_feedback(t->higher, b, t->x, t->feedback);
    for (int i = 0; i < b->n; i++) t->trial[i] = -t->r[i] - t->feedback[i];
    mhb_condensation_solve(t->system, t->trial);
  }
  memcpy(t->step, t->trial, bytes);
  scale_step(t);
  return MHB_TRUNCATION_NEWTON;
}

double mhb_truncation_error(mhb_truncation *t, const double *x) {
  mhb_balance *b    = t->doubled;
  double       size = mhb_balance_vibration(t->balance, x);
  copy_rows(3 * b->n_pairs, x, t->balance->nb, t->x, b->nb);
  memset(t->step, 0, sizeof(double) * (size_t)b->n);
  t->higher_size = 0;
  t->kind        = MHB_TRUNCATION_NONE;
  if (mhb_balance_is_linear(t->balance)) return 0;
  mhb_balance_set_operating_point(b, &t->balance->eval->at);
  for (int a = 0; a < b->n_pairs; a++)
    memcpy(b->eval->info[a].slider, t->balance->eval->info[a].slider, sizeof(double[2]));
  b->eval->near = true;
  t->part       = 1;
  t->kind = t->ring && t->factors && mhb_ring_truncation_step(t->ring, t->factors, t->x, t->step)
                ? MHB_TRUNCATION_NEWTON
                : set_step(t);
  b->eval->near = false;
  return size > 0 ? hypot(mhb_norm(t->step, b->n), t->higher_size) / size : 0;
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
