/* Which of NLopt's methods for studies finds a kinked optimum with the fewest evaluations.
 *
 * The objective is shaped as the highest peak over preload and friction. It is the higher of two
 * smooth peaks, which exchange their rank along a curved valley. Its floor is a kink, with noise of
 * 1e-9. Two, three and five keys; 20 optima each, by the same optimiser as studies. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/study/optimiser.h"

enum { N_LEVELS = 3, MOST_KEYS = 5 };
static const double levels[N_LEVELS] = {1e-2, 1e-3, 1e-4}; /* above the optimum, relative */

typedef struct {
  int    n;
  double at[MOST_KEYS]; /* the optimum; its value is 1 */
} kinked;

/* 1 at the optimum; the kink runs along curve = 0. */
static double value_of(const kinked *f, const double *u) {
  double along = 0, across = u[0] - f->at[0];
  for (int i = 1; i < f->n; i++) {
    double d = u[i] - f->at[i];
    across += 0.8 * d + 0.5 * d * d;
    along += d * d;
  }
  double stuck = 1 + 1.5 * across + 0.4 * across * across, slipping = 1 - 2.2 * across;
  return fmax(stuck, slipping) + 0.6 * along + 1e-9 * sin(1e7 * (u[0] + u[f->n - 1]));
}

/* Evaluations until a level is reached; 0: never. Returns the least value over 1. */
static double run(const kinked *f, study_algorithm algorithm, int starts, int evaluations,
                  unsigned long seed, int reached[N_LEVELS]) {
  double         first[STUDY_MOST_STARTS * MOST_KEYS], best = INFINITY;
  study_optimise settings = {
      .evaluations = evaluations, .starts = starts, .seed = seed, .algorithm = algorithm};
  optimiser    *o;
  const double *u;
  for (int i = 0; i < starts * f->n; i++)
    first[i] = i < f->n ? 0.5 : fmod(0.5 + 0.6180339887 * i + 0.1 * (double)seed, 1);
  memset(reached, 0, N_LEVELS * sizeof *reached);
  if (optimiser_create(&settings, f->n, first, &o) != SHB_OK) return INFINITY;
  int count = 0;
  for (int start; (start = optimiser_ask(o, &u)) >= 0;) {
    double value = value_of(f, u);
    count++;
    best = fmin(best, value);
    for (int l = 0; l < N_LEVELS; l++)
      if (!reached[l] && best < 1 + levels[l]) reached[l] = count;
    optimiser_tell(o, start, value, NAN);
  }
  optimiser_destroy(o);
  return best - 1;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void row(int n, study_algorithm algorithm, int starts, int evaluations, int cases) {
  double above[64];
  int    hits[N_LEVELS] = {0}, sum[N_LEVELS] = {0};
  for (int c = 0; c < cases; c++) {
    kinked f = {.n = n};
    int    reached[N_LEVELS];
    for (int i = 0; i < n; i++)
      f.at[i] = 0.1 + 0.8 * fmod(0.37 + 0.7548776662 * (c * n + i + 1), 1);
    above[c] = run(&f, algorithm, starts, evaluations, 1 + (unsigned long)c, reached);
    for (int l = 0; l < N_LEVELS; l++) {
      hits[l] += reached[l] > 0;
      sum[l] += reached[l];
    }
  }
  qsort(above, (size_t)cases, sizeof *above, ascending);
  printf("%d keys  %-7s %2d starts  %4d evaluations  median above %8.1e  worst %8.1e ", n,
         study_algorithm_name(algorithm), starts, evaluations, above[cases / 2], above[cases - 1]);
  for (int l = 0; l < N_LEVELS; l++)
    printf("  %.0e: %2d of %d, %3d", levels[l], hits[l], cases, hits[l] ? sum[l] / hits[l] : 0);
  printf("\n");
}

int main(int argc, char **argv) {
  static const int keys[] = {2, 3, 5};
  int              cases  = argc > 1 && strcmp(argv[1], "--quick") == 0 ? 4 : 20;
  printf("level: optima found, mean evaluations until then\n");
  for (int i = 0; i < 3; i++) {
    row(keys[i], STUDY_SBPLX, 4, 200, cases);
    row(keys[i], STUDY_SBPLX, 1, 200, cases);
    row(keys[i], STUDY_CRS, 1, 200, cases);
    row(keys[i], STUDY_ISRES, 1, 200, cases);
    row(keys[i], STUDY_DIRECT, 1, 200, cases);
  }
  return 0;
}
