/* What the readers of values share: the value being read, and checks of kind and range. */
#ifndef CASES_PARSE_VALUE_CONTEXT_H
#define CASES_PARSE_VALUE_CONTEXT_H

#include <stdbool.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

typedef struct case_value_context {
  case_issues    *issues;
  const case_key *key;
  const char     *path;
  case_file      *file;
} case_value_context;

/* Record that node is of the wrong kind, unless it is broken, and return false. The first function
 * says what the key expects. */
bool case_value_refuse(const case_value_context *c, const case_node *node);
bool case_value_refuse_kind(const case_value_context *c, const char *path, const case_node *node,
                            const char *expected);

/* Read a number in the unit and the range of the key. */
bool case_value_number(const case_value_context *c, const char *path, const case_node *node,
                       double *value);

/* Read a list of n such numbers. */
bool case_value_numbers(const case_value_context *c, const char *path, const case_node *node, int n,
                        double *value);

/* Read a whole number; slot is an int. */
bool case_value_integer(const case_value_context *c, const case_node *node, void *slot);

/* Text for messages: "a number in N/m", "one of neighbour, ground", "[x, y, z] in m". */
void case_value_expected(const case_key *key, char *text, size_t size);

/* Read a pair [number in unit, phase] for load factors and signals. The number is at most `most`
 * either way. The phase is optional, in rad. */
bool case_value_polar(case_issues *issues, const char *path, const case_node *node,
                      const char *unit, double most, double polar[2]);

#endif
