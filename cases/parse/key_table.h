/* The rows of the key table, and the conditions under which a key is read. */
#ifndef CASES_PARSE_KEY_TABLE_H
#define CASES_PARSE_KEY_TABLE_H

#include <stdbool.h>

#include "cases/parse/keys.h"

/* Every key of a case file, in the order of the manual. */
case_keys case_key_table(void);

/* Whether the condition of a key holds in this file. */
bool case_key_applies(const case_key *key, const case_file *file);

#endif
