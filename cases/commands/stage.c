#include "cases/commands/stage.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cases/commands/up_to_date.h"
#include "cases/schema/case_paths.h"
#include "modal/hdf5/stamp.h"

int stage_program(command_id command, const char **words) {
  int n      = 0;
  words[n++] = shb_child_program(command == COMMAND_MODAL ? "shroudhb-modal" : "shroudhb-pool");
  if (command != COMMAND_MODAL) words[n++] = command_row_of(command)->name;
  return n;
}

shb_status stage_run(command_id command, const command_options *options, shb_child_end *end) {
  const char *words[COMMAND_WORDS];
  char        name[32];
  const int   n     = stage_program(command, words);
  shb_child   child = shb_child_of((char *const *)words);
  snprintf(name, sizeof name, "shroudhb-%s", command_row_of(command)->name);
  child.name           = name;
  command_options said = *options;
  said.json            = false; /* the document is that of the command that the user gave */
  options_words(command_row_of(command), &said, words, n);
  const shb_status status = shb_child_run(&child, end);
  free((void *)words[0]);
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
  command_options plain = *options;
  shb_child_end   result;
  if (file->modal_file || up_to_date_modes(file) || !may_be_made(file)) return SHB_OK;
  plain.force = false;
  SHB_TRY(stage_run(COMMAND_MODAL, &plain, &result));
  return result.code == SHB_OK ? SHB_OK
                               : shb_fail((shb_status)result.code, __FILE__, __LINE__, "%s", "");
}
