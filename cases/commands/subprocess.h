/* One stage as a child process. */
#ifndef CASES_COMMANDS_SUBPROCESS_H
#define CASES_COMMANDS_SUBPROCESS_H

#include <stdbool.h>

#include "mesh/base/status.h"

typedef struct {
  int    code;    /* exit code; 130 if the run was interrupted */
  double seconds; /* wall */
  double cpu;     /* s, user and system, all threads */
  double peak;    /* greatest resident memory, bytes */
} subprocess_result;

/* Path of a program beside this one, else its bare name, for which PATH is searched; malloc'ed. */
char *subprocess_program(const char *name);

/* Run argv to its end; argv[0] is from subprocess_program. SIGINT, SIGTERM and SIGHUP are passed on
 * to the child. It then publishes its finished results, and the code of the result is 130.
 *
 * Errors: SHB_ERR_IO if the child cannot be started, or was killed by a signal. */
shb_status subprocess_run(char *const argv[], subprocess_result *result);
/* The same with descriptors for its standard output and error; negative: those of this program. */
shb_status subprocess_run_to(char *const argv[], int out, int err, subprocess_result *result);

enum { SUBPROCESS_COPY = 32 };

/* A text as a file without a name, which child processes may open at path until it is closed. It
 * goes with the last process that holds it. *copy: its descriptor. Errors: SHB_ERR_IO. */
shb_status subprocess_copy(const char *text, int *copy, char path[SUBPROCESS_COPY]);

#endif
