/* Outputs of a response: the motion of a probe or of a contact, as a vector or along one axis. */
#ifndef POSTPROC_ANALYSIS_OUTPUTS_H
#define POSTPROC_ANALYSIS_OUTPUTS_H

#include <complex.h>

#include "mhb/response/response.h"

/* Of a ring of different blades also: the blade that swings highest at a point, and the mean over
 * the blades. Their place is the first probe of a blade, or its first contact without probes. */
typedef enum { POST_PLACE_PROBE, POST_PLACE_CONTACT, POST_PLACE_WORST, POST_PLACE_MEAN } post_place;
typedef enum {
  POST_QUANTITY_FIRST_HARMONIC, /* its semi-major axis */
  POST_QUANTITY_PEAK_TO_PEAK,
  POST_QUANTITY_RSS /* of the first harmonic: the root of the sum of squared components */
} post_quantity;

enum { POST_WHOLE = -1 }; /* axis: the displacement vector */

typedef struct {
  post_place place;
  int        index; /* of the probe or the contact pair */
  int        axis;  /* 0..2, or POST_WHOLE */
} post_output;

/* Largest length of x(t) = Re a e^{jt} in a cycle, the semi-major axis of its ellipse:
 *
 *   |x|max^2 = (sum |a_i|^2 + |sum a_i^2|)/2; |a| for n = 1.
 *
 *   a  in  [n], stride apart; n <= 3 */
double post_semi_major_axis(int n, const double complex *a, int stride);

/* Root of the sum of |a_i|^2: rss. */
double post_rss(int n, const double complex *a, int stride);

/* Largest distance between two instants of x(t) = Re sum_{k=0..m} a_k e^{jkt}; for n = 1 max - min.
 *
 *   a  in  [n][m + 1]; n <= 3 */
double post_peak_to_peak(int n, int m, const double complex *a);

/* Default output of a response: that of mhb.track, else the first probe, else the first contact. Of
 * a ring of different blades it is on the one that swings highest. */
post_output post_output_primary(const mhb_response *response);
/* Harmonic index of the excitation's first harmonic: the order of the branch. */
int post_first_harmonic(const mhb_branch *branch);
/* The quantity that a report begins with: what mhb.track maximises, else the first harmonic. */
post_quantity post_quantity_primary(const mhb_response *response);
/* Name of a quantity, the harmonic counted in the excitation: "first harmonic", "harmonic 3", "peak
 * to peak", "first harmonic, rss". */
void post_quantity_name(const mhb_response *response, post_quantity quantity, char out[32]);

/* Amplitude of harmonic k of an output at a point of a branch, m; 0 above its harmonics. */
double post_amplitude(const mhb_response *response, const mhb_branch *branch, int point,
                      post_output output, int k);

/* quantity of output at every point of a branch, [n_points] m, malloc'ed. Errors: SHB_ERR_IO no
 * memory. */
shb_status post_series(const mhb_response *response, const mhb_branch *branch, post_output output,
                       post_quantity quantity, double **values);

/* Blade that swings highest at a point of a ring, from 0. */
int post_worst_blade(const mhb_response *response, const mhb_branch *branch, int point);

/* Names "tip", "contact 2" (plain text; a probe may have any name) and "tangential", "u, sliding",
 * "motion". */
void        post_place_name(const mhb_response *response, post_output output, char out[128]);
const char *post_axis_name(post_output output);

/* Name of a contact pair: "contact", followed by gap and a number from 1 if there are several. With
 * several interfaces the interface's name replaces "contact". */
void post_contact_name(const mhb_response *response, int pair, const char *gap, char out[128]);

#endif
