/* The curves of a response in numbers, one object a preload. */
#ifndef POSTPROC_SUMMARY_RESPONSE_SUMMARY_H
#define POSTPROC_SUMMARY_RESPONSE_SUMMARY_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/summary/stress_summary.h"

/* Put the keys finished, complete, engine_order, blades, output, parameter, curves and optimum into
 * an object that is open. Errors: SHB_ERR_IO no
 * memory. */
shb_status post_response_put(const post_analysis *analysis, const post_stress_source *stress,
                             post_json *json);

#endif
