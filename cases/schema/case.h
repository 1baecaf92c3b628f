/* Reading a case file. */
#ifndef CASES_SCHEMA_CASE_H
#define CASES_SCHEMA_CASE_H

#include <stdio.h>

#include "cases/parse/case_file.h"
#include "mesh/base/status.h"

/* Read and check a case file. All errors of the file are printed to errors at once, each as
 * "file:line:col: error: key: text" with the source line and a caret; returns SHB_ERR_INPUT (SHB_ERR_IO if it
 * cannot be opened). stages: bit mask of case_stage that will run; a stage's required keys are only required then. */
shb_status case_read(const char *path, int stages, FILE *errors, case_file *out);
void       case_free(case_file *file);

#endif
