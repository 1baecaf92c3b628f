/* Participation factors and effective masses of the modes under motion of the root.
 *
 *   gamma_ir = phi_i^T M r,   effective mass gamma_ir^2   (mass-normalised modes)
 *
 * r: translation along x, y, z, or rotation about the engine axis, clamped nodes included. The
 * effective masses of all modes sum to the mass (moment of inertia) of the body, less a part of the
 * clamped nodes. That part, r_c^T (M_cc - M_cf M_ff^-1 M_fc) r_c, vanishes as the mesh
 * is refined. At speed the modes are those about the equilibrium, and the rotation is that of the
 * deformed blade. */
#ifndef MODAL_EIGEN_PARTICIPATION_H
#define MODAL_EIGEN_PARTICIPATION_H

#include "fem/body/rigid_body.h"
#include "modal/eigen/eigen.h"
#include "modal/hdf5/h5.h"

typedef struct {
  int     n_modes;
  double *gamma;              /* [n_modes][FEM_RIGID] kg^1/2 and, the last, kg^1/2 m */
  double  inertia[FEM_RIGID]; /* of the whole body: kg three times, kg m2 */
} modal_participation;

/* Compute them; out is zeroed before. displacement: [n_nodes][3] m of the equilibrium, NULL at
 * rest. Collective; every rank gets the result. */
shb_status modal_participation_create(const fem_body *body, const double *displacement,
                                      const fem_system *system, const modal_eigen *eigen,
                                      modal_participation *out);

/* Write /modes/participation, effective_mass [m, 3], rotation_participation, effective_inertia [m],
 * and the root attributes mass and inertia. /modes/frequency must exist. */
shb_status modal_participation_write(hid_t file, const modal_participation *participation);

void modal_participation_free(modal_participation *participation); /* also on a zeroed struct */

#endif
