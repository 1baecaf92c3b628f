/* The worst places at every peak of a response as a table. */
#ifndef POSTPROC_FIELD_STRESS_TABLE_H
#define POSTPROC_FIELD_STRESS_TABLE_H

#include "postproc/draw/text_buffer.h"
#include "postproc/field/peak_stress.h"

/* One row a place, the worst of each point first (RFC 4180; the first row holds the names):
 *
 *   branch, kind, n0_N, frequency_Hz, point, special, stable
 *   place, node, x_m, y_m, z_m        place from 1; node from 0
 *   amplitude_Pa, principal_Pa, mean_Pa, safety     as of post_worst_place; empty if not given
 *
 * Points are those kept in the response. If a whole branch is kept, only its peaks and its highest
 * point count.
 * Errors: SHB_ERR_IO no memory. */
shb_status post_stress_table(const post_blade_field *field, const mhb_response *response,
                             const post_fatigue *fatigue, post_buffer *out);

#endif
