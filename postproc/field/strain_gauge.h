/* Strain gauges: the strain along a direction at a point of the surface. It is evaluated for each
 * mode and residual column, and at the kept points of a response. */
#ifndef POSTPROC_FIELD_STRAIN_GAUGE_H
#define POSTPROC_FIELD_STRAIN_GAUGE_H

#include "postproc/draw/text_buffer.h"
#include "postproc/field/blade_field.h"

/* Where a gauge is wanted, and where it is. */
typedef struct {
  const char     *name;
  double          at[3];        /* m, mesh axes */
  double          direction[3]; /* of any length */
  double          foot[3];      /* m, nearest point of the surface */
  double          along[3]; /* unit vector along the surface: direction without its normal part */
  double complex *mode; /* [wave][n_modes] kg^-1/2/m: strain of each mode; one wave of a blade */
  double complex *residual; /* [wave][n_column] 1/N */
  double          at_speed; /* static strain */
} post_gauge;

/* Place a gauge and evaluate its modes. The strain is along . sym(grad u) along of the element's
 * shape functions at the foot; nothing is averaged over elements. The field is one of
 * post_blade_field_read_motion, of a disc after post_blade_field_match. SHB_ERR_INPUT: the point is
 * farther from the surface than MESH_FE_NEAR times the size of the blade, or the direction is
 * normal to the surface. SHB_ERR_IO: no memory. */
shb_status post_gauge_place(const post_blade_field *field, post_gauge *gauge);
void       post_gauge_free(post_gauge *gauge);

/* Harmonics 0..b->n_harmonics of the strain at a kept point, without the static part. SHB_ERR_IO:
 * no memory. */
shb_status post_gauge_strain(const post_blade_field *field, const post_gauge *gauge,
                             const mhb_branch *branch, int kept, double complex *strain);

/* Append a table (RFC 4180), a row a kept point and gauge:
 *
 *   branch, kind, n0_N, frequency_Hz, point, special, stable, gauge
 *   amplitude       of the excitation's harmonic
 *   peak_to_peak    over a period
 *   mean            harmonic 0
 *   static          at speed, not part of the others; empty at rest
 *
 * Errors: SHB_ERR_IO no memory. */
shb_status post_gauge_table(const post_blade_field *field, const mhb_response *response,
                            int n_gauges, const post_gauge *gauge, post_buffer *out);

#endif
