/* What a response tells of its case besides the branches. */
#ifndef MHB_RESPONSE_DESCRIBE_H
#define MHB_RESPONSE_DESCRIBE_H

#include "mhb/problem/settings.h"
#include "mhb/response/response.h"
#include "modal/model/model.h"

/* What a response tells of the model and the settings besides its branches. SHB_ERR_IO: no memory. */
shb_status mhb_response_describe(mhb_response *response, const modal_model *model,
                                 const mhb_settings *settings);

#endif
