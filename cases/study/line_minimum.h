/* The least value of a function of one variable from its values and slopes.
 *
 * A least value lies where the slope changes its sign from - to +. The slope may jump there: the
 * highest peak has a kink where two peaks are equally high. So each bracket of a change of sign is
 * closed by two models of the function. For a smooth minimum it is the cubic of both ends, for a
 * kink the larger of two parabolas, one an end. The model that foretold the last value better gives
 * the next point. Smooth minima and kinks then converge superlinearly, and a jump is halved. */
#ifndef CASES_STUDY_LINE_MINIMUM_H
#define CASES_STUDY_LINE_MINIMUM_H

#include <stdbool.h>

/* Value and slope at u. A slope that is not known is NAN, a value that is not known INFINITY.
 * Returns false to end the search. */
typedef bool line_function(void *context, double u, double *value, double *slope);

/* Search [low, high]: first at even distances, both ends among them. Then the bracket that promises
 * the least value is closed, and others while they promise less than was found.
 *   width  in  a bracket as narrow as this is closed
 * The caller keeps the least value of those that it gave. */
void line_minimum(double low, double high, double width, line_function *function, void *context);

#endif
