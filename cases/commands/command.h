/* What the commands share: the case of a command line, provenance. */
#ifndef CASES_COMMANDS_COMMAND_H
#define CASES_COMMANDS_COMMAND_H

#include "cases/options/finish.h"
#include "cases/options/options.h"
#include "cases/parse/case_file.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mesh/process/child.h"

/* Read the case of a command with its overrides, and make the folder of --into where it is missing.
 * Errors: as case_read and shb_make_folder. */
shb_status command_read(const command_options *options, int stages, case_file *out);

/* Read the text of the case once for all programs that the command starts: options->text becomes
 * path, that of a copy (mesh/process/child). The caller closes *copy. Errors: as case_text_read. */
shb_status command_keep_text(command_options *options, int *copy, char path[SHB_CHILD_TEXT]);

/* Provenance of an output. The pointers are kept: settings is case_settings of the stage, name the
 * command. */
shb_provenance command_provenance(const case_file *file, char *settings, const char *name);

#endif
