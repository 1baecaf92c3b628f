/* Meshes and comparisons that the tests of fem/ and modal/ share. */
#ifndef TESTS_SUPPORT_FEM_H
#define TESTS_SUPPORT_FEM_H

#include "fem/body/rotating_body.h"

extern const fem_material steel; /* 210 GPa, 0.3, 7850 kg/m3 */

/* |a - b| <= relative |b|, in double (cmocka's own comparison casts to float). */
void check_close(double a, double b, double relative, const char *what);
/* |a| <= bound */
void check_below(double a, double bound, const char *what);

/* u^T K u of one field, J: of a body about a state (NULL: at rest); of a body without loads. */
double tangent_energy(const fem_body *body, const double *state, const double *u);
double strain_energy(const mesh_fe *mesh, const fem_material *material, const fem_element *element,
                     const double *u);

/* Stiffness of an isotropic material, Pa: strains 11, 22, 33, 12, 13, 23, shear strains doubled. */
void isotropic_stiffness(const fem_material *material, double C[6][6]);

/* The elements of the meshes made from here on; tetrahedra at first. */
void      use_elements(mesh_kind kind);
mesh_kind used_elements(void);

/* Box, failing the test when it cannot be made. */
mesh_fe make_box(const double size[3], const int n[3]);

/* An annular sector about the x axis. Box coordinates (x, y, z) become axial x, angle (y / width -
 * 1/2) sector, radius inner + z. Group root is the inner face, load the outer face, contact_right
 * and contact_left the sides; the normal of the right side is tangential. Elements are curved. */
mesh_fe make_sector(const double size[3], double inner, int blades, const int n[3]);

/* Put every node of an edge in the middle between the edge's corners. */
void straighten(mesh_fe *mesh);

/* Move every node inside the box by up to amount in each direction, reproducibly. Hexahedra keep
 * straight edges, so that 2x2x2 points integrate the stiffness exactly under constant stress. */
void shake_inside(mesh_fe *mesh, const double size[3], double amount);

#endif
