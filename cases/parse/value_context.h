/* A value in hand: what its reader needs to know, and what readers share. */
#ifndef CASES_PARSE_VALUE_CONTEXT_H
#define CASES_PARSE_VALUE_CONTEXT_H

#include <stdbool.h>

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"

typedef struct {
  case_issues    *issues;
  const case_key *key;
  const char     *path;
  case_file      *file;
} case_value_context;

/* Record that node is of the wrong kind (nothing if it is broken); false. The first says what the key wants. */
bool case_value_refuse(const case_value_context *c, const case_node *node);
bool case_value_refuse_kind(const case_value_context *c, const char *path, const case_node *node,
                            const char *expected);

/* A number in the key's unit and range. */
bool case_value_number(const case_value_context *c, const char *path, const case_node *node,
                       double *value);

/* A list of n of them. */
bool case_value_numbers(const case_value_context *c, const char *path, const case_node *node, int n,
                        double *value);

/* slot: int */
bool case_value_integer(const case_value_context *c, const case_node *node, void *slot);

/* What the key wants, for messages: "a number in N/m", "one of neighbour, ground", "[x, y, z] in m". */
void case_value_expected(const case_key *key, char *text, size_t size);

/* A pair [number in unit, phase] (phase optional, rad); for load factors and signals. */
bool case_value_polar(case_issues *issues, const char *path, const case_node *node,
                      const char *unit, double polar[2]);

#endif
