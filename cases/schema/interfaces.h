/* The list contact.interfaces: into the settings of the stages, and its checks. */
#ifndef CASES_SCHEMA_INTERFACES_H
#define CASES_SCHEMA_INTERFACES_H

#include "cases/parse/reader.h"

/* The settings of the balance and of the mesh from the list; which one leads. After the parameter that is followed. */
void case_share_interfaces(case_reader *reader);

void case_check_interfaces(case_reader *reader, int stages);

#endif
