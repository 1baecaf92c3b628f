/* Programs and functions as child processes. What may crash runs in one: this module turns the
 * signal that ended it into one line. */
#ifndef MESH_PROCESS_CHILD_H
#define MESH_PROCESS_CHILD_H

#include <stdbool.h>
#include <sys/types.h>

#include "mesh/base/status.h"

/* How a child ended, and what it cost. */
typedef struct {
  int    code;    /* exit code; 130 if the run was interrupted */
  int    signal;  /* that ended it; 0: none */
  double seconds; /* wall */
  double cpu;     /* s, user and system, all threads */
  double peak;    /* greatest resident memory, bytes */
} shb_child_end;

/* A program to start. Descriptors replace those of this program unless they are negative. */
typedef struct {
  char *const *words; /* words[0]: its path, from shb_child_program; a NULL ends them */
  const char  *name;  /* in messages; NULL: the last part of the path */
  int          in, out, err;
  int          report; /* where its messages go as data (mesh/process/report) */
  bool         apart;  /* under mpiexec: it is no rank, and reports nothing */
} shb_child;

/* A child with the descriptors of this program. */
shb_child shb_child_of(char *const words[]);

/* Path of a program beside this one, else its bare name, for which PATH is searched; malloc'ed. */
char *shb_child_program(const char *name);

/* Start a child, and go on. Errors: SHB_ERR_IO. */
shb_status shb_child_start(const shb_child *child, pid_t *pid);

/* Run a child to its end. SIGINT, SIGTERM and SIGHUP are passed on to it. It then publishes its
 * finished results, and its code is 130.
 *
 * Errors: SHB_ERR_IO if it cannot be started, or was killed by a signal. */
shb_status shb_child_run(const shb_child *child, shb_child_end *end);

/* Run a function in a fork of this process, whose standard error leads nowhere, and with a limit of
 * its processor time. The function's value is the exit code.
 *
 *   seconds  in  of the processor; a child that needs more ends by SIGXCPU
 * Errors: SHB_ERR_IO there is no process for it. A signal is no error, but told in *end. */
shb_status shb_child_try(int (*work)(void *context), void *context, long seconds,
                         shb_child_end *end);

enum { SHB_CHILD_HOW = 128 };

/* "was killed by signal 9 (Killed); out of memory?", or "ended with code 4", of a status of
 * waitpid. */
const char *shb_child_how(int status, char text[SHB_CHILD_HOW]);

enum { SHB_CHILD_TEXT = 32 };

/* A text as a file without a name, which child processes may open at path until it is closed. It
 * goes with the last process that holds it. *copy: its descriptor. Errors: SHB_ERR_IO. */
shb_status shb_child_text(const char *text, int *copy, char path[SHB_CHILD_TEXT]);

#endif
