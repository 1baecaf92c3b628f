/* The balance of a case, from its modal file to NAME.response.h5. */
#ifndef CASES_COMMANDS_BALANCE_RUN_H
#define CASES_COMMANDS_BALANCE_RUN_H

#include "cases/commands/command.h"
#include "mhb/amplification/ring_samples.h"

/* The samples that rotor.mistuning asks for, by the threads. */
mhb_sampling balance_sampling(const case_file *file);

/* Solve the case unless its response file is up to date.
 *   crew  in  computes the samples of a ring; NULL: the threads
 * Errors: those of case_model_read, mhb_forced_response, mhb_ring_response,
 * mhb_tracked_response. */
shb_status balance_run(const case_file *file, const command_options *options,
                       const mhb_sample_crew *crew);

#endif
