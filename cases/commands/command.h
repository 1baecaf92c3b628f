/* What the commands share: options, the closing error line, provenance. */
#ifndef CASES_COMMANDS_COMMAND_H
#define CASES_COMMANDS_COMMAND_H

#include <stdbool.h>

#include "cases/commands/subprocess.h"
#include "cases/parse/case_file.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"

enum { COMMAND_SETS = 64, COMMAND_WORDS = 2 * COMMAND_SETS + 20 };

typedef struct {
  bool        quiet, verbose, force;
  const char *mode;  /* "inspect" for --inspect, or NULL; see command_parse */
  const char *path;  /* the FILE argument */
  const char *other; /* a second FILE, or NULL; known where the usage mentions OTHER */
  bool        csv;   /* --csv; known where the usage mentions it, as the next two */
  bool        json, no_report;
  const char *svg; /* argument of --svg, or NULL; known where the usage mentions --svg */
  int         n_set;
  const char *set[COMMAND_SETS]; /* arguments of --set */
  const char *into;              /* argument of --into, or NULL */
  const char *text;              /* argument of --text, or NULL */
} command_options;

/* Parse a command line: options and one FILE, in any order; "--" ends the options.
 *
 * --set KEY=VALUE (any number) and --into FOLDER are known where the usage mentions --set. So is
 * --text COPY, for programs that start each other: COPY holds the text of FILE, read before.
 * --help prints the usage and ends the program with 0, --version likewise. --quiet, --verbose and
 * --force are always known. Any other long option in the usage text becomes out->mode. An unknown
 * word is one line on stderr and exit code 2.
 *
 * Returns a value below 0 to go on, else the exit code. out points into argv. */
int command_parse(int argc, char **argv, const char *usage, command_options *out);

/* Read the case of a command with its overrides, and make the folder of --into where it is missing.
 * Errors: as case_read and shb_make_folder. */
shb_status command_read(const command_options *options, int stages, case_file *out);

/* Read the text of the case once for all programs that the command starts: options->text becomes
 * path, that of a copy (subprocess.h). The caller closes *copy. Errors: as case_text_read. */
shb_status command_keep_text(command_options *options, int *copy, char path[SUBPROCESS_COPY]);

/* Append the options that a stage passes on to another program: quiet, verbose, force, --set,
 * --into, and the file. The words belong to options.
 *   words  inout  [COMMAND_WORDS], n of them used
 * Returns the number of words, with a NULL behind. */
int command_forward(const command_options *options, const char **words, int n);

/* Exit code for a status. Unless the status is SHB_OK, prints "shroudhb: error: TEXT" with the last
 * message, or "warning" for SHB_NOT_CONVERGED. Without a message nothing is printed: case_read
 * prints its errors itself. If standard output is incomplete, SHB_OK and SHB_NOT_CONVERGED become
 * SHB_ERR_IO. */
int command_finish(shb_status status);

/* Provenance of an output. The pointers are kept: settings is case_settings of the stage, name the
 * command. */
shb_provenance command_provenance(const case_file *file, char *settings, const char *name);

#endif
