/* The command line of every command, read by getopt_long from one table of options. */
#ifndef CASES_OPTIONS_OPTIONS_H
#define CASES_OPTIONS_OPTIONS_H

#include "cases/options/command_row.h"

/* Read a command line. argv[0] is the command. Options and files come in any order; "--" ends the
 * options. A word that is wrong is one line on stderr. Returns a value below 0 to go on, else the
 * exit code. */
int options_read(const command_row *row, int argc, char **argv, command_options *out);

/* The words that say the same to another command: the options that it has, and the files.
 *   words  inout  [COMMAND_WORDS], n of them used; they belong to options
 * Returns the number of words, with a NULL behind. */
int options_words(const command_row *row, const command_options *options, const char **words,
                  int n);

#endif
