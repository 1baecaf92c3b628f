/* Reading one value of the case file into its slot. */
#ifndef CASES_PARSE_VALUE_H
#define CASES_PARSE_VALUE_H

#include <stdbool.h>
#include <stdio.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

/* Read node by its row, check the range and store the value at slot. slot is file + key->at, or in
 * the element for "[]" rows. Every fault is recorded under path. The reader reads CASE_LIST
 * itself. */
bool case_value_read(case_issues *issues, const case_key *key, const char *path,
                     const case_node *node, case_file *file, void *slot);

/* May the text of a scalar be the name of a case or study, after which its files are called? A
 * fault is recorded under path. */
bool case_value_is_name(case_issues *issues, const char *path, const case_node *node);

/* Print a value as the settings of a stage have it: "PATH = VALUE", or lines of its own. */
void case_value_print(const case_printed *p);

#endif
