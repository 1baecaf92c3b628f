/* The settings of a stage as text: a stage runs again only when they have changed. */
#ifndef CASES_SCHEMA_STAGE_SETTINGS_H
#define CASES_SCHEMA_STAGE_SETTINGS_H

#include "cases/parse/case_file.h"

/* Lines "key = value" in SI of every key on which stage depends, in the order of the key table;
 * malloc'ed. */
char *case_settings(const case_file *file, case_stage stage);

#endif
