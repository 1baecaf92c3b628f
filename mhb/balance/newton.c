#include "mhb/balance/newton.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

enum { MAX_ITERATIONS = 40, MAX_HALVINGS = 8 };

mhb_newton *mhb_newton_create(int n) {
  mhb_newton *w   = shb_alloc_zeroed(1, sizeof *w);
  size_t      one = (size_t)n + 1;
  w->n            = n;
  w->r            = shb_arena_take(&w->arena, one, sizeof(double));
  w->step         = shb_arena_take(&w->arena, one, sizeof(double));
  w->trial        = shb_arena_take(&w->arena, one, sizeof(double));
  w->slope        = shb_arena_take(&w->arena, one, sizeof(double));
  w->row          = shb_arena_take(&w->arena, one, sizeof(double));
  return w;
}

void mhb_newton_destroy(mhb_newton *w) {
  if (!w) return;
  shb_arena_free(&w->arena);
  mhb_condensation_destroy(w->system);
  free(w);
}

void mhb_newton_bind(mhb_newton *w, const mhb_balance *b) {
  const mhb_condensation *s = w->system;
  if (s && s->balance == b && s->m == b->m && s->n_pairs == b->n_pairs) return;
  mhb_condensation_destroy(w->system);
  w->system = mhb_condensation_create(b);
}

/* Halve the step until |r| decreases; leaves r and the linearisation at the new x. */
static int line_search(mhb_newton *w, mhb_balance *b, double value, double *x, double *size) {
  int n = w->n;
  memcpy(w->trial, x, sizeof(double) * (size_t)n);
  double before = *size, fraction = 1;
  for (int i = 0; i < MAX_HALVINGS; i++, fraction *= 0.5) {
    for (int j = 0; j < n; j++) x[j] = w->trial[j] - fraction * w->step[j];
    b->eval->near = true;
    mhb_balance_linearise(b, x, value, w->r, NULL);
    b->eval->near = false;
    *size         = mhb_norm(w->r, n);
    if (*size < (1 - 0.1 * fraction) * before) return 1;
  }
  return 0;
}

mhb_reason mhb_newton_solve(mhb_newton *w, mhb_balance *b, double value, double tolerance,
                            double *x, int *iterations) {
  int n = w->n;
  mhb_newton_bind(w, b);
  mhb_balance_linearise(b, x, value, w->r, NULL);
  double size = mhb_norm(w->r, n);
  for (*iterations = 0; *iterations < MAX_ITERATIONS; ++*iterations) {
    if (size <= tolerance * fmax(mhb_norm(x, n), DBL_MIN)) return MHB_CONVERGED;
    if (w->go_on && !w->go_on(w->context)) return MHB_GIVEN_UP;
    memcpy(w->step, w->r, sizeof(double) * (size_t)n);
    if (!mhb_condensation_factor(w->system, NULL, NULL) ||
        !mhb_condensation_solve(w->system, w->step))
      return MHB_SINGULAR;
    if (!line_search(w, b, value, x, &size))
      return size <= 100 * tolerance * mhb_norm(x, n) ? MHB_CONVERGED /* |r| is rounding */
                                                      : MHB_NO_DESCENT;
  }
  return MHB_MAX_ITERATIONS;
}
