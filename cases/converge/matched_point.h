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

/* Newton's method ends at this residual, relative to the motion. After creation: 1e-10. */
void point_matcher_set_tolerance(point_matcher *matcher, double tolerance);

/* Solve the balance next to a place on a curve with as many pairs: in the plane across the curve,
 * or at the same frequency.
 *
 *   found  out  Hz, m (first harmonic of the excitation)
 *
 * Returns 1 if a solution was found, else 0. */
int point_matcher_solve(point_matcher *matcher, const curve_place *place, bool same_frequency,
                        double found[2]);

/* The same in the plane across the curve, from the solution found last, moved as the curve moves.
 * The place of that solution must be near. As solve where none was found yet. */
int point_matcher_follow(point_matcher *matcher, const curve_place *place, double found[2]);

/* A solution as a start for others, also of matchers with other harmonics. */
typedef struct {
  int     harmonics; /* of x */
  double  omega, n0; /* rad/s, N */
  double *x;         /* [3 pairs][1 + 2 harmonics] m; NULL: none */
} matched_solution;

/* Keep the solution found last. Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_keep(const point_matcher *matcher, matched_solution *solution);
void       matched_solution_free(matched_solution *solution);

/* Solve between two kept solutions of one curve, share from a to b, in the plane across a chord of
 * it. Returns 1 if a solution was found, else 0. */
int point_matcher_between(point_matcher *matcher, const matched_solution *a,
                          const matched_solution *b, double share,
                          const matched_solution *const chord[2], double found[2]);

/* How much the amplitude at a kept solution of fewer harmonics changes with those of the matcher,
 * at its frequency, m. At a smooth peak that is the change of the peak, whose frequency moves too.
 * Two steps with one linearisation, whose changes add up: where the second is not small, new slip
 * begins. The matcher's solution found last is lost.
 *   change  out  NAN: not known
 * Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_change(point_matcher *matcher, const matched_solution *solution,
                                double *change);

/* Append the solution found last to a branch of a response with as many pairs and probes. The
 * branch has the harmonics of the matcher. Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_record(point_matcher *matcher, mhb_response *response, int branch);

/* Verdict of the multipliers on the solution found last: 1 stable, 0 unstable, -1 undecided.
 * Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_judge(point_matcher *matcher, int *stable);

/* The peak near the solution found last, by its own equations, and its derivatives.
 *   near   in  how far a smooth peak may be
 *   found  out Hz, m
 * At a smooth peak the solution found last becomes that of the peak. Else the balance is left
 * elsewhere: solve again before the other functions. Errors: SHB_ERR_IO no memory. */
shb_status point_matcher_peak(point_matcher *matcher, mhb_peak_near near,
                              mhb_peak_derivatives *derivatives, double found[2]);

#endif
