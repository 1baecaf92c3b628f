/* The settings of a stage as text: a stage runs again only when they have changed. */
#ifndef CASES_SCHEMA_STAGE_SETTINGS_H
#define CASES_SCHEMA_STAGE_SETTINGS_H

#include "cases/parse/case_file.h"

/* "key = value" lines in SI, sorted as in the key table, of every key that stage depends on; malloc'ed. */
char *case_settings(const case_file *file, case_stage stage);

#endif
