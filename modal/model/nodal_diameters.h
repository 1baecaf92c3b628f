/* Modal models of a sector of a bladed disc, one a nodal diameter, and their file. Free of PETSc.
 *
 * Of N sectors, the next one at +2 pi/N about the axis lags by theta = 2 pi n/N: u_(b+1) = e^(-j
 * theta) u_b. Shapes and residual terms at nodal diameter n are complex for 0 < n < N/2; the terms
 * are Hermitian. A wave that runs backwards, n' = N - n, has the conjugate shapes and terms. Its
 * response to a load f is the conjugate of that of nodal diameter n to conj(f).
 *
 * In the file: groups /nodal_diameter_n, root attributes blades and nodal_diameters
 * (docs/user/own_modes.md). Derivation: docs/theory/cyclic_sector.md. */
#ifndef MODAL_MODEL_NODAL_DIAMETERS_H
#define MODAL_MODEL_NODAL_DIAMETERS_H

#include "modal/model/model.h"

typedef struct modal_nodal_diameters {
  int          blades;    /* N */
  int          n;         /* nodal diameters held */
  int         *diameter;  /* [n] ascending, 0 to N/2; the first is 0 */
  modal_model *model;     /* [n] real parts, and all complex arrays of the load */
  modal_model *imaginary; /* [n] imaginary parts (modal_model_write_complex_at); none: real */
  modal_model *backward;  /* [n] arrays of the load alone, of the backward wave; none: real */
} modal_nodal_diameters;

/* One harmonic's model. */
typedef struct {
  const modal_model *model;
  const modal_model *imaginary; /* NULL: real */
  const modal_model *loads;     /* whose arrays of the load count */
  double             sign;      /* of the imaginary parts */
} modal_wave;

/* Allocate n models of N blades; all zero. */
void modal_nodal_diameters_create(int blades, int n, modal_nodal_diameters *diameters);

/* Write the groups to an open modal file that has its provenance. Sets format_version. */
shb_status modal_nodal_diameters_write(hid_t file, const modal_nodal_diameters *diameters);

/* Read them; n = 0 if the file has no nodal diameters. Errors: as modal_model_read; SHB_ERR_INPUT
 * also if the models do not fit together. */
shb_status modal_nodal_diameters_read(const char *path, modal_nodal_diameters *diameters);

/* Nodal diameter, 0 to blades/2, of a wave whose next blade lags by 2 pi wave/blades, forwards or
 * backwards. */
int modal_nodal_diameter(long wave, int blades);

/* Index of nodal diameter n, or -1. */
int modal_nodal_diameters_find(const modal_nodal_diameters *diameters, int n);

/* Model of a wave whose next blade lags by 2 pi wave/N; wave any whole number. false: the file
 * lacks its nodal diameter, which is *missing. */
bool modal_nodal_diameters_wave(const modal_nodal_diameters *diameters, long wave,
                                modal_wave *found, int *missing);

/* A model with real shapes: the same for every wave. */
modal_wave modal_wave_real(const modal_model *model);

/* Value of an entry from its real and imaginary array; im NULL: real. */
static inline double complex modal_wave_value(const modal_wave *wave, const double *re,
                                              const double *im, size_t i) {
  return CMPLX(re[i], im ? wave->sign * im[i] : 0);
}

void modal_nodal_diameters_free(modal_nodal_diameters *diameters); /* also on a zeroed struct */

#endif
