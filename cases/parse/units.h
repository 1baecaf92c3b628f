/* Numbers with units, converted to SI, with a check of their dimension. Angle counts as a dimension
 * of its own, so that rad/s differs from Hz. */
#ifndef CASES_PARSE_UNITS_H
#define CASES_PARSE_UNITS_H

#include <stdbool.h>

enum { CASE_WHY = 256 };

/* A decimal number and a unit, such as "6000 rpm", "35 deg", "2MN/m", "7.85 g/cm3", "0.2 %". A
 * number without a unit is in SI.
 *
 *   text   in   as in the case file
 *   unit   in   SI unit of the key, e.g. "N/m"; "" for a number without a dimension
 *   value  out  in that SI unit; powers of ten are exact: 0.2 mm is the double nearest to 0.0002
 *   why    out  on failure: the reason, one line without the key
 *
 * Refused: nan, inf, hexadecimal, decimal commas, overflow, an unknown unit, a unit of another
 * dimension, text after the unit. A number below 1e-100 in size is refused unless it is 0. Units
 * are products and quotients (kg/m3, N/mm, rad/s) of m g t s N Pa bar Hz rad deg rev rpm %. The
 * prefixes n u m c k M G are allowed where customary. */
bool case_quantity(const char *text, const char *unit, double *value, char why[CASE_WHY]);

/* Read a decimal integer. Everything else is refused. */
bool case_integer(const char *text, int *value, char why[CASE_WHY]);

#endif
