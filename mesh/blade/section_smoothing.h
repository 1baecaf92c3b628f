/* The shape of a plan's quadrangles. */
#ifndef MESH_BLADE_SECTION_SMOOTHING_H
#define MESH_BLADE_SECTION_SMOOTHING_H

#include "mesh/blade/section_mesh.h"

/* Move the corners that lie neither on the outline nor in the section, each towards the mean of its neighbours as far as
 * the worst of its quadrangles gets better for it; then put the middles of their sides half way. SHB_ERR_IO. */
shb_status mesh_planar_smooth(mesh_planar *plan);

/* Least sine of a corner's angle outside the section; -1 where the outline's mesh does not meet the section's along the
 * whole contour (gmsh covers the tip of a hole that it does not resolve). */
double mesh_planar_least_sine(const mesh_planar *plan);

#endif
