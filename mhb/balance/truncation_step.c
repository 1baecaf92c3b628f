#include "mhb/balance/truncation_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "mhb/balance/higher_harmonics.h"
#include "mhb/low_rank/lone_harmonics.h"
#include "mhb/numerics/lu.h"
#include "mhb/numerics/vector.h"
#include "mhb/structure/ring_receptance.h"

/* What may be left of the step, with many pairs and with few. */
static const double LEFT = 0.1, LEFT_OF_FEW = 0.01;

/* A correction must be smaller than this part of the one before. The first one has the harmonics
 * above m only, the second one what the others make of them. */
static const double GAIN = 0.7;

/* Error of the solutions with m harmonics and many pairs; the next residual removes it. */
static const double ROUGH = 1e-2;

static void create_pairs(mhb_truncation_step *t) {
  const mhb_balance *b       = t->balance;
  const double      *between = b->settings->frequency;
  const size_t       n = 3 * (size_t)b->n_pairs, above = (size_t)(t->doubled->m - b->m);
  t->D = shb_arena_take(&t->arena, 3 * n, sizeof *t->D);
  if (!t->above) {
    t->A      = shb_arena_take(&t->arena, above * n * n, sizeof *t->A);
    t->pivot  = shb_arena_take(&t->arena, above * n, sizeof *t->pivot);
    t->u      = shb_arena_take(&t->arena, n, sizeof *t->u);
    t->system = mhb_condensation_create(b);
    return;
  }
  t->form = shb_arena_take(&t->arena, (size_t)b->n_pairs, sizeof *t->form);
  t->jacobian =
      mhb_woodbury_create(b->product, b->law, SHB_TWO_PI * between[0], SHB_TWO_PI * between[1]);
}

mhb_truncation_step *mhb_truncation_step_create(const mhb_balance *b, mhb_balance *doubled,
                                                mhb_woodbury *above) {
  mhb_truncation_step *t   = shb_alloc_zeroed(1, sizeof *t);
  const size_t         all = (size_t)doubled->n;
  t->balance               = b;
  t->doubled               = doubled;
  t->above                 = above;
  t->low                   = shb_arena_take(&t->arena, (size_t)b->n, sizeof(double));
  t->at                    = shb_arena_take(&t->arena, all, sizeof(double));
  t->r                     = shb_arena_take(&t->arena, all, sizeof(double));
  t->most                  = above ? MHB_MOST_TRUNCATION_STEPS : MHB_MOST_STEPS_OF_FEW;
  t->steps                 = shb_arena_take(&t->arena, (size_t)t->most * all, sizeof(double));
  create_pairs(t);
  return t;
}

void mhb_truncation_step_destroy(mhb_truncation_step *t) {
  if (!t) return;
  mhb_woodbury_destroy(t->jacobian);
  mhb_condensation_destroy(t->system);
  shb_arena_free(&t->arena);
  free(t);
}

static const double complex (*stiffness_of(const mhb_truncation_step *t))[9] {
  return (const double complex(*)[9])t->D;
}

/* Place of harmonic k > m of few pairs among the factors above. */
static size_t place_of(const mhb_truncation_step *t, int k) {
  return (size_t)(k - t->balance->m - 1);
}

/* Factors of few pairs above m. 0: singular. */
static int factor_above(mhb_truncation_step *t) {
  const mhb_receptance *r = t->doubled->receptance;
  const size_t          n = (size_t)r->n;
  for (int k = t->balance->m + 1; k <= t->doubled->m; k++) {
    double complex *A = t->A + place_of(t, k) * n * n;
    mhb_receptance_update(t->doubled->receptance, k);
    mhb_harmonic_matrix(r->n, r->R + (size_t)k * n * n, stiffness_of(t), A);
    if (!mhb_factor_complex(r->n, A, t->pivot + place_of(t, k) * n)) return 0;
  }
  return 1;
}

static void solve_above(mhb_truncation_step *t, double *x) {
  const int n = t->doubled->receptance->n, nb = t->doubled->nb;
  for (int k = t->balance->m + 1; k <= t->doubled->m; k++, x += 2) {
    const size_t at = place_of(t, k), first = 2 * (size_t)t->balance->m + 1;
    for (int i = 0; i < n; i++) t->u[i] = CMPLX(x[i * nb + (int)first], x[i * nb + (int)first + 1]);
    mhb_solve_complex(n, t->A + at * (size_t)(n * n), t->pivot + at * (size_t)n, 1, t->u);
    for (int i = 0; i < n; i++) {
      x[i * nb + (int)first]     = creal(t->u[i]);
      x[i * nb + (int)first + 1] = cimag(t->u[i]);
    }
  }
}

/* Factors with m harmonics, and of those above. 0: singular, or there is no small basis. */
static int factor(mhb_truncation_step *t) {
  const mhb_balance *b = t->balance;
  for (int a = 0; a < b->n_pairs; a++) {
    if (t->form) t->form[a] = mhb_pair_block(b, a);
    mhb_last_stiffness(b, a, (double complex(*)[3])(t->D + 9 * a));
  }
  mhb_receptance_set_frequency(t->doubled->receptance, b->eval->at.omega);
  if (t->system) return mhb_condensation_factor(t->system, NULL, NULL) && factor_above(t);
  return mhb_woodbury_factor(t->jacobian, t->form, b->eval->dp, b->law, NULL, NULL) &&
         mhb_lone_harmonics_factor(t->above, b->law, b->m + 1, stiffness_of(t));
}

int mhb_truncation_step_solve(mhb_truncation_step *t, double *change) {
  const mhb_balance *b    = t->balance;
  const int          rows = 3 * b->n_pairs, nb = b->nb, wide = t->doubled->nb;
  const size_t       length = sizeof(double) * (size_t)nb;
  for (int i = 0; i < rows; i++) memcpy(t->low + i * nb, change + i * wide, length);
  if (!(t->system ? mhb_condensation_solve(t->system, t->low)
                  : mhb_woodbury_solve(t->jacobian, ROUGH, t->low)))
    return 0;
  for (int i = 0; i < rows; i++) memcpy(change + i * wide, t->low + i * nb, length);
  return 1;
}

/* change[doubled->n] <- the first matrix' solution. 0: it failed. */
static int solve(mhb_truncation_step *t, double *change) {
  if (t->system)
    solve_above(t, change);
  else
    mhb_lone_harmonics_solve(t->above, t->balance->m + 1, stiffness_of(t), change);
  return mhb_truncation_step_solve(t, change);
}

static double product(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* Broyden's update of correction `done` by those before (Kelley 1995, 7.3). */
static void update(const double *steps, int done, int n, double *step) {
  for (int j = 0; j + 1 < done; j++) {
    const double *s = steps + j * n, *after = s + n;
    const double  part = product(n, s, step) / product(n, s, s);
    for (int i = 0; i < n; i++) step[i] += part * after[i];
  }
  if (done == 0) return;
  const double *s    = steps + (done - 1) * n;
  const double  rest = 1 - product(n, s, step) / product(n, s, s);
  for (int i = 0; i < n; i++) step[i] /= rest;
}

/* t->r <- the residual at x + step. */
static void evaluate(mhb_truncation_step *t, const double *x, const double *step) {
  mhb_balance *b = t->doubled;
  for (int i = 0; i < b->n; i++) t->at[i] = x[i] + step[i];
  b->assumed = t->balance->eval->kind;
  mhb_balance_evaluate(b, t->at, t->balance->eval->at.omega, t->r, NULL, NULL);
  b->assumed = NULL;
}

int mhb_truncation_step_find(mhb_truncation_step *t, const double *x, const double *r,
                             const double *feedback, double *step) {
  mhb_balance *b      = t->doubled;
  const int    n      = b->n;
  double       before = INFINITY;
  if (!factor(t)) return 0;
  memset(step, 0, sizeof(double) * (size_t)n);
  const double left = t->system ? LEFT_OF_FEW : LEFT;
  for (int done = 0; done < t->most; done++) {
    double *change = t->steps + done * n;
    if (done > 0) evaluate(t, x, step);
    const double *residual = done > 0 ? t->r : r;
    for (int i = 0; i < n; i++) change[i] = -residual[i] - (feedback ? feedback[i] : 0);
    if (!solve(t, change)) return 0;
    update(t->steps, done, n, change);
    for (int i = 0; i < n; i++) step[i] += change[i];
    const double size = mhb_norm(change, n), part = size / before;
    if (done > 1 && !(part < GAIN)) return 0;
    if (done > 1 && size * part / (1 - part) <= left * mhb_norm(step, n)) return 1;
    before = size;
  }
  return 0;
}
