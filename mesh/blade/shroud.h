/* The tip shroud: a segment of a ring whose two sides are congruent Z-notches.
 *
 * The left side is three planar faces over a Z in the plan view (axial, tangential): leading leg, contact leg
 * of length shroud_contact along u, trailing leg; all are drawn out along (tan phi/cos psi, 0, 1), which lies
 * in the contact plane and leaves the front and rear faces flat. The solid is those faces revolved by the
 * sector angle, so the right side is the left one turned. The contact leg's centre lies on its own radial
 * plane, so that in the cylindrical axes there the right side's normal is exactly
 * v = (cos psi cos phi, sin psi cos phi, -sin phi) (Chen, Yang, Menq 1999, eq. 2). */
#ifndef MESH_BLADE_SHROUD_H
#define MESH_BLADE_SHROUD_H

#include <stdbool.h>

#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"
#include "mesh/blade/frame.h"

enum { MESH_SHROUD_LEGS = 3, MESH_SHROUD_CONTACT = 1 /* the middle leg */ };

/* Centre of mass of a leg's planar face on the left or right side, own coordinates, m. */
void mesh_shroud_centre(const mesh_blade *blade, int leg, bool right, double own[3]);

/* The shroud unrolled: plan coordinates (p, axial), p = R theta + t, R the radius at mid thickness, t the tangential place
 * of the left side's Z at this axial place and theta the angle from it. The two sides are p = t -+ R pi/N. */

/* Corners of the outline, anticlockwise from the front of the right side: its Z, then the left one's backwards. */
void mesh_shroud_outline(const mesh_blade *blade, double corner[2 * (MESH_SHROUD_LEGS + 1)][2]);

/* Is a point of the outline on the contact leg: 1 right, -1 left, 0 neither? */
int mesh_shroud_contact_side(const mesh_blade *blade, const double plan[2]);

/* Own coordinates at a share (0 underside, 1 top) of the thickness. */
void mesh_shroud_roll_up(const mesh_blade *blade, const double plan[2], double share,
                         double own[3]);

/* Plan coordinates of a point of the underside; and the radial coordinate of the underside above or below own. */
void   mesh_shroud_unroll(const mesh_blade *blade, const double own[3], double plan[2]);
double mesh_shroud_underside(const mesh_blade *blade, const double own[3]);

/* SHB_ERR_INPUT for a shroud that cannot be built or does not cover the last section. */
shb_status mesh_shroud_check(const mesh_blade *blade);

/* Add the solids, one a leg, to gmsh's OpenCASCADE model. */
shb_status mesh_shroud_build(const mesh_blade *blade, const mesh_frame *frame,
                             int volumes[MESH_SHROUD_LEGS]);

#endif
