/* Keys that are in the file but not read. */
#ifndef CASES_SCHEMA_UNUSED_KEYS_H
#define CASES_SCHEMA_UNUSED_KEYS_H

#include "cases/parse/reader.h"

/* Record an issue for every key in the file whose condition in the key table does not hold. It says
 * which condition is missing, or that the key is to be left out. A block of which nothing is read
 * is one issue. Not reported: faults that other checks report, and properties of the machine that
 * always hold (rotor.blades, excitation.engine_order). */
void case_check_unused(const case_reader *reader);

#endif
