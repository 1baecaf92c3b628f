/* Numbers of the page of a study, as JSON for its script.
 *
 *   name, plan, path, n, finished
 *   keys, outputs, derivatives   [{name, unit, scale}]: shown is value in SI / scale
 *   derivative_at                the parameter's value in the case; null: unknown
 *   key, value, error, derivative   a list for each column, with a number a design; null: unknown
 *   status [n] (study_state), reason {design: text}, seconds [n]
 *   objective (output), best (design), both -1 if there is none
 *   effects  [output][key] {share, at, mean}: study_main_effect
 *   curves   {start [n+1], run, code, data}: points of all designs. A run begins at point run[j].
 *            Its code is stable + 1, and 4 more where a new branch begins. data: base64 of
 *            float32 [2][points], frequency in Hz and amplitude in m.
 *   optimum  {method, history, bound}; uncertainty {samples, failed, confidence, level, mean,
 *            deviation, percentile, first, total}; percentile, first and total are lists of [value,
 *            low, high]
 *   robust   {key [group][k], samples, failed [group], confidence, level, mean, deviation 
 *            [group][output], percentile [group * outputs + output][level] of [value, low, high]}
 *   ramp     {light, dark}: colours from low to high
 *
 * Designs are counted from 0. */
#ifndef POSTPROC_STUDY_STUDY_DATA_H
#define POSTPROC_STUDY_STUDY_DATA_H

#include "postproc/draw/text_buffer.h"
#include "postproc/study/design_study.h"

/* Write the numbers. Curves are thinned: no point left out is farther from the chord than 0.1 % of
 * the chart. It is more where the curves would take over 1.5 MB.
 *
 *   tolerance  out  the share of the chart that was allowed
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status study_data(const design_study *study, post_buffer *out, double *tolerance);

#endif
