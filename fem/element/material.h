/* Linear elastic material: isotropic, or orthotropic with three given axes (single crystals).
 *
 * Strains and stresses are vectors in the order 11, 22, 33, 12, 13, 23, with shear strains
 * doubled. */
#ifndef FEM_ELEMENT_MATERIAL_H
#define FEM_ELEMENT_MATERIAL_H

#include <stdbool.h>

#include "mesh/core/fe_mesh.h"

typedef struct {
  double E;           /* Young's modulus, Pa; anisotropic: the largest of the three */
  double nu;          /* Poisson's ratio; anisotropic: not used */
  double rho;         /* density, kg/m3 */
  bool   anisotropic; /* C replaces E and nu */
  double C[6][6];     /* stiffness in mesh axes, Pa */
} fem_material;

/* Orthotropic constants; cubic if those of the axes are equal. nu_ij is the contraction along j
 * under stress along i, so nu_ij / E_i = nu_ji / E_j. */
typedef struct {
  double E[3];        /* Pa, along axes 1, 2, 3 */
  double nu[3];       /* nu12, nu13, nu23 */
  double G[3];        /* Pa, G12, G13, G23 */
  double axis[3];     /* axis 1 in mesh axes, of any length */
  double in_plane[3]; /* a vector in the plane of axes 1 and 2, on the side of 2 */
} fem_orthotropic;

/* Material with its stiffness in mesh axes.
 * Errors: SHB_ERR_INPUT if the stiffness is not positive definite, or the axes have no
 * direction. */
shb_status fem_material_orthotropic(const fem_orthotropic *from, double rho, fem_material *out);

/* Material of an element.
 *   materials  in  one a region of the mesh, or one if the mesh has no regions */
static inline const fem_material *fem_material_at(const fem_material *materials,
                                                  const mesh_fe *mesh, int element) {
  return mesh->region ? &materials[mesh->region[element]] : materials;
}

#endif
