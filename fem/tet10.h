/* Stiffness and mass of the 10-node tetrahedron. */
#ifndef FEM_TET10_H
#define FEM_TET10_H

#include <stdbool.h>

#include "fem/material.h"
#include "fem/quadrature.h"

typedef enum {
  FEM_MASS_EXACT,  /* exact on straight-sided elements, degree 7 on curved ones */
  FEM_MASS_4POINT, /* the 4-point rule of CalculiX's C3D10, for comparisons */
} fem_mass_rule;

/* The rules an assembly needs, tabulated once. */
typedef struct {
  fem_mass_rule mass;
  fem_tet_rule  straight;               /* 4 points: the stiffness integrand is of degree 2 */
  fem_tet_rule  curved;                 /* stiffness of curved elements */
  fem_tet_rule  full;                   /* degree 7: mass of curved elements, N_i N_j det J */
  double        reference_mass[10][10]; /* integral of N_i N_j over the reference element */
} fem_tet10;

/* Lame constants, Pa. */
typedef struct {
  double lambda, mu;
} fem_lame;

fem_lame fem_lame_of(const fem_material *material);

PetscErrorCode fem_tet10_create(fem_mass_rule mass, fem_tet10 *element);

/* Do all mid-side nodes lie in the middle of their edges (to 1e-9 of the edge)? Then J is constant. */
bool fem_tet10_is_straight(const double x[10][3]);

/* The rule that the stiffness of this element uses. */
const fem_tet_rule *fem_tet10_stiffness_rule(const fem_tet10 *element, const double x[10][3]);

/* g[i][d] = dN_i / dx_d at a point of the rule; returns det J. */
double fem_tet10_gradient(const fem_tet_rule *rule, int point, const double x[10][3],
                          double g[10][3]);

/* K = integral of B^T D B, isotropic; rows and columns 3 node + axis.  x in m, K in N/m. */
void fem_tet10_stiffness(const fem_tet10 *element, const fem_material *material,
                         const double x[10][3], double K[30][30]);

/* Scalar mass m_ij = integral of rho N_i N_j dV, kg; the matrix is m_ij times the 3x3 identity. */
void fem_tet10_mass(const fem_tet10 *element, double rho, const double x[10][3], double m[10][10]);

#endif
