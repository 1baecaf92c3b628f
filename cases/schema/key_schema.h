/* The key table as a JSON Schema (draft 7): editors complete and check a case file by it. */
#ifndef CASES_SCHEMA_KEY_SCHEMA_H
#define CASES_SCHEMA_KEY_SCHEMA_H

#include <stdio.h>

/* The schema of a case file. It holds names, types, words, ranges of bare numbers, and the help of
 * every key. What depends on other keys is left to the program itself. */
void case_print_schema(FILE *out);
/* Parts of a schema: a text in quotation marks; `"quantity": {...}`, a number with its unit. */
void case_print_json_string(const char *text, FILE *out);
void case_print_quantity_definition(FILE *out);

/* That of a motion file for `shroudhb contact`. */
void case_print_motion_schema(FILE *out);

#endif
