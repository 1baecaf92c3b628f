/* The planar mesh between the airfoil's section and an outline around it. */
#ifndef MESH_BLADE_SECTION_OUTLINE_H
#define MESH_BLADE_SECTION_OUTLINE_H

#include "mesh/blade/section_mesh.h"

/* The plan of an outline around the section: gmsh's triangles (and, if recombine, quadrangles) at twice the size, each cut
 * through the middles of its sides, so that only quadrangles remain.
 *   section  in   at[] are the places in this plan, m
 *   corner   in   [n_corners][2] m, anticlockwise; parts[i] elements (even) between corners i and i + 1
 *   size     in   element size away from the section, m
 * A gmsh session must be open; its current model is left as it was. Errors: SHB_ERR_INPUT gmsh fails, what heads the text. */
shb_status mesh_section_outline_create(const mesh_planar *section, int n_corners,
                                       const double corner[][2], const int *parts, double size,
                                       bool recombine, const char *what, mesh_planar *plan);

#endif
