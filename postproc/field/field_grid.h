/* NAME.field.vtkhdf: one period of the whole blade, or of all blades, for ParaView and VTK. */
#ifndef POSTPROC_FIELD_FIELD_GRID_H
#define POSTPROC_FIELD_FIELD_GRID_H

#include "postproc/field/whole_period.h"

enum { POST_LEAST_STEPS = 2, POST_MOST_STEPS = 1000 };

/* Write a VTKHDF file, version 2.0, type UnstructuredGrid, with so many even steps of one period in
 * the group Steps. The mesh is stored once. Point data of each step:
 *
 *   displacement  [step n][3] m, vibration with its mean; double precision, of a ring single
 *   stress        [step n][6] Pa, xx, yy, zz, xy, yz, xz; not of a ring
 *   von_mises     [step n] Pa, signed, of that stress
 *
 * Of all steps: static_displacement [n][3] m and static_stress [n][6] Pa at speed; of a ring the
 * cell data blade.
 *   ring        in  all blades one after the other, else blade 0
 *   provenance  in  for the root attributes
 * Errors: as h5_publish; SHB_ERR_INPUT more than 2 GB. Source: VTKHDF file format, temporal
 * UnstructuredGrid. */
shb_status post_field_grid(const post_period *period, int steps, bool ring,
                           const shb_provenance *provenance, const char *path);

#endif
