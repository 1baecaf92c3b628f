/* NAME.html: the report page. One file, no network, light and dark, printable. Its charts are plain
 * SVG; a script makes them interactive. */
#ifndef POSTPROC_REPORT_REPORT_H
#define POSTPROC_REPORT_REPORT_H

#include "postproc/analysis/file_origin.h"
#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/report/blade_view.h"

/* blade may be NULL, or one that does not fit. case_name and the texts of source may hold any
 * characters. Errors: SHB_ERR_IO no memory. */
shb_status post_report(const post_analysis *analysis, const post_origin *source,
                       const char *case_name, const post_blade_view *blade, post_buffer *out);

#endif
