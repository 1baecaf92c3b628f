/* What can be plotted of a response: the motion of a probe or of a contact, whole or along one axis. */
#ifndef POSTPROC_ANALYSIS_OUTPUTS_H
#define POSTPROC_ANALYSIS_OUTPUTS_H

#include <complex.h>

#include "mhb/response/response.h"

typedef enum { POST_PLACE_PROBE, POST_PLACE_CONTACT } post_place;
typedef enum { POST_QUANTITY_FIRST_HARMONIC, POST_QUANTITY_PEAK_TO_PEAK } post_quantity;

enum { POST_WHOLE = -1 }; /* axis: the displacement vector itself */

typedef struct {
  post_place place;
  int        index; /* of the probe or the contact pair */
  int        axis;  /* 0..2, or POST_WHOLE */
} post_output;

/* Largest length a vector x(t) = Re a e^{jt} reaches in a cycle, the semi-major axis of its ellipse:
 * |x|max^2 = (sum |a_i|^2 + |sum a_i^2|)/2. For n = 1 it is |a|.
 *   a  in  [n], stride apart; n <= 3 */
double post_semi_major_axis(int n, const double complex *a, int stride);

/* Largest distance between two instants of a cycle of x(t) = Re sum_{k=0..m} a_k e^{jkt}; for n = 1 max - min.
 *   a  in  [n][m + 1]; n <= 3
 * Sampled at 8 instants a period of the highest harmonic, then refined by Newton on both instants; accurate to
 * rounding. NAN when out of memory. */
double post_peak_to_peak(int n, int m, const double complex *a);

/* The output that stands for the response when one must be chosen: first probe, else first contact. */
post_output post_output_primary(const mhb_response *response);
/* Harmonic that the excitation's first is: the branch's order (fundamental = excitation / order). */
int post_first_harmonic(const mhb_branch *branch);

/* Amplitude of harmonic k of output at a point of branch, m; 0 beyond its harmonics. */
double post_amplitude(const mhb_response *response, const mhb_branch *branch, int point,
                      post_output output, int k);

/* quantity of output at every point of branch, [n_points] m; malloc'ed. Errors: SHB_ERR_IO (no memory). */
shb_status post_series(const mhb_response *response, const mhb_branch *branch, post_output output,
                       post_quantity quantity, double **values);

/* "tip", "contact 2" (plain text; a probe's name may be anything) and "tangential", "u (sliding)", "motion". */
void        post_place_name(const mhb_response *response, post_output output, char out[128]);
const char *post_axis_name(post_output output);

/* A contact pair: "contact", with the number from 1 after gap where there are several; of several interfaces the name of its
 * own one, with a number if it has several pairs. */
void post_contact_name(const mhb_response *response, int pair, const char *gap, char out[128]);

#endif
