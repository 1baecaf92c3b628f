#include "mhb/search/multistart.h"

#include <math.h>
#include <string.h>

#include "mhb/numerics/random.h"
#include "mhb/structure/ring_receptance.h"

static const double TOLERANCE = 1e-10, SMALL = 1e-6;
enum { MAX_STEPS = 40, MAX_HALVINGS = 6 };

/* A random motion with jumps of acceleration: harmonic k is bounded by that of the fundamental over
 * k^2. */
static void draw(const mhb_balance *b, double size, unsigned long long *seed, double *x) {
  for (int row = 0; row < b->n / b->nb; row++)
    for (int j = 0; j < b->nb; j++) {
      int k              = (j + 1) / 2;
      x[row * b->nb + j] = size * mhb_random(seed) / fmax(1, k * k);
    }
}

/* A number from 0 to n - 1. */
static int choose(int n, unsigned long long *seed) {
  return (int)(0.5 * (mhb_random(seed) + 1) * n);
}

/* In a ring: a known motion, but for up to half of the contacts next to each other, which are
 * random. Motions of few blades are hardly met from random motions of all. */
static void draw_beside(const mhb_balance *b, double size, const mhb_solution_set *set,
                        unsigned long long *seed, double *x) {
  const mhb_ring_receptance *g     = b->receptance->ring;
  const size_t               own   = (size_t)g->n * (size_t)b->nb;
  const int                  known = choose(set->n_solutions, seed);
  const int length = 1 + choose(g->blades / 2, seed), first = choose(g->blades, seed);
  double    random[b->n];
  draw(b, size, seed, random);
  memcpy(x, set->x + (size_t)known * (size_t)set->n, sizeof random);
  for (int i = 0; i < length; i++) {
    const size_t at = (size_t)((first + i) % g->blades) * own;
    memcpy(x + at, random + at, own * sizeof *x);
  }
}

static void start_at(const mhb_balance *b, double size, const mhb_solution_set *set,
                     unsigned long long *seed, double *x) {
  if (b->receptance->ring && set->n_solutions > 0 && mhb_random(seed) < 0)
    draw_beside(b, size, set, seed, x);
  else
    draw(b, size, seed, x);
}

/* Newton's method from x with steps of 2 size at most, for each blade of a ring. 1: |r| has become
 * small. */
static int descend(mhb_newton *w, mhb_balance *b, double value, double size, double *x) {
  int    n = b->n;
  double start[n];
  if (b->receptance->ring) size *= sqrt(b->receptance->ring->blades);
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

void mhb_multistart_once(mhb_newton *w, mhb_balance *b, double value, double size,
                         unsigned long long *seed, mhb_solution_set *set, double *x, bool *is_new) {
  int iterations;
  *is_new = false;
  mhb_newton_bind(w, b);
  set->n = b->n;
  start_at(b, size, set, seed, x);
  if (!descend(w, b, value, size, x)) return;
  if (mhb_newton_solve(w, b, value, TOLERANCE, x, &iterations) != MHB_CONVERGED) return;
  *is_new = !mhb_solution_set_has(set, x);
  if (*is_new) mhb_solution_set_add_copies(set, b, x);
}
