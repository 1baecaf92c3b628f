/* Error against seconds of a response curve: harmonics 1...31, automatic harmonics, three
 * accuracies of the law.
 *
 * The error of a point is relative to Newton's method with 31 harmonics at the same frequency. The
 * error of a curve is the one that 95 % of its points do not exceed. Folds and points without a
 * solution nearby are counted apart. A curve reaches a tolerance if 95 % of its points are within
 * it and all are within twice that. */
#ifndef BENCH_PRECISION_H
#define BENCH_PRECISION_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* Print the rows of a scene. The goal is that automatic harmonics at tolerance 1e-4 cost at most
 * 1.5 times the cheapest fixed number that reaches it. *failed counts automatic ones whose error
 * exceeds the tolerance, never times. */
shb_status bench_precision(const char *name, const modal_model *model, const mhb_settings *settings,
                           int *failed);

#endif
