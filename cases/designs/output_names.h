/* The outputs of a design by name: what a study, an optimiser or another program may ask for. */
#ifndef CASES_DESIGNS_OUTPUT_NAMES_H
#define CASES_DESIGNS_OUTPUT_NAMES_H

#include <stddef.h>

#include "cases/parse/case_file.h"

enum { STUDY_UNIT_TEXT = 32, STUDY_OUTPUT_TEXT = 96, STUDY_MAX_OUTPUTS = 64 };

typedef enum {
  STUDY_PEAK,           /* m, highest first harmonic of the first output over all curves */
  STUDY_FREQUENCY,      /* Hz, where */
  STUDY_PEAK_TO_PEAK,   /* m, there */
  STUDY_STABLE,         /* 1, 0, NAN: not judged; there */
  STUDY_DISSIPATION,    /* J a cycle, all pairs; there */
  STUDY_STRESS,         /* Pa, greatest amplitude of the signed von Mises stress; there */
  STUDY_SAFETY,         /* -, least safety against Goodman's line; there */
  STUDY_RSS,            /* m, root of the sum of squares of that harmonic's components; there */
  STUDY_PROBE,          /* m, highest first harmonic of a probe over all curves */
  STUDY_GAUGE,          /* -, amplitude of the strain at a gauge; at the highest peak */
  STUDY_MODE_FREQUENCY, /* Hz, of a mode with free contacts */
  STUDY_N_QUANTITIES
} study_quantity;

typedef struct {
  study_quantity quantity;
  int            index; /* of the probe or gauge; of the mode, from 0 */
  char           name[STUDY_OUTPUT_TEXT];
  char           unit[STUDY_UNIT_TEXT];
} study_output;

/* Understand a name: peak, frequency, peak_to_peak, stable, dissipation, stress, safety, the name
 * of a probe or gauge, or modes[I].frequency with I from 1. False with a reason otherwise. */
bool study_output_parse(const char *name, const case_file *file, study_output *output, char *why,
                        size_t size);

/* Number of derivatives of the peak that a study has: all where the peak is among its outputs, else
 * 0. Their order is that of mhb/tracking/peak_system.h. */
int study_derivatives(int n_outputs, const study_output *output);

/* A derivative's parameter: name (n0, scale, mu, ku, kv, damping), unit of the derivative, and its
 * value in a case. "damping" is modal.damping if that is one ratio or a loss factor. Otherwise it
 * is "damping_factor": all ratios change in common, by a factor that is 1 in the case. */
void study_derivative(const case_file *file, int i, char name[STUDY_UNIT_TEXT],
                      char unit[STUDY_UNIT_TEXT], double *value);

/* The value of that damping in a case; 1 without one. */
double study_damping(const case_file *file);

#endif
