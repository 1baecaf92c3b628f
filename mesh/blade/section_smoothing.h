/* Quality of the quadrangles of a planar mesh. */
#ifndef MESH_BLADE_SECTION_SMOOTHING_H
#define MESH_BLADE_SECTION_SMOOTHING_H

#include "mesh/blade/section_mesh.h"

/* Improve the quadrangles. Corners outside the section and off the outline move towards the mean of
 * their neighbours, as far as their worst quadrangle improves. Then the middles of sides are set
 * half way. */
void mesh_planar_smooth(mesh_planar *plan);

/* Smallest sine of a corner's angle outside the section. Returns -1 if the mesh does not meet the
 * whole contour of the section. gmsh covers the tip of a hole that it does not resolve. */
double mesh_planar_least_sine(const mesh_planar *plan);

#endif
