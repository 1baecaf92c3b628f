/* What the modal stage adds to the model in the modal file. This is the mesh, the full mode shapes,
 * the contact patches, a sampled receptance, and a VTKHDF group for ParaView. */
#ifndef MODAL_STAGE_MODEL_EXPORT_H
#define MODAL_STAGE_MODEL_EXPORT_H

#include "fem/body/rotation.h"
#include "mesh/core/fe_mesh.h"
#include "modal/common/completeness.h"
#include "modal/condense/contact_patches.h"
#include "modal/model/model.h"

/* Mode shapes, their stresses, and those of the residual shapes, at every node. */
typedef struct {
  double *shape;           /* [m][n_nodes][3] kg^-1/2 */
  float  *stress;          /* [m][n_nodes][6] Pa kg^-1/2 */
  float  *residual_stress; /* [columns][n_nodes][6] Pa/N */
} modal_fields;

/* Write /mesh/{nodes [n][3], connectivity [e][10 or 20], sets/NAME [f][6 or 8]}, and with several
 * volumes /mesh/{volume, material [e]}. */
shb_status modal_export_mesh(hid_t file, const mesh_fe *mesh);

/* Write /modes/shape [m][n][3] in mesh axes; clamped nodes are zero. */
shb_status modal_export_shapes(hid_t file, int n_modes, int n_nodes, const double *shape);

/* Write /modes/stress [m][n][6] in single precision: xx, yy, zz, xy, yz, xz in mesh axes. */
shb_status modal_export_stress(hid_t file, int n_modes, int n_nodes, const float *stress);

/* Write the attributes checked, checked_count, checked_below and missed_chance of /modes. */
shb_status modal_export_check(hid_t file, const modal_check *check);

/* Write the attribute rotor_turns of modes/coriolis, left or right, where there is one. */
shb_status modal_export_turning(hid_t at, fem_turning turning);

/* Write /contact/nodes [entry][3] (pair, right node, left node or -1), /contact/weight [entry] and
 * /contact/coordinates [side][pair][3]. */
shb_status modal_export_contact(hid_t file, const modal_patches *patches);

/* Write /VTKHDF, an UnstructuredGrid of quadratic cells. Its points link to /mesh/nodes. Point data
 * "mode_001 116.684 Hz", ... are views of /modes/shape, which must exist. static_displacement and
 * static_von_mises link to /static where that exists. Source: VTKHDF file format, version 1.0. */
shb_status modal_export_vtk(hid_t file, const mesh_fe *mesh, int n_modes, const double *frequency);

/* Name of a mode's array, from 0: "mode_001 116.684 Hz". */
enum { MODAL_VTK_NAME = 40 };
void modal_vtk_name(int mode, double frequency, char name[MODAL_VTK_NAME]);

#endif
