/* What was read from a study file, for a person to compare with what was meant. Keys, ranges,
 * distributions, limits and cost are in the units of engineers. */
#ifndef CASES_DESIGNS_STUDY_ECHO_H
#define CASES_DESIGNS_STUDY_ECHO_H

#include "cases/designs/study_spec.h"

/* What designs took that are known from earlier runs; n = 0: none. */
typedef struct {
  int    n;
  double seconds; /* mean CPU time of one, with its share of mesh and modes */
} study_cost;

/* Print a checked study.
 *   cost   in  of known designs
 *   cores  in  that compute designs */
void study_echo(const study_spec *spec, const study_cost *cost, int cores, FILE *out);

/* "5 mm", "80 MPa", "0.3": a value in SI as engineers write it. */
enum { STUDY_ECHO = 64 };
void study_echo_value(double value, const char *unit, char out[STUDY_ECHO]);

#endif
