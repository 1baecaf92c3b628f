/* A steady pressure that follows the deformed surface of group load.
 *
 * With x = X + u on a face and the outward normal n, the traction -p n on the deformed area gives
 *   force      f_i = -p int N_i x,r cross x,s dr ds
 *   stiffness  -df_i/dx_j = p int N_i [N_j,r (e_b cross x,s) - N_j,s (e_b cross x,r)] dr ds
 * The stiffness is symmetric but for an integral along the edge of the loaded surface (Hibbitt
 * 1979; Schweizerhof, Ramm 1984). Only the symmetric part is assembled. The equilibrium is still
 * that of the true force, as its residual is exact. Eigenvalues change with the square of the skew
 * part A, as phi^T A phi = 0. */
#ifndef FEM_BODY_PRESSURE_H
#define FEM_BODY_PRESSURE_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "fem/element/quadrature.h"

/* Forces of pressure p on the nodes of one face, N.
 *   x  in   [nodes][3] m, deformed
 *   f  out  [nodes][3] */
void fem_face_pressure(const fem_face_rule *rule, double p, const double x[][3], double f[][3]);

/* Symmetric part of -df/dx, N/m: K is [3 nodes][3 nodes]. */
void fem_face_pressure_stiffness(const fem_face_rule *rule, double p, const double x[][3],
                                 double *K);

/* Subtract the pressure forces at the block rows of this rank; nothing without pressure.
 *   out  in/out  [last - first][3] N */
PetscErrorCode fem_pressure_residual(const fem_body *body, const fem_system *system,
                                     const double *u, PetscScalar *out);

/* Add the symmetric load stiffness to system->K; the caller assembles. */
PetscErrorCode fem_pressure_tangent(const fem_body *body, const double *u, fem_system *system);

/* Symmetric load stiffness of one face, in the frames of its block rows: [3 nodes][3 nodes]. */
PetscErrorCode fem_pressure_face_tangent(const fem_body *body, const double *u,
                                         const fem_system *system, int face, double *K);

/* u^T K u, K the load stiffness at the displacements state, J. */
double fem_pressure_energy(const fem_body *body, const double *state, const double *u);

/* Subtract the pressure forces at all nodes, and add their resultant to load.
 *   unbalanced  in/out  [n_nodes][3] N
 *   load        in/out  [3] N */
PetscErrorCode fem_pressure_unbalanced(const fem_body *body, const double *u,
                                       double (*unbalanced)[3], double     load[3]);

#endif
