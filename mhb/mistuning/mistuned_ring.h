/* A ring of different blades in contact with their neighbours.
 *
 * Contact b is between blades b and b + 1, the last one between the last blade and blade 0. The
 * load of blade b lags by b times the inter-blade phase 2 pi E/N. Pairs, probes and modes of blade
 * 0 come first. Those of blade 1 follow. */
#ifndef MHB_MISTUNING_MISTUNED_RING_H
#define MHB_MISTUNING_MISTUNED_RING_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

typedef struct mhb_mistuned_ring {
  int                blades, n_pairs, n_probes, n_modes; /* of a blade */
  const modal_model *tuned;                              /* the caller's */
  double            *deviation;                          /* [blades][n_modes] */
  modal_model       *blade;                              /* [blades] (blade_model.h) */
  /* Sizes, names, interfaces, normals, areas, frequencies, damping and modal forces of all blades.
   * Shapes and residual terms are NULL: each blade has its own. */
  modal_model whole;
} mhb_mistuned_ring;

/* columns 1: deviation[blades] of all modes of a blade; n_modes: deviation[blades][n_modes]. tuned
 * must outlive the ring. Errors:
 *
 *   SHB_ERR_INPUT  contact to ground, or a modal file without left faces; a deviation of -50 % or
 *                  less */
shb_status mhb_mistuned_ring_create(const modal_model *tuned, const mhb_settings *settings,
                                    const double *deviation, int columns, mhb_mistuned_ring **ring);
void       mhb_mistuned_ring_destroy(mhb_mistuned_ring *ring);

#endif
