#include "cases/commands/stage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

shb_status stage_run(const char *stage, const command_options *options, subprocess_result *result) {
  char        name[32];
  const char *words[COMMAND_WORDS];
  snprintf(name, sizeof name, "shroudhb-%s", stage);
  char *program = subprocess_program(name);
  SHB_CHECK(program, SHB_ERR_IO, "out of memory");
  words[0] = program;
  int n    = 1;
  if (options->no_report && strcmp(stage, "post") == 0) words[n++] = "--no-report";
  command_forward(options, words, n);
  shb_status status = subprocess_run((char *const *)words, result);
  free(program);
  return status;
}
