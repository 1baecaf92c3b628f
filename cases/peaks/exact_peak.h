/* The highest peak of an output: found beside a coarse curve, then solved with enough harmonics.
 *
 * A sweep with few harmonics shows where the curve may be highest; fine_curve.h finds the maxima
 * there with more. Each is solved by the equations of a peak, or by comparison where these fail.
 * The highest are solved with about twice the harmonics again, and the change is the error. */
#ifndef CASES_PEAKS_EXACT_PEAK_H
#define CASES_PEAKS_EXACT_PEAK_H

#include "cases/peaks/peak_field.h"
#include "cases/peaks/peak_walk.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "mhb/tracking/peak_derivatives.h"
#include "modal/model/model.h"
#include "postproc/analysis/outputs.h"

/* Numbers at a peak, and their changes by more harmonics (NAN: not known). */
typedef struct {
  bool   found;
  bool   edge;    /* the highest point is an end of a curve: the peak may lie outside the range */
  bool   exact;   /* solved again; false: a point of the coarse curve */
  bool   doubt;   /* a place where the curve may be higher has no fine solution */
  double missed;  /* m, the highest place of the coarse curve without a fine solution; 0: none */
  double high[2]; /* Hz, between which such places are high; the first is the greater: none */
  bool   walked;  /* it is the peak that was walked to from another design */
  double frequency, amplitude, peak_to_peak, rss, dissipation; /* Hz, m, m, m, J */
  double frequency_error, amplitude_error, peak_to_peak_error, rss_error, dissipation_error;
  int    stable;           /* 1, 0; -1: not judged or undecided */
  mhb_peak_derivatives by; /* of kind MHB_PEAK_UNJUDGED if they were not asked for */
  double field[STUDY_MAX_OUTPUTS], field_error[STUDY_MAX_OUTPUTS]; /* of peak_field; NAN: none */
} exact_peak;

typedef struct {
  bool               multipliers, derivatives;
  peak_field        *field;     /* NULL: not asked for */
  int                harmonics; /* of the coarse curve at most, per period of the excitation */
  bool               hasty;     /* as of fine_maxima_find */
  const solved_peak *walked;    /* from another design, joins the maxima; NULL: none */
  solved_peak       *solution;  /* out: that of the peak; NULL: not asked for */
} exact_peak_asked;

/* Find the highest peak of an output over all nonlinear branches of a response.
 *
 *   settings  in  of the case: harmonics, or those that the tolerance of the motion asks for
 *   asked     in  what is computed there besides
 *
 * Errors: SHB_ERR_IO no memory; those of mhb_balance_create. */
shb_status exact_peak_find(const modal_model *model, const mhb_settings *settings,
                           mhb_response *response, post_output output, exact_peak_asked asked,
                           exact_peak *peak);

#endif
