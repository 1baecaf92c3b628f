/* Stability along a branch of a response, point by point. */
#ifndef TESTS_HARD_FLOQUET_H
#define TESTS_HARD_FLOQUET_H

#include "mhb/floquet/floquet.h"
#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

typedef struct {
  mhb_verdict  verdict;
  mhb_crossing crossing;
  int          n_unstable;
  double       largest;
} floquet;

/* out[n_points] */
void floquet_branch(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                    const mhb_branch *b, int substeps, floquet *out);

/* Where the largest multiplier crosses the unit circle between points i and i + 1, rad/s; by
 * bisection with corrected points. */
double floquet_crossing(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                        const mhb_branch *b, int i, int substeps);

#endif
