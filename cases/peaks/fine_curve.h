/* The curve with more harmonics beside a coarse one, sampled where it may be highest.
 *
 * A coarse curve may have other maxima than the fine one. With three harmonics two peaks of nearly
 * equal height merge into one near optimum preloads of cases/z_notch_blade. So the maxima are those
 * of the fine curve. Its samples lie in planes across the coarse curve, at points that may be the
 * highest. Half-way between those that are high lies one more. */
#ifndef CASES_PEAKS_FINE_CURVE_H
#define CASES_PEAKS_FINE_CURVE_H

#include "cases/peaks/peak_walk.h"
#include "mhb/response/response.h"
#include "postproc/analysis/outputs.h"

/* A sample that is not lower than those beside it. */
typedef struct {
  const mhb_branch *branch;   /* of the coarse curve */
  int               point;    /* of the coarse branch, at the sample or before it */
  bool              edge;     /* an end of the branch */
  bool              walked;   /* no sample: it was walked to from another design */
  double            found[2]; /* Hz, m */
  matched_solution  before, at, after;
  double            beside[2]; /* m, amplitudes before and after */
} fine_maximum;

typedef struct {
  int           n;
  fine_maximum *list;   /* [n] by falling amplitude */
  double        missed; /* m, highest point of the coarse curve without a fine solution; 0: none */
  double high[2];       /* Hz, between which such points are high; the first is the greater: none */
} fine_maxima;

/* The maxima of an output that may be the highest over all nonlinear branches.
 *
 *   harmonics  in  of the fine curve, per period of the excitation; 0: those of the settings
 *   hasty      in  give up if a high maximum of the coarse curve has no fine solution beside it: no
 *                  maxima, and that one is missed. In 26 of 31 such designs of z_notch_blade it
 *                  could not be solved from its neighbours either. Likewise if the coarse curve is
 *                  doubtful: its contact opens, and several points have no fine solution
 *   maxima     out to be freed in any case
 * Errors: SHB_ERR_IO no memory; those of mhb_balance_create. */
shb_status fine_maxima_find(const modal_model *model, const mhb_settings *settings,
                            const mhb_response *coarse, post_output output, int harmonics,
                            bool hasty, fine_maxima *maxima);
void       fine_maxima_free(fine_maxima *maxima);

/* Append a peak that was walked to from another design. Its own branch is not known: it takes the
 * first one of its order. Nothing is done without such a branch. Errors: SHB_ERR_IO no
 * memory. */
shb_status fine_maxima_append(const mhb_response *coarse, const solved_peak *peak,
                              fine_maxima *maxima);

/* Harmonics of a balance on a branch of some order. */
int fine_harmonics(const mhb_settings *settings, const mhb_branch *branch, int harmonics);

#endif
