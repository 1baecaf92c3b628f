/* The commands of studies. Each returns the exit code. */
#ifndef CASES_STUDY_SHROUDHB_STUDY_H
#define CASES_STUDY_SHROUDHB_STUDY_H

#include "cases/commands/command.h"

int study_command(const command_options *options);
int eval_command(const command_options *options);
int design_command(const command_options *options);

#endif
