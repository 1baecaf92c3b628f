/* The block mesh.groups: which faces are root, contact_right, contact_left, load. */
#ifndef CASES_PARSE_GROUPS_H
#define CASES_PARSE_GROUPS_H

#include "cases/parse/diagnostics.h"
#include "cases/parse/keys.h"
#include "cases/parse/yaml.h"
#include "mesh/core/group_rules.h"

/* {GROUP: {plane: [x, y, z], normal: [x, y, z]} | {radius: r} | {nearest: [x, y, z]} | {name: WORD}}, a plane and a
 * radius with an optional tolerance. Groups that are not among the usual four go to rules->more, in order (cases/schema/named_groups.h sorts
 * them). Every fault is recorded under path. */
bool case_groups_read(case_issues *issues, const char *path, const case_node *node,
                      mesh_rules *rules);

/* root, contact_right, contact_left, load? */
bool case_group_is_usual(const char *name);

/* One line a rule, in SI. */
void case_groups_print(FILE *out, const char *path, const mesh_rules *rules);

#endif
