/* Peaks of study designs: CPU time a design, and error against full sweeps.
 *
 *   bench_study FILE      a modal file: contact and excitation of cases/z_notch_blade, 15 designs
 *   bench_study FILE --random N [SEED]
 *                         the same, N random designs in wide ranges: n0 5 to 500 N, mu 0.1 to 0.5,
 *                         ku and kv 0.1 to 5 MN/m, even in the logarithm but for mu
 *   bench_study           a small random ring, 8 designs
 *   bench_study --quick   the same, 3 designs
 *
 * A row is a design of preload and friction. The reference is the highest point of a sweep of the
 * whole range with 31 harmonics and a tenth of the law's tolerance. Random designs have sweeps in
 * outline with 15 harmonics, and with 31 where the peak is not within AGREES of that. A peak
 * between two points of the reference is higher than both, by some 1e-5, in outline by up to 1e-3.
 * So a positive error is no fault.
 * Goal: no peak is lower than the reference by more than 1 %, the tolerance of the case. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal/model/model.h"
#include "tests/bench/studied_designs.h"

enum { PRELOADS = 5, FRICTIONS = 3 };

static const double GOAL = 0.01, AGREES = 0.003;

typedef struct {
  studied_peak study;
  swept_peak   sweep;
} row;

static double error_of(const row *r) {
  return r->study.peak / r->sweep.peak - 1;
}

static shb_status measure(const case_model *model, row *out) {
  *out = (row){0};
  SHB_TRY(studied_peak_find(model, &out->study));
  return swept_peak_find(model, 31, 0.1, false, &out->sweep, NULL);
}

/* In outline, with 15 harmonics; with 31 where the peak is not within AGREES of that. */
static shb_status measure_in_outline(const case_model *model, row *out) {
  *out = (row){0};
  SHB_TRY(studied_peak_find(model, &out->study));
  SHB_TRY(swept_peak_find(model, 15, 1, true, &out->sweep, NULL));
  if (fabs(error_of(out)) < AGREES) return SHB_OK;
  return swept_peak_find(model, 31, 1, true, &out->sweep, NULL);
}

/* Returns the number of faults; -1 after an error. */
static int table(case_model *model, const double *n0, const double *mu, int most) {
  int    fault = 0, n = 0;
  double cpu = 0, sweep = 0, worst = 0;
  printf("%9s %5s %12s %10s %10s %8s %8s\n", "n0, N", "mu", "peak, m", "error", "estimated", "s",
         "sweep s");
  for (int i = 0; i < PRELOADS * FRICTIONS && n < most; i++, n++) {
    row one;
    model->settings.n_preloads = 1;
    model->settings.n0[0]      = n0[i % PRELOADS];
    model->settings.mu         = mu[i / PRELOADS];
    if (measure(model, &one) != SHB_OK) return -1;
    double error = error_of(&one);
    fault += !(error > -GOAL);
    worst = fmax(worst, fabs(error));
    cpu += one.study.cpu;
    sweep += one.sweep.cpu;
    printf("%9.4g %5.2f %12.6g %+10.1e %10.1e %8.3f %8.3f  %s\n", model->settings.n0[0],
           model->settings.mu, one.study.peak, error, one.study.error / one.study.peak,
           one.study.cpu, one.sweep.cpu, error > -GOAL ? "good" : "BAD");
    fflush(stdout);
  }
  printf("mean: %.3f s a design, %.3f s a sweep; largest error %.1e\n", cpu / n, sweep / n, worst);
  return fault;
}

/* ---------------------------------------------------------------- random designs */

static void randomise(mhb_settings *s, unsigned long *seed) {
  s->n_preloads = 1;
  s->n0[0]      = random_between(5, 500, seed);
  s->mu         = 0.1 + 0.4 * next_random(seed);
  s->ku[0] = s->ku[2] = random_between(1e5, 5e6, seed);
  s->kv               = random_between(1e5, 5e6, seed);
}

/* Returns the number of faults; -1 after an error. */
static int random_table(case_model *model, int n, unsigned long seed) {
  int    fault = 0, not_done = 0;
  double cpu = 0, sweep = 0, lowest = 0, highest_error = 0;
  model->settings.frequency[1] = 400; /* Hz, for stiff contacts */
  printf("%9s %6s %9s %9s %12s %10s %10s %8s %8s\n", "n0, N", "mu", "ku, N/m", "kv, N/m", "peak, m",
         "error", "estimated", "s", "sweep s");
  for (int i = 0; i < n; i++) {
    row one;
    randomise(&model->settings, &seed);
    if (measure_in_outline(model, &one) != SHB_OK) return -1;
    double error = error_of(&one);
    bool   bad   = !(error > -GOAL);
    fault += bad && one.study.done;
    not_done += !one.study.done;
    lowest        = fmin(lowest, error);
    highest_error = fmax(highest_error, error);
    cpu += one.study.cpu;
    sweep += one.sweep.cpu;
    printf("%9.4f %6.4f %9.4e %9.4e %12.6g %+10.1e %10.1e %8.3f %8.3f  %s%s\n",
           model->settings.n0[0], model->settings.mu, model->settings.ku[0], model->settings.kv,
           one.study.peak, error, one.study.error / one.study.peak, one.study.cpu, one.sweep.cpu,
           bad ? "BAD" : "good", one.study.done ? "" : ", not converged");
    fflush(stdout);
  }
  printf("mean: %.3f s a design, %.3f s for its sweeps; errors %+.1e to %+.1e; %d not converged\n",
         cpu / n, sweep / n, lowest, highest_error, not_done);
  return fault;
}

int main(int argc, char **argv) {
  static const double z_n0[PRELOADS] = {8, 12, 25, 60, 200}, z_mu[FRICTIONS] = {0.3, 0.2, 0.45};
  static const double s_n0[PRELOADS]  = {0.15, 0.25, 0.4, 0.1, 0.6},
                      s_mu[FRICTIONS] = {0.4, 0.3, 0.5};
  int        quick = argc > 1 && !strcmp(argv[1], "--quick"), from_file = argc > 1 && !quick;
  case_model model;
  shb_status status          = studied_model(from_file ? argv[1] : NULL, &model);
  const unsigned long seed   = argc > 4 ? strtoul(argv[4], NULL, 10) : 1;
  int                 random = argc > 3 && !strcmp(argv[2], "--random") ? atoi(argv[3]) : 0;
  int                 fault  = status != SHB_OK ? -1
                               : random         ? random_table(&model, random, seed)
                               : from_file      ? table(&model, z_n0, z_mu, PRELOADS * FRICTIONS)
                                                : table(&model, s_n0, s_mu, quick ? 3 : 8);
  if (fault < 0) fprintf(stderr, "%s\n", shb_message());
  printf("%s\n", fault ? "FAULTS" : "no peak is lower than its reference by more than 1 %");
  modal_model_free(&model.model);
  return fault != 0;
}
