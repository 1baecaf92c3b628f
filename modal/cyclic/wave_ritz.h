/* Residual modes of a wave: modal/condense/residual_modes.h with Hermitian moments. */
#ifndef MODAL_CYCLIC_WAVE_RITZ_H
#define MODAL_CYCLIC_WAVE_RITZ_H

#include <complex.h>

#include "modal/condense/residual_modes.h"

typedef struct {
  int             n;
  double         *lambda; /* [n] rad2/s2, ascending */
  double complex *weight; /* [blocks * columns][n] of the columns of V_0, V_1, V_2 */
} wave_ritz;

/* Solve the Ritz problem. moment[j]: mu_(j+1), [columns][columns] by rows, made Hermitian in place.
 * Errors: SHB_ERR_IO the eigensolver failed. */
shb_status wave_ritz_create(int columns, double complex *const moment[2 * MODAL_RESIDUAL_BLOCKS],
                            wave_ritz *ritz);
void       wave_ritz_free(wave_ritz *ritz); /* also on a zeroed struct */

/* a = (a + a^H)/2, [n][n]. */
void wave_make_hermitian(double complex *a, int n);

#endif
