/* `shroudhb field`: one period of the whole blade from a response file and its modal file. */
#ifndef CASES_COMMANDS_FIELD_COMMAND_H
#define CASES_COMMANDS_FIELD_COMMAND_H

#include <stdbool.h>
#include <stdio.h>

#include "mesh/base/status.h"

/* Options with a number; -1: not given. */
typedef struct {
  const char *response;      /* NAME.response.h5 */
  const char *modal;         /* NULL: NAME.modal.h5 beside it */
  int         branch, point; /* as `inspect` counts them */
  int         peak;          /* rank by height, from 1; -1: the highest */
  int         steps;         /* of the period; -1: 24 */
  double      scale;         /* of the picture; -1: chosen */
  bool        ring;
} field_options;

/* Write NAME.field.vtkhdf and NAME.field.glb. With a point or a peak chosen the names are
 * NAME.field_BRANCH_POINT, with ring NAME.ring. What was written goes to out, if not NULL. Without
 * a branch the linear limits count only if nothing else was kept. Errors: SHB_ERR_INPUT the point
 * is not kept, or the modal file lacks shapes; as mhb_response_read, post_field_grid,
 * post_field_scene. */
shb_status field_command(const field_options *options, FILE *out);

#endif
