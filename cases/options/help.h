/* The help texts, made from the table of commands. */
#ifndef CASES_OPTIONS_HELP_H
#define CASES_OPTIONS_HELP_H

#include <stdio.h>

#include "cases/options/command_table.h"

/* What `shroudhb --help` prints: all commands. */
void help_print_all(FILE *out);

/* What `shroudhb COMMAND --help` prints: its forms, what it does, its options. */
void help_print(const command_row *row, FILE *out);

/* --help and --version among the words before "--": prints the answer, and returns the exit code;
 * below 0: neither is there.
 *   row  in  of the command; NULL: `shroudhb` itself */
int help_answer(const command_row *row, int argc, char **argv);

#endif
