/* Everything the page says about a response, worked out once: which curves belong together, their peaks and folds,
 * how the peak moves with the preload. */
#ifndef POSTPROC_ANALYSIS_RESPONSE_ANALYSIS_H
#define POSTPROC_ANALYSIS_RESPONSE_ANALYSIS_H

#include <stdbool.h>

#include "mhb/response/response.h"
#include "postproc/analysis/abscissa.h"
#include "postproc/analysis/campbell.h"
#include "postproc/analysis/convergence.h"
#include "postproc/analysis/curves.h"
#include "postproc/analysis/outputs.h"

/* Curves of one preload (nonlinear), or one linear limit. */
typedef struct {
  mhb_branch_kind kind;
  bool            empty; /* its branches hold no point, so that n0 is not known */
  double          n0;    /* N; NAN for the limits and for branches along which it varies */
  int rank; /* 0.. among the nonlinear groups, ascending n0; the colour index. -1 for the limits */
} post_group;

/* The highest peak of one group. */
typedef struct {
  double n0, at,
      amplitude;      /* of the group; abscissa and m, refined. NAN if the group has no point */
  int  branch, point; /* where, -1 if nowhere */
  bool edge;          /* the largest value is at the end of the range */
  bool level;         /* it is the same all along; at: the end where the limit is the response's */
  bool complete;      /* every branch of the group covered the range */
} post_track_point;

/* How the highest peak of one output follows the preload. */
typedef struct {
  int               n; /* preloads with a constant, known n0 and at least one point, ascending */
  post_track_point *point;       /* [n] */
  post_track_point  open, stuck; /* the limits; amplitude NAN if not computed */
  int best; /* the lowest peak; one at the edge of the frequency range only if all are; -1 if n = 0 */
  double bracket[2]; /* n0 of the neighbours of best, N; NAN at an end */
  /* parabola through best and its neighbours, log amplitude over n0 (over log n0 when all are positive); NAN unless
   * best has both neighbours and none of the three is at the edge of the range nor four times as far as the other */
  double optimum_n0, optimum_amplitude;
} post_tracking;

/* Peaks, valleys and folds of one branch. */
typedef struct {
  const double *amplitude; /* [n_points] m, first harmonic of the primary output */
  int           n_peaks, n_valleys, n_folds;
  post_peak    *peak;
  post_peak
      *valley; /* minima where another parameter than the frequency is followed; no bandwidth */
  post_fold *fold;
  int        group;
} post_curve;

typedef struct {
  const mhb_response *response;
  post_output         primary;
  int                 n_groups, n_ranks;
  post_group         *group;    /* nonlinear ones first, by rank; then varying n0, open, stuck */
  post_curve         *curve;    /* [n_branches] */
  double            **values;   /* behind curve[].amplitude */
  post_tracking       tracking; /* of the primary output's first harmonic */
  post_abscissa       abscissa;
  double              frequency[2]; /* Hz, range of all points */
  double              largest;      /* m, of the primary output over all branches */
  int                 n_points;
  const post_convergence
      *convergence; /* speed against error, if the case was studied; set by the caller */
  const post_campbell *campbell; /* modes over the speed, if there are several; set by the caller */
} post_analysis;

/* Errors: SHB_ERR_INPUT (no branch with a point), SHB_ERR_IO (no memory). The response must outlive the analysis. */
shb_status post_analysis_create(const mhb_response *response, post_analysis **analysis);
void       post_analysis_destroy(post_analysis *analysis);

/* quantity of output on every branch, [n_branches][n_points of the branch] m; free with post_values_free. */
shb_status post_values(const mhb_response *response, post_output output, post_quantity quantity,
                       double ***values);
void       post_values_free(const mhb_response *response, double **values);

/* Tracking of an output from its values on every branch; free with post_tracking_free. */
shb_status post_track(const post_analysis *analysis, double *const *values,
                      post_tracking *tracking);
void       post_tracking_free(post_tracking *tracking);

/* Largest of the error estimates of a point that are finite; NAN if none is. */
double post_error(const mhb_branch *branch, int point);

/* Share 0 stuck, 1 slipping, 2 open at a point, mean of the pairs; and the energy of all pairs, J a cycle. */
double post_state(const mhb_response *response, const mhb_branch *branch, int point, int state);
double post_dissipation(const mhb_response *response, const mhb_branch *branch, int point);

/* The curves are drawn against another parameter, at one frequency. */
bool post_at_one_frequency(const post_analysis *analysis);
/* " at 240 Hz" if so, else "". */
char *post_frequency_text(const post_analysis *analysis, char out[POST_PLACE]);

/* What tells a curve from the main one of its group: "", ", found by search", ", order 2, from a flip". */
void post_branch_note(const mhb_response *response, const mhb_branch *branch, char out[64]);

/* "open", "stuck", "n₀ = 50 N", "n₀ varying". */
void post_group_name(const post_group *group, char out[64]);

/* "7 harmonics", or "1 to 21 harmonics" where each nonlinear point has its own number. */
void post_put_harmonics(const mhb_response *response, post_buffer *out);

/* "run-up: speed 1080 to 3480 rpm along E = 5", or at one speed; nothing where the speed does not go with the frequency. */
void post_put_run_up(const post_analysis *analysis, post_buffer *out);

#endif
