/* Equal results on any number of ranks: all ranks against this rank alone. Run under mpiexec -n 1,
 * 2, 3. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/body/partition.h"
#include "modal/common/session.h"
#include "modal/model/receptance.h"
#include "modal/stage/stage.h"
#include "tests/support/fem.h"
#include "tests/support/one_of_each.h"

enum { BLADES = 23 };

static const double      size[3] = {0.04, 1, 0.12}, inner = 0.1;
static const modal_probe probe = {"tip", {0.04, 0.0, 0.22}};

/* Only rank 0 has the mesh at first, as in the stage. */
static void check_ranks(double speed) {
  const int      cells[3] = {4, 4, 10};
  mesh_fe        mesh     = {0};
  modal_settings settings = {.axis     = MESH_AXIS_X,
                             .blades   = BLADES,
                             .speed    = speed,
                             .modes    = 12,
                             .damping  = {.ratio = 0.002},
                             .n_probes = 1,
                             .probe    = &probe};
  const fem_load load     = {
          .kind = FEM_LOAD_PRESSURE, .pressure = 200, .n_harmonics = 1, .factor = {0, 1}};
  settings = one_of_each(settings, 3, false, load);
  modal_result one, all;
  int          rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) mesh = make_sector(size, inner, BLADES, cells);
  assert_int_equal(fem_mesh_broadcast(PETSC_COMM_WORLD, &mesh), 0);
  assert_int_equal(modal_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &one), SHB_OK);
  assert_int_equal(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &all), SHB_OK);
  for (int i = 0; i < settings.modes; i++) {
    check_close(all.model.frequency[i], one.model.frequency[i], 1e-11, "frequency");
    check_below(all.model.eigen_residual[i], 1e-9, "residual of a mode");
  }
  assert_int_equal(all.eigen.check.count, one.eigen.check.count);
  assert_true(all.eigen.check.probability <= 1e-9 && one.eigen.check.probability <= 1e-9);
  for (int i = 0; i < 9 * settings.modes; i++)                           /* signs included */
    check_below(all.model.right[i] - one.model.right[i], 1e-5, "shape"); /* of order 1 */
  for (int i = 0; i < FEM_RIGID * settings.modes; i++)
    check_below(all.participation.gamma[i] - one.participation.gamma[i],
                1e-6 * sqrt(one.participation.inertia[i % FEM_RIGID]), "participation");
  for (int r = 0; r < FEM_RIGID; r++)
    check_close(all.participation.inertia[r], one.participation.inertia[r], 1e-12, "inertia");
  double complex a[18 * 18], b[18 * 18];
  modal_receptance(&one.model, 3000, a);
  modal_receptance(&all.model, 3000, b);
  for (int i = 0; i < 18 * 18; i++) check_below(cabs(a[i] - b[i]), 1e-8 * cabs(a[0]), "receptance");
  modal_result_free(&one);
  modal_result_free(&all);
  mesh_fe_free(&mesh);
}

/* The inertia count sums the pivots of all ranks. */
static void world_counts_alike(void **state) {
  (void)state;
  const modal_eigen_settings settings = {.modes = 12, .check = MODAL_CHECK_INERTIA};
  const int                  cells[3] = {4, 4, 10};
  mesh_fe                    mesh     = make_sector(size, inner, BLADES, cells);
  fem_system                 system;
  modal_eigen                eigen;
  assert_int_equal(fem_system_create(PETSC_COMM_WORLD, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &settings, &eigen), 0);
  assert_string_equal(eigen.check.method, "inertia");
  assert_int_equal(eigen.check.count, 11);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static void world_equals_one_rank(void **state) {
  (void)state;
  check_ranks(0);
}

static void world_equals_one_rank_at_speed(void **state) {
  (void)state;
  check_ranks(6000);
}

static void world_equals_one_rank_with_hexahedra(void **state) {
  (void)state;
  use_elements(MESH_HEX20);
  check_ranks(300);
  use_elements(MESH_TET10);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(world_equals_one_rank),
                                     cmocka_unit_test(world_counts_alike),
                                     cmocka_unit_test(world_equals_one_rank_at_speed),
                                     cmocka_unit_test(world_equals_one_rank_with_hexahedra)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  MPI_Allreduce(MPI_IN_PLACE, &failures, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  modal_session_end(&session, SHB_OK);
  return failures;
}
