#include "tests/support/fem.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/energy.h"
#include "mesh/base/constants.h"
#include "tests/support/box.h"

const fem_material steel = {.E = 2.1e11, .nu = 0.3, .rho = 7850};

void check_close(double a, double b, double relative, const char *what) {
  if (!(fabs(a - b) <= relative * fabs(b)))
    fail_msg("%s: %.12g, wanted %.12g to %.1e, off by %.2e", what, a, b, relative,
             fabs(a - b) / fabs(b));
}

void check_below(double a, double bound, const char *what) {
  if (!(fabs(a) <= bound)) fail_msg("%s: %.3e, wanted below %.3e", what, a, bound);
}

double tangent_energy(const fem_body *body, const double *state, const double *u) {
  double energy;
  fem_tangent_energies(body, state, 1, u, &energy);
  return energy;
}

double strain_energy(const mesh_fe *mesh, const fem_material *material, const fem_element *element,
                     const double *u) {
  const fem_body body = {.mesh = mesh, .material = material, .element = element};
  return tangent_energy(&body, NULL, u);
}

void isotropic_stiffness(const fem_material *material, double C[6][6]) {
  const fem_lame lame = fem_lame_of(material);
  memset(C, 0, 36 * sizeof(double));
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) C[i][j] = lame.lambda + (i == j ? 2 * lame.mu : 0);
    C[3 + i][3 + i] = lame.mu;
  }
}

static mesh_kind kind = MESH_TET10;

void use_elements(mesh_kind wanted) {
  kind = wanted;
}

mesh_kind used_elements(void) {
  return kind;
}

int use_hexahedra(void **state) {
  (void)state;
  use_elements(MESH_HEX20);
  return 0;
}

fem_element *make_element_tables(fem_rules rules) {
  fem_element *element = malloc(sizeof *element);
  if (element && fem_element_create(kind, rules, element) == 0) return element;
  free(element);
  return NULL;
}

int run_groups_of_elements(const struct CMUnitTest *tests, size_t n, CMFixtureFunction set_up,
                           CMFixtureFunction tear_down) {
  static const char *const name[] = {"tet10", "hex20"};
  int                      failed = 0;
  for (int i = 0; i < 2; i++) {
    use_elements(i ? MESH_HEX20 : MESH_TET10);
    failed += _cmocka_run_group_tests(name[i], tests, n, set_up, tear_down);
  }
  return failed;
}

mesh_fe make_box(const double size[3], const int n[3]) {
  mesh_fe    mesh;
  shb_status status = kind == MESH_HEX20 ? box_hex(size, n, &mesh) : box_mesh(size, n, &mesh);
  if (status != SHB_OK) fail_msg("%s", shb_message());
  return mesh;
}

mesh_fe make_sector(const double size[3], double inner, int blades, const int n[3]) {
  mesh_fe mesh = make_box(size, n);
  assert_int_equal(box_set(&mesh, MESH_ROOT, 2, 0), SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_RIGHT, 1, 0), SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_LEFT, 1, size[1]), SHB_OK);
  const double sector = SHB_TWO_PI / blades;
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, radius = inner + x[2];
    /* tangential is axial x radial: at z > 0, -y; the angle about x grows from z towards -y */
    double angle = (0.5 - x[1] / size[1]) * sector;
    x[1]         = -radius * sin(angle);
    x[2]         = radius * cos(angle);
  }
  return mesh;
}

static double random_unit(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-52 - 1;
}

void straighten(mesh_fe *mesh) {
  const mesh_topology *topology = mesh_topology_of(mesh->kind);
  double              *x        = mesh->coordinates;
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = mesh->connectivity + topology->nodes * e;
    for (int s = 0; s < topology->edges; s++) {
      const int a = node[topology->edge[s][0]], b = node[topology->edge[s][1]];
      for (int d = 0; d < 3; d++)
        x[3 * node[topology->corners + s] + d] = (x[3 * a + d] + x[3 * b + d]) / 2;
    }
  }
}

void shake_inside(mesh_fe *mesh, const double size[3], double amount) {
  uint64_t state = 7;
  for (int i = 0; i < mesh->n_nodes; i++) {
    double *x      = mesh->coordinates + 3 * i;
    int     inside = 1;
    for (int d = 0; d < 3; d++) inside = inside && x[d] > 1e-12 && x[d] < size[d] - 1e-12;
    for (int d = 0; d < 3 && inside; d++) x[d] += amount * random_unit(&state);
  }
  if (mesh->kind == MESH_HEX20) straighten(mesh);
}
