/* Static deflection of a rotating rod against the closed form, and the group /static of the
 * file. */
#include "modal/condense/static_deflection.h"

#include "modal/common/session.h"
#include "tests/support/box.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"

/* No lateral contraction: the rod is one-dimensional. */
static const fem_material rod      = {.E = 2.1e11, .rho = 7850};
static const double       size[3]  = {0.31, 0.011, 0.007};
static const int          cells[3] = {8, 1, 1};

typedef struct {
  mesh_fe            mesh;
  fem_element       *element;
  fem_system         system;
  modal_patches      patches;
  modal_condensation to;
  modal_deflection   result;
} scene;

/* Clamped at x = 0, turning about z; the end face x = L is in contact with the ground. */
static void solve(double speed, scene *s) {
  const double one = 1, radial[3] = {1, 0, 0};
  *s         = (scene){.mesh = make_box(size, cells), .element = malloc(sizeof *s->element)};
  int middle = -1;
  for (int i = 0; i < s->mesh.n_nodes; i++) { /* the section's centre lies on the x axis */
    double *x = s->mesh.coordinates + 3 * i;
    x[1] -= size[1] / 2;
    x[2] -= size[2] / 2;
    if (fabs(x[0] - size[0] / 2) < 1e-9 && middle < 0) middle = i;
  }
  assert_ok(box_set(&s->mesh, MESH_CONTACT_RIGHT, 0, size[0]));
  assert_int_equal(fem_element_create(s->mesh.kind, FEM_STANDARD, s->element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &s->mesh, &rod, FEM_STANDARD, &s->system), 0);
  assert_ok(modal_patches_create(&s->mesh, MESH_AXIS_Z, 3, true, 1, &s->patches));
  modal_patches_dofs(&s->patches, &s->to.contact);
  for (int d = 0; d < 3; d++) modal_dofs_add(&s->to.probe, 1, &middle, &one, radial);
  const fem_body body = {&s->mesh, &rod, s->element, {MESH_AXIS_Z, speed}, 0};
  assert_ok(modal_deflection_solve(&body, &s->system, &s->to, &s->patches, NULL, &s->result));
}

static void release(scene *s) {
  modal_deflection_free(&s->result);
  modal_dofs_free(&s->to.contact);
  modal_dofs_free(&s->to.probe);
  modal_patches_free(&s->patches);
  fem_system_destroy(&s->system);
  mesh_fe_free(&s->mesh);
  free(s->element);
}

/* u(x) = rho omega^2/(2 E) (L^2 x - x^3/3), sigma(0) = rho omega^2 L^2/2: a slow rod, whose large
 * displacements and stiffening are below 1e-6. */
static void rod_stretches(void **state) {
  (void)state;
  scene        s;
  const double speed = 200, L = size[0], factor = rod.rho * speed * speed / (2 * rod.E);
  solve(speed, &s);
  const double end = factor * 2 * L * L * L / 3, middle = factor * (L * L * L / 2 - L * L * L / 24);
  check_close(s.result.contact[2], end, 1e-4, "radial motion of the end");
  check_close(s.result.probe[0], middle, 1e-3, "radial motion of the middle");
  check_close(s.result.closing[0], end, 1e-4, "motion along the outward normal");
  check_close(s.result.greatest_displacement, end, 1e-3, "greatest displacement");
  check_close(s.result.greatest_stress, factor * rod.E * L * L, 1e-2, "stress at the clamp");
  const double mass = rod.rho * L * size[1] * size[2];
  check_close(s.result.statics.force[0], -mass * speed * speed * L / 2, 1e-4, "clamp's force");
  check_below(s.result.statics.force[0] + s.result.statics.load[0], 1e-6 * mass * speed * speed * L,
              "balance of forces");
  release(&s);
}

/* Without rotation and pressure the file gets the two root attributes only. */
static void rest_writes_no_group(void **state) {
  (void)state;
  const modal_deflection none   = {0};
  const modal_model      model  = {.n_modes = 1, .n_pairs = 1};
  char                   path[] = "/tmp/shroudhb-deflection-XXXXXX";
  hid_t                  file;
  double                 speed, pressure;
  assert_true(mkstemp(path) >= 0);
  assert_ok(h5_create(path, &file));
  assert_ok(modal_deflection_write(file, &none, 5, 3, &model));
  assert_ok(h5_close(file));
  assert_ok(h5_open(path, &file));
  assert_ok(h5_read_attribute_double(file, "/", "rotor_speed", -1, &speed));
  assert_ok(h5_read_attribute_double(file, "/", "rotor_pressure", -1, &pressure));
  assert_true(speed == 0 && pressure == 0);
  assert_false(h5_exists(file, "/static"));
  assert_ok(h5_close(file));
  remove(path);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rod_stretches),
                                     cmocka_unit_test(rest_writes_no_group)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
