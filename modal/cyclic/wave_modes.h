/* Lowest modes of a sector at one nodal diameter: K(theta) phi = lambda M(theta) phi by complex
 * block Lanczos, with the check that none is missing. */
#ifndef MODAL_CYCLIC_WAVE_MODES_H
#define MODAL_CYCLIC_WAVE_MODES_H

#include "modal/common/completeness.h"
#include "modal/cyclic/wave_operator.h"

typedef struct {
  int              modes; /* wanted, >= 1 */
  modal_check_kind check; /* AUTO or NEVER */
} wave_settings;

/* Residual of an eigenpair as in modal/eigen/eigen.h. */
typedef struct {
  int             n;
  size_t          order;
  double         *lambda;         /* [n] rad2/s2, ascending */
  double         *eigen_residual; /* [n] */
  double complex *phi, *m_phi;    /* [n][order], phi^H M phi = 1; the mesh fixes the phases */
  modal_check     check;
} wave_modes;

/* Solve; with a mode missing again with blocks of twice the size.
 *
 * The eigenvalues are Rayleigh quotients from the strains of the body about state, as those of
 * nodal diameter 0 (NULL: at rest). Errors: SHB_ERR_INPUT more modes than dofs, an equilibrium that
 * is not stable; SHB_NOT_CONVERGED, also if a mode stays missing; SHB_INTERRUPTED. */
shb_status wave_modes_solve(wave_operator *op, const wave_settings *settings, const fem_body *body,
                            const double *state, wave_modes *out);

/* X -= phi phi^H M X for each column. C: scratch [columns][n]. */
void wave_modes_project_out(const wave_modes *modes, int columns, double complex *X,
                            double complex *C);

void wave_modes_free(wave_modes *modes); /* also on a zeroed struct */

#endif
