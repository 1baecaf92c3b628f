/* The worst stress at a peak in numbers. */
#ifndef POSTPROC_SUMMARY_STRESS_SUMMARY_H
#define POSTPROC_SUMMARY_STRESS_SUMMARY_H

#include "postproc/field/blade_field.h"
#include "postproc/field/peak_stress.h"
#include "postproc/summary/json.h"

typedef struct {
  const post_blade_field *field;   /* NULL or n_nodes = 0: no stress */
  const post_fatigue     *fatigue; /* NULL: no safety */
} post_stress_source;

/* Put the key stress: an object, or null if the modal amplitudes at the point are not kept. Errors:
 * SHB_ERR_IO no memory. */
shb_status post_stress_put(const post_stress_source *source, const mhb_branch *branch, int point,
                           post_json *json);

#endif
