/* `shroudhb field`: one period of the whole blade from a response file and its modal file. */
#ifndef CASES_FIELD_FIELD_COMMAND_H
#define CASES_FIELD_FIELD_COMMAND_H

#include <stdio.h>

#include "cases/commands/command.h"
#include "mesh/base/status.h"

/* Write NAME.field.vtkhdf and NAME.field.glb. With a point or a peak chosen the names are
 * NAME.field_BRANCH_POINT, with ring NAME.ring. What was written goes to out, if not NULL. Without
 * a branch the linear limits count only if nothing else was kept. Errors: SHB_ERR_INPUT the point
 * is not kept, or the modal file lacks shapes; as mhb_response_read, post_field_grid,
 * post_field_scene. */
shb_status field_write(const command_options *options, FILE *out);

/* Length of NAME in NAME.response.h5, NAME.modal.h5 or NAME.h5. */
int field_stem(const char *path);

#endif
