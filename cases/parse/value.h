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

/* "path = value" in SI with %.17g; several lines for a table. Of a list the rows that one of stages depends on. */
void case_value_print(FILE *out, const case_key *key, const case_file *file, int stages);

/* What the key wants, for messages: "a number in N/m", "one of neighbour, ground", "[x, y, z] in m". */
void case_value_expected(const case_key *key, char *text, size_t size);

/* A pair [number in unit, phase] (phase optional, rad); for load factors and signals. */
bool case_value_polar(case_issues *issues, const char *path, const case_node *node,
                      const char *unit, double polar[2]);

#endif
