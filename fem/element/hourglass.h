/* Hexahedra that 2x2x2 points leave without stiffness. */
#ifndef FEM_ELEMENT_HOURGLASS_H
#define FEM_ELEMENT_HOURGLASS_H

#include "mesh/core/fe_mesh.h"

/* Eight points see 48 strains of the 54 that a hexahedron has beside its rigid motions. A column of single elements keeps
 * one motion without energy an element, clamped or not; two elements side by side across the column keep none (counted
 * for boxes of up to 3x3x2). SHB_ERR_INPUT if in some element two pairs of opposite faces are free, neither shared with
 * another element nor clamped; the text names one and how many there are. Tetrahedra always pass. */
shb_status fem_hourglass_check(const mesh_fe *mesh);

#endif
