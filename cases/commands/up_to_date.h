/* Whether a stage's file still fits the case: a stage runs again only when its settings text changed. */
#ifndef CASES_COMMANDS_UP_TO_DATE_H
#define CASES_COMMANDS_UP_TO_DATE_H

#include <stdbool.h>

#include "cases/parse/case_file.h"

/* All that the output of stage depends on: its keys and the contents of its input file. malloc'ed *text. SHB_ERR_IO. */
shb_status up_to_date_settings(const case_file *file, case_stage stage, const char *input,
                               char **text);

/* Whether the HDF5 file at path was made from these settings. */
bool up_to_date_with(const char *path, const char *settings);

/* Whether the HDF5 file at path was made from the keys of stage that the case has now. */
bool up_to_date_keys(const case_file *file, case_stage stage, const char *path);

/* One warning line on stderr if the HDF5 file at path was made from other keys of stage than the case has now.
 * Files that cannot be read are left to whoever needs them. */
void up_to_date_warn(const case_file *file, case_stage stage, const char *path);

#endif
