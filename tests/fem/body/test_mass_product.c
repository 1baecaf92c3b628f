/* Products with the mass matrix: PETSc's own, any number of columns and threads. */
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fem/body/assemble.h"
#include "fem/body/mass_product.h"
#include "tests/support/fem.h"

static Mat dense(const fem_system *system, int n) {
  Mat X;
  assert_int_equal(
      MatCreateDense(PETSC_COMM_SELF, PETSC_DECIDE, PETSC_DECIDE, 3 * system->n_free, n, NULL, &X),
      0);
  assert_int_equal(MatSetRandom(X, NULL), 0);
  return X;
}

/* Largest |Y - M X| relative to |M X| of a column. */
static double difference(Mat M, Mat X, Mat Y) {
  double worst = 0, norm, error;
  int    n;
  Vec    x, y, mx;
  MatGetSize(X, NULL, &n);
  MatCreateVecs(M, NULL, &mx);
  for (int c = 0; c < n; c++) {
    MatDenseGetColumnVecRead(X, c, &x);
    MatDenseGetColumnVecRead(Y, c, &y);
    MatMult(M, x, mx);
    VecNorm(mx, NORM_2, &norm);
    VecAXPY(mx, -1, y);
    VecNorm(mx, NORM_2, &error);
    worst = PetscMax(worst, error / norm);
    MatDenseRestoreColumnVecRead(Y, c, &y);
    MatDenseRestoreColumnVecRead(X, c, &x);
  }
  VecDestroy(&mx);
  return worst;
}

static void columns_are_multiplied(void **state) {
  (void)state;
  const double size[3]  = {.2, .03, .01};
  const int    cells[3] = {15, 4, 3}, count[] = {1, 3, 4, 5, 9}, most = omp_get_max_threads();
  mesh_fe      mesh = make_box(size, cells);
  fem_system   system;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  for (int i = 0; i < 5; i++) {
    Mat first = NULL;
    for (int threads = 1; threads <= 3; threads++) {
      Mat       X = dense(&system, count[i]), Y = dense(&system, count[i]);
      PetscBool same = PETSC_TRUE;
      omp_set_num_threads(threads);
      assert_int_equal(fem_mass_multiply(system.M, X, Y), 0);
      check_below(difference(system.M, X, Y), 1e-14, "M X against PETSc's");
      if (first) MatEqual(first, Y, &same);
      assert_true(same);
      MatDestroy(&X);
      if (first)
        MatDestroy(&Y);
      else
        first = Y;
    }
    MatDestroy(&first);
  }
  omp_set_num_threads(most);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(columns_are_multiplied)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
