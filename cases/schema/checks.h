/* Conditions between the keys of a case file. */
#ifndef CASES_SCHEMA_CHECKS_H
#define CASES_SCHEMA_CHECKS_H

#include "cases/parse/reader.h"

/* Checks that one of mesh.blade and mesh.file is given, and one of pressure, traction and force.
 * Sets load.kind and load.has_at. To be called before case_reader_require, which depends on
 * them. */
void case_check_alternatives(case_reader *reader, int stages);

/* Checks the geometry, ranges that depend on other keys, and that input files exist. True if a file
 * cannot be read, which is also recorded as an issue. */
bool case_check_values(case_reader *reader, int stages);

#endif
