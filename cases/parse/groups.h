/* The block mesh.groups: rules that select the faces and volumes of a group. */
#ifndef CASES_PARSE_GROUPS_H
#define CASES_PARSE_GROUPS_H

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"
#include "mesh/core/group_rules.h"

/* Read the mapping GROUP: rule, where a rule is one of
 *   {plane: [x, y, z], normal: [x, y, z]}
 *   {radius: r}
 *   {nearest: [x, y, z]}
 *   {name: WORD}
 * A plane and a radius may have a tolerance. Groups besides the usual six go to rules->more, in
 * the order of the file; schema/named_groups.h sorts them. Every fault is recorded under path. */
bool case_groups_read(case_issues *issues, const char *path, const case_node *node,
                      mesh_rules *rules);

/* Is it one of the usual groups root, contact_right, contact_left, load, cyclic_right and
 * cyclic_left? */
bool case_group_is_usual(const char *name);

/* Print the rules in SI units, one line each. */
void case_groups_print(FILE *out, const char *path, const mesh_rules *rules);

#endif
