/* What the verdicts on stability and the motion that lasts say, in words.
 *
 * Two words for two things: a wave is modulated where side waves or a doubled period take it over
 * and no fold is passed. A solution beyond a fold is never seen. */
#ifndef POSTPROC_ANALYSIS_STABILITY_FINDINGS_H
#define POSTPROC_ANALYSIS_STABILITY_FINDINGS_H

#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"

/* Verdict on a point, in the order in which one of a line's two ends decides how it is drawn. */
typedef enum {
  POST_VERDICT_STABLE,
  POST_VERDICT_NOT_JUDGED,
  POST_VERDICT_MODULATED,
  POST_VERDICT_NEVER_SEEN,
  POST_N_VERDICTS
} post_verdict;

post_verdict post_verdict_of(const mhb_branch *branch, int point);

/* Whether a window of the slow sweep shows what lasts. Where the wave is stable it need not: the
 * motion of an unstable stretch rings on there. */
bool post_swing_lasts(const mhb_branch *branch, int window);

/* Window of the largest swing of any blade in the slow sweep of a branch; -1: none. */
int post_largest_swing(const mhb_branch *branch);

/* Write list items: how many points are modulated, never seen and not judged, and what lasts. */
void post_stability_findings(const post_analysis *analysis, post_buffer *out);

/* Write a key figure: what lasts at a peak. Nothing if the wave is stable there. */
void post_lasting_figure(const post_analysis *analysis, const post_track_point *peak,
                         post_buffer *out);

/* The same in words for the terminal, after a comma. */
void post_lasting_summary(const post_analysis *analysis, const post_track_point *peak,
                          post_buffer *out);

#endif
