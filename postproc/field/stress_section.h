/* Stress at the peaks as a section of the report page. */
#ifndef POSTPROC_FIELD_STRESS_SECTION_H
#define POSTPROC_FIELD_STRESS_SECTION_H

#include "postproc/draw/text_buffer.h"
#include "postproc/field/peak_stress.h"

/* Append a section of HTML: a table with a row a curve, at its highest kept point. It has the worst
 * place with its stresses and safety. Below are the worst places of each curve as lists, and the
 * greatest static stress at speed. Nonlinear curves only, unless nothing else was kept. Nothing is
 * appended where nothing was kept. Errors: SHB_ERR_IO no memory. */
shb_status post_stress_section(const post_blade_field *field, const mhb_response *response,
                               const post_fatigue *fatigue, post_buffer *out);

#endif
