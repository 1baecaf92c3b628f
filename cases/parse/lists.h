/* Reading of values that are lists or tables, and of their short forms. */
#ifndef CASES_PARSE_LISTS_H
#define CASES_PARSE_LISTS_H

#include "cases/parse/value_context.h"

/* The types CASE_PRELOADS, CASE_NUMBERS and CASE_INTEGERS, CASE_POINTS, CASE_FACTORS, CASE_PROBES
 * and CASE_GAUGES of keys.h, and the lists beside words. */
bool case_list_preloads(const case_value_context *c, const case_node *node, void *slot);
bool case_list_numbers(const case_value_context *c, const case_node *node, void *slot);
bool case_list_frequencies(const case_value_context *c, const case_node *node, void *slot);
bool case_list_factors(const case_value_context *c, const case_node *node, void *slot);
bool case_list_probes(const case_value_context *c, const case_node *node, void *slot);
/* rotor.mistuning but for {file: }. */
bool case_list_mistuning(const case_value_context *c, const case_node *node, void *slot);
bool case_list_gauges(const case_value_context *c, const case_node *node, void *slot);

#endif
