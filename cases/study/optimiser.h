/* Minimisation as questions and answers, by NLopt or by line_minimum.h.
 *
 * Each start runs in a thread of its own, asks for the value at a point, and sleeps until it is
 * told. Its points depend on its own answers only, so that the order of answers does not change the
 * result. */
#ifndef CASES_STUDY_OPTIMISER_H
#define CASES_STUDY_OPTIMISER_H

#include <stdbool.h>

#include "cases/designs/study_optimise.h"
#include "mesh/base/status.h"

typedef struct optimiser optimiser;

/* Begin all starts in the unit cube.
 *   first  in  [starts][n] their first points
 * Errors: SHB_ERR_IO no memory, no thread. */
shb_status optimiser_create(const study_optimise *settings, int n, const double *first,
                            optimiser **out);

/* A start that waits for a value, the lowest; its point [n] is the caller's to read until it is
 * told. Waits while a start is thinking. -1: all wait for values that were asked for, or are
 * done. */
int optimiser_ask(optimiser *o, const double **point);

/* The value at the point that a start asked for. For STUDY_SLOPE also the slope along the one key
 * of the unit cube; NAN: not known. */
void optimiser_tell(optimiser *o, int start, double value, double slope);

/* Whether a start ended because its evaluations were used up. */
bool optimiser_used_up(const optimiser *o, int start);

/* End all threads, also those that wait. */
void optimiser_destroy(optimiser *o);

/* "SBPLX of NLopt 2.7.1", "root of the slope" */
void optimiser_name(study_algorithm algorithm, char *out, size_t size);

#endif
