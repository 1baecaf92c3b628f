#include "mhb/balance/multistart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/balance/subharmonics.h"
#include "mhb/numerics/random.h"

static const double TOLERANCE = 1e-10, SAME = 1e-5, SMALL = 1e-6;
enum { MAX_STEPS = 40, MAX_HALVINGS = 6 };

void mhb_solution_set_free(mhb_solution_set *set) {
  free(set->x);
  *set = (mhb_solution_set){0};
}

shb_status mhb_solution_set_add(mhb_solution_set *set, int n, const double *x) {
  if (set->n_solutions == set->capacity) {
    int     room = 2 * set->capacity + 8;
    double *more = realloc(set->x, sizeof(double) * (size_t)room * (size_t)n);
    SHB_CHECK(more, SHB_ERR_IO, "out of memory for %d solutions", room);
    set->x        = more;
    set->capacity = room;
  }
  set->n = n;
  memcpy(set->x + (size_t)set->n_solutions++ * (size_t)n, x, sizeof(double) * (size_t)n);
  return SHB_OK;
}

/* A random motion with jumps of acceleration: harmonic k is bounded by that of the fundamental over
 * k^2. */
static void draw(const mhb_balance *b, double size, unsigned long long *seed, double *x) {
  for (int row = 0; row < b->n / b->nb; row++)
    for (int j = 0; j < b->nb; j++) {
      int k              = (j + 1) / 2;
      x[row * b->nb + j] = size * mhb_random(seed) / fmax(1, k * k);
    }
}

static double distance(const double *a, const double *b, int n) {
  double d[n];
  for (int i = 0; i < n; i++) d[i] = a[i] - b[i];
  return mhb_norm(d, n);
}

/* Newton's method from x with steps of 2 size at most. 1: |r| has become small. */
static int descend(mhb_newton *w, mhb_balance *b, double value, double size, double *x) {
  int    n = b->n;
  double start[n];
  for (int step = 0; step < MAX_STEPS; step++) {
    mhb_balance_linearise(b, x, value, w->r, NULL);
    double before = mhb_norm(w->r, n), part = 1;
    if (!isfinite(before)) return 0;
    if (before <= SMALL * mhb_norm(x, n)) return 1;
    memcpy(w->step, w->r, sizeof(double) * (size_t)n);
    if (!mhb_condensation_factor(w->system, NULL, NULL) ||
        !mhb_condensation_solve(w->system, w->step))
      return 0;
    double length = mhb_norm(w->step, n), r = INFINITY;
    if (length > 2 * size) part = 2 * size / length;
    memcpy(start, x, sizeof start);
    for (int k = 0; k <= MAX_HALVINGS && !(r < before); k++, part *= 0.5) {
      for (int i = 0; i < n; i++) x[i] = start[i] - part * w->step[i];
      mhb_balance_evaluate(b, x, value, w->r, NULL, NULL);
      r = mhb_norm(w->r, n);
    }
    if (!(r < before)) return 0;
  }
  return 0;
}

bool mhb_solution_set_has(const mhb_solution_set *set, const double *x) {
  for (int f = 0; f < set->n_solutions; f++) {
    const double *y = set->x + (size_t)f * (size_t)set->n;
    if (distance(x, y, set->n) <= SAME * fmax(mhb_norm(x, set->n), mhb_norm(y, set->n)))
      return true;
  }
  return false;
}

shb_status mhb_solution_set_add_shifts(mhb_solution_set *set, const mhb_balance *b,
                                       const double *x) {
  double later[b->n];
  set->n = b->n;
  for (int j = 0; j < b->receptance->nu; j++) {
    mhb_subharmonic_shift(b, x, j, later);
    if (!mhb_solution_set_has(set, later)) SHB_TRY(mhb_solution_set_add(set, b->n, later));
  }
  return SHB_OK;
}

shb_status mhb_multistart_once(mhb_newton *w, mhb_balance *b, double value, double size,
                               unsigned long long *seed, mhb_solution_set *set, double *x,
                               bool *is_new) {
  int iterations;
  *is_new = false;
  SHB_TRY(mhb_newton_bind(w, b));
  set->n = b->n;
  draw(b, size, seed, x);
  if (!descend(w, b, value, size, x)) return SHB_OK;
  if (mhb_newton_solve(w, b, value, TOLERANCE, x, &iterations) != MHB_CONVERGED) return SHB_OK;
  *is_new = !mhb_solution_set_has(set, x);
  return *is_new ? mhb_solution_set_add_shifts(set, b, x) : SHB_OK;
}
