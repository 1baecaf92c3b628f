/* Checks of the block material, or of the list materials. */
#ifndef CASES_SCHEMA_MATERIALS_H
#define CASES_SCHEMA_MATERIALS_H

#include "cases/parse/reader.h"

/* Compute the stiffness in mesh axes of anisotropic materials. Faults of the constants are
 * issues. */
void case_check_materials(case_reader *reader);

#endif
