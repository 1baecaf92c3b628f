#include "mesh/blade/frame.h"

#include <math.h>

#include "mesh/base/vec3.h"
#include "mesh/gmsh/api.h"
#include "mesh/gmsh/session.h"

mesh_frame mesh_frame_at(mesh_axis axis) {
  mesh_frame frame = {.axis = axis};
  double     stacking[3];
  mesh_axis_stacking(axis, stacking);
  mesh_axes_at(axis, stacking, frame.axes);
  return frame;
}

void mesh_frame_to_mesh(const mesh_frame *frame, const double own[3], double at[3]) {
  for (int d = 0; d < 3; d++)
    at[d] = own[0] * frame->axes[0][d] + own[1] * frame->axes[1][d] + own[2] * frame->axes[2][d];
}

void mesh_frame_to_own(const mesh_frame *frame, const double at[3], double own[3]) {
  for (int i = 0; i < 3; i++) own[i] = vec3_dot(at, frame->axes[i]);
}

void mesh_frame_rotate(double angle, const double own[3], double out[3]) {
  double t = own[0], r = own[2], c = cos(angle), s = sin(angle);
  out[0] = t * c + r * s;
  out[1] = own[1];
  out[2] = r * c - t * s;
}

shb_status mesh_frame_add_point(const mesh_frame *frame, const double own[3], int *tag) {
  double at[3];
  mesh_frame_to_mesh(frame, own, at);
  GMSH_TRY("mesh.blade", *tag = gmshModelOccAddPoint(at[0], at[1], at[2], 0, -1, &ierr));
  return SHB_OK;
}
