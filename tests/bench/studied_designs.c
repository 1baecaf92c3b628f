#include "tests/bench/studied_designs.h"

#include <cblas.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>

#include "cases/peaks/design_run.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mhb/branches/forced_response.h"
#include "modal/model/model.h"
#include "postproc/analysis/outputs.h"
#include "tests/support/random_model.h"
#include "tests/support/z_notch_settings.h"

shb_status studied_model(const char *file, case_model *model) {
  *model = (case_model){.settings = file ? z_notch_settings() : random_settings(7)};
  omp_set_num_threads(1);
  openblas_set_num_threads(1); /* small systems: others would only wait, and count as time */
  model->settings.lasting = MHB_LASTING_NEVER;
  if (file) return modal_model_read(file, &model->model);
  random_model(1, WITH_LEFT, 1, &model->model);
  model->settings.motion_tolerance = 0.01;
  model->settings.frequency[0]     = 0.6 / SHB_TWO_PI;
  model->settings.frequency[1]     = 1.6 / SHB_TWO_PI;
  return SHB_OK;
}

shb_status studied_peak_find(const case_model *model, studied_peak *out) {
  static const study_output output[] = {{.quantity = STUDY_PEAK}, {.quantity = STUDY_FREQUENCY}};
  enum { OUTPUTS = sizeof output / sizeof *output };
  design_study one;
  SHB_TRY(design_study_create(0, OUTPUTS, study_derivatives(OUTPUTS, output), &one));
  study_design *design = design_study_add(&one, NULL);
  double        began  = shb_processor_seconds();
  shb_status status = design ? design_run(NULL, model, NULL, OUTPUTS, output, design) : SHB_ERR_IO;
  *out              = (studied_peak){.cpu = shb_processor_seconds() - began};
  if (design) {
    out->done  = design->state == STUDY_DONE;
    out->peak  = design->value[0];
    out->at    = design->value[1];
    out->error = design->error[0];
    snprintf(out->reason, sizeof out->reason, "%s", design->reason ? design->reason : "");
  }
  design_study_free(&one);
  return status;
}

/* The highest point of all nonlinear curves. */
static void take_highest(const mhb_response *r, swept_peak *out) {
  const post_output first = post_output_primary(r);
  out->complete           = true;
  out->peak = out->at = 0;
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    if (b->kind != MHB_BRANCH_NONLINEAR) continue;
    out->complete = out->complete && (b->main != k || b->complete);
    for (int i = 0; i < b->n_points; i++) {
      const double a = post_amplitude(r, b, i, first, post_first_harmonic(b));
      if (a <= out->peak) continue;
      out->peak = a;
      out->at   = b->frequency[i];
    }
  }
}

shb_status swept_peak_find(const case_model *model, int harmonics, double accuracy, bool outline,
                           swept_peak *out, mhb_response **response) {
  mhb_response *r       = NULL;
  mhb_settings  full    = model->settings;
  full.motion_tolerance = 0;
  full.harmonics        = harmonics;
  full.stability        = MHB_STABILITY_NEVER;
  full.outline          = outline;
  full.max_points       = 20000;
  full.tolerance *= accuracy;
  const double     began  = shb_processor_seconds();
  const shb_status status = mhb_forced_response(&model->model, &full, NULL, NULL, NULL, &r);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  out->cpu += shb_processor_seconds() - began;
  take_highest(r, out);
  if (response)
    *response = r;
  else
    mhb_response_destroy(r);
  return SHB_OK;
}

double next_random(unsigned long *state) {
  *state = *state * 48271UL % 2147483647UL;
  return (double)*state / 2147483647.;
}

double random_between(double low, double high, unsigned long *state) {
  return low * pow(high / low, next_random(state));
}
