/* The rows of the key table. */
#ifndef CASES_PARSE_KEY_TABLE_H
#define CASES_PARSE_KEY_TABLE_H

#include "cases/parse/keys.h"

/* Every key of a case file, in the order of the manual. */
case_keys case_key_table(void);

#endif
