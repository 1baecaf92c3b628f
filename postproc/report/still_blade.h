/* The blade as a still picture: its sharp edges and its outline, for pages without WebGL. */
#ifndef POSTPROC_REPORT_STILL_BLADE_H
#define POSTPROC_REPORT_STILL_BLADE_H

#include "mesh/base/axes.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/field/blade_field.h"
#include "postproc/field/blade_skin.h"

/* Seen from outside at an angle, the radial direction up; surfaces that face away have no edges. */
void post_still_blade(const post_blade_field *field, mesh_axis axis, post_buffer *out);

/* Shroud of a sector with the contact's axes v, u, w and the angles psi and phi, rad: from outside,
 * and along the engine axis. */
void post_contact_axes(double psi, double phi, post_buffer *out);

#endif
