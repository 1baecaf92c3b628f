/* Modal amplitudes of points of a response, from the contact forces recorded there. */
#ifndef MHB_RESPONSE_MODAL_MOTION_H
#define MHB_RESPONSE_MODAL_MOTION_H

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* modal of every branch <- the amplitudes of the points that settings->save names, in the modes of
 * the model. At harmonic k of branch and load,
 *   amplitude_i = (scale F_i - sum_b conj(B_bi) p_b)/(w_i^2 - w^2 + 2 j zeta_i w_i w),
 * with the contact force p of the file. Of a disc, the modes are those of the nodal diameter of
 * harmonic k, of a backward wave conjugate. The forces on the contact dofs and the scale of the
 * load are kept as well: residual shapes are multiplied by them. In a run-up nothing is kept: the
 * modes there change with the speed. The response was described by mhb_response_describe.
 * Errors: those of mhb_receptance_create. */
shb_status mhb_modal_motion_keep(const modal_model *model, const mhb_settings *settings,
                                 mhb_response *response);

#endif
