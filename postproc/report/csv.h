/* The whole response as one table, a row a point (RFC 4180: comma, CRLF, quotes where needed; first row names). */
#ifndef POSTPROC_REPORT_CSV_H
#define POSTPROC_REPORT_CSV_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* Columns: branch, kind, n0_N (of the linear limits only if it is followed), frequency_Hz, the parameter that is followed if it is
 * neither (scale, mu, ku_N_m, kv_N_m); for each probe axis NAME_tangential_amplitude_m, _phase_deg (first
 * harmonic), _peak_to_peak_m, and NAME_motion_amplitude_m, NAME_motion_peak_to_peak_m; for each contact (contact,
 * or contact1, contact2, ...) the same with v, u, w, then _stuck, _slipping, _open (shares of the period) and
 * _dissipation_J; stable (1, 0, empty: not known), special (fold, peak, flip, Neimark-Sacker, empty);
 * what stable rests on: judged (multipliers; marginal, undecided, folds: parity of folds), loss (fold, flip, Neimark-Sacker, empty),
 * largest_multiplier (modulus; empty where none was computed); iterations, seconds, error_newton, _truncation, _sampling,
 * _modal; origin (end of the range, search, flip) and order nu: it repeats after nu periods. The amplitudes and phases are those of the
 * excitation's harmonic, peak to peak that of all. Numbers as %0.12g, phase of Re a e^{jwt} in degrees; a number that is not finite is left empty. */
void post_csv(const mhb_response *response, post_buffer *out);

#endif
