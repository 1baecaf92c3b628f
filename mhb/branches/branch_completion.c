#include "mhb/branches/branch_completion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/branches/branch_stability.h"
#include "mhb/branches/record.h"

/* A pair of folds nearer than this is no jump that anyone could observe. Relative to the value, or
 * to a hundredth of the range. */
static const double HAIRLINE = 1e-5;

/* Unmark pairs of folds that are hairlines. */
static void unmark_hairlines(mhb_branch *branch, double range) {
  int last = -1;
  for (int i = 0; i < branch->n_points; i++) {
    if (branch->special[i] != MHB_FOLD) continue;
    double width    = last < 0 ? INFINITY : fabs(branch->value[i] - branch->value[last]);
    bool   hairline = width < HAIRLINE * fmax(fabs(branch->value[i]), 0.01 * range);
    if (hairline) branch->special[i] = branch->special[last] = MHB_ORDINARY;
    last = hairline ? -1 : i;
  }
}

static void set_reason(mhb_branch *branch, const mhb_completion *c) {
  char        text[256];
  mhb_end     end    = c->interrupted ? MHB_END_INTERRUPTED : c->end;
  bool        own    = c->other_reason && !c->interrupted;
  const char *reason = own ? c->other_reason : mhb_end_text(end);
  snprintf(text, sizeof text, "%s", reason);
  if (!own && end == MHB_END_MAX_POINTS && branch->n_points > 0)
    snprintf(text, sizeof text, "%s: %d points, the last at %.6g Hz; more points go on", reason,
             branch->n_points, branch->frequency[branch->n_points - 1]);
  if (c->n_gaps > 0)
    snprintf(text, sizeof text, "%s, with %d gap%s: %s", reason, c->n_gaps,
             c->n_gaps > 1 ? "s" : "", c->first_gap);
  free(branch->reason);
  branch->reason = shb_text(text);
  branch->complete =
      !own && c->n_gaps == 0 &&
      (end == MHB_END_HIGH || end == MHB_END_LOW || end == MHB_END_CLOSED || end == MHB_END_JOINED);
}

shb_status mhb_branch_complete(mhb_tracer *tracer, const mhb_chain *chain, mhb_response *response,
                               int index, mhb_completion *c) {
  const mhb_harmonic_levels *levels    = tracer->levels;
  const mhb_settings        *settings  = levels->settings;
  mhb_branch                *branch    = &response->branch[index];
  mhb_parameter              parameter = levels->parameter;
  double                     range     = mhb_parameter_shown(parameter, levels->high - levels->low);
  int                        n_begins, begins[chain->n + 1];
  branch->n_harmonics = tracer->store->n_harmonics;
  branch->order       = tracer->store->subharmonics;
  mhb_chain_join(chain, tracer->store, response, index, begins, &n_begins);
  unmark_hairlines(branch, range);
  c->interrupted = c->end == MHB_END_INTERRUPTED;
  if (c->by_folds) mhb_branch_stability_by_folds(branch, begins, n_begins, c->stable_at);
  if (!mhb_judges_stability(settings) || c->interrupted) {
    set_reason(branch, c);
    return SHB_OK;
  }
  mhb_branch_stability *stability;
  bool                  finished = true;
  SHB_TRY(mhb_harmonic_levels_use(tracer->levels, levels->highest)); /* no point has more */
  SHB_TRY(mhb_branch_stability_create(mhb_tracer_balance(tracer), &stability));
  shb_status status =
      mhb_branch_stability_judge(stability, tracer, response, index, begins, n_begins, &finished);
  mhb_branch_stability_destroy(stability);
  c->interrupted = !finished;
  if (status == SHB_OK) set_reason(branch, c);
  return status;
}
