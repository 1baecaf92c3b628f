/* Mass and moment of inertia of a bar at rest and displaced, and the inertia forces of its
 * motions. */
#include "fem/body/rigid_body.h"

#include "mesh/base/vec3.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"

static const double size[3] = {0.2, 0.03, 0.05};

typedef struct {
  mesh_fe     mesh;
  fem_element element;
  fem_system  system;
  fem_body    body;
  Vec         load[FEM_RIGID];
} bar;

static void make_bar(mesh_kind kind, mesh_axis axis, bar *b) {
  const int cells[3] = {3, 2, 2};
  use_elements(kind);
  b->mesh = make_box(size, cells);
  assert_int_equal(fem_element_create(kind, FEM_STANDARD, &b->element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &b->mesh, &steel, FEM_STANDARD, &b->system),
                   0);
  b->body = (fem_body){
      .mesh = &b->mesh, .material = &steel, .element = &b->element, .rotation = {.axis = axis}};
  for (int r = 0; r < FEM_RIGID; r++) MatCreateVecs(b->system.K, NULL, &b->load[r]);
}

static void free_bar(bar *b) {
  for (int r = 0; r < FEM_RIGID; r++) VecDestroy(&b->load[r]);
  fem_system_destroy(&b->system);
  mesh_fe_free(&b->mesh);
}

/* About an axis through the corner: mass times (a^2 + b^2) / 3 of the two sides across. */
static void inertia_has_closed_forms(void **state) {
  (void)state;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++)
    for (int axis = MESH_AXIS_X; axis <= MESH_AXIS_Z; axis++) {
      const double a = size[(axis + 1) % 3], c = size[(axis + 2) % 3];
      const double mass = steel.rho * size[0] * size[1] * size[2];
      double       inertia[FEM_RIGID];
      bar          b;
      make_bar((mesh_kind)kind, (mesh_axis)axis, &b);
      assert_int_equal(fem_rigid_load(&b.body, NULL, &b.system, b.load, inertia), 0);
      for (int r = 0; r < 3; r++) check_close(inertia[r], mass, 1e-13, "mass");
      check_close(inertia[3], mass * (a * a + c * c) / 3, 1e-13, "moment of inertia");
      free_bar(&b);
    }
}

/* Displaced by s along y, about z: the moment gains m (2 s l_y / 2 + s^2). */
static void rotation_is_about_the_deformed_position(void **state) {
  (void)state;
  const double mass = steel.rho * size[0] * size[1] * size[2], s = 0.1;
  double       rest[FEM_RIGID], moved[FEM_RIGID];
  bar          b;
  make_bar(MESH_HEX20, MESH_AXIS_Z, &b);
  double *u = calloc(3 * (size_t)b.mesh.n_nodes, sizeof *u);
  for (int i = 0; i < b.mesh.n_nodes; i++) u[3 * i + 1] = s;
  assert_int_equal(fem_rigid_load(&b.body, NULL, &b.system, b.load, rest), 0);
  assert_int_equal(fem_rigid_load(&b.body, u, &b.system, b.load, moved), 0);
  check_close(moved[3] - rest[3], mass * (s * size[1] + s * s), 1e-12, "moment of inertia");
  free(u);
  free_bar(&b);
}

/* A field that vanishes near the clamp does not meet the mass between free and clamped nodes. Its
 * product with M r is then that with the mass matrix of the free dofs. */
static void loads_are_those_of_the_mass_matrix(void **state) {
  (void)state;
  double inertia[FEM_RIGID], axial[3];
  bar    b;
  make_bar(MESH_TET10, MESH_AXIS_X, &b);
  assert_int_equal(fem_rigid_load(&b.body, NULL, &b.system, b.load, inertia), 0);
  mesh_axis_vector(MESH_AXIS_X, axial);
  Vec    field, product;
  double one, other;
  MatCreateVecs(b.system.M, &field, &product);
  for (int r = 0; r < FEM_RIGID; r++) {
    PetscScalar *value;
    VecGetArray(field, &value);
    for (int i = 0; i < b.mesh.n_nodes; i++) {
      if (b.system.row[i] < 0) continue;
      double v[3] = {r == 0, r == 1, r == 2};
      if (r == 3) vec3_cross(axial, b.mesh.coordinates + 3 * i, v);
      const double x = b.mesh.coordinates[3 * i] / size[0], bump = x > 0.7 ? x - 0.7 : 0;
      for (int d = 0; d < 3; d++) value[3 * b.system.row[i] + d] = bump * v[d];
    }
    VecRestoreArray(field, &value);
    VecDot(field, b.load[r], &one);
    MatMult(b.system.M, field, product);
    PetscScalar *rigid;
    Vec          motion;
    VecDuplicate(field, &motion);
    VecGetArray(motion, &rigid);
    for (int i = 0; i < b.mesh.n_nodes; i++) {
      if (b.system.row[i] < 0) continue;
      double v[3] = {r == 0, r == 1, r == 2};
      if (r == 3) vec3_cross(axial, b.mesh.coordinates + 3 * i, v);
      for (int d = 0; d < 3; d++) rigid[3 * b.system.row[i] + d] = v[d];
    }
    VecRestoreArray(motion, &rigid);
    VecDot(motion, product, &other);
    check_close(one, other, 1e-12, "field . M r");
    VecDestroy(&motion);
  }
  VecDestroy(&field);
  VecDestroy(&product);
  free_bar(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(inertia_has_closed_forms),
                                     cmocka_unit_test(rotation_is_about_the_deformed_position),
                                     cmocka_unit_test(loads_are_those_of_the_mass_matrix)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
