/* Analysis of a response for the page: groups of curves, peaks and folds, the peak over the
 * preload. */
#ifndef POSTPROC_ANALYSIS_RESPONSE_ANALYSIS_H
#define POSTPROC_ANALYSIS_RESPONSE_ANALYSIS_H

#include <stdbool.h>

#include "mhb/response/response.h"
#include "postproc/analysis/abscissa.h"
#include "postproc/analysis/campbell.h"
#include "postproc/analysis/convergence.h"
#include "postproc/analysis/curves.h"
#include "postproc/analysis/outputs.h"

/* Curves of one preload (nonlinear), or of one linear limit. */
typedef struct {
  mhb_branch_kind kind;
  bool            empty; /* its branches hold no point, thus n0 is unknown */
  double          n0;    /* N; NAN for the limits, and if it varies */
  /* Index among the nonlinear groups by ascending n0, also of the colour; -1 for the limits. */
  int rank;
} post_group;

/* Highest peak of one group. Where its error is above the tolerance none is told. */
typedef struct {
  double n0, at,
      amplitude;      /* n0 of the group; abscissa and amplitude (m) refined, NAN: none is told */
  int  branch, point; /* indices, -1 if there is none */
  bool edge;          /* the largest value is at an end of the range */
  /* The amplitude is constant; at: the end where the limit is that of the response. */
  bool level;
  bool complete; /* all branches of the group cover the range */
  bool doubtful; /* its estimated error is above the tolerance: it is no result */
} post_track_point;

/* Highest peak of one output over the preload. */
typedef struct {
  int               n;           /* preloads with a known n0 and at least one point, ascending */
  post_track_point *point;       /* [n] */
  post_track_point  open, stuck; /* the limits; amplitude NAN if not computed */
  /* Index of the lowest peak, without doubtful ones; one at an edge of the range only if all are;
   * -1: none. */
  int    best;
  double bracket[2]; /* n0 of the next peaks that are not doubtful, N; NAN if there is none */
  /* Vertex of the parabola through best and its neighbours, log amplitude over n0 (over log n0 if
   * all are positive). NAN unless best has two neighbours at a ratio of spacings below 4 and no
   * point is at an edge or doubtful. */
  double optimum_n0, optimum_amplitude;
} post_tracking;

/* The highest peaks of one resonance each, by rising frequency (resonances.h). */
typedef struct {
  int            n;
  post_tracking *list; /* each has a peak at half of the preloads or more */
} post_resonances;

/* Peaks, valleys and folds of one branch. */
typedef struct {
  const double *amplitude; /* [n_points] m, first harmonic of the primary output */
  int           n_peaks, n_valleys, n_folds;
  post_peak    *peak;
  /* Minima if another parameter than the frequency is followed; no bandwidth. */
  post_peak *valley;
  post_fold *fold;
  int        group;
} post_curve;

typedef struct {
  const mhb_response *response;
  post_output         primary;
  int                 n_groups, n_ranks;
  post_group         *group;      /* nonlinear by rank, then varying n0, open, stuck */
  post_curve         *curve;      /* [n_branches] */
  double            **values;     /* memory of curve[].amplitude */
  post_tracking       tracking;   /* of the first harmonic of the primary output */
  post_resonances     resonances; /* of the same; none until resonances.h adds them */
  post_abscissa       abscissa;
  double              frequency[2]; /* Hz, range over all points */
  double              largest;      /* m, largest primary output of all branches */
  int                 n_points;
  /* Convergence study of the case, if there is one; set by the caller. */
  const post_convergence *convergence;
  /* Settings of the response, and the area of each contact, m2; NULL: not known. Set by the
   * caller. */
  const mhb_settings *settings;
  const double       *area;
  const char         *stress;   /* section of the page on stress, HTML; NULL: none. Set likewise. */
  const struct post_safe *safe; /* frequencies over the nodal diameter; NULL: none. Set likewise. */
  /* [n_campbells] modes over the speed, if there are several. Of a disc one a nodal diameter that
   * its load meets, that of the engine order first. Set by the caller. */
  const post_campbell *campbell;
  int                  n_campbells;
} post_analysis;

/* The response must outlive the analysis. Errors: SHB_ERR_INPUT no branch with a point; SHB_ERR_IO
 * no memory. */
shb_status post_analysis_create(const mhb_response *response, post_analysis **analysis);
void       post_analysis_destroy(post_analysis *analysis);

/* quantity of output on every branch, [n_branches][n_points of the branch] m; free with
 * post_values_free. */
shb_status post_values(const mhb_response *response, post_output output, post_quantity quantity,
                       double ***values);
void       post_values_free(const mhb_response *response, double **values);

/* Tracking of an output from its values on every branch; free with post_tracking_free. */
shb_status post_track(const post_analysis *analysis, double *const *values,
                      post_tracking *tracking);
/* Set best, bracket and optimum. any_edge: a largest value at an edge of the range counts. */
void post_tracking_optimum(bool any_edge, post_tracking *tracking);
void post_tracking_free(post_tracking *tracking);
void post_resonances_free(post_resonances *resonances);

/* Some contacts of a point stick throughout and others do not. Nothing determines the mean friction
 * of the former, which moves the latter: the point is one of many answers. */
bool post_undetermined(const mhb_response *response, const mhb_branch *branch, int point);

/* Largest finite error estimate of a point; NAN if there is none. */
double post_error(const mhb_branch *branch, int point);

/* Spatial error of a point; NAN where it was not judged. */
double post_spatial_error(const mhb_branch *branch, int point);

/* Share of the period in a state (0 stuck, 1 slipping, 2 open), mean over the pairs. */
double post_state(const mhb_response *response, const mhb_branch *branch, int point, int state);
/* Energy of all pairs that slip, J per cycle; of others the file has only round-off. */
double post_dissipation(const mhb_response *response, const mhb_branch *branch, int point);

/* True if the curves are drawn over another parameter, at one frequency. */
bool post_at_one_frequency(const post_analysis *analysis);
/* " at 240 Hz" in that case, else "". */
char *post_frequency_text(const post_analysis *analysis, char out[POST_PLACE]);

/* Text that distinguishes a curve from the main one: "", ", isolated curve found by search",
 * ", order 2, from a flip". */
void post_branch_note(const mhb_response *response, const mhb_branch *branch, char out[64]);

/* "open", "stuck", "n₀ = 50 N", "n₀ varying". */
void post_group_name(const post_group *group, char out[64]);

/* "7 harmonics", or "1 to 21 harmonics" if the number varies over the nonlinear points. */
void post_put_harmonics(const mhb_response *response, post_buffer *out);

/* "run-up: speed 1080 to 3480 rpm along E = 5", or at one speed; nothing without a run-up. */
void post_put_run_up(const post_analysis *analysis, post_buffer *out);

#endif
