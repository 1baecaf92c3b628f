/* The modal file of a sector with a disc: version 3, a group a nodal diameter. */
#ifndef MODAL_STAGE_SECTOR_EXPORT_H
#define MODAL_STAGE_SECTOR_EXPORT_H

#include "modal/stage/sector_solve.h"

/* Write all of it. At the root: provenance, mesh, static deflection. In /nodal_diameter_n: the
 * model, /modes/shape [m][n][3] complex or, at 0 and N/2, real, and the check that no mode is
 * missing. In /nodal_diameter_0 also the patches of the contact.
 *   shape  in  [m][n_nodes][3] of nodal diameter 0 */
shb_status modal_sector_write(hid_t file, const mesh_fe *mesh, const modal_result *first,
                              const double *shape, const modal_sector *sector,
                              const shb_provenance *provenance);

#endif
