/* --json: a command as a child process, its result or its error as one JSON document. */
#ifndef CASES_FRONT_JSON_COMMAND_H
#define CASES_FRONT_JSON_COMMAND_H

#include "cases/options/command_row.h"

/* Run the program words[0] of a command, words ended by NULL. If it succeeds, or has not converged
 * everywhere, the document is what it printed, or what the stage post prints of its results
 * (command_json). Else it holds the errors that the child reported:
 *
 *   {"error": {"code": 2, "kind": "bad input", "messages": ["...", ...]}}
 *
 * Returns the exit code of the command. */
int json_command(const command_row *row, char **words);

#endif
