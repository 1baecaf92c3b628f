#include "mhb/search/solution_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/vector.h"
#include "mhb/search/ring_symmetry.h"

static const double SAME = 1e-5;

void mhb_solution_set_free(mhb_solution_set *set) {
  free(set->x);
  *set = (mhb_solution_set){0};
}

void mhb_solution_set_add(mhb_solution_set *set, int n, const double *x) {
  if (set->n_solutions == set->capacity) {
    set->capacity = 2 * set->capacity + 8;
    set->x        = shb_realloc(set->x, (size_t)set->capacity * (size_t)n, sizeof(double));
  }
  set->n = n;
  memcpy(set->x + (size_t)set->n_solutions++ * (size_t)n, x, sizeof(double) * (size_t)n);
}

static double distance(const double *a, const double *b, int n) {
  double d[n];
  for (int i = 0; i < n; i++) d[i] = a[i] - b[i];
  return mhb_norm(d, n);
}

bool mhb_solution_set_has(const mhb_solution_set *set, const double *x) {
  for (int f = 0; f < set->n_solutions; f++) {
    const double *y = set->x + (size_t)f * (size_t)set->n;
    if (distance(x, y, set->n) <= SAME * fmax(mhb_norm(x, set->n), mhb_norm(y, set->n)))
      return true;
  }
  return false;
}

void mhb_solution_set_add_copies(mhb_solution_set *set, const mhb_balance *b, const double *x) {
  const int copies = mhb_motion_copies(b);
  double    copy[b->n];
  set->n = b->n;
  for (int j = 0; j < copies; j++) {
    mhb_motion_copy(b, x, j, copy);
    if (!mhb_solution_set_has(set, copy)) mhb_solution_set_add(set, b->n, copy);
  }
}
