/* The settings of a convergence study as text. */
#ifndef CASES_SCHEMA_CONVERGE_SETTINGS_H
#define CASES_SCHEMA_CONVERGE_SETTINGS_H

#include "cases/parse/case_file.h"
#include "mesh/base/status.h"

enum { CONVERGE_STAGES = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_CONVERGE };

/* Everything that the result of a study depends on, as text; malloc'ed. Errors: SHB_ERR_IO. */
shb_status converge_settings(const case_file *file, char **text);

#endif
