/* Checks of material, or of the list materials. */
#ifndef CASES_MATERIALS_H
#define CASES_MATERIALS_H

#include "cases/reader.h"

/* Stiffness in mesh axes where a material is not isotropic; what one alone says wrongly, or both together. */
void case_check_materials(case_reader *reader);

#endif
