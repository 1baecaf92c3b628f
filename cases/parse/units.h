/* Numbers with units, to SI, with their dimension checked. Angles count as a dimension of their own, so that
 * rad/s is not Hz. */
#ifndef CASES_PARSE_UNITS_H
#define CASES_PARSE_UNITS_H

#include <stdbool.h>

enum { CASE_WHY = 256 };

/* "6000 rpm", "35 deg", "2MN/m", "7.85 g/cm3", "0.2 %": a decimal number and a unit; a bare number is SI.
 *
 *   text   in   as in the case file
 *   unit   in   SI unit of the key, e.g. "N/m"; "" for a number without a dimension
 *   value  out  in that SI unit; powers of ten are exact (0.2 mm gives the double nearest to 0.0002)
 *   why    out  on failure what is wrong, one line without the key
 *
 * Refused: text that is not wholly read, nan, inf, hexadecimal, decimal commas, overflow, an unknown unit, a
 * unit of another dimension. Units are products and quotients (kg/m3, N/mm, rad/s) of m g t s N Pa bar Hz rad
 * deg rev rpm %, with the prefixes n u m c k M G where they are in use. */
bool case_quantity(const char *text, const char *unit, double *value, char why[CASE_WHY]);

/* A decimal integer; refuses all else. */
bool case_integer(const char *text, int *value, char why[CASE_WHY]);

#endif
