/* Linear elastic isotropic material. */
#ifndef FEM_MATERIAL_H
#define FEM_MATERIAL_H

typedef struct {
  double E;   /* Young's modulus, Pa */
  double nu;  /* Poisson's ratio */
  double rho; /* density, kg/m3 */
} fem_material;

#endif
