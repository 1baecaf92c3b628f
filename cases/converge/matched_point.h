/* Amplitude of an output at the solution next to a known point of another curve. Curves are
 * compared by it without interpolation between their points. */
#ifndef CASES_CONVERGE_MATCHED_POINT_H
#define CASES_CONVERGE_MATCHED_POINT_H

#include <stdbool.h>

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "mhb/tracking/peak_derivatives.h"
#include "modal/model/model.h"
#include "postproc/analysis/outputs.h"

typedef struct point_matcher point_matcher;

/* A place on a known curve, between two points of a branch. The curve runs from low to high. */
typedef struct {
  const mhb_branch *branch;
  int               from, to, low, high; /* points */
  double            part;                /* 0 at from, 1 at to */
} curve_place;

/* Create a balance with this number of harmonics, in place of the number and tolerance of settings.
 * The model must outlive it. Errors: as mhb_balance_create. */
shb_status point_matcher_create(const modal_model *model, const mhb_settings *settings,
                                int harmonics, post_output output, point_matcher **out);
void       point_matcher_destroy(point_matcher *matcher);

/* Solve the balance next to a place on a curve with as many pairs: in the plane across the curve,
 * or at the same frequency.
 *
 *   found  out  Hz, m (first harmonic of the excitation)
 *
 * Returns 1 if a solution was found, else 0. */
int point_matcher_solve(point_matcher *matcher, const curve_place *place, bool same_frequency,
                        double found[2]);

/* Append the solution found last to a branch of a response with as many pairs and probes. The
 * branch has the harmonics of the matcher. Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_record(point_matcher *matcher, mhb_response *response, int branch);

/* Verdict of the multipliers on the solution found last: 1 stable, 0 unstable, -1 undecided.
 * Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_judge(point_matcher *matcher, int *stable);

/* Derivatives of the peak that the solution found last is at. The balance is left elsewhere: solve
 * again before the other functions. Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_derivatives(point_matcher *matcher, mhb_peak_derivatives *derivatives);

#endif
