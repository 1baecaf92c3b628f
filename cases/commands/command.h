/* What every command shares: options, the closing error line, provenance. */
#ifndef CASES_COMMANDS_COMMAND_H
#define CASES_COMMANDS_COMMAND_H

#include <stdbool.h>

#include "cases/parse/case_file.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"

typedef struct {
  bool        quiet, verbose, force;
  const char *mode;  /* "inspect" for --inspect, or NULL; see command_parse */
  const char *path;  /* the FILE argument */
  const char *other; /* a second FILE, or NULL; known where the usage mentions OTHER */
  const char *svg;   /* what --svg names, or NULL; known where the usage mentions it */
} command_options;

/* Options and the one FILE of a command line, in any order; "--" ends the options.
 *
 * --help (prints usage) and --version end the program with 0. --quiet, --verbose and --force are always
 * known; any other long option that the usage text mentions (say --inspect) becomes out->mode. A word that
 * is not known is one line on stderr and exit code 2.
 * Returns < 0 to go on, else the exit code. out points into argv. */
int command_parse(int argc, char **argv, const char *usage, command_options *out);

/* Exit code for status; unless it is SHB_OK prints "shroudhb: error: TEXT" ("warning" for SHB_NOT_CONVERGED)
 * with the last recorded text, if there is one: case_read has already printed its errors and leaves none. A standard
 * output that could not be written whole makes SHB_ERR_IO of SHB_OK and SHB_NOT_CONVERGED. */
int command_finish(shb_status status);

/* Provenance of an output; keeps the pointers (settings: case_settings of the stage; name: the command). */
shb_provenance command_provenance(const case_file *file, char *settings, const char *name);

#endif
