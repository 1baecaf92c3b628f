/* "shroudhb run": all stages of a case in turn. */
#ifndef CASES_COMMANDS_RUN_H
#define CASES_COMMANDS_RUN_H

#include <stdio.h>

#include "cases/commands/command.h"
#include "cases/parse/case_file.h"

enum { RUN_ALL = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST };

/* Check the whole case, then run its stages as child processes; stops at the first that fails. A stage that did
 * not converge everywhere lets the next ones run; its code is returned at the end. Says where the results are.
 * The text of a stage's failure is the stage's own: none is left for the closing line. */
shb_status run_case(const command_options *options);

/* What would be computed, a few lines. */
void run_describe(const case_file *file, FILE *out);

#endif
