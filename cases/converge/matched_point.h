/* Amplitude of an output at the solution next to a known one: what compares curves without interpolation between their points. */
#ifndef CASES_CONVERGE_MATCHED_POINT_H
#define CASES_CONVERGE_MATCHED_POINT_H

#include <stdbool.h>

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"
#include "postproc/analysis/outputs.h"

typedef struct point_matcher point_matcher;

/* A place on a known curve: part of the way from one point to another of a branch, the curve running as from low to high. */
typedef struct {
  const mhb_branch *branch;
  int               from, to, low, high; /* points */
  double            part;                /* 0 at from, 1 at to */
} curve_place;

/* A balance of that many harmonics (the settings' own number and tolerance do not count). The model must outlive it.
 * Errors: as mhb_balance_create. */
shb_status point_matcher_create(const modal_model *model, const mhb_settings *settings,
                                int harmonics, post_output output, point_matcher **out);
void       point_matcher_destroy(point_matcher *matcher);

/* The solution of this balance next to a place of another one, which has as many pairs: in the plane across the curve there, or at the
 * same frequency.
 *   found  out  Hz, m (first harmonic of the excitation)
 * 1: found; 0: not. */
int point_matcher_solve(point_matcher *matcher, const curve_place *place, bool same_frequency,
                        double found[2]);

#endif
