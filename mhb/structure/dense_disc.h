/* All sectors of a flexible disc as one modal model with dense shapes.
 *
 * One sector that meets itself, as in mhb/mistuning/dense_ring.h. Its contact b has the right face
 * of sector b and the left face of sector b + 1. A pair of standing waves takes the place of each
 * complex mode. Residual modes are left out; time integration needs none. Cost and memory grow with
 * the square of the number of sectors. */
#ifndef MHB_STRUCTURE_DENSE_DISC_H
#define MHB_STRUCTURE_DENSE_DISC_H

#include "mhb/problem/settings.h"
#include "modal/model/nodal_diameters.h"

/* settings->nodal_diameters must hold all nodal diameters. The probes are those of sector 0. model
 * is freed by modal_model_free in any case. Errors: SHB_ERR_INPUT a nodal diameter is missing. */
shb_status mhb_dense_disc(const mhb_settings *settings, modal_model *model);

/* The settings of that model: one sector, engine order 0, as many contacts as sectors. */
void mhb_dense_disc_settings(const mhb_settings *settings, mhb_settings *own);

#endif
