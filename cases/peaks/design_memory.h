/* Whether the sweeps of a study fit into memory beside each other, before any of them begins.
 *
 * Known before are the harmonics of the first sweep of a design and the blades of a ring of
 * different blades. Contact points are those that the case gives, else one. Of a case with
 * modal.file they are those of the file. A design that needs more is refused in its own row. */
#ifndef CASES_PEAKS_DESIGN_MEMORY_H
#define CASES_PEAKS_DESIGN_MEMORY_H

#include "cases/designs/study_spec.h"

/* sharing: processes of this machine that compute designs.
 *
 * Errors: SHB_ERR_INPUT the largest design does not fit, with what would (mhb_sweep_fits);
 * SHB_ERR_IO no memory. Faults of a design are its own, and no error here. */
shb_status design_memory_check(const study_spec *spec, int sharing);

#endif
