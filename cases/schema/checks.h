/* What must hold between the keys of a case file. */
#ifndef CASES_SCHEMA_CHECKS_H
#define CASES_SCHEMA_CHECKS_H

#include "cases/parse/reader.h"

/* One of mesh.blade and mesh.file, one of pressure, traction and force. Sets load.kind and load.has_at. Before
 * case_reader_require, which asks what applies. */
void case_check_alternatives(case_reader *reader, int stages);

/* Geometry, ranges that depend on other keys, and files that must be there. Returns true if a file could not
 * be read (an issue is recorded too). */
bool case_check_values(case_reader *reader, int stages);

#endif
