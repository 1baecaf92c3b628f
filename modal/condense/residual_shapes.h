/* Static response of the whole blade to a unit force on each contact dof and load pattern, without
 * the part of the modes kept. It adds to the sum over the modes what they leave out at all nodes,
 * as the residual flexibility does at contact and probes (MacNeal 1971). */
#ifndef MODAL_CONDENSE_RESIDUAL_SHAPES_H
#define MODAL_CONDENSE_RESIDUAL_SHAPES_H

#include "modal/condense/condense.h"

typedef struct {
  int             n, n_contact; /* columns: contact dofs, then load patterns; 0: none are kept */
  int             n_nodes, n_harmonics;
  double         *shape;       /* [n][n_nodes][3] m/N on rank 0, mesh axes; NULL elsewhere */
  double complex *load_weight; /* [K + 1][n - n_contact] of the patterns in each load harmonic */
} modal_residual_shapes;

/* P K^-1 B with the projector P = I - phi phi^T M. Nothing is kept of more than 96 columns or above
 * 256 MB: out->n is 0 then. Collective. Errors: SHB_ERR_IO solver. */
shb_status modal_residual_shapes_create(const fem_system *system, const modal_eigen *eigen,
                                        const modal_condensation *to, modal_residual_shapes *out);

/* Write /residual/{shape [c][n][3], stress [c][n][6], load_weight [K + 1][patterns]}; nothing
 * without columns. stress: [n][n_nodes][6] Pa/N. */
shb_status modal_residual_shapes_write(hid_t file, const modal_residual_shapes *shapes,
                                       const float *stress);

/* The last of them alone. */
shb_status modal_residual_weight_write(hid_t file, const modal_residual_shapes *shapes);

void modal_residual_shapes_free(modal_residual_shapes *shapes); /* also on a zeroed struct */

#endif
