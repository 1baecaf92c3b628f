/* `shroudhb field --face`: the contact face of a response. */
#ifndef CASES_FIELD_FACE_COMMAND_H
#define CASES_FIELD_FACE_COMMAND_H

#include <stdio.h>

#include "cases/commands/command.h"
#include "mesh/base/status.h"

/* Write NAME.face.vtkhdf, or NAME.face_BRANCH_POINT.vtkhdf of a chosen point, beside the response.
 *   out  in  for a line on what was written; NULL: quiet
 * Errors: SHB_ERR_INPUT the response has no maps, or not of that point; SHB_ERR_IO. */
shb_status face_write(const command_options *options, FILE *out);

#endif
