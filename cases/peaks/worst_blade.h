/* The highest peak of a ring of different blades: that of the blade that swings highest. */
#ifndef CASES_PEAKS_WORST_BLADE_H
#define CASES_PEAKS_WORST_BLADE_H

#include "cases/commands/load_model.h"
#include "cases/peaks/exact_peak.h"

/* Amplitude of the blade that swings highest at a point, m. */
double worst_blade_amplitude(const mhb_response *response, const mhb_branch *branch, int point);

/* The curves of the case, and the highest peak of any blade over all nonlinear ones. The sweep
 * locates it with the harmonics of the case. The error is that of the harmonics left out there,
 * NAN where it is not known. Other numbers than frequency and amplitude are NAN, and stable is -1.
 *   model     in   of a case with rotor.mistuning
 *   response  out  the caller destroys it, also after an error
 * Errors: as mhb_forced_response. */
shb_status worst_blade_peak(const case_model *model, mhb_response **response, exact_peak *peak);

#endif
