/* A stage of a case as a child process. */
#ifndef CASES_COMMANDS_STAGE_H
#define CASES_COMMANDS_STAGE_H

#include "cases/commands/command.h"
#include "cases/commands/subprocess.h"

/* Run shroudhb-STAGE ("mesh", "modal", ...) with the options it shares with the front command. It
 * prints its own messages. Errors: as subprocess_run; its exit code is in the result. */
shb_status stage_run(const char *stage, const command_options *options, subprocess_result *result);

/* Run shroudhb-modal, which makes the mesh too, where the modes of the case are out of date: what
 * `shroudhb run` does. Nothing is done with modal.file, and with a file that is damaged or of
 * another program. Errors: that of the stage, which has told it. */
shb_status stage_renew_modes(const case_file *file, const command_options *options);

#endif
