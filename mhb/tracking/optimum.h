/* The parameter at which the highest of all tracked peaks is least.
 *
 * The highest peak is the envelope of the tracked branches. Its least value lies where one peak is
 * stationary, where two peaks exchange their rank (a kink of the envelope, a minimax), or at an end
 * of the range. */
#ifndef MHB_TRACKING_OPTIMUM_H
#define MHB_TRACKING_OPTIMUM_H

#include "mhb/response/response.h"
#include "mhb/tracking/tracked_curve.h"
#include "modal/model/model.h"

/* Find the optimum of the tracked branches of a response, into response->optimum. An exchange is
 * located by solving both peaks. MHB_OPTIMUM_JUMP: a branch ends there inside the range. The least
 * value may then lie in the gap beside it.
 *   settings  in  of the balance; harmonics are those of the branches */
shb_status mhb_find_optimum(const modal_model *model, const mhb_settings *settings,
                            const mhb_tracking *tracking, mhb_response *response);

/* Whether a recorded point is within a share of the highest of all branches at its value. */
bool mhb_is_highest(const mhb_tracking *tracking, mhb_response *response, int branch, int point,
                    double share);

#endif
