/* Meshes and comparisons that the tests of fem and modal share. */
#ifndef TESTS_SUPPORT_FEM_H
#define TESTS_SUPPORT_FEM_H

#include "fem/body/rotating_body.h"
#include "tests/support/check.h"

extern const fem_material steel; /* 210 GPa, 0.3, 7850 kg/m3 */

/* Fails unless |a - b| <= relative |b|. */
void check_close(double a, double b, double relative, const char *what);
/* Fails unless |a| <= bound. */
void check_below(double a, double bound, const char *what);

/* u^T K u of one field, J: of a body about a state (NULL: at rest); of a body without loads. */
double tangent_energy(const fem_body *body, const double *state, const double *u);
double strain_energy(const mesh_fe *mesh, const fem_material *material, const fem_element *element,
                     const double *u);

/* Stiffness of an isotropic material, Pa: strains 11, 22, 33, 12, 13, 23, shear strains doubled. */
void isotropic_stiffness(const fem_material *material, double C[6][6]);

/* The kind of elements of the meshes made from here on; initially tetrahedra. */
void      use_elements(mesh_kind kind);
mesh_kind used_elements(void);
int       use_hexahedra(void **state); /* the same as set-up of a group; 0 */

/* Tables of the elements in use, malloc'ed; NULL if they cannot be made. */
fem_element *make_element_tables(fem_rules rules);

/* An array of tests with tetrahedra, then with hexahedra, as groups tet10 and hex20. Returns the
 * number of failures. */
#define run_with_both_elements(tests, set_up, tear_down) \
  run_groups_of_elements((tests), sizeof(tests) / sizeof *(tests), (set_up), (tear_down))
int run_groups_of_elements(const struct CMUnitTest *tests, size_t n, CMFixtureFunction set_up,
                           CMFixtureFunction tear_down);

/* A box; fails the test if it cannot be made. */
mesh_fe make_box(const double size[3], const int n[3]);

/* An annular sector about the x axis, of curved elements. Box coordinates (x, y, z) become the
 * axial coordinate x, the angle (y / width - 1/2) sector and the radius inner + z. Group root is
 * the inner face and load the outer one. contact_right and contact_left are the sides; the normal
 * of the right one is tangential. */
mesh_fe make_sector(const double size[3], double inner, int blades, const int n[3]);

/* Move every midside node to the middle between the corners of its edge. */
void straighten(mesh_fe *mesh);

/* Move every interior node by up to amount in each direction, repeatably. Hexahedra keep straight
 * edges: then 2x2x2 points integrate the stiffness exactly under constant stress. */
void shake_inside(mesh_fe *mesh, const double size[3], double amount);

#endif
