/* The parametric shrouded blade: root block, lofted airfoil, tip shroud with Z-notch contact faces. */
#ifndef MESH_BLADE_BLADE_H
#define MESH_BLADE_BLADE_H

#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"

/* Mesh the blade (second order) and publish it as a gmsh 4.1 file with the groups root, contact_right,
 * contact_left, load (the pressure side) and a $Comments section that holds the provenance (mesh/gmsh/provenance.h).
 * The same blade gives the same file. With verbose progress: the sharpest corner of all elements. Where curved edges invert elements, at thin places, these are made
 * straight if they are at most 1 % of all. progress may be NULL.
 * Errors: SHB_ERR_INPUT for a geometry that cannot be built (what is wrong in the case's words) or inverted
 * elements (tags named); SHB_ERR_IO when the file cannot be written; SHB_INTERRUPTED. Nothing is left behind
 * on failure. */
shb_status mesh_blade_write(const mesh_blade *blade, const char *path,
                            const shb_provenance *provenance, shb_progress *progress);

#endif
