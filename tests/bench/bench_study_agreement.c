/* Studies against sweeps: random designs in wide ranges, gaps included.
 *
 *   bench_study_agreement FILE N [SEED]   a modal file, contact and excitation of
 *                                         cases/z_notch_blade, N designs
 *   bench_study_agreement --one FILE N0 MU KU KV SCALE DAMPING
 *   bench_study_agreement --quick         a small random ring, 2 designs with a gap
 *
 * A third of the preloads is even from -20 to 20 N. The others reach 600 N, even in the logarithm.
 * Friction is 0.05 to 0.6. Even in the logarithm are ku and kv, 0.1 to 10 MN/m, the scale, 0.1 to
 * 10, and the damping, 2e-4 to 2e-2.
 *
 * The reference is the highest point of a sweep in outline with 15 harmonics. It has 31 where the
 * peak is not within AGREES of it. A design is a fault if its peak is done and lower than the
 * reference by more than three times its told error. A peak between two points of an outline is
 * higher than both by up to POINTS, so a higher peak is no fault. */
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

enum { OUTPUTS = 2 };

static const double AGREES = 3e-3, POINTS = 1e-3;

typedef struct {
  bool   done;
  double peak, at, error;         /* m, Hz, m */
  double reference, reference_at; /* m, Hz */
  double cpu, sweeps;             /* s */
} row;

static void take_highest(const mhb_response *r, row *out) {
  post_output first = post_output_primary(r);
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    for (int i = 0; i < b->n_points && b->kind == MHB_BRANCH_NONLINEAR; i++) {
      double a = post_amplitude(r, b, i, first, post_first_harmonic(b));
      if (a <= out->reference) continue;
      out->reference    = a;
      out->reference_at = b->frequency[i];
    }
  }
}

static shb_status add_reference(const case_model *model, int harmonics, row *out) {
  mhb_response *r       = NULL;
  mhb_settings  full    = model->settings;
  full.motion_tolerance = 0;
  full.harmonics        = harmonics;
  full.stability        = MHB_STABILITY_NEVER;
  full.outline          = true;
  full.max_points       = 20000;
  double     began      = shb_processor_seconds();
  shb_status status     = mhb_forced_response(&model->model, &full, NULL, NULL, NULL, &r);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  out->sweeps += shb_processor_seconds() - began;
  out->reference = 0;
  take_highest(r, out);
  mhb_response_destroy(r);
  return SHB_OK;
}

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
    out->at    = design->value[1];
    out->error = design->error[0];
  }
  design_study_free(&one);
  return status;
}

static double shortfall(const row *r) {
  return r->reference * (1 - POINTS) - r->peak;
}

/* Returns 1: a fault; 0: none; -1: an error. */
static int compare(const case_model *model, row *out) {
  const mhb_settings *s = &model->settings;
  if (study_peak(model, out) != SHB_OK || add_reference(model, 15, out) != SHB_OK) return -1;
  if (!(fabs(out->peak / out->reference - 1) < AGREES) && add_reference(model, 31, out) != SHB_OK)
    return -1;
  const double told = isfinite(out->error) ? 3 * out->error : 0;
  const bool   low = !(shortfall(out) <= told), fault = low && out->done;
  printf("%9.4f %6.4f %9.3e %9.3e %7.4f %8.2e %12.6g %8.2f %+9.1e %9.1e %8.3f %8.3f  %s%s\n",
         s->n0[0], s->mu, s->ku[0], s->kv, s->scale, model->model.damping_ratio[0], out->peak,
         out->at, out->peak / out->reference - 1, out->error / out->peak, out->cpu, out->sweeps,
         low ? "LOW" : "good", out->done ? "" : ", not converged");
  if (low) printf("          reference %.6g m at %.2f Hz\n", out->reference, out->reference_at);
  fflush(stdout);
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

static void set_contact(case_model *model, double n0, double mu, double ku, double kv, double scale,
                        double damping) {
  mhb_settings *s = &model->settings;
  s->n_preloads   = 1;
  s->n0[0]        = n0;
  s->mu           = mu;
  s->ku[0] = s->ku[2] = ku;
  s->kv               = kv;
  s->scale            = scale;
  for (int i = 0; i < model->model.n_modes; i++) model->model.damping_ratio[i] = damping;
}

static int random_designs(case_model *model, int n, unsigned long seed) {
  int    faults = 0, not_done = 0;
  double cpu = 0, sweeps = 0;
  printf("%9s %6s %9s %9s %7s %8s %12s %8s %9s %9s %8s %8s\n", "n0, N", "mu", "ku, N/m", "kv, N/m",
         "scale", "damping", "peak, m", "Hz", "error", "told", "s", "sweeps s");
  for (int i = 0; i < n; i++) {
    row          one;
    const bool   near = next_random(&seed) < 1. / 3;
    const double n0   = near ? -20 + 40 * next_random(&seed) : between(20, 600, &seed);
    const double mu = 0.05 + 0.55 * next_random(&seed), ku = between(1e5, 1e7, &seed);
    const double kv = between(1e5, 1e7, &seed), scale = between(0.1, 10, &seed);
    set_contact(model, n0, mu, ku, kv, scale, between(2e-4, 2e-2, &seed));
    const int fault = compare(model, &one);
    if (fault < 0) return -1;
    faults += fault;
    not_done += !one.done;
    cpu += one.cpu;
    sweeps += one.sweeps;
  }
  printf("%d designs, %d too low, %d not converged; mean %.3f s a design, %.3f s its sweeps\n", n,
         faults, not_done, cpu / n, sweeps / n);
  return faults;
}

static int one_design(case_model *model, char **number) {
  double x[6];
  row    one;
  for (int i = 0; i < 6; i++) x[i] = strtod(number[i], NULL);
  set_contact(model, x[0], x[1], x[2], x[3], x[4], x[5]);
  return compare(model, &one);
}

static int quick_designs(case_model *model) {
  static const double n0[]         = {-0.05, 0.15};
  int                 faults       = 0;
  model->settings.motion_tolerance = 0.01;
  model->settings.frequency[0]     = 0.6 / SHB_TWO_PI;
  model->settings.frequency[1]     = 1.6 / SHB_TWO_PI;
  for (int i = 0; i < 2; i++) {
    row one;
    model->settings.n_preloads = 1;
    model->settings.n0[0]      = n0[i];
    const int fault            = compare(model, &one);
    if (fault < 0) return -1;
    faults += fault;
  }
  return faults;
}

int main(int argc, char **argv) {
  const bool  quick = argc > 1 && !strcmp(argv[1], "--quick");
  const bool  one   = argc > 8 && !strcmp(argv[1], "--one");
  const char *file  = one ? argv[2] : argc > 2 ? argv[1] : NULL;
  case_model  model = {.settings = quick ? random_settings(7) : z_notch_settings()};
  int         fault = -1;
  omp_set_num_threads(1);
  if (!quick && !file) {
    fputs(
        "usage: bench_study_agreement FILE N [SEED], --one FILE N0 MU KU KV SCALE DAMPING or "
        "--quick\n",
        stderr);
    return 2;
  }
  model.settings.lasting = MHB_LASTING_NEVER;
  if (quick) {
    random_model(1, WITH_LEFT, 1, &model.model);
    fault = quick_designs(&model);
  } else if (modal_model_read(file, &model.model) == SHB_OK) {
    model.settings.frequency[0]     = 60;
    model.settings.frequency[1]     = 420;
    model.settings.motion_tolerance = 1e-3;
    const unsigned long seed        = !one && argc > 3 ? strtoul(argv[3], NULL, 10) : 1;
    fault = one ? one_design(&model, argv + 3) : random_designs(&model, atoi(argv[2]), seed);
  }
  if (fault < 0) fprintf(stderr, "%s\n", shb_message());
  printf("%s\n", fault ? "FAULTS" : "no peak is lower than its sweeps by three times its error");
  modal_model_free(&model.model);
  return fault != 0;
}
