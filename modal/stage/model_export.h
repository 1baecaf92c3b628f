/* What our own modal stage adds to the modal file beside the model: mesh, full mode shapes, contact patches, a
 * sampled receptance, and a VTKHDF group that lets ParaView open the file as it is. */
#ifndef MODAL_STAGE_MODEL_EXPORT_H
#define MODAL_STAGE_MODEL_EXPORT_H

#include "mesh/core/fe_mesh.h"
#include "modal/common/completeness.h"
#include "modal/condense/contact_patches.h"
#include "modal/model/model.h"

/* Writes /mesh/{nodes [n][3], connectivity [e][10 or 20], sets/NAME [f][6 or 8]}. */
shb_status modal_export_mesh(hid_t file, const mesh_fe *mesh);

/* Writes /modes/shape [m][n][3], mesh axes, clamped nodes zero. */
shb_status modal_export_shapes(hid_t file, int n_modes, int n_nodes, const double *shape);

/* Writes the attributes checked, checked_count, checked_below, missed_chance of /modes. */
shb_status modal_export_check(hid_t file, const modal_check *check);

/* Writes /contact/nodes [entry][3] (pair, right node, left node or -1), /contact/weight [entry] and
 * /contact/coordinates [side][pair][3]. */
shb_status modal_export_contact(hid_t file, const modal_patches *patches);

/* Writes /receptance/frequency [201 + m] Hz, even steps from 0 to 1.1 times the highest mode and the modes' own, and
 * /receptance/contact [201 + m][n_contact][n_contact]; nothing when that would exceed 64 MB. */
shb_status modal_export_receptance(hid_t file, const modal_model *model);

/* Writes /VTKHDF, an UnstructuredGrid of quadratic cells whose points are a link to /mesh/nodes and whose point
 * data mode_001, ... are views of /modes/shape, which must be there; static_displacement and static_von_mises are links to
 * /static where it is.
 * Source: VTKHDF file format, version 1.0. */
shb_status modal_export_vtk(hid_t file, const mesh_fe *mesh, int n_modes);

#endif
