/* One value of the case file: from its node into its slot, and from its slot to a settings line. */
#ifndef CASES_PARSE_VALUE_H
#define CASES_PARSE_VALUE_H

#include <stdbool.h>
#include <stdio.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

/* Read node as key says, check its range and store it at slot (file + key->at unless a section's row). Every
 * fault is recorded under path. Not for CASE_LIST, whose rows the reader walks itself. */
bool case_value_read(case_issues *issues, const case_key *key, const char *path,
                     const case_node *node, case_file *file, void *slot);

#endif
