/* Stiffness and mass of an element: ten-node tetrahedron or twenty-node hexahedron.
 *
 * n = element->n nodes; x is [n][3] m, matrices are dense by rows. */
#ifndef FEM_ELEMENT_ELEMENT_H
#define FEM_ELEMENT_ELEMENT_H

#include <stdbool.h>

#include "fem/element/material.h"
#include "fem/element/quadrature.h"

enum { FEM_DOFS = 3 * MESH_NODES }; /* of the largest element */

/* Quadrature. The mass is exact (degree 7 in curved tetrahedra, 3x3x3 points in hexahedra) unless it is CalculiX's.
 * The stiffness of a hexahedron with 2x2x2 points converges faster than with 3x3x3, which stiffen bending, but has rank
 * 48 of 54: where elements lie in a column one by one, motions without energy are left (fem/element/hourglass.h); with two
 * elements across, or more, none is. */
typedef enum {
  FEM_STANDARD, /* stiffness: tetrahedra 4 points (27 where curved), hexahedra 2x2x2 */
  FEM_CALCULIX, /* as CalculiX's C3D10 and C3D20R: the mass with the points of the stiffness too, tetrahedra 4 points
                   also where curved */
  FEM_FULL,     /* stiffness of hexahedra with 3x3x3 points (CalculiX's C3D20) */
} fem_rules;

/* The rules an assembly needs, tabulated once. */
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

/* Is the map from the reference element affine (to 1e-9 of its edges)? Then J is constant. */
bool fem_element_is_straight(const fem_element *element, const double x[][3]);

/* The rule that the stiffness of this element uses. */
const fem_rule *fem_element_stiffness_rule(const fem_element *element, const double x[][3]);

/* g[i][d] = dN_i / dx_d at a point of the rule; returns det J. */
double fem_element_gradient(const fem_element *element, const fem_rule *rule, int point,
                            const double x[][3], double g[][3]);

/* The rows by which a node's displacement changes the Green-Lagrange strain (fem/element/material.h) at the deformation gradient F:
 * B[.][a] = sym(F^T (e_a g^T)), shear doubled; for F = I the usual B. */
void fem_strain_rows(const double F[3][3], const double g[3], double B[6][3]);

/* K += volume B_i^T C B_j of all nodes i <= j, any C: the upper triangle of [3n][3n]. */
void fem_add_anisotropic(int n, const double C[6][6], double volume, const double F[3][3],
                         const double g[][3], double *K);

/* K = integral of B^T D B, N/m: [3n][3n], rows and columns 3 node + axis. */
void fem_element_stiffness(const fem_element *element, const fem_material *material,
                           const double x[][3], double *K);

/* Scalar mass m_ij = integral of rho N_i N_j dV, kg: [n][n]; the matrix is m_ij times the 3x3 identity. */
void fem_element_mass(const fem_element *element, double rho, const double x[][3], double *m);

#endif
