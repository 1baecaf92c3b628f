/* NAME.face.vtkhdf: the contact face at a peak, for ParaView and VTK. */
#ifndef POSTPROC_FIELD_CONTACT_GRID_H
#define POSTPROC_FIELD_CONTACT_GRID_H

#include "mesh/base/publish.h"
#include "postproc/field/contact_map.h"

/* Write a VTKHDF file, version 1.0, type UnstructuredGrid of quadratic faces. Its point data are
 * pressure in Pa, slip in m and dissipation in J/m2. Three more, stuck, slipping and open, are
 * shares of the period.
 *   row         in  peak of the maps
 *   branch      in  of the response, for the root attributes branch, point, frequency (Hz)
 *   provenance  in  for the root attributes
 * Errors: as h5_publish. Source: VTKHDF file format. */
shb_status post_contact_grid(const post_contact_face *face, const post_contact_maps *maps, int row,
                             int branch, double frequency, const shb_provenance *provenance,
                             const char *path);

#endif
