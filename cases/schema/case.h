/* Reading a case file. */
#ifndef CASES_SCHEMA_CASE_H
#define CASES_SCHEMA_CASE_H

#include <stdio.h>

#include "cases/parse/case_file.h"
#include "cases/schema/overrides.h"
#include "mesh/base/status.h"

/* Read and check a case file. All errors of the file are printed to errors, each as "file:line:col:
 * error: key: text" with the source line and a caret.
 *
 *   stages  in  mask of the stages that will run; keys that only others require may be missing
 *
 * Errors: SHB_ERR_INPUT a fault in the file; SHB_ERR_IO the file cannot be opened, or memory was
 * short, which out->no_memory tells. */
shb_status case_read(const char *path, int stages, FILE *errors, case_file *out);
/* The same with overrides, which may be NULL. The text of the case then ends with a comment line
 * for each. */
shb_status case_read_with(const char *path, const case_overrides *overrides, int stages,
                          FILE *errors, case_file *out);
void       case_free(case_file *file);

#endif
