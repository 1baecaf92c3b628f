/* Contact interfaces, one or several: their checks, and their values for the balance. */
#ifndef CASES_SCHEMA_INTERFACES_H
#define CASES_SCHEMA_INTERFACES_H

#include "cases/parse/reader.h"

/* Copy the interfaces to the settings of the balance, and choose the leading one. To be called
 * after the continuation parameter is known. */
void case_share_interfaces(case_reader *reader);

/* The parameters of the balance become those of the leading interface. */
void case_lead(mhb_settings *mhb, int lead);

void case_check_interfaces(case_reader *reader, int stages);

#endif
