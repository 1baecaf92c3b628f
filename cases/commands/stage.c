#include "cases/commands/stage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/up_to_date.h"
#include "cases/schema/case_paths.h"
#include "modal/hdf5/stamp.h"

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

/* A modal file that is damaged, or of another program, is not replaced: the balance tells of it.
 * One that is missing is made. */
static bool may_be_made(const case_file *file) {
  char *path = case_modal_path(file), *settings = NULL;
  bool  made = path != NULL;
  if (made && access(path, F_OK) == 0) {
    const h5_stamp_state state = h5_stamp_check(path);
    made                       = state == H5_INTACT || state == H5_UNSTAMPED;
    settings                   = made ? up_to_date_written(path) : NULL;
    made                       = settings && *settings;
  }
  free(settings);
  free(path);
  return made;
}

shb_status stage_renew_modes(const case_file *file, const command_options *options) {
  command_options   plain = *options;
  subprocess_result result;
  if (file->modal_file || up_to_date_modes(file) || !may_be_made(file)) return SHB_OK;
  plain.force = false;
  SHB_TRY(stage_run("modal", &plain, &result));
  return result.code == SHB_OK ? SHB_OK
                               : shb_fail((shb_status)result.code, __FILE__, __LINE__, "%s", "");
}
