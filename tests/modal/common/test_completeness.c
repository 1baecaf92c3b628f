/* The completeness check finds missed modes: repeated ones, and pairs hidden from the solver. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "modal/common/session.h"
#include "modal/eigen/block_lanczos.h"
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

static PetscInt block_size(const modal_eigen *eigen) {
  PetscInt size = 0;
  modal_block_lanczos_get_size(eigen->eps, &size);
  return size;
}

/* Several copies of the body side by side, without contact. */
static mesh_fe repeat(const mesh_fe *one, int copies, double pitch) {
  const int nodes          = mesh_topology_of(one->kind)->nodes;
  const int face           = mesh_topology_of(one->kind)->face_nodes;
  const int root           = one->set[MESH_ROOT].n;
  mesh_fe   all            = {.kind = one->kind};
  all.n_nodes              = copies * one->n_nodes;
  all.n_elements           = copies * one->n_elements;
  all.coordinates          = malloc(3 * (size_t)all.n_nodes * sizeof *all.coordinates);
  all.node_tag             = calloc((size_t)all.n_nodes, sizeof *all.node_tag);
  all.connectivity         = malloc((size_t)(nodes * all.n_elements) * sizeof *all.connectivity);
  all.element_tag          = calloc((size_t)all.n_elements, sizeof *all.element_tag);
  all.set[MESH_ROOT].n     = copies * root;
  all.set[MESH_ROOT].nodes = malloc((size_t)(copies * root * face) * sizeof(int));
  for (int c = 0; c < copies; c++) {
    const int first = c * one->n_nodes;
    for (int i = 0; i < 3 * one->n_nodes; i++)
      all.coordinates[3 * first + i] = one->coordinates[i] + (i % 3 == 1 ? c * pitch : 0);
    for (int i = 0; i < nodes * one->n_elements; i++)
      all.connectivity[c * nodes * one->n_elements + i] = one->connectivity[i] + first;
    for (int i = 0; i < root * face; i++)
      all.set[MESH_ROOT].nodes[c * root * face + i] = one->set[MESH_ROOT].nodes[i] + first;
  }
  return all;
}

/* Independent bars have every frequency as often as there are bars. A block of four columns finds
 * four of them, until rounding errors bring in the others. */
static void copies_are_found(void **state) {
  (void)state;
  enum { MODES = 12 };
  const double size[3]  = {0.2, 0.031, 0.011};
  const int    cells[3] = {7, 2, 1}, copies[2] = {6, 9};
  mesh_fe      bar = make_box(size, cells);
  for (int k = 0; k < 2; k++) {
    modal_eigen_settings settings = {.modes = MODES, .tolerance = 1e-6};
    mesh_fe              row      = repeat(&bar, copies[k], 1.5 * size[1]);
    fem_system           one, all;
    modal_eigen          single, eigen;
    assemble(&bar, &one);
    assemble(&row, &all);
    solve(&one, &settings, &single);
    solve(&all, &settings, &eigen);
    for (int i = 0; i < MODES; i++)
      check_close(eigen.lambda[i], single.lambda[i / copies[k]], 1e-6, "one of many");
    print_message("%d copies: blocks of %d, checked by %s\n", copies[k], (int)block_size(&eigen),
                  eigen.check.method);
    assert_int_equal(eigen.check.count,
                     /* modes equal to the limit are not below it */
                     (MODES - 1) / copies[k] * copies[k]);
    modal_eigen_destroy(&eigen);
    modal_eigen_destroy(&single);
    fem_system_destroy(&all);
    fem_system_destroy(&one);
    mesh_fe_free(&row);
  }
  mesh_fe_free(&bar);
}

/* Pairs of a square bar, with blocks of one column: the solver finds one of each pair. */
static void pairs_are_found(void **state) {
  (void)state;
  const double               size[3]  = {0.2, 0.02, 0.02};
  const int                  cells[3] = {12, 3, 3};
  const modal_check_kind     kind[2]  = {MODAL_CHECK_AUTO, MODAL_CHECK_INERTIA};
  const modal_eigen_settings usual    = {.modes = 4};
  fem_system                 system;
  modal_eigen                good, eigen;
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_box(size, cells);
  use_elements(MESH_TET10);
  assemble(&mesh, &system);
  solve(&system, &usual, &good);
  assert_int_equal(block_size(&good), 4);
  for (int k = 0; k < 2; k++) {
    modal_eigen_settings settings = {.modes = 4, .tolerance = 1e-6, .check = kind[k]};
    PetscOptionsSetValue(NULL, "-eps_block_size", "1");
    solve(&system, &settings, &eigen);
    PetscOptionsClearValue(NULL, "-eps_block_size");
    assert_int_equal(block_size(&eigen), 2);
    assert_string_equal(eigen.check.method, k == 0 ? "restart" : "inertia");
    for (int i = 0; i < 4; i++) check_close(eigen.lambda[i], good.lambda[i], 1e-6, "eigenvalue");
    modal_eigen_destroy(&eigen);
  }
  modal_eigen_destroy(&good);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* Krylov-Schur has no block basis: its modes are counted by inertia. */
static void others_are_counted(void **state) {
  (void)state;
  const double         size[3]  = {0.2, 0.031, 0.011};
  const int            cells[3] = {12, 3, 2};
  modal_eigen_settings settings = {.modes = 10};
  mesh_fe              mesh     = make_box(size, cells);
  fem_system           system;
  modal_eigen          eigen;
  assemble(&mesh, &system);
  PetscOptionsSetValue(NULL, "-eps_type", EPSKRYLOVSCHUR);
  solve(&system, &settings, &eigen);
  PetscOptionsClearValue(NULL, "-eps_type");
  assert_string_equal(eigen.check.method, "inertia");
  assert_int_equal(eigen.check.count, 9);
  assert_true(eigen.check.probability == 0);
  check_close(eigen.check.limit, eigen.lambda[9] * (1 - 1e-6), 1e-9, "limit");
  modal_eigen_destroy(&eigen);
  settings.check = MODAL_CHECK_NEVER;
  solve(&system, &settings, &eigen);
  assert_string_equal(eigen.check.method, "no");
  assert_true(eigen.check.probability == 1);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(copies_are_found),
                                     cmocka_unit_test(pairs_are_found),
                                     cmocka_unit_test(others_are_counted)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
