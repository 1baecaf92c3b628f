/* Error against seconds of a response curve: each number of harmonics 1...31, harmonics chosen, three accuracies of the law.
 *
 * The error of a curve is that of its points, each against Newton with 31 harmonics at the same frequency, relative: the one
 * that 95 % of them do not exceed. Folds and points without a solution near by are counted apart. A curve reaches a tolerance if 95 %
 * of its points are within it and all within twice that. */
#ifndef BENCH_PRECISION_H
#define BENCH_PRECISION_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* Prints the rows of one scene and whether the chosen harmonics at tolerance 1e-4 cost at most 1.5 times the cheapest fixed number
 * that reaches it. *failed: counts chosen ones whose error is above the tolerance, never seconds. */
shb_status bench_precision(const char *name, const modal_model *model, const mhb_settings *settings,
                           int *failed);

#endif
