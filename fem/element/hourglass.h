/* Detection of hexahedra with zero-energy modes under 2x2x2 quadrature. */
#ifndef FEM_ELEMENT_HOURGLASS_H
#define FEM_ELEMENT_HOURGLASS_H

#include "mesh/core/fe_mesh.h"

/* Eight points give 48 strains; a hexahedron has 54 modes besides its rigid motions. A column of
 * single elements keeps one zero-energy mode an element, clamped or not. Two elements side by side
 * across the column keep none (counted for boxes of up to 3x3x2). Tetrahedra always pass. Errors:
 * SHB_ERR_INPUT if an element has two pairs of opposite faces that are free: neither shared with
 * another element or sector nor clamped. The message gives their number and one tag. */
shb_status fem_hourglass_check(const mesh_fe *mesh);

#endif
