/* Blade coordinates (tangential, axial, radial), fixed at the stacking line, and mesh axes. */
#ifndef MESH_BLADE_FRAME_H
#define MESH_BLADE_FRAME_H

#include "mesh/base/axes.h"
#include "mesh/base/status.h"

/* Rows: tangential, axial and radial unit vectors at the stacking line, in mesh axes;
 * right-handed. */
typedef struct {
  mesh_axis axis;
  double    axes[3][3];
} mesh_frame;

mesh_frame mesh_frame_at(mesh_axis axis);

/* Blade coordinates (own) to mesh axes (at), and back. */
void mesh_frame_to_mesh(const mesh_frame *frame, const double own[3], double at[3]);
void mesh_frame_to_own(const mesh_frame *frame, const double at[3], double own[3]);

/* Rotate a point in blade coordinates by angle (rad) about the engine axis; out may be own. */
void mesh_frame_rotate(double angle, const double own[3], double out[3]);

/* Add a point to gmsh's OpenCASCADE model. */
shb_status mesh_frame_add_point(const mesh_frame *frame, const double own[3], int *tag);

#endif
