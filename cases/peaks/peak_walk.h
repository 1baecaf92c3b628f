/* From a peak of one design to that of another: the contact's values change in steps, and the peak
 * is solved after each. */
#ifndef CASES_PEAKS_PEAK_WALK_H
#define CASES_PEAKS_PEAK_WALK_H

#include "cases/converge/matched_point.h"

/* Preload, mu, kv, kuu, kuw, kww, scale of the excitation. */
enum { PEAK_WALK_VALUES = 7 };

/* A solved peak and the contact that it belongs to. */
typedef struct {
  double           value[PEAK_WALK_VALUES]; /* SI */
  int              order;                   /* of its branch */
  double           amplitude;               /* m */
  matched_solution solution;                /* its x is NULL if there is none */
} solved_peak;

/* The values of a case's settings. False: the case has several preloads or interfaces, or is a
 * run-up, which are not walked. */
bool peak_walk_values(const mhb_settings *settings, double value[PEAK_WALK_VALUES]);

/* Walk from a peak to the contact of the settings. Values above 0 change by equal factors, others
 * evenly. Each step ends at a smooth peak near the last one, or is halved.
 *
 *   model, settings  in   of the design that is walked to
 *   arrived          out  its x is NULL if the walk ended on the way; to be freed in any case
 * Errors: SHB_ERR_IO no memory; those of mhb_balance_create. */
shb_status peak_walk(const modal_model *model, const mhb_settings *settings, post_output output,
                     const solved_peak *from, solved_peak *arrived);

void solved_peak_free(solved_peak *peak);

#endif
