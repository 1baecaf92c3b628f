/* The ring of a flexible disc in modal coordinates: every nodal diameter has modes of its own.
 *
 * Nodal diameter n, 0 <= n <= N/2, theta = 2 pi/N, contact motion u_b = Phi_n z_n e^(-j n theta b)
 * of sector b. The complex amplitudes z_n are the unitary discrete Fourier transform of coordinates
 * y_b of the sectors, one a mode:
 *   z_n = N^(-1/2) sum_b e^(j n theta b) y_b
 * so that a shift of the ring renames the y_b, as for blades that are coupled by their contacts
 * alone. Real coordinates of z, orthonormal to y: z_0 | sqrt 2 Re z_n, sqrt 2 Im z_n | z_(N/2).
 *
 * Coriolis terms couple the modes of a nodal diameter, z'' + (D + G) z' + diag(w^2) z = f. The
 * amplitudes a of the damped gyroscopic modes do not meet, a' = p a + in f. There are 2 m complex
 * ones in the place of z and z'. At nodal diameters 0 and N/2 they are m conjugate pairs, of which
 * one of each is kept. A clamped blade with Coriolis terms is a disc whose nodal diameters are all
 * alike. Derivations: docs/theory/stability.md, docs/theory/coriolis.md. */
#ifndef MHB_STRUCTURE_DISC_MODES_H
#define MHB_STRUCTURE_DISC_MODES_H

#include <complex.h>

#include "mesh/base/arena.h"
#include "mhb/problem/settings.h"
#include "mhb/structure/receptance.h"

/* Damped gyroscopic modes of every nodal diameter: two halves of m. The poles of the first lie
 * above the real axis, those of the second below. Of real shapes only the first half counts, and
 * the motion is the real part. */
typedef struct {
  double complex *G;            /* [diameter][m][m] 1/s */
  double complex *pole;         /* [diameter][2][m] 1/s */
  double complex *shape;        /* [diameter][2][m][n] contact motion by an amplitude */
  double complex *force;        /* [diameter][2][m][n] rate of an amplitude by -p of the contacts */
  double complex *to_amplitude; /* [diameter][2 m][2 m] from (z, z') */
  double complex *to_state;     /* [diameter][2 m][2 m] back */
} mhb_coupled_modes;

typedef struct mhb_disc_modes {
  int             blades, n, modes, all; /* N; 3 pairs; kept of each diameter, of all in the file */
  int             diameters;             /* N/2 + 1 */
  double         *omega, *zeta;          /* [diameter][modes] rad/s, - */
  double complex *shape;       /* [diameter][modes][n] (v, u, w) of the contact, kg^-1/2 */
  double complex *flexibility; /* [diameter][n][n] static one of all else, m/N; NULL: none */
  double         *fourier;     /* [N][N] real coordinates of z by y */
  modal_wave     *wave;        /* [diameter] and the phase of the next blade */
  double complex *phase;
  mhb_modal_part *part;       /* run-up: of the models at one speed; else NULL */
  mhb_coupled_modes *coupled; /* with Coriolis terms, else NULL */
  shb_arena          arena;
} mhb_disc_modes;

/* The lowest modes of each nodal diameter of settings->nodal_diameters, which must hold all of
 * them; the others answer statically. Without nodal diameters each has the model of the receptance.
 * SHB_ERR_INPUT: a nodal diameter is missing; a gyroscopic mode does not oscillate. */
shb_status mhb_disc_modes_create(const mhb_receptance *receptance, const mhb_settings *settings,
                                 int blades, int modes, mhb_disc_modes **disc);
void       mhb_disc_modes_destroy(mhb_disc_modes *disc);

/* Anew, after the receptance, which it was made with, went to another speed of a run-up. */
void mhb_disc_modes_set(const mhb_receptance *receptance, mhb_disc_modes *disc);

/* First of the real coordinates of a nodal diameter; *count of them, 1 or 2. */
int mhb_disc_modes_first(const mhb_disc_modes *disc, int diameter, int *count);

/* dense [N n][N n] += the map of the sectors' contacts whose symbol at nodal diameter n is
 * block[diameter][n][n], Hermitian. */
void mhb_disc_modes_add_map(const mhb_disc_modes *disc, const double complex *block, double *dense);

/* motion [N n] += that of the contacts by a unit of y of a mode of a blade. */
void mhb_disc_modes_add_motion(const mhb_disc_modes *disc, int blade, int mode, double *motion);

#endif
