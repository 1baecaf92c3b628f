/* Engine axis, cylindrical axes at a point, rotation about the axis.
 *
 * The engine axis passes through the origin. At a point off the axis the radial direction (z)
 * points away from the axis and the axial direction (y) along it. The tangential direction (x) is
 * axial x radial, so a positive rotation about the axis moves a point along +x. The neighbour on
 * the right is the blade rotated by +2 pi/N. Its left face lies on the right face of this blade. */
#ifndef MESH_BASE_AXES_H
#define MESH_BASE_AXES_H

typedef enum {
  MESH_AXIS_X,
  MESH_AXIS_Y,
  MESH_AXIS_Z,
  MESH_AXIS_MX,
  MESH_AXIS_MY,
  MESH_AXIS_MZ
} mesh_axis;

/* Unit vector along the engine axis. */
void mesh_axis_vector(mesh_axis axis, double axial[3]);

/* Rows of axes: tangential (x), axial (y), radial (z) at point; point must be off the axis. */
void mesh_axes_at(mesh_axis axis, const double point[3], double axes[3][3]);

/* out = point rotated by angle (rad) about the axis, right-handed; out may be point. */
void mesh_axis_rotate(mesh_axis axis, double angle, const double point[3], double out[3]);

/* Rows of the 4x4 matrix of that rotation, as gmsh takes affine maps. */
void mesh_axis_matrix(mesh_axis axis, double angle, double matrix[16]);

/* Radial direction along which the parametric blade is stacked: z for x and y axes, x for z
 * axes. */
void mesh_axis_stacking(mesh_axis axis, double radial[3]);

#endif
