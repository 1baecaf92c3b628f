/* The main branch of one preload, without linear limits, file and progress. */
#ifndef TESTS_SUPPORT_MAIN_CURVE_H
#define TESTS_SUPPORT_MAIN_CURVE_H

#include "mhb/problem/settings.h"
#include "mhb/response/monitor.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Trace it at the settings' first preload into branch 0 of a new response with room for some
 * harmonics.
 *   seconds  out  processor seconds, or NULL
 * The caller destroys the response, also after an error. */
shb_status main_curve(const modal_model *model, const mhb_settings *settings, int harmonics,
                      double *seconds, mhb_response **response);

/* The same under a monitor. */
shb_status watched_main_curve(const modal_model *model, const mhb_settings *settings, int harmonics,
                              mhb_monitor *monitor, mhb_response **response);

/* The same from where another such call was stopped; what it left for that is taken from its
 * response. */
shb_status continued_main_curve(const modal_model *model, const mhb_settings *settings,
                                int harmonics, mhb_monitor *monitor, mhb_response *stopped,
                                mhb_response **response);

#endif
