/* Checks of the excitation: one load, or the list excitation.loads. */
#ifndef CASES_SCHEMA_LOADS_H
#define CASES_SCHEMA_LOADS_H

#include "cases/parse/reader.h"

/* Find the kind of each load. Several kinds, or a force without a place, are issues. */
void case_check_load(case_reader *reader);

/* Checks for loads of zero, and for load harmonics above those of the balance. */
void case_check_load_values(case_reader *reader, int stages);

#endif
