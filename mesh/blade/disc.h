/* The disc below the root block: one sector of a rim on a web, clamped at the bore.
 *
 * The rim is as long as the root block. Its outer radius lies between the lower corners of the
 * block and its top, so that the block stands in it. Sides are the planes at +-pi/N. */
#ifndef MESH_BLADE_DISC_H
#define MESH_BLADE_DISC_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

/* Has the blade a disc? */
bool mesh_disc_wanted(const mesh_blade *blade);

/* SHB_ERR_INPUT for a disc that cannot be built; the message names the key. Nothing without a
 * disc. */
shb_status mesh_disc_check(const mesh_blade *blade);

/* Volume of the sector of the disc, m3. */
double mesh_disc_volume(const mesh_blade *blade);

/* Build the solid in gmsh's OpenCASCADE model. */
shb_status mesh_disc_build(const mesh_blade *blade, const mesh_frame *frame, int *volume);

/* Centres of mass of the bore and of the two sides, blade coordinates, m. */
void mesh_disc_bore_centre(const mesh_blade *blade, double own[3]);
void mesh_disc_side_centre(const mesh_blade *blade, bool right, double own[3]);

#endif
