/* The planar mesh that is swept through a disc: that of the root block, and strips to the sides of
 * the sector. */
#ifndef MESH_BLADE_DISC_PLAN_H
#define MESH_BLADE_DISC_PLAN_H

#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/section_mesh.h"

/* Extend the plan of the root block. Its nodes and quadrangles come first, with the same numbers.
 * Each strip continues the edges on its side of the block in equal columns. Both sides of the
 * sector have nodes at the same axial places.
 *   root  in   at[]: tangential and axial, m, with equal edges on the block's long sides
 *   plan  out  at[]: angle from the stacking line, rad, and axial, m; the sides are at exactly
 *              +-pi/N. No contour. */
void mesh_disc_plan_create(const mesh_blade *blade, const mesh_planar *root, mesh_planar *plan);

#endif
