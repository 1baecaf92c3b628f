/* An element under large displacements: total Lagrangian formulation, St. Venant-Kirchhoff
 * material.
 *
 * With g_i = dN_i/dX, the displacement gradient H and the Lame constants lambda, mu:
 *   F = I + H,  E = (H + H^T + H^T H)/2,  S = lambda tr(E) I + 2 mu E,  p_i = F g_i
 *   force    f_i  = int F S g_i dV
 *   tangent  K_ij = int (g_i . S g_j) I + lambda p_i p_j^T + mu p_j p_i^T + mu (g_i . g_j) F F^T dV
 * For an anisotropic material S = C E, and B_i^T C B_j with the rows of fem_strain_rows replaces
 * the terms with lambda and mu. Quadrature is fem_element_stiffness_rule. For u = 0 the tangent is
 * fem_element_stiffness. */
#ifndef FEM_ELEMENT_FINITE_STRAIN_H
#define FEM_ELEMENT_FINITE_STRAIN_H

#include "fem/element/element.h"

/* Deformation at one point. */
typedef struct {
  double F[3][3]; /* deformation gradient */
  double S[3][3]; /* second Piola-Kirchhoff stress, Pa */
} fem_deformation;

/* H[a][d] = du_a/dX_d = sum_i u_i[a] g_i[d]; rigid translations cancel. */
void fem_displacement_gradient(int n, const double g[][3], const double u[][3], double H[3][3]);

void fem_deformation_at(const fem_material *material, const double H[3][3], fem_deformation *at);

/* Internal forces of the nodes, N.  x, u in m. */
void fem_element_force(const fem_element *element, const fem_material *material,
                       const double x[][3], const double u[][3], double f[][3]);

/* Derivative of the internal forces, N/m, symmetric: [3n][3n], rows and columns 3 node + axis. */
void fem_element_tangent(const fem_element *element, const fem_material *material,
                         const double x[][3], const double u[][3], double *K);

/* Cauchy stress F S F^T / det F: xx, yy, zz, xy, yz, xz, Pa; its von Mises stress, Pa. */
void   fem_cauchy(const fem_deformation *at, double stress[6]);
double fem_von_mises(const double stress[6]);

/* Derivative of the Cauchy stress by the displacement gradient H, Pa: D[stress][3 a + d] belongs to
 * H[a][d]. With dE = sym(F^T dF), dS = C dE and J = det F,
 *   d sigma = (dF S F^T + F dS F^T + F S dF^T)/J - tr(dF F^-1) sigma. */
void fem_cauchy_tangent(const fem_material *material, const fem_deformation *at, double D[6][9]);

/* Largest von Mises stress of the Cauchy stress at the quadrature points of an element, Pa. */
double fem_element_stress(const fem_element *element, const fem_material *material,
                          const double x[][3], const double u[][3]);

#endif
