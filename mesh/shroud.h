/* The tip shroud: a segment of a ring whose two sides are congruent Z-notches.
 *
 * The left side is three planar faces over a Z in the plan view (axial, tangential): leading leg, contact leg
 * of length shroud_contact along u, trailing leg; all are drawn out along (tan phi/cos psi, 0, 1), which lies
 * in the contact plane and leaves the front and rear faces flat. The solid is those faces revolved by the
 * sector angle, so the right side is the left one turned. The contact leg's centre lies on its own radial
 * plane, so that in the cylindrical axes there the right side's normal is exactly
 * v = (cos psi cos phi, sin psi cos phi, -sin phi) (Chen, Yang, Menq 1999, eq. 2). */
#ifndef MESH_SHROUD_H
#define MESH_SHROUD_H

#include <stdbool.h>

#include "mesh/blade.h"
#include "mesh/frame.h"

enum { MESH_SHROUD_LEGS = 3, MESH_SHROUD_CONTACT = 1 /* the middle leg */ };

/* Centre of mass of a leg's planar face on the left or right side, own coordinates, m. */
void mesh_shroud_centre(const mesh_blade *blade, int leg, bool right, double own[3]);

/* SHB_ERR_INPUT for a shroud that cannot be built or does not cover the last section. */
shb_status mesh_shroud_check(const mesh_blade *blade);

/* Add the solids, one a leg, to gmsh's OpenCASCADE model. */
shb_status mesh_shroud_build(const mesh_blade *blade, const mesh_frame *frame,
                             int volumes[MESH_SHROUD_LEGS]);

#endif
