/* The solved design that is nearest to another one. */
#ifndef CASES_STUDY_NEAREST_DESIGN_H
#define CASES_STUDY_NEAREST_DESIGN_H

#include "postproc/study/design_study.h"

/* The nearest design that is done, and was not tried again itself; -1: none. The distance is taken
 * over the keys, each divided by its range over all designs. Keys above 0 enter by their logarithm.
 * Of equal distances the first design counts. */
int nearest_design(const design_study *study, int design);

#endif
