/* Stress and strain of the whole blade at a peak: outputs of a design that need the modal file's
 * stresses. */
#ifndef CASES_PEAKS_PEAK_FIELD_H
#define CASES_PEAKS_PEAK_FIELD_H

#include "cases/designs/output_names.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

typedef struct peak_field peak_field;

/* Whether an output is one of these, and whether any is. */
bool peak_field_gives(const study_output *output);
bool peak_field_wanted(int n, const study_output *output);

/* Read what a modal file has for these outputs. Errors: SHB_ERR_INPUT the file has no stresses;
 * those of post_blade_field_read. */
shb_status peak_field_create(const char *modal, int n, const study_output *output,
                             peak_field **field);
void       peak_field_destroy(peak_field *field);

/* Take Goodman's lines and gauges of a case. Nothing is done if they are those of the last call.
 * Errors: as post_blade_regions, post_gauge_place. */
shb_status peak_field_use(peak_field *field, const case_file *file);

/* The outputs at a point of a branch.
 *   settings  in  of the balance
 *   response  in  with the branch; modal amplitudes are kept of every point of it
 *   value     out [n] Pa, -, m/m: of the outputs that peak_field_gives; the others stay
 * Errors: SHB_ERR_INPUT the modal file does not fit; SHB_ERR_IO. */
shb_status peak_field_evaluate(peak_field *field, const modal_model *model,
                               const mhb_settings *settings, mhb_response *response, int branch,
                               int point, double *value);

#endif
