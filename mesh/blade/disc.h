/* The disc below the root block: one sector of a rim on a web, clamped at the bore.
 *
 * The rim is as long as the root block. Its outer radius lies between the lower corners of the
 * block and its top, so that the block stands in it. Below the rim the web widens over the taper,
 * or in a step. Sides are the planes at +-pi/N.
 *
 * Hexahedra are swept along the radius, from the bore to the top of the rim. Their plan is that of
 * the root block, with strips at both sides to those of the sector. Axial places shrink with the
 * length of the profile at their radius, tangential ones with the radius. */
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

/* Radii of the profile: bore, where the taper begins, foot and top of the rim, m. */
void mesh_disc_radii(const mesh_blade *blade, double radius[4]);

/* Angle from the stacking line of a tangential place on top of the rim, rad. */
double mesh_disc_angle(const mesh_blade *blade, double tangential);

/* Height of the top of the rim at a tangential place, blade coordinates, m. */
double mesh_disc_top(const mesh_blade *blade, double tangential);

/* Point of the swept disc. place: angle, rad, and axial place in the rim, m. */
void mesh_disc_point(const mesh_blade *blade, double radius, const double place[2], double own[3]);

/* Build the solid in gmsh's OpenCASCADE model. */
shb_status mesh_disc_build(const mesh_blade *blade, const mesh_frame *frame, int *volume);

/* Centres of mass of the bore and of the two sides, blade coordinates, m. */
void mesh_disc_bore_centre(const mesh_blade *blade, double own[3]);
void mesh_disc_side_centre(const mesh_blade *blade, bool right, double own[3]);

#endif
