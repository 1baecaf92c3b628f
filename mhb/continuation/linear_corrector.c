#include "mhb/continuation/linear_corrector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/balance/stick_stiffness.h"
#include "mhb/numerics/lu.h"

enum { MAX_ITERATIONS = 8 };

mhb_linear_corrector *mhb_linear_corrector_create(const mhb_balance *b) {
  mhb_linear_corrector *s     = shb_alloc_zeroed(1, sizeof *s);
  size_t                pairs = (size_t)b->n_pairs, n = 3 * pairs;
  s->n     = (int)n;
  s->A     = shb_alloc_zeroed(n * n, sizeof(double complex));
  s->pivot = shb_alloc_zeroed(n, sizeof(int));
  s->u     = shb_alloc_zeroed(n, sizeof(double complex));
  s->p     = shb_alloc_zeroed(n, sizeof(double complex));
  s->slope = shb_alloc_zeroed((size_t)b->n, sizeof(double));
  s->kind  = shb_alloc_zeroed(pairs, sizeof *s->kind);
  return s;
}

void mhb_linear_corrector_destroy(mhb_linear_corrector *s) {
  if (!s) return;
  free(s->A);
  free(s->pivot);
  free(s->u);
  free(s->p);
  free(s->slope);
  free(s->kind);
  free(s);
}

static int factor(mhb_linear_corrector *s, const mhb_balance *b, int k) {
  const size_t n = (size_t)s->n;
  mhb_receptance_update(b->receptance, k);
  mhb_stick_matrix(b->n_pairs, b->law, s->kind, k, b->receptance->R + (size_t)k * n * n, s->A);
  return mhb_factor_complex(s->n, s->A, s->pivot);
}

/* u <- A_k^-1 u. *factored: whether s->A holds the factors of A_k; many pairs do without. 0:
 * singular. */
static int solve(mhb_linear_corrector *s, mhb_balance *b, int k, bool *factored) {
  if (!*factored && mhb_balance_solve_many_stuck(b, k, s->kind, s->u)) return 1;
  *factored = *factored || factor(s, b, k);
  return *factored && mhb_solve_complex(s->n, s->A, s->pivot, 1, s->u);
}

static void store(const mhb_balance *b, int k, const double complex *in, double *x) {
  for (int i = 0; i < 3 * b->n_pairs; i++) {
    x[i * b->nb + 2 * k - 1] = creal(in[i]);
    x[i * b->nb + 2 * k]     = cimag(in[i]);
  }
}

/* Harmonic k > 0 of x and slope at the receptance's omega. */
static int harmonic(mhb_linear_corrector *s, mhb_balance *b, int k, double *x) {
  int  n        = s->n;
  bool factored = false;
  if (!b->receptance->driven[k]) {
    memset(s->u, 0, sizeof(double complex) * (size_t)n);
    store(b, k, s->u, x);
    store(b, k, s->u, s->slope);
    return 1;
  }
  mhb_balance_update_probes(b, k);
  memcpy(s->u, b->receptance->free + k * n, sizeof(double complex) * (size_t)n);
  if (!solve(s, b, k, &factored)) return 0;
  store(b, k, s->u, x);
  memset(s->p, 0, sizeof(double complex) * (size_t)n);
  for (int a = 0; a < b->n_pairs; a++)
    if (s->kind[a] == MHB_PAIR_STUCK) mhb_stick_force(&b->law[a], k, s->u + 3 * a, s->p + 3 * a);
  mhb_receptance_slope(b->receptance, k, s->p, s->u);
  if (!solve(s, b, k, &factored)) return 0;
  store(b, k, s->u, s->slope);
  return 1;
}

/* In its regime a pair acts as a spring, or not at all. */
static mhb_pair_kind class_of(mhb_pair_kind kind) {
  return kind == MHB_PAIR_AT_LIMIT ? MHB_PAIR_STUCK : kind;
}

void mhb_linear_set_states(mhb_linear_corrector *s, const mhb_evaluation *e, int n_pairs) {
  for (int a = 0; a < n_pairs; a++) s->kind[a] = class_of(e->kind[a]);
}

bool mhb_linear_states_hold(const mhb_linear_corrector *s, const mhb_evaluation *e, int n_pairs) {
  for (int a = 0; a < n_pairs; a++)
    if (class_of(e->kind[a]) != s->kind[a]) return false;
  return true;
}

/* Inner product over the harmonics k > 0. */
static double product(const mhb_balance *b, const double *x, const double *y) {
  double sum = 0;
  for (int row = 0; row < 3 * b->n_pairs; row++)
    for (int i = row * b->nb + 1; i < (row + 1) * b->nb; i++) sum += x[i] * y[i];
  return sum;
}

int mhb_linear_correct(mhb_linear_corrector *s, mhb_balance *b, const double *normal,
                       double x_weight, double value_weight, double *x, double *omega,
                       int *iterations) {
  double plane = x_weight * product(b, normal, x) + value_weight * normal[b->n] * *omega;
  for (*iterations = 1; *iterations <= MAX_ITERATIONS; ++*iterations) {
    mhb_receptance_set_frequency(b->receptance, *omega);
    for (int k = 1; k <= b->m; k++)
      if (!harmonic(s, b, k, x)) return 0;
    double off  = x_weight * product(b, normal, x) + value_weight * normal[b->n] * *omega - plane;
    double rate = x_weight * product(b, normal, s->slope) + value_weight * normal[b->n];
    double step = -off / rate;
    if (!isfinite(step) || fabs(step) > 0.1 * *omega) return 0;
    if (fabs(step) < 1e-12 * *omega) return 1;
    *omega += step;
  }
  return 0;
}

/* A <- I + R_0 dp_0/du_0, column-major, factored. */
static int factor_means(mhb_linear_corrector *s, const mhb_balance *b) {
  int    n     = s->n;
  size_t block = 3 * (size_t)b->nb;
  mhb_receptance_update(b->receptance, 0);
  for (int a = 0; a < b->n_pairs; a++)
    for (int d = 0; d < 3;
         d++) { /* dp[c]: how the mean force c of a pair follows its mean motion d */
      const double *dp = b->eval->dp + (size_t)a * block * block + d * b->nb;
      double        p[3];
      for (int c = 0; c < 3; c++) p[c] = dp[(size_t)(c * b->nb) * block];
      const double complex *R = b->receptance->R + 3 * a;
      for (int i = 0; i < n; i++, R += n)
        s->A[(3 * a + d) * n + i] =
            creal(R[0]) * p[0] + creal(R[1]) * p[1] + creal(R[2]) * p[2] + (i == 3 * a + d);
    }
  return mhb_factor_complex(n, s->A, s->pivot);
}

int mhb_linear_correct_means(mhb_linear_corrector *s, const mhb_balance *b, const double *r,
                             int again, double *x) {
  if (!again && !factor_means(s, b)) return 0;
  for (int row = 0; row < s->n; row++) s->u[row] = r[row * b->nb];
  if (!mhb_solve_complex(s->n, s->A, s->pivot, 1, s->u)) return 0;
  for (int row = 0; row < s->n; row++) x[row * b->nb] -= creal(s->u[row]);
  return 1;
}
