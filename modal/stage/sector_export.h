/* The modal file of a sector with a disc: version 3, a group a nodal diameter. */
#ifndef MODAL_STAGE_SECTOR_EXPORT_H
#define MODAL_STAGE_SECTOR_EXPORT_H

#include "modal/stage/model_export.h"
#include "modal/stage/sector_solve.h"

/* Write all of it. At the root: provenance, mesh, static deflection. In /nodal_diameter_n: the
 * model, /modes/{shape [m][n][3], stress [m][n][6]}, /residual as a clamped blade has it, and the
 * check that no mode is missing. Shapes and stresses are complex, at 0 and N/2 real. In
 * /nodal_diameter_0 also the patches of the contact. Of several speeds the models of all.
 *   of  in  shapes and stresses of nodal diameter 0 */
shb_status modal_sector_write(hid_t file, const mesh_fe *mesh, const modal_result *first,
                              const modal_fields *of, const modal_sector *sector,
                              const shb_provenance *provenance);

#endif
