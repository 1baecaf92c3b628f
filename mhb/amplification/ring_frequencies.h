/* Natural frequencies of the ring with stuck contacts, over nodal diameter and speed. */
#ifndef MHB_AMPLIFICATION_RING_FREQUENCIES_H
#define MHB_AMPLIFICATION_RING_FREQUENCIES_H

#include "mhb/problem/settings.h"
#include "mhb/run_up/stuck_frequencies.h"
#include "modal/model/model.h"

enum { MHB_MOST_FAMILIES = 8, MHB_MOST_STUCK = 12 };

/* The lowest families at every nodal diameter. The open ones of a blade that is clamped at its root
 * have the same frequency at every diameter. Of a disc (settings->nodal_diameters) there are the
 * diameters of its file. Nothing without a neighbour or with less than three blades.
 * Errors: as mhb_stuck_frequencies. */
shb_status mhb_families_over_diameters(const modal_model *model, const mhb_settings *settings,
                                       mhb_diagrams *diagrams);

/* All diagrams of a modal file: also the lowest stuck frequencies at each of its speeds, where it
 * has several. Errors: as modal_model_read and mhb_stuck_frequencies. */
shb_status mhb_diagrams_compute(const char *modal, const mhb_settings *settings,
                                mhb_diagrams *diagrams);

#endif
