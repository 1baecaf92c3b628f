/* One stage as a child process. */
#ifndef CASES_COMMANDS_SUBPROCESS_H
#define CASES_COMMANDS_SUBPROCESS_H

#include "mesh/base/status.h"

typedef struct {
  int    code;    /* exit code; 130 if the run was interrupted */
  double seconds; /* wall */
  double cpu;     /* s, user and system, all threads */
  double peak;    /* greatest resident memory, bytes */
} subprocess_result;

/* Path of a program that lies beside this one, else its bare name (PATH is then searched); malloc'ed. */
char *subprocess_program(const char *name);

/* Run argv (argv[0] from child_program) to its end. SIGINT and SIGTERM are handed on to the child, which ends
 * the stage and publishes what it has; the result's code is then 130.
 * Errors: SHB_ERR_IO if it cannot be started, or was killed by a signal. */
shb_status subprocess_run(char *const argv[], subprocess_result *result);

#endif
