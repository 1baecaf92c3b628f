/* The tip shroud: a segment of a ring whose two sides are congruent Z-notches.
 *
 * The left side consists of three planar faces over a Z in the plan view (axial, tangential). They
 * are the leading leg, the contact leg of length shroud_contact along u, and the trailing leg. They
 * are extruded along (tan phi/cos psi, 0, 1). This direction lies in the contact plane and leaves
 * the front and rear faces flat. The solid is these faces revolved by the sector angle, so the
 * right side is the left one rotated. The centre of the contact leg lies on its own radial plane.
 * In the cylindrical axes there the normal of the right side is v = (cos psi cos phi, sin psi cos
 * phi, -sin phi) (Chen, Yang, Menq 1999, eq. 2). */
#ifndef MESH_BLADE_SHROUD_H
#define MESH_BLADE_SHROUD_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

enum { MESH_SHROUD_LEGS = 3, MESH_SHROUD_CONTACT = 1 /* the middle leg */ };

/* Centre of mass of the planar face of a leg on the left or right side, blade coordinates, m. */
void mesh_shroud_centre(const mesh_blade *blade, int leg, bool right, double own[3]);

/* The unrolled shroud has the coordinates (p, axial) with p = R theta + t. R is the radius at mid
 * thickness. t is the tangential coordinate of the left side's Z at this axial coordinate. theta is
 * the angle from that point. The two sides are p = t -+ R pi/N. */

/* Corners of the outline, anticlockwise: the Z of the right side from the front, then the left one
 * from the rear. */
void mesh_shroud_outline(const mesh_blade *blade, double corner[2 * (MESH_SHROUD_LEGS + 1)][2]);

/* Side of a point of the outline on the contact leg: 1 right, -1 left, 0 neither. */
int mesh_shroud_contact_side(const mesh_blade *blade, const double plan[2]);

/* Blade coordinates of a point of the unrolled shroud at a share of the thickness (0 underside, 1
 * top). */
void mesh_shroud_roll_up(const mesh_blade *blade, const double plan[2], double share,
                         double own[3]);

/* Unrolled coordinates of a point of the underside; radial coordinate of the underside at the axial
 * and tangential coordinates of own. */
void   mesh_shroud_unroll(const mesh_blade *blade, const double own[3], double plan[2]);
double mesh_shroud_underside(const mesh_blade *blade, const double own[3]);

/* SHB_ERR_INPUT if the shroud cannot be built or does not cover the last section. */
shb_status mesh_shroud_check(const mesh_blade *blade);

/* Add the solids of the legs to gmsh's OpenCASCADE model. */
shb_status mesh_shroud_build(const mesh_blade *blade, const mesh_frame *frame,
                             int volumes[MESH_SHROUD_LEGS]);

#endif
