/* Groups of the mesh besides the usual four: named where they are used, found by name or by the rules of mesh.groups. */
#ifndef CASES_SCHEMA_NAMED_GROUPS_H
#define CASES_SCHEMA_NAMED_GROUPS_H

#include "cases/parse/reader.h"

/* Give every group that the case names its rule; tell the rules of groups that it does not name. */
void case_assign_groups(case_reader *reader);

#endif
