/* A stage of a case as a child process. */
#ifndef CASES_COMMANDS_STAGE_H
#define CASES_COMMANDS_STAGE_H

#include "cases/commands/command.h"
#include "cases/options/command_table.h"

/* The program of a command and its first words: shroudhb-modal, or shroudhb-pool and the name.
 * Returns how many words there are; words[0] is malloc'ed. */
int stage_program(command_id command, const char **words);

/* Run a command with what the options say that it knows. It prints its own messages. Errors: as
 * shb_child_run; its exit code is in *end. */
shb_status stage_run(command_id command, const command_options *options, shb_child_end *end);

/* Run the modal stage, which makes the mesh too, where the modes of the case are out of date: what
 * `shroudhb run` does. Nothing is done with modal.file, and with a file that is damaged or of
 * another program. Errors: that of the stage, which has told it. */
shb_status stage_renew_modes(const case_file *file, const command_options *options);

#endif
