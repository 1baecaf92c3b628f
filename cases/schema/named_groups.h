/* Groups of the mesh besides the usual six. A key names them; the mesh or a rule defines them. */
#ifndef CASES_SCHEMA_NAMED_GROUPS_H
#define CASES_SCHEMA_NAMED_GROUPS_H

#include "cases/parse/reader.h"

/* Assign a rule to every group that the case names. Rules of other groups are issues. */
void case_assign_groups(case_reader *reader);

#endif
