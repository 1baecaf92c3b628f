/* Numbers of a report page, as one JSON document for its script: report.schema.json. */
#ifndef POSTPROC_REPORT_PAGE_DATA_H
#define POSTPROC_REPORT_PAGE_DATA_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/report/blade_view.h"

/* Write at most about 2.3 MB, and the blade. Columns that do not fit are left out: first axes, then
 * harmonics, then places. Above 30 000 points ordinary points between special ones are thinned.
 *
 *   blade     in   that moves, or NULL
 *   left_out  out  number of columns left out, for a note to the reader
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status post_page_data(const post_analysis *analysis, int chosen, const post_blade_view *blade,
                          post_buffer *out, int *left_out);

#endif
