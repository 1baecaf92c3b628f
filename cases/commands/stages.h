/* The commands of a case. Each does its work and returns the exit code. */
#ifndef CASES_COMMANDS_STAGES_H
#define CASES_COMMANDS_STAGES_H

#include "cases/commands/command.h"

int mesh_command(const command_options *options);
int mhb_command(const command_options *options);
int integrate_command(const command_options *options);
int post_command(const command_options *options);
int inspect_command(const command_options *options);
int contact_command(const command_options *options);

/* Print that a case is in order, as JSON. */
shb_status check_print_json(const case_file *file);

#endif
