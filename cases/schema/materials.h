/* Checks of material, or of the list materials. */
#ifndef CASES_SCHEMA_MATERIALS_H
#define CASES_SCHEMA_MATERIALS_H

#include "cases/parse/reader.h"

/* Stiffness in mesh axes where a material is not isotropic; what one alone says wrongly, or both together. */
void case_check_materials(case_reader *reader);

#endif
