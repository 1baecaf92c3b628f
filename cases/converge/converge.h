/* `shroudhb converge`: the ladders of a convergence study, run rung by rung. */
#ifndef CASES_CONVERGE_CONVERGE_H
#define CASES_CONVERGE_CONVERGE_H

#include "cases/commands/command.h"
#include "cases/parse/case_file.h"

/* Run the ladders, print table and conclusion, and write NAME.converge.{h5,csv,svg}. An interrupted
 * study reports the finished rungs.
 *
 *   options->mode  in  "no-mesh", "finer" or NULL
 *
 * Returns SHB_OK, SHB_NOT_CONVERGED (see the usage text), SHB_INTERRUPTED or an error. */
shb_status converge_case(case_file *file, const command_options *options);

/* The commands converge and rung. Each returns the exit code. */
int converge_command(const command_options *options);
int rung_command(const command_options *options);

#endif
