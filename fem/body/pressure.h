/* A steady pressure that follows the deformed surface of group load.
 *
 * With x = X + u on a face, f_i = -p int N_i x,r cross x,s dr ds: the traction -p n on the deformed area, n outward.
 * Its derivative, the load stiffness -df_i/dx_j = p int N_i [N_j,r (e_b cross x,s) - N_j,s (e_b cross x,r)], is symmetric but for an integral
 * along the edge of the loaded surface (Hibbitt 1979; Schweizerhof, Ramm 1984). Only the symmetric part is assembled: the equilibrium is that of
 * the true force all the same, since its residual is exact, and eigenvalues change with the square of what is left out, for phi^T A phi = 0 with A skew. */
#ifndef FEM_BODY_PRESSURE_H
#define FEM_BODY_PRESSURE_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "fem/element/quadrature.h"

/* Forces of pressure p on the nodes of one face, N.  x, f: [nodes][3], x of the deformed face, m. */
void fem_face_pressure(const fem_face_rule *rule, double p, const double x[][3], double f[][3]);

/* Symmetric part of -df/dx, N/m: [3 nodes][3 nodes]. */
void fem_face_pressure_stiffness(const fem_face_rule *rule, double p, const double x[][3],
                                 double *K);

/* out -= f at the block rows of this rank: [last - first][3]. Nothing without pressure. */
PetscErrorCode fem_pressure_residual(const fem_body *body, const fem_system *system,
                                     const double *u, PetscScalar *out);

/* system->K += symmetric load stiffness; assembly is the caller's. */
PetscErrorCode fem_pressure_tangent(const fem_body *body, const double *u, fem_system *system);

/* u^T K u, K that stiffness at the displacements state. */
double fem_pressure_energy(const fem_body *body, const double *state, const double *u);

/* balance -= f at all nodes, load += its resultant: [n_nodes][3], [3]. */
PetscErrorCode fem_pressure_unbalanced(const fem_body *body, const double *u,
                                       double (*unbalanced)[3], double     load[3]);

#endif
