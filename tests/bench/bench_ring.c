/* The fast integrator of a ring beside the slow one: ms a period for an error.
 *
 *   bench_ring            the table
 *   bench_ring --quick    few repetitions
 *
 * Scene: 40 blades, 20 modes of 1 to 100 rad/s, one contact a blade, from rest.
 * Error: of the positions of all modes after three periods, against 8192 steps, relative. The
 * baseline is mhb/integration in the same run. The exit code depends on errors only, because times
 * depend on the machine. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/ring/ring_step.h"
#include "tests/support/random_model.h"

enum { PERIODS = 3, FINE = 8192, MODES = 20 };

static double *list(size_t n, double size, unsigned long long *seed) {
  double *x = malloc(n * sizeof *x);
  for (size_t i = 0; i < n; i++) x[i] = size * random_unit(seed);
  return x;
}

/* Twenty modes in place of the random model's six. */
static void twenty_modes(modal_model *model) {
  unsigned long long seed = 3;
  random_model(1, WITH_LEFT, 5, model);
  free(model->frequency);
  free(model->damping_ratio);
  free(model->right);
  free(model->left);
  free(model->probe);
  free(model->modal_force);
  model->n_modes       = MODES;
  model->frequency     = malloc(MODES * sizeof(double));
  model->damping_ratio = malloc(MODES * sizeof(double));
  model->right         = list(3 * MODES, .6, &seed);
  model->left          = list(3 * MODES, .6, &seed);
  model->probe         = list(6 * MODES, 1, &seed);
  model->modal_force   = calloc(3 * MODES, sizeof *model->modal_force);
  for (int i = 0; i < MODES; i++) {
    model->frequency[i]           = pow(100, (double)i / (MODES - 1)) / SHB_TWO_PI;
    model->damping_ratio[i]       = .002;
    model->modal_force[MODES + i] = .2 * random_unit(&seed);
  }
}

static shb_status make(const modal_model *model, const mhb_settings *s, double omega, int steps,
                       mhb_ring_model **m, mhb_ring *ring) {
  double complex none[3 * 64] = {0};
  SHB_TRY(mhb_ring_model_create(model, s, s->n0[0], omega, m));
  mhb_ring_model_set(*m, omega, steps);
  mhb_ring_create(*m, ring);
  mhb_ring_start(ring, 0, none);
  return SHB_OK;
}

/* Motion of both sides of all blades by the modes after PERIODS, [6][lanes]. */
static shb_status end_of(const modal_model *model, const mhb_settings *s, double omega, int steps,
                         double *end) {
  mhb_ring_model *m;
  mhb_ring        ring;
  SHB_TRY(make(model, s, omega, steps, &m, &ring));
  for (int i = 0; i < PERIODS; i++) mhb_ring_period(&ring);
  for (int i = 0; i < 6; i++)
    for (int b = 0; b < m->blades; b++) {
      size_t at              = (size_t)(i % 3) * ring.row + 8 + (size_t)b;
      end[i * m->blades + b] = (i < 3 ? ring.right : ring.left)[at];
    }
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  return SHB_OK;
}

/* Least ms a period of several runs: the machine may be busy. */
static double milliseconds(const modal_model *model, const mhb_settings *s, double omega, int steps,
                           int runs, int *modes) {
  mhb_ring_model *m;
  mhb_ring        ring;
  double          best = INFINITY;
  if (make(model, s, omega, steps, &m, &ring) != SHB_OK) return NAN;
  for (int i = 0; i < runs; i++) {
    double started = shb_seconds();
    for (int k = 0; k < 10; k++) mhb_ring_period(&ring);
    best = fmin(best, 100 * (shb_seconds() - started));
  }
  *modes = m->modes;
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  return best;
}

/* The slow integrator from the same rest, 48 steps. */
static double slow(const modal_model *model, const mhb_settings *s, double omega, double *end,
                   double *ms) {
  mhb_integrator *g;
  double          started;
  *ms = NAN;
  if (mhb_integrator_create(model, s, 1, &g) != SHB_OK) return NAN;
  double complex none[6] = {0};
  mhb_integrator_set(g, omega, s->n0[0], 48);
  mhb_integrator_balance(g, 1, none);
  started = shb_seconds();
  for (int i = 0; i < PERIODS; i++)
    if (!mhb_integrator_period(g)) return NAN;
  *ms = 1000 * (shb_seconds() - started) / PERIODS;
  memset(end, 0, sizeof(double) * 6 * (size_t)g->blades);
  for (int i = 0; i < 6; i++)
    for (int b = 0; b < g->blades; b++)
      for (int k = 0; k < g->modes; k++)
        end[i * g->blades + b] += g->ring.shape[i * g->modes + k] * g->z[b * g->modes + k];
  mhb_integrator_destroy(g);
  return 0;
}

static double apart(const double *a, const double *b, int n) {
  double difference = 0, size = 0;
  for (int i = 0; i < n; i++) {
    difference += pow(a[i] - b[i], 2);
    size += pow(b[i], 2);
  }
  return sqrt(difference / size);
}

/* ms a period of 256 steps where blades differ by a percent. */
static double different(const modal_model *model, const mhb_settings *s, double omega, int runs) {
  double             delta[64], ms = NAN;
  int                modes;
  mhb_mistuned_ring *ring;
  mhb_settings       own = *s;
  if (mhb_deviations_random(0.01, 7, 0, s->blades, delta) != SHB_OK ||
      mhb_mistuned_ring_create(model, s, delta, 1, &ring) != SHB_OK)
    return NAN;
  own.ring = ring;
  ms       = milliseconds(&ring->whole, &own, omega, 256, runs, &modes);
  mhb_mistuned_ring_destroy(ring);
  return ms;
}

static int table(const modal_model *model, const mhb_settings *s, double omega, int runs) {
  static const int steps[] = {64, 128, 256, 512, 1024};
  double           fine[6 * 64], end[6 * 64], slow_ms, at_256 = NAN;
  int              n = 6 * s->blades, modes = 0;
  if (end_of(model, s, omega, FINE, fine) != SHB_OK) return 1;
  slow(model, s, omega, end, &slow_ms);
  printf("%d blades, %d modes; error after %d periods against %d steps\n\n", s->blades,
         model->n_modes, PERIODS, FINE);
  printf("%-28s %10s %10s %8s\n", "", "ms/period", "error", "ratio");
  printf("%-28s %10.2f %10.1e %8s\n", "slow integrator, 48 steps", slow_ms, apart(end, fine, n),
         "1");
  for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
    if (end_of(model, s, omega, steps[i], end) != SHB_OK) return 1;
    double ms = milliseconds(model, s, omega, steps[i], runs, &modes), error = apart(end, fine, n);
    printf("ring, %4d steps, %2d modes     %10.4f %10.1e %8.0f\n", steps[i], modes, ms, error,
           slow_ms / ms);
    if (steps[i] == 256) at_256 = error;
  }
  double own_ms = different(model, s, omega, runs),
         ms     = milliseconds(model, s, omega, 256, runs, &modes);
  printf("%-28s %10.4f %10s %8.0f\n", "256 steps, different blades", own_ms, "", slow_ms / own_ms);
  printf("different over equal blades: %.2f\n", own_ms / ms);
  int good = at_256 < 5e-3;
  printf("\nerror at 256 steps below 5e-3: %s\n", good ? "yes" : "NO");
  return !good;
}

int main(int argc, char **argv) {
  modal_model  model = {0};
  mhb_settings s     = random_settings(1);
  double       omega = .97;
  int          quick = argc > 1 && strcmp(argv[1], "--quick") == 0;
  s.blades           = 40;
  s.engine_order     = 5;
  s.n0[0]            = .2;
  s.ku[1]            = 0;
  s.ku[2]            = s.ku[0];
  twenty_modes(&model);
  int status = table(&model, &s, omega, quick ? 2 : 40);
  modal_model_free(&model);
  return status;
}
