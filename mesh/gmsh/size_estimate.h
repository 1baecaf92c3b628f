/* How many nodes the mesh of a solid will have, told before gmsh makes it: gmsh has no bound, and takes all memory. */
#ifndef MESH_GMSH_SIZE_ESTIMATE_H
#define MESH_GMSH_SIZE_ESTIMATE_H

#include "mesh/gmsh/source_settings.h"

/* What there is to mesh, in the file's unit: of OpenCASCADE's solids exact, else guessed from boxes, the volume 0. */
typedef struct {
  double length, area, volume;
} mesh_extent;

/* Nodes of second order at element size h: n = 2 length / h + 4.6 area / h^2 + 6 volume / h^3 (two nodes an edge of a curve; 2.3 triangles
 * in a square of h, two nodes each; in a cube 4.3 tetrahedra, 1.4 nodes each: gmsh's own at 1.1 times h on the average). */
double mesh_estimate_nodes(const mesh_extent *extent, double h);

/* The size at which there would be so many nodes. */
double mesh_estimate_size(const mesh_extent *extent, double nodes);

/* Most nodes of a mesh: 3 million, or less where the memory that is free does not hold them (1.5 kB each). */
double mesh_estimate_most_nodes(void);

/* Of the solid that gmsh holds, before it is meshed: measures it, and keeps gmsh from elements so small that curves alone would
 * fill the memory. SHB_ERR_INPUT: source->size gives too many nodes (how many, and a size that would do, are told). */
shb_status mesh_estimate_check_solid(const mesh_source *source, mesh_extent *extent);

/* The same from the mesh of curves (dimension 1) or faces (2) that there is by now, before the next dimension is meshed. */
shb_status mesh_estimate_check_dimension(const mesh_source *source, int dimension,
                                         mesh_extent *extent);

#endif
