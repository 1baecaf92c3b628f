/* The parametric blade: root block, lofted airfoil, tip shroud with Z-notch contact faces. */
#ifndef MESH_BLADE_BLADE_H
#define MESH_BLADE_BLADE_H

#include "mesh/base/progress.h"
#include "mesh/base/publish.h"
#include "mesh/base/status.h"
#include "mesh/blade/blade_parameters.h"

/* Mesh the blade with second-order elements and publish a gmsh 4.1 file.
 *
 * The file has the groups root, contact_right, contact_left, load (the pressure side) and a
 * $Comments section with the provenance (mesh/gmsh/provenance.h). The same blade gives the same
 * file. Inverted elements at thin places are straightened, up to 1 % of all. With verbose progress
 * the sharpest corner of all elements is reported.
 *   progress  in  NULL: none is shown
 * Errors: SHB_ERR_INPUT for a geometry that cannot be built; the message names the key of the case.
 * SHB_ERR_INPUT for inverted elements; the message names tags. SHB_ERR_IO, SHB_INTERRUPTED. After
 * an error no file is left behind. */
shb_status mesh_blade_write(const mesh_blade *blade, const char *path,
                            const shb_provenance *provenance, shb_progress *progress);

#endif
