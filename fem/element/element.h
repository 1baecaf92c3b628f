/* Stiffness and mass of an element: ten-node tetrahedron or twenty-node hexahedron.
 *
 * n = element->n nodes; x is [n][3] m; matrices are dense by rows. */
#ifndef FEM_ELEMENT_ELEMENT_H
#define FEM_ELEMENT_ELEMENT_H

#include <stdbool.h>

#include "fem/element/material.h"
#include "fem/element/quadrature.h"

enum { FEM_DOFS = 3 * MESH_NODES }; /* of the largest element */

/* Quadrature. The mass is exact (degree 7 in curved tetrahedra, 3x3x3 points in hexahedra) unless
 * it is CalculiX's.
 *
 * The stiffness of a hexahedron with 2x2x2 points converges faster than with 3x3x3 points, which
 * stiffen bending. Its rank is 48 of 54. Where elements lie in a column one by one, motions without
 * energy are left (fem/element/hourglass.h). With two or more elements across, none is left.
 *
 * Four points integrate the stiffness of a tetrahedron with straight sides exactly. Where sides are
 * curved, 27 points are stiffer, and in coarse meshes farther from the converged frequencies. A
 * rule exact to degree 2 keeps the order of convergence (Ciarlet and Raviart 1972, isoparametric
 * elements). Six strains at four points give the rank 24 = 30 - 6: only rigid motions are without
 * energy. Under constant stress four points leave forces inside a body of curved tetrahedra, as
 * shape gradients times the cofactors of J are cubics. The forces fall as the mesh is refined; 27
 * points leave none. */
typedef enum {
  FEM_STANDARD, /* stiffness: tetrahedra 4 points, hexahedra 2x2x2 */
  FEM_CALCULIX, /* CalculiX's C3D10 and C3D20R: the mass too has the points of FEM_STANDARD */
  FEM_FULL,     /* stiffness: tetrahedra 27 points where curved, hexahedra 3x3x3 (C3D20) */
} fem_rules;

/* Tabulated quadrature rules of an assembly. */
typedef struct {
  mesh_kind kind;
  int       n; /* nodes */
  fem_rules rules;
  fem_rule  straight;                                /* stiffness where J is constant */
  fem_rule  curved;                                  /* stiffness elsewhere */
  fem_rule  mass;                                    /* N_i N_j det J where J is not constant */
  double    reference_mass[MESH_NODES * MESH_NODES]; /* [n][n] integral of N_i N_j */
} fem_element;

/* Lame constants, Pa. */
typedef struct {
  double lambda, mu;
} fem_lame;

fem_lame fem_lame_of(const fem_material *material);

PetscErrorCode fem_element_create(mesh_kind kind, fem_rules rules, fem_element *element);

/* Is the map from the reference element affine, to 1e-9 of its edges? J is then constant. */
bool fem_element_is_straight(const fem_element *element, const double x[][3]);

/* Rule for the stiffness of this element. */
const fem_rule *fem_element_stiffness_rule(const fem_element *element, const double x[][3]);

/* g[i][d] = dN_i / dx_d at a point of the rule. Returns det J. */
double fem_element_gradient(const fem_element *element, const fem_rule *rule, int point,
                            const double x[][3], double g[][3]);

/* Derivative of the Green-Lagrange strain (order as in fem/element/material.h) with respect to the
 * displacement of a node, at deformation gradient F: B[.][a] = sym(F^T (e_a g^T)), shear doubled.
 * For F = I this is the linear B. */
void fem_strain_rows(const double F[3][3], const double g[3], double B[6][3]);

/* K += volume B_i^T C B_j for all nodes i <= j and any C; upper triangle of [3n][3n]. */
void fem_add_anisotropic(int n, const double C[6][6], double volume, const double F[3][3],
                         const double g[][3], double *K);

/* K = integral of B^T D B dV, N/m: [3n][3n], rows and columns 3 node + axis. */
void fem_element_stiffness(const fem_element *element, const fem_material *material,
                           const double x[][3], double *K);

/* Scalar mass m_ij = integral of rho N_i N_j dV, kg: [n][n]. The mass matrix is m_ij times the 3x3
 * identity. */
void fem_element_mass(const fem_element *element, double rho, const double x[][3], double *m);

#endif
