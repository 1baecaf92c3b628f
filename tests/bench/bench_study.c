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
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/peaks/design_run.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"
#include "modal/model/model.h"
#include "postproc/analysis/outputs.h"
#include "tests/support/random_model.h"
#include "tests/support/z_notch_settings.h"

enum { PRELOADS = 5, FRICTIONS = 3, OUTPUTS = 2 };

static const double GOAL = 0.01, AGREES = 0.003;

typedef struct {
  bool   done;
  double cpu, peak, error; /* s, m, estimated relative error */
  double sweep, reference; /* s, m */
} row;

static double highest(const mhb_response *r) {
  post_output first = post_output_primary(r);
  double      most  = 0;
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    if (b->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int i = 0; i < b->n_points; i++)
      most = fmax(most, post_amplitude(r, b, i, first, post_first_harmonic(b)));
  }
  return most;
}

/* The highest point of a sweep of the whole range. Adds its CPU time. */
static shb_status reference(const case_model *model, int harmonics, double accuracy, bool outline,
                            row *out) {
  mhb_response *r       = NULL;
  mhb_settings  full    = model->settings;
  full.motion_tolerance = 0;
  full.harmonics        = harmonics;
  full.stability        = MHB_STABILITY_NEVER;
  full.outline          = outline;
  full.max_points       = 20000;
  full.tolerance *= accuracy;
  double     began  = shb_processor_seconds();
  shb_status status = mhb_forced_response(&model->model, &full, NULL, NULL, NULL, &r);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  out->sweep += shb_processor_seconds() - began;
  out->reference = highest(r);
  mhb_response_destroy(r);
  return SHB_OK;
}

/* The peak as a study has it. */
static shb_status study_peak(const case_model *model, row *out) {
  static const study_output output[OUTPUTS] = {{.quantity = STUDY_PEAK},
                                               {.quantity = STUDY_FREQUENCY}};
  design_study              one;
  SHB_TRY(design_study_create(0, OUTPUTS, study_derivatives(OUTPUTS, output), &one));
  study_design *design = design_study_add(&one, NULL);
  double        began  = shb_processor_seconds();
  shb_status status = design ? design_run(NULL, model, NULL, OUTPUTS, output, design) : SHB_ERR_IO;
  *out              = (row){.cpu = shb_processor_seconds() - began};
  if (design) {
    out->done  = design->state == STUDY_DONE;
    out->peak  = design->value[0];
    out->error = design->error[0] / design->value[0];
  }
  design_study_free(&one);
  return status;
}

static shb_status measure(const case_model *model, row *out) {
  SHB_TRY(study_peak(model, out));
  return reference(model, 31, 0.1, false, out);
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
    double error = one.peak / one.reference - 1;
    fault += !(error > -GOAL);
    worst = fmax(worst, fabs(error));
    cpu += one.cpu;
    sweep += one.sweep;
    printf("%9.4g %5.2f %12.6g %+10.1e %10.1e %8.3f %8.3f  %s\n", model->settings.n0[0],
           model->settings.mu, one.peak, error, one.error, one.cpu, one.sweep,
           error > -GOAL ? "good" : "BAD");
    fflush(stdout);
  }
  printf("mean: %.3f s a design, %.3f s a sweep; largest error %.1e\n", cpu / n, sweep / n, worst);
  return fault;
}

/* ---------------------------------------------------------------- random designs */

/* Numbers between 0 and 1 (Lehmer, modulus 2^31 - 1). */
static double next_random(unsigned long *state) {
  *state = *state * 48271UL % 2147483647UL;
  return (double)*state / 2147483647.;
}

static double between(double low, double high, unsigned long *seed) {
  return low * pow(high / low, next_random(seed));
}

static void randomise(mhb_settings *s, unsigned long *seed) {
  s->n_preloads = 1;
  s->n0[0]      = between(5, 500, seed);
  s->mu         = 0.1 + 0.4 * next_random(seed);
  s->ku[0] = s->ku[2] = between(1e5, 5e6, seed);
  s->kv               = between(1e5, 5e6, seed);
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
    if (study_peak(model, &one) != SHB_OK || reference(model, 15, 1, true, &one) != SHB_OK)
      return -1;
    if (!(fabs(one.peak / one.reference - 1) < AGREES) &&
        reference(model, 31, 1, true, &one) != SHB_OK)
      return -1;
    double error = one.peak / one.reference - 1;
    bool   bad   = !(error > -GOAL);
    fault += bad && one.done;
    not_done += !one.done;
    lowest        = fmin(lowest, error);
    highest_error = fmax(highest_error, error);
    cpu += one.cpu;
    sweep += one.sweep;
    printf("%9.4f %6.4f %9.4e %9.4e %12.6g %+10.1e %10.1e %8.3f %8.3f  %s%s\n",
           model->settings.n0[0], model->settings.mu, model->settings.ku[0], model->settings.kv,
           one.peak, error, one.error, one.cpu, one.sweep, bad ? "BAD" : "good",
           one.done ? "" : ", not converged");
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
  case_model model  = {.settings = from_file ? z_notch_settings() : random_settings(7)};
  shb_status status = SHB_OK;
  omp_set_num_threads(1);
  model.settings.lasting = MHB_LASTING_NEVER;
  if (from_file) {
    status = modal_model_read(argv[1], &model.model);
  } else {
    random_model(1, WITH_LEFT, 1, &model.model);
    model.settings.motion_tolerance = 0.01;
    model.settings.frequency[0]     = 0.6 / SHB_TWO_PI;
    model.settings.frequency[1]     = 1.6 / SHB_TWO_PI;
  }
  int random = argc > 3 && !strcmp(argv[2], "--random") ? atoi(argv[3]) : 0;
  int fault  = status != SHB_OK ? -1
               : random    ? random_table(&model, random, argc > 4 ? strtoul(argv[4], NULL, 10) : 1)
               : from_file ? table(&model, z_n0, z_mu, PRELOADS * FRICTIONS)
                           : table(&model, s_n0, s_mu, quick ? 3 : 8);
  if (fault < 0) fprintf(stderr, "%s\n", shb_message());
  printf("%s\n", fault ? "FAULTS" : "no peak is lower than its reference by more than 1 %");
  modal_model_free(&model.model);
  return fault != 0;
}
