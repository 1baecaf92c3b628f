/* Estimate of the number of nodes before gmsh meshes a solid. gmsh has no bound of its own and
 * fills the memory. */
#ifndef MESH_GMSH_SIZE_ESTIMATE_H
#define MESH_GMSH_SIZE_ESTIMATE_H

#include "mesh/gmsh/source_settings.h"

/* Extent of the solid in the unit of the file. Exact for OpenCASCADE's solids; otherwise estimated
 * from boxes, with volume 0. */
typedef struct {
  double length, area, volume;
} mesh_extent;

/* Number of second-order nodes at element size h: n = 2 length / h + 4.6 area / h^2 + 6 volume /
 * h^3.
 *
 * A curve has two nodes an element. A square of side h has 2.3 triangles with two nodes each. A
 * cube of side h has 4.3 tetrahedra with 1.4 nodes each, as gmsh's mean edge is 1.1 h. */
double mesh_estimate_nodes(const mesh_extent *extent, double h);

/* Element size that gives this number of nodes. */
double mesh_estimate_size(const mesh_extent *extent, double nodes);

/* Bytes that a mesh takes while gmsh makes it. */
double mesh_estimate_bytes(double nodes);

/* Largest number of nodes: 3 million, or what the free memory holds. */
double mesh_estimate_most_nodes(void);

/* Measure the solid in gmsh before it is meshed, and set a least element size, so that the curves
 * alone cannot fill the memory.
 * Errors: SHB_ERR_INPUT if source->size gives too many nodes; the message gives their number and a
 * suitable size. */
shb_status mesh_estimate_check_solid(const mesh_source *source, mesh_extent *extent);

/* Check again with the mesh of the curves (dimension 1) or faces (2), before the next dimension. */
shb_status mesh_estimate_check_dimension(const mesh_source *source, int dimension,
                                         mesh_extent *extent);

#endif
