/* A solution of the balance from a cold start. */
#ifndef TESTS_SUPPORT_SOLUTION_H
#define TESTS_SUPPORT_SOLUTION_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* Solution x[3 pairs (2 harmonics + 1)] in real form, at omega rad/s and the first preload. Fails
 * the test if there is none. */
void cold_solution(const modal_model *model, const mhb_settings *settings, double omega,
                   double tolerance, double *x);

#endif
