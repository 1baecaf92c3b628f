/* `mpiexec -n N shroudhb-pool samples`: the balance of a case whose samples of random rings are
 * shared over MPI. */
#ifndef CASES_FRONT_SHROUDHB_SAMPLES_H
#define CASES_FRONT_SHROUDHB_SAMPLES_H

#include "cases/commands/command.h"

/* Returns the exit code. */
int samples_command(const command_options *options);

#endif
