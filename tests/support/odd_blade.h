/* A parametric blade with odd dimensions: an airfoil of three sections, root and shroud. */
#ifndef TESTS_SUPPORT_ODD_BLADE_H
#define TESTS_SUPPORT_ODD_BLADE_H

#include "mesh/blade/blade.h"

/* Of tetrahedra; other sizes and elements are set by the test. */
mesh_blade odd_blade(void);

#endif
