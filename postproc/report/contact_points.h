/* Motion of the contacts and their law at points of the curves, for the page's script. It follows
 * the contact law through a period and draws loops, friction path and states.
 *
 * Why the script computes the law: a period of one contact takes 1.8 kB as samples (9 signals at
 * 100 instants, two bytes each), its motion 0.3 kB (10 harmonics). */
#ifndef POSTPROC_REPORT_CONTACT_POINTS_H
#define POSTPROC_REPORT_CONTACT_POINTS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

enum { POST_SHOWN_CONTACTS = 4 };

/* Which contacts are written, and at which points. */
typedef struct {
  int n, pair[POST_SHOWN_CONTACTS]; /* those that dissipate most over all curves, ascending */
  int stride;                       /* every stride-th point of a curve, besides peaks and folds */
} post_contact_plan;

/* n = 0 if the law is not known (analysis->settings is NULL) or there is no contact. */
post_contact_plan post_contact_points(const post_analysis *analysis);

/* Names of the contacts written: ["contact 1", ...]. */
void post_put_contact_names(const post_analysis *analysis, const post_contact_plan *plan,
                            post_buffer *out);

/* ,"contact":{"at":[indices into kept],"k":[highest harmonic],"data":"base64 of float32"}
 *
 * data: for each point and contact the law, then the motion in m, a signal being
 *   c0 + sum c_k cos k t + s_k sin k t:
 *   mu, n0, kv, kuu, kuw, kww, [3 (v, u, w)][c0, c1, s1, ..., ck, sk]
 * Nothing for linear limits and points by time integration.
 *   kept  in  [n] points of branch b that the page has */
void post_put_contact_points(const post_analysis *analysis, const post_contact_plan *plan, int b,
                             int n, const int *kept, post_buffer *out);

#endif
