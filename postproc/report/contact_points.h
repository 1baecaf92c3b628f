/* Contacts over one period at points of the curves, for the page's script, which only draws them.
 *
 * The contact law in C (mhb/contact/time_history.h) follows the recorded motion. It is the law of
 * the balance, so what is drawn is what the file holds. A loop whose forces are not those of the
 * file is not written.
 *
 * Samples are thinned to the corners of a polygon that is off by 0.2 % of what a signal spans: half
 * a pixel. A loop takes some 0.8 kB of the page. */
#ifndef POSTPROC_REPORT_CONTACT_POINTS_H
#define POSTPROC_REPORT_CONTACT_POINTS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

enum { POST_SHOWN_CONTACTS = 4 };

/* Which contacts are written, and at which points. */
typedef struct {
  int     n, pair[POST_SHOWN_CONTACTS]; /* those that dissipate most over all curves, ascending */
  int     stride; /* every stride-th point of a curve, besides peaks and folds */
  double *share;  /* [n_pairs] of each pair in its interface */
} post_contact_plan;

/* n = 0 if the law is not known (analysis->settings is NULL) or there is no contact. Free it in any
 * case. Errors: SHB_ERR_IO no memory. */
shb_status post_contact_points(const post_analysis *analysis, post_contact_plan *plan);
void       post_contact_plan_free(post_contact_plan *plan);

/* {"all": number of contacts, "names": of those written, "full": 32767, "signals": rows of a
 * loop's data, "loop": columns of its numbers}. */
void post_put_contacts(const post_analysis *analysis, const post_contact_plan *plan,
                       post_buffer *out);

/* ,"contact":{"at":[indices into kept],"loops":[[n, scales, numbers], ...],"data":"base64"}
 *
 * loops   one for each point and contact: the number of samples; the scales of u, w (m), fu, fw,
 *         load, limit (N); shares stuck, slipping, open and J a cycle, as in the file. n = 0: the
 *         law does not give the forces of the file there.
 * data    16-bit integers [7][n] a loop: phase, u, w, fu, fw, load, each 32767 times its share of
 *         the scale, and the state from the sample before (0 stuck, 1 slipping, 2 open). The limit
 *         of friction is to its scale as the load is.
 * Nothing for linear limits and points by time integration.
 *   kept  in  [n] points of branch b that the page has
 * Errors: SHB_ERR_IO no memory. */
shb_status post_put_contact_points(const post_analysis *analysis, const post_contact_plan *plan,
                                   int b, int n, const int *kept, post_buffer *out);

#endif
