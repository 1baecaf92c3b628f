/* The numbers behind the page's interactive charts, as JSON for its script.
 *
 * Members: groups [{name, kind, n0, rank}], branches [{group, n, complete, reason, data}], outputs [{place, axis,
 * quantity, row, track, peaks, folds}], spectra [{place, row, n}], rows, chosen, log, abscissa {parameter (as in a case
 * file), name, unit, scale (value in SI / scale is read), log, range [lo, hi]}.
 *   data      base64 of float32 [rows][n]; rows 0..7: abscissa in SI, shares stuck, slipping, open, dissipation J,
 *             error estimate, stable, special; then what outputs and spectra (harmonics 0..n-1) point to, in m
 *   track     a preload each: [group, n0, amplitude, abscissa, edge, stuck, slipping, open, dissipation]
 *   peaks, folds   [group, abscissa, amplitude] */
#ifndef POSTPROC_REPORT_PAGE_DATA_H
#define POSTPROC_REPORT_PAGE_DATA_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* At most about 2.3 MB: axes, harmonics and places are left out, in this order and to be told to the reader, when
 * they do not fit; beyond some 30 000 points ordinary points between the special ones are thinned.
 *   left_out  out  number of columns left out
 * Errors: SHB_ERR_IO (no memory). */
shb_status post_page_data(const post_analysis *analysis, int chosen, post_buffer *out,
                          int *left_out);

#endif
