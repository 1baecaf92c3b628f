/* Numbers of the page's interactive charts, as JSON for its script.
 *
 *   groups    [{name, kind, n0, rank}]
 *   branches  [{group, n, complete, reason, data}]
 *   outputs   [{place, axis, quantity, row, track, best, limits, resonances, peaks, folds}]
 *   spectra   [{place, row, n}]
 *   pairs, contacts   number of contacts, names of those that are written (contact_points.h)
 *   rows, chosen, log; in a run-up rpm, speed over frequency
 *   abscissa  {parameter (as in a case file), name, unit, scale (shown is value in SI / scale),
 *             log, range [lo, hi]}
 *
 *   data   base64 of float32 [rows][n]. Rows 0 .. 8: abscissa in SI, shares stuck, slipping, open,
 *          dissipation in J, error estimate, stable, special, mark. Further rows, in m, belong to
 *          outputs and spectra (harmonics 0 .. n - 1).
 *   track  for each preload [group, n0, amplitude, abscissa, edge, stuck, slipping, open,
 *          dissipation]
 *          edge: 2 where the estimated error is above the tolerance
 *   best   index of the lowest of these, -1: none
 *   peaks, folds  [group, abscissa, amplitude]
 *   resonances    where there are several, each [[n0, abscissa, amplitude], ...] */
#ifndef POSTPROC_REPORT_PAGE_DATA_H
#define POSTPROC_REPORT_PAGE_DATA_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* Write at most about 2.3 MB. Columns that do not fit are left out: first axes, then harmonics,
 * then places. Above some 30 000 points ordinary points between special ones are thinned.
 *
 *   left_out  out  number of columns left out, for a note to the reader
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status post_page_data(const post_analysis *analysis, int chosen, post_buffer *out,
                          int *left_out);

#endif
