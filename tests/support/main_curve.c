#include "tests/support/main_curve.h"

#include <time.h>

#include "mhb/balance/balance.h"
#include "mhb/branches/main_branch.h"
#include "tests/support/quiet_monitor.h"

static shb_status trace(const modal_model *model, const mhb_settings *s, int harmonics,
                        mhb_monitor *monitor, double *seconds, mhb_response *stopped,
                        mhb_response **out) {
  mhb_balance *balance;
  *out = NULL;
  SHB_TRY(mhb_balance_create(model, s, &balance));
  mhb_balance_set_preload(balance, s->n0[0]);
  mhb_balance_set_parameter(balance, s->parameter);
  *out              = mhb_response_create(model->n_pairs, model->n_probes, harmonics);
  shb_status status = *out ? SHB_OK : shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  if (status == SHB_OK) mhb_response_branch(*out, MHB_BRANCH_NONLINEAR);
  if (status == SHB_OK) (*out)->parameter = s->parameter;
  if (status == SHB_OK && stopped) {
    (*out)->branch[0].unfinished  = stopped->branch[0].unfinished;
    stopped->branch[0].unfinished = NULL;
  }
  clock_t started = clock();
  if (status == SHB_OK) status = mhb_trace_main_branch(balance, *out, monitor);
  if (seconds) *seconds = (double)(clock() - started) / CLOCKS_PER_SEC;
  mhb_balance_destroy(balance);
  return status;
}

shb_status main_curve(const modal_model *model, const mhb_settings *s, int harmonics,
                      double *seconds, mhb_response **out) {
  quiet_monitor monitor = quiet_monitor_create(0);
  return trace(model, s, harmonics, &monitor.base, seconds, NULL, out);
}

shb_status watched_main_curve(const modal_model *model, const mhb_settings *s, int harmonics,
                              mhb_monitor *monitor, mhb_response **out) {
  return trace(model, s, harmonics, monitor, NULL, NULL, out);
}

shb_status continued_main_curve(const modal_model *model, const mhb_settings *s, int harmonics,
                                mhb_monitor *monitor, mhb_response *stopped, mhb_response **out) {
  return trace(model, s, harmonics, monitor, NULL, stopped, out);
}
