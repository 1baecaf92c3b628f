/* --json: a command as a child process, its result or its error as one JSON document. */
#ifndef CASES_FRONT_JSON_COMMAND_H
#define CASES_FRONT_JSON_COMMAND_H

/* Run the program words[0], words ended by NULL. Its standard error is passed on when it ends.
 * If it succeeds, or has not converged everywhere, the document is what it printed, or what the
 * program then[0] prints (NULL: none). Else it is
 *
 *   {"error": {"code": 2, "kind": "bad input", "messages": ["...", ...]}}
 *
 * Returns the exit code of the command. */
int json_command(char *const words[], char *const then[]);

#endif
