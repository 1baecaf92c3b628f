/* The key table as text: the list of `shroudhb keys` and the page of the case reference. */
#ifndef CASES_PARSE_KEY_LISTING_H
#define CASES_PARSE_KEY_LISTING_H

#include <stdio.h>

#include "cases/parse/keys.h"

/* Every key with unit, range, default and help; one line a key. */
void case_print_keys(FILE *out);

/* Print any table of keys so. */
void case_print_key_table(case_keys keys, FILE *out);

/* The page docs/user/case_reference.md: Markdown, one table a block. */
void case_print_reference(FILE *out);

#endif
