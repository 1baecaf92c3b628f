/* The table of commands: what `shroudhb` knows, its options and its help. */
#ifndef CASES_OPTIONS_COMMAND_TABLE_H
#define CASES_OPTIONS_COMMAND_TABLE_H

#include "cases/options/command_row.h"

typedef enum {
  COMMAND_RUN,
  COMMAND_MESH,
  COMMAND_MODAL,
  COMMAND_MHB,
  COMMAND_INTEGRATE,
  COMMAND_POST,
  COMMAND_CONVERGE,
  COMMAND_STUDY,
  COMMAND_EVAL,
  COMMAND_CHECK,
  COMMAND_KEYS,
  COMMAND_INSPECT,
  COMMAND_FIELD,
  COMMAND_CONTACT,
  COMMAND_SAMPLES, /* not shown: those that other commands start, or mpiexec */
  COMMAND_RUNG,
  COMMAND_DESIGN,
  COMMANDS
} command_id;

const command_row *command_row_of(command_id id);

/* The command of a name; COMMANDS: there is none. */
command_id command_find(const char *name);

/* The command that a program was called as, a path ending in shroudhb-NAME; COMMANDS: none. */
command_id command_called(const char *program);

/* The command that is shown and most like a word; NULL: none is. */
const char *command_nearest(const char *word);

#endif
