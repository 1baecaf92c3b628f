/* The factor: CHOLMOD against MUMPS and the matrix itself, indefinite matrices, lack of memory. */
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "fem/body/assemble.h"
#include "fem/solver/factor.h"
#include "fem/solver/petsc_error.h"
#include "mesh/base/memory.h"
#include "mesh/base/phases.h"
#include "tests/support/fem.h"

static const char mumps[] = "-st_pc_factor_mat_solver_type";

typedef struct {
  mesh_fe    mesh;
  fem_system system;
} body;

static int create(void **state) {
  static body  b;
  const double size[3]  = {.2, .03, .01};
  const int    cells[3] = {15, 4, 3};
  b.mesh                = make_box(size, cells);
  *state                = &b;
  return fem_system_create(PETSC_COMM_SELF, &b.mesh, &steel, FEM_STANDARD, &b.system);
}

static int destroy(void **state) {
  body *b = *state;
  fem_system_destroy(&b->system);
  mesh_fe_free(&b->mesh);
  return 0;
}

static Mat dense(const body *b, int n) {
  Mat X;
  assert_int_equal(MatCreateDense(PETSC_COMM_SELF, PETSC_DECIDE, PETSC_DECIDE, 3 * b->system.n_free,
                                  n, NULL, &X),
                   0);
  assert_int_equal(MatSetRandom(X, NULL), 0);
  return X;
}

/* K += share M */
static void add_mass(body *b, double share) {
  Mat A;
  assert_int_equal(fem_system_shifted(&b->system, -share, &A), 0);
  MatDestroy(&b->system.K);
  b->system.K = A;
}

/* |K X - B| / (|K| |X|), the backward error. */
static double backward_error(const body *b, Mat X, Mat B) {
  double worst = 0, size, length, norm;
  Vec    x, right, kx;
  int    n;
  MatGetSize(X, NULL, &n);
  MatCreateVecs(b->system.K, NULL, &kx);
  MatNorm(b->system.K, NORM_FROBENIUS, &size);
  for (int c = 0; c < n; c++) {
    MatDenseGetColumnVecRead(X, c, &x);
    MatDenseGetColumnVecRead(B, c, &right);
    MatMult(b->system.K, x, kx);
    VecAXPY(kx, -1, right);
    VecNorm(kx, NORM_2, &norm);
    VecNorm(x, NORM_2, &length);
    worst = fmax(worst, norm / (size * length));
    MatDenseRestoreColumnVecRead(B, c, &right);
    MatDenseRestoreColumnVecRead(X, c, &x);
  }
  VecDestroy(&kx);
  return worst;
}

static void columns_solve_the_system(void **state) {
  const body *b       = *state;
  const int   count[] = {1, 2, 3, 4, 5, 7, 8, 11, 16, 33};
  fem_factor *factor;
  bool        definite;
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor), 0);
  assert_string_equal(fem_factor_program(factor), "CHOLMOD");
  assert_int_equal(fem_factor_update(factor, b->system.K, &definite), 0);
  assert_true(definite);
  for (int i = 0; i < 10; i++) {
    Mat B = dense(b, count[i]), X = dense(b, count[i]);
    assert_int_equal(fem_factor_solve_many(factor, B, X), 0);
    check_below(backward_error(b, X, B), 1e-15, "backward error");
    MatDestroy(&B);
    MatDestroy(&X);
  }
  fem_factor_destroy(&factor);
}

/* Solutions of one, four and seventy columns. */
static void solve_with(const body *b, int threads, double *out) {
  const int   count[] = {1, 4, 70};
  fem_factor *factor;
  bool        definite;
  omp_set_num_threads(threads);
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor), 0);
  assert_int_equal(fem_factor_update(factor, b->system.K, &definite), 0);
  for (int i = 0; i < 3; i++) {
    const size_t  size = 3 * (size_t)b->system.n_free * (size_t)count[i];
    const double *x;
    Mat           B = dense(b, count[i]), X = dense(b, count[i]);
    assert_int_equal(fem_factor_solve_many(factor, B, X), 0);
    check_below(backward_error(b, X, B), 1e-15, "backward error");
    assert_int_equal(MatDenseGetArrayRead(X, &x), 0);
    memcpy(out, x, size * sizeof *x);
    out += size;
    MatDenseRestoreArrayRead(X, &x);
    MatDestroy(&B);
    MatDestroy(&X);
  }
  fem_factor_destroy(&factor);
}

/* A mesh with wide panels, several subtrees and panels in none. */
static void threads_change_no_bit(void **state) {
  (void)state;
  const int    most     = omp_get_max_threads();
  const double size[3]  = {.2, .06, .05};
  const int    cells[3] = {12, 7, 6};
  body         b        = {.mesh = make_box(size, cells)};
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &b.mesh, &steel, FEM_STANDARD, &b.system), 0);
  const size_t count = 75 * 3 * (size_t)b.system.n_free;
  double      *one = malloc(count * sizeof *one), *other = malloc(count * sizeof *one);
  for (int threads = 1; threads <= 3; threads++) {
    solve_with(&b, threads, threads == 1 ? one : other);
    if (threads > 1) assert_memory_equal(one, other, count * sizeof *one);
  }
  omp_set_num_threads(most);
  free(one);
  free(other);
  fem_system_destroy(&b.system);
  mesh_fe_free(&b.mesh);
}

/* One vector, with MUMPS on one rank too, and after the matrix has changed. */
static void both_programs_agree(void **state) {
  body       *b = *state;
  fem_factor *one, *other;
  bool        definite;
  Vec         x, y, right;
  double      norm, difference;
  MatCreateVecs(b->system.K, &x, &right);
  VecDuplicate(x, &y);
  VecSetRandom(right, NULL);
  assert_int_equal(fem_factor_create(b->system.K, 0, &one), 0);
  PetscOptionsSetValue(NULL, mumps, "mumps");
  assert_int_equal(fem_factor_create(b->system.K, 0, &other), 0);
  PetscOptionsClearValue(NULL, mumps);
  assert_string_equal(fem_factor_program(other), "MUMPS");
  for (int pass = 0; pass < 2; pass++) {
    assert_int_equal(fem_factor_update(one, b->system.K, &definite), 0);
    assert_true(definite);
    assert_int_equal(fem_factor_update(other, b->system.K, &definite), 0);
    assert_true(definite);
    assert_int_equal(fem_factor_solve(one, right, x), 0);
    assert_int_equal(fem_factor_solve(other, right, y), 0);
    VecNorm(y, NORM_2, &norm);
    VecAXPY(y, -1, x);
    VecNorm(y, NORM_2, &difference);
    check_below(difference, 1e-8 * norm, "CHOLMOD against MUMPS");
    add_mass(b, 1e6);
  }
  fem_factor_destroy(&one);
  fem_factor_destroy(&other);
  VecDestroy(&x);
  VecDestroy(&y);
  VecDestroy(&right);
}

/* K - w^2 M beyond the first mode (210 Hz), then K again with the same analysis. */
static void indefinite_matrices_are_told(void **state) {
  body        *b       = *state;
  const double squared = 2e6;
  fem_factor  *factor[2];
  bool         definite;
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor[0]), 0);
  PetscOptionsSetValue(NULL, mumps, "mumps");
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor[1]), 0);
  PetscOptionsClearValue(NULL, mumps);
  for (int i = 0; i < 2; i++) {
    for (int sign = -1; sign <= 1; sign += 2) {
      add_mass(b, sign * squared);
      assert_int_equal(fem_factor_update(factor[i], b->system.K, &definite), 0);
      assert_int_equal(definite, sign > 0);
    }
    fem_factor_destroy(&factor[i]);
  }
}

/* The allocator of a sanitizer takes additional memory and address space. */
#ifdef __SANITIZE_ADDRESS__
#define SKIP_UNDER_SANITIZER() skip()
#else
#define SKIP_UNDER_SANITIZER() (void)0
#endif

/* The process takes the memory that the analysis estimates. */
static void memory_is_foreseen(void **state) {
  (void)state;
  SKIP_UNDER_SANITIZER();
  const double size[3]  = {.2, .06, .05};
  const int    cells[3] = {18, 8, 7};
  mesh_fe      mesh     = make_box(size, cells);
  fem_system   system;
  fem_factor  *factor;
  bool         definite;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(fem_factor_create(system.K, 0, &factor), 0);
  const double before = shb_memory_peak(), foreseen = fem_factor_bytes(factor);
  assert_int_equal(fem_factor_update(factor, system.K, &definite), 0);
  const double taken = shb_memory_peak() - before;
  print_message("%.3g MB foreseen, %.3g MB taken\n", 1e-6 * foreseen, 1e-6 * taken);
  assert_true(foreseen > 50e6);
  assert_true(taken > .7 * foreseen && taken < 1.15 * foreseen);
  fem_factor_destroy(&factor);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* With too little memory, one line is reported before anything is factorised. */
static void too_little_memory_is_one_line(void **state) {
  const body   *b = *state;
  struct rlimit was, now;
  fem_factor   *factor = NULL;
  const double  most   = shb_memory_available();
  assert_true(most > 1e8 && most < 1e16);
  getrlimit(RLIMIT_AS, &was);
  PetscPushErrorHandler(fem_petsc_error_handler, NULL);
  assert_int_not_equal(fem_factor_create(b->system.K, 1e15, &factor), 0);
  print_message("%s\n", shb_message());
  assert_non_null(strstr(shb_message(), "GB"));
  assert_null(strchr(shb_message(), '\n'));
  fem_factor_destroy(&factor);
  PetscPopErrorHandler();
  SKIP_UNDER_SANITIZER();
  now          = was;
  now.rlim_cur = (rlim_t)64 << 30;
  assert_int_equal(setrlimit(RLIMIT_AS, &now), 0);
  assert_true(shb_memory_available() <= 64. * (1 << 30));
  setrlimit(RLIMIT_AS, &was);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_is_foreseen), /* first: it measures the peak of the process */
      cmocka_unit_test_setup_teardown(columns_solve_the_system, create, destroy),
      cmocka_unit_test_setup_teardown(both_programs_agree, create, destroy),
      cmocka_unit_test_setup_teardown(indefinite_matrices_are_told, create, destroy),
      cmocka_unit_test(threads_change_no_bit),
      cmocka_unit_test_setup_teardown(too_little_memory_is_one_line, create, destroy)};
  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
