/* shroudhb converge: speed against error of a case, setting by setting. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/commands/command.h"
#include "cases/converge/converge.h"
#include "cases/schema/case.h"
#include "cases/schema/converge_settings.h"
#include "mesh/base/progress.h"

int converge_command(const command_options *options) {
  command_options own = *options;
  case_file       file;
  int             copy;
  char            path[SHB_CHILD_TEXT];
  shb_status      status = command_keep_text(&own, &copy, path); /* the same for every rung */
  if (status == SHB_OK) status = command_read(&own, CONVERGE_STAGES, &file);
  if (status != SHB_OK) return command_finish(status);
  shb_interrupt_catch();
  status = converge_case(&file, &own);
  case_free(&file);
  return command_finish(status);
}
