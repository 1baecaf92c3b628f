#include "cases/study/nearest_design.h"

#include <math.h>

/* Lowest and highest value of a key over all designs. */
static void set_range(const design_study *s, int key, double range[2]) {
  range[0] = INFINITY;
  range[1] = -INFINITY;
  for (int i = 0; i < s->n; i++) {
    range[0] = fmin(range[0], s->design[i].key[key]);
    range[1] = fmax(range[1], s->design[i].key[key]);
  }
}

/* The square of the distance between two designs. */
static double distance(const design_study *s, double (*range)[2], int a, int b) {
  double sum = 0;
  for (int k = 0; k < s->n_keys; k++) {
    double low = range[k][0], high = range[k][1];
    double x = s->design[a].key[k], y = s->design[b].key[k];
    double part = low > 0 ? log(x / y) / log(high / low) : (x - y) / (high - low);
    if (high > low) sum += part * part;
  }
  return sum;
}

int nearest_design(const design_study *s, int design) {
  int    best  = -1;
  double least = INFINITY, range[s->n_keys + 1][2];
  for (int k = 0; k < s->n_keys; k++) set_range(s, k, range[k]);
  for (int i = 0; i < s->n; i++) {
    const study_design *d = &s->design[i];
    if (i == design || d->state != STUDY_DONE || d->tried_from >= 0) continue;
    double here = distance(s, range, i, design);
    if (here >= least) continue;
    least = here;
    best  = i;
  }
  return best;
}
