/* The parametric blade of hexahedra: a planar section mesh swept through root, airfoil and
 * shroud. */
#ifndef MESH_BLADE_HEX_SWEEP_H
#define MESH_BLADE_HEX_SWEEP_H

#include "mesh/base/progress.h"
#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

/* Make the mesh in gmsh's current model, with the physical groups root, contact_right,
 * contact_left, load and body.
 *
 * The solid is the one that mesh/blade/blade.c fuses for tetrahedra, with OpenCASCADE's loft
 * between root block and shroud. A gmsh session must be open; the blade must have been checked.
 * Errors: SHB_ERR_INPUT if gmsh cannot build or mesh the blade; SHB_INTERRUPTED. */
shb_status mesh_hex_sweep_build(const mesh_blade *blade, const mesh_frame *frame,
                                shb_progress *progress);

#endif
