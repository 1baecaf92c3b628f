/* The description of the case in a response, beside the branches. */
#ifndef MHB_RESPONSE_DESCRIBE_H
#define MHB_RESPONSE_DESCRIBE_H

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* Sizes, modes, interfaces and probe names of response <- those of model and settings.
 * SHB_ERR_INPUT: interfaces of the model and of the settings do not go together. */
shb_status mhb_response_describe(mhb_response *response, const modal_model *model,
                                 const mhb_settings *settings);

#endif
