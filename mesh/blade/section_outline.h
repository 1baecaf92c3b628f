/* The planar mesh between the airfoil's section and an outline around it. */
#ifndef MESH_BLADE_SECTION_OUTLINE_H
#define MESH_BLADE_SECTION_OUTLINE_H

#include "mesh/blade/section_mesh.h"

/* Mesh the region between the section and an outline. gmsh makes triangles (and, if recombine,
 * quadrangles) of twice the size. Each is split at the middles of its sides, so that only
 * quadrangles remain. A gmsh session must be open; its current model stays as it was.
 *   section  in  at[] in this plane, m
 *   corner   in  [n_corners][2] m, anticlockwise
 *   parts    in  [n_corners] elements between corners i and i + 1, even
 *   size     in  element size away from the section, m
 *   what     in  heads the message
 * Errors: SHB_ERR_INPUT if gmsh fails. */
shb_status mesh_section_outline_create(const mesh_planar *section, int n_corners,
                                       const double corner[][2], const int *parts, double size,
                                       bool recombine, const char *what, mesh_planar *plan);

#endif
