/* The list contact.interfaces: its checks, and its values for the balance and the mesh. */
#ifndef CASES_SCHEMA_INTERFACES_H
#define CASES_SCHEMA_INTERFACES_H

#include "cases/parse/reader.h"

/* Copy the list to the settings of the balance and the mesh, and choose the leading interface. To
 * be called after the continuation parameter is known. */
void case_share_interfaces(case_reader *reader);

void case_check_interfaces(case_reader *reader, int stages);

#endif
