/* `shroudhb check` and `shroudhb keys`: what a file must hold, and whether one does. */
#ifndef CASES_FRONT_CHECK_H
#define CASES_FRONT_CHECK_H

#include "cases/commands/command.h"

/* All errors of a case or a study at once. Returns the exit code. */
int check_command(const command_options *options);

/* Print the keys of a file. argv[0] is the command. Returns the exit code. */
int keys_command(int argc, char **argv);

#endif
