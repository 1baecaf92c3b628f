/* "shroudhb run": all stages of a case in turn. */
#ifndef CASES_FRONT_RUN_H
#define CASES_FRONT_RUN_H

#include <stdio.h>

#include "cases/commands/command.h"
#include "cases/parse/case_file.h"

enum { RUN_ALL = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST };

/* Check the whole case, then run its stages as child processes up to the first failure. A stage
 * that has not converged everywhere does not end the run, but its code is returned. Prints where
 * the results are. A failed stage prints its own message, so none is left for the closing line. */
shb_status run_case(const command_options *options);

/* Print a few lines that describe the computation. */
void run_describe(const case_file *file, FILE *out);

#endif
