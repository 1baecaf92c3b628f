/* Keys that are given but would never be read. */
#ifndef CASES_PARSE_UNUSED_KEYS_H
#define CASES_PARSE_UNUSED_KEYS_H

#include "cases/parse/reader.h"

/* Every key that is given although its condition in the key table does not hold is an issue at its place: what would have to
 * be otherwise, or that it is to be left out; once a block where nothing of the block is read. Not told: what other checks
 * tell, and what is true of the machine whatever it meets (rotor.blades, excitation.engine_order). */
void case_check_unused(const case_reader *reader);

#endif
