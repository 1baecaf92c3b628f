/* Linear elastic material: isotropic, or of any anisotropy made from three axes (single crystals).
 *
 * Strains and stresses as vectors: 11, 22, 33, 12, 13, 23, shear strains doubled. */
#ifndef FEM_ELEMENT_MATERIAL_H
#define FEM_ELEMENT_MATERIAL_H

#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

typedef struct {
  double E;           /* Young's modulus, Pa; anisotropic: the greatest of the three */
  double nu;          /* Poisson's ratio; anisotropic: not used */
  double rho;         /* density, kg/m3 */
  bool   anisotropic; /* C holds instead of E and nu */
  double C[6][6];     /* stiffness in mesh axes, Pa */
} fem_material;

/* Three orthogonal planes of symmetry; cubic if the constants of the axes are equal. nu[ij]: strain along j for one along i
 * under stress along i, so that nu_ij / E_i = nu_ji / E_j. */
typedef struct {
  double E[3];        /* Pa, along axes 1, 2, 3 */
  double nu[3];       /* nu12, nu13, nu23 */
  double G[3];        /* Pa, G12, G13, G23 */
  double axis[3];     /* axis 1 in mesh axes, of any length */
  double in_plane[3]; /* a vector in the plane of axes 1 and 2, on the side of 2 */
} fem_orthotropic;

/* C in mesh axes. SHB_ERR_INPUT: not positive definite, or axes without a direction. */
shb_status fem_material_orthotropic(const fem_orthotropic *from, double rho, fem_material *out);

/* Material of an element: materials[mesh->region], one for each of the mesh's regions; the one where it has none. */
static inline const fem_material *fem_material_at(const fem_material *materials,
                                                  const mesh_fe *mesh, int element) {
  return mesh->region ? &materials[mesh->region[element]] : materials;
}

#endif
