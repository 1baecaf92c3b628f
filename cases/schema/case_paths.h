/* The files of a case: its outputs beside it, its mesh and its modal file. */
#ifndef CASES_SCHEMA_CASE_PATHS_H
#define CASES_SCHEMA_CASE_PATHS_H

#include <stdbool.h>

#include "cases/parse/case_file.h"
#include "mesh/base/status.h"

/* folder/NAME + suffix, with a suffix such as ".modal.h5"; from shb_text, as the others. */
char *case_output(const case_file *file, const char *suffix);
/* May folder/NAME + suffix be written? For each of n suffixes. SHB_ERR_IO. */
shb_status case_output_check(const case_file *file, int n, const char *const *suffix);
/* Is mesh.file converted to NAME.msh first? True for solids, for other units than m, and for groups
 * by rule. */
bool case_mesh_is_made(const case_file *file);
/* mesh_file or NAME.msh; modal_file or NAME.modal.h5. */
char *case_mesh_path(const case_file *file);
char *case_modal_path(const case_file *file);

#endif
