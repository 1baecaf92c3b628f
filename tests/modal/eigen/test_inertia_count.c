/* Number of eigenvalues below a limit, by negative pivots. */
#include "modal/eigen/inertia_count.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "modal/common/session.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

static void assemble(const mesh_fe *mesh, fem_system *system) {
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, &steel, FEM_STANDARD, system), 0);
}

static void solve(const fem_system *system, const modal_eigen_settings *settings,
                  modal_eigen *eigen) {
  if (modal_eigen_solve(system, settings, eigen) != 0) fail_msg("%s", shb_message());
  assert_int_equal(eigen->n, settings->modes);
}

/* Between two modes the number of negative pivots is that of the modes below, for a clamped and a
 * free body. */
static void inertia_counts(void **state) {
  (void)state;
  const double size[3]  = {0.11, 0.07, 0.05};
  const int    cells[3] = {4, 3, 2};
  for (int clamped = 0; clamped < 2; clamped++) {
    modal_eigen_settings settings = {.modes = 9, .shift = clamped ? 0 : -1e8};
    mesh_fe              mesh     = make_box(size, cells);
    fem_system           system;
    modal_eigen          eigen;
    if (!clamped) mesh.set[MESH_ROOT].n = 0;
    assemble(&mesh, &system);
    solve(&system, &settings, &eigen);
    assert_string_equal(eigen.check.method, "restart");
    for (int i = clamped ? 0 : 6; i < 8; i++) {
      int count;
      assert_int_equal(
          modal_inertia_count(&system, (eigen.lambda[i] + eigen.lambda[i + 1]) / 2, &count), 0);
      assert_int_equal(count, i + 1);
    }
    modal_eigen_destroy(&eigen);
    fem_system_destroy(&system);
    mesh_fe_free(&mesh);
  }
}

/* A system that gives up K has the same modes to the last bit. K can be had again, and they are the
 * same once more. */
static void a_system_may_give_up_its_stiffness(void **state) {
  (void)state;
  const double          size[3]  = {0.11, 0.07, 0.05};
  const int             cells[3] = {4, 3, 2};
  mesh_fe               mesh     = make_box(size, cells);
  fem_system            system;
  modal_spare_stiffness spare    = {&system, {&mesh, &steel, FEM_STANDARD}};
  modal_eigen_settings  settings = {.modes = 9, .check = MODAL_CHECK_INERTIA};
  modal_eigen           kept, given;
  assemble(&mesh, &system);
  solve(&system, &settings, &kept);
  assert_non_null(system.K);
  settings.spare = &spare;
  for (int time = 0; time < 2; time++) {
    solve(&system, &settings, &given);
    assert_null(system.K);
    assert_string_equal(given.check.method, "inertia");
    assert_int_equal(given.check.count, kept.check.count);
    assert_memory_equal(given.lambda, kept.lambda, 9 * sizeof *kept.lambda);
    modal_eigen_destroy(&given);
    assert_int_equal(fem_system_restore(&spare.source, &system), 0);
  }
  modal_eigen_destroy(&kept);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(inertia_counts),
                                     cmocka_unit_test(a_system_may_give_up_its_stiffness)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
