/* The whole response as one table, a row for each point (RFC 4180: comma, CRLF, quotes where
 * needed; the first row holds the names). */
#ifndef POSTPROC_REPORT_CSV_H
#define POSTPROC_REPORT_CSV_H

#include "mhb/response/response.h"
#include "postproc/draw/text_buffer.h"

/* Columns:
 *
 *   branch, kind, n0_N       n0_N of the linear limits only if it is followed
 *   frequency_Hz; scale, mu, ku_N_m or kv_N_m if that is followed
 *   NAME_tangential_amplitude_m, _phase_deg, _peak_to_peak_m   also _axial, _radial, each probe
 *   NAME_motion_amplitude_m, NAME_motion_peak_to_peak_m        each probe
 *   contact_v_..., contact_u_..., contact_w_..., contact_motion_...   each contact, numbered if
 *                            there are several
 *   contact_stuck, _slipping, _open, _dissipation_J   shares of the period; energy per cycle
 *   stable                   1, 0, empty: not judged
 *   special                  fold, peak, flip, Neimark-Sacker, empty
 *   judged                   basis of stable: multipliers, marginal, undecided, neighbours, folds;
 *                            no: not judged
 *   loss                     fold, flip, Neimark-Sacker, empty
 *   largest_multiplier       modulus; empty if not computed
 *   iterations, seconds, error_newton, _truncation, _sampling, _modal
 *   origin                   end of the range, search, flip, aside
 *   order                    nu: the motion repeats after nu periods
 *
 * Amplitude and phase are those of the excitation's harmonic; the phase is that of Re a e^{jwt},
 * degrees. Peak to peak includes all harmonics. Numbers are written as %.12g, empty if not
 * finite. */
void post_csv(const mhb_response *response, post_buffer *out);

#endif
