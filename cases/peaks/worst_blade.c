#include "cases/peaks/worst_blade.h"

#include <math.h>

#include "mhb/amplification/ring_peak.h"
#include "mhb/branches/forced_response.h"

/* Relative distance from an end of the range at which a point is on it. */
static const double AT_END = 1e-9;

double worst_blade_amplitude(const mhb_response *r, const mhb_branch *b, int point) {
  double worst = 0;
  for (int blade = 0; blade < r->ring; blade++)
    worst = fmax(worst, mhb_blade_amplitude(r, b, point, blade));
  return worst;
}

static void take(const mhb_response *r, const mhb_branch *b, const mhb_settings *s,
                 exact_peak *peak) {
  for (int p = 0; p < b->n_points; p++) {
    const double worst = worst_blade_amplitude(r, b, p), error = b->error_truncation[p];
    if (!(worst > peak->amplitude)) continue;
    peak->found           = true;
    peak->exact           = !mhb_branch_marked(b, p);
    peak->amplitude       = worst;
    peak->amplitude_error = error >= 0 ? error * worst : NAN;
    peak->frequency       = b->frequency[p];
    peak->edge            = b->frequency[p] <= s->frequency[0] * (1 + AT_END) ||
                 b->frequency[p] >= s->frequency[1] * (1 - AT_END);
  }
}

shb_status worst_blade_peak(const case_model *model, mhb_response **response, exact_peak *peak) {
  mhb_settings s          = model->settings;
  s.resume                = false;
  s.save                  = (mhb_save_settings){MHB_SAVE_LISTED, 0, {0}}; /* nothing */
  *peak                   = (exact_peak){.peak_to_peak       = NAN,
                                         .dissipation        = NAN,
                                         .frequency_error    = NAN,
                                         .amplitude_error    = NAN,
                                         .peak_to_peak_error = NAN,
                                         .dissipation_error  = NAN,
                                         .stable             = -1,
                                         .by                 = {.kind = MHB_PEAK_UNJUDGED}};
  const shb_status status = mhb_forced_response(&model->model, &s, NULL, NULL, NULL, response);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) return status;
  for (int i = 0; i < (*response)->n_branches; i++)
    if ((*response)->branch[i].kind == MHB_BRANCH_NONLINEAR)
      take(*response, &(*response)->branch[i], &s, peak);
  return SHB_OK;
}
