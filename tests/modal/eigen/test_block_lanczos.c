/* Block Lanczos against SLEPc's Krylov-Schur, on bodies with and without repeated modes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

enum { MODES = 20 };

static void solve_with(const fem_system *system, const char *type, const char *block,
                       modal_eigen *eigen) {
  const modal_eigen_settings settings = {.modes = MODES};
  EPSType                    used;
  PetscBool                  same;
  PetscOptionsSetValue(NULL, "-eps_type", type);
  if (block) PetscOptionsSetValue(NULL, "-eps_block_size", block);
  assert_int_equal(modal_eigen_solve(system, &settings, eigen), 0);
  PetscOptionsClearValue(NULL, "-eps_type");
  if (block) PetscOptionsClearValue(NULL, "-eps_block_size");
  EPSGetType(eigen->eps, &used);
  PetscStrcmp(used, type, &same);
  assert_true(same);
  assert_int_equal(eigen->n, MODES);
}

/* Largest component of a mode of one solution outside the span of the other's modes, in the M
 * norm. */
static double outside(const fem_system *system, const modal_eigen *one, const modal_eigen *other) {
  Mat    X;
  double worst = 0, square;
  Vec    x, mx;
  MatCreateVecs(system->M, NULL, &mx);
  MatDuplicate(one->phi, MAT_COPY_VALUES, &X);
  modal_eigen_project_out(system, other, X);
  for (int i = 0; i < MODES - 1; i++) { /* the last may be half of a pair */
    MatDenseGetColumnVecRead(X, i, &x);
    MatMult(system->M, x, mx);
    VecDot(x, mx, &square);
    worst = fmax(worst, sqrt(fmax(square, 0)));
    MatDenseRestoreColumnVecRead(X, i, &x);
  }
  MatDestroy(&X);
  VecDestroy(&mx);
  return worst;
}

static void compare(const double size[3], const int cells[3], double *gap) {
  const char *block[] = {"1", "3", "4", "8"};
  mesh_fe     mesh    = make_box(size, cells);
  fem_system  system;
  modal_eigen reference;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  solve_with(&system, EPSKRYLOVSCHUR, NULL, &reference);
  *gap = INFINITY;
  for (int i = 1; i < MODES; i++)
    *gap = fmin(*gap, reference.lambda[i] / reference.lambda[i - 1] - 1);
  for (int k = *gap < 1e-6 ? 1 : 0; k < 4; k++) { /* single vectors miss pairs */
    modal_eigen eigen;
    solve_with(&system, "block_lanczos", block[k], &eigen);
    double worst = 0;
    for (int i = 0; i < MODES; i++) {
      check_close(eigen.lambda[i], reference.lambda[i], 1e-9, "eigenvalue");
      check_below(eigen.eigen_residual[i], 1e-9, "residual");
      worst = fmax(worst, fabs(eigen.lambda[i] / reference.lambda[i] - 1));
    }
    double out = outside(&system, &eigen, &reference);
    print_message("blocks of %s: eigenvalues to %.1e, modes to %.1e\n", block[k], worst, out);
    check_below(out, 1e-7, "mode outside the other's span");
    modal_eigen_destroy(&eigen);
  }
  modal_eigen_destroy(&reference);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static void modes_are_krylov_schurs(void **state) {
  (void)state;
  const double size[3]  = {0.2, 0.031, 0.011};
  const int    cells[3] = {12, 3, 2};
  double       gap;
  compare(size, cells, &gap);
  assert_true(gap > 1e-6);
}

/* With hexahedra a square bar bends alike in both directions. */
static void pairs_are_found(void **state) {
  (void)state;
  const double size[3]  = {0.2, 0.02, 0.02};
  const int    cells[3] = {12, 3, 3};
  double       gap;
  use_elements(MESH_HEX20);
  compare(size, cells, &gap);
  use_elements(MESH_TET10);
  assert_true(gap < 1e-9);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(modes_are_krylov_schurs),
                                     cmocka_unit_test(pairs_are_found)};
  if (SlepcInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  SlepcFinalize();
  return failures;
}
