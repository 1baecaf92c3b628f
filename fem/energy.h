/* Strain energy of a displacement field, element by element from the strains. */
#ifndef FEM_ENERGY_H
#define FEM_ENERGY_H

#include "fem/tet10.h"
#include "mesh/fe_mesh.h"

/* u^T K u (twice the strain energy, J) of nodal displacements [n_nodes][3], with the quadrature of
 * fem_tet10_stiffness. The product with the assembled K loses log10(lambda_max / lambda) digits to the cancellation
 * of rigid motion inside each element; strains do not, so that Rayleigh quotients keep about 13 digits. */
double fem_strain_energy(const mesh_fe *mesh, const fem_material *material,
                         const fem_tet10 *element, const double *u);

#endif
