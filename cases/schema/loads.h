/* Checks of the excitation: one load, or the list excitation.loads. */
#ifndef CASES_SCHEMA_LOADS_H
#define CASES_SCHEMA_LOADS_H

#include "cases/parse/reader.h"

/* Which kind of load each one is; more than one kind, or a force without a place, are told. */
void case_check_load(case_reader *reader);

/* Loads that move nothing, and harmonics for which the balance has no room. */
void case_check_load_values(case_reader *reader, int stages);

#endif
