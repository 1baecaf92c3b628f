/* Static answers to many unit loads: against dense solutions. */
#include "fem/supernodal/unit_loads.h"

#include <cblas.h>
#include <lapacke.h>

#include "tests/support/block_body.h"
#include "tests/support/check.h"

typedef struct {
  block_body     of;
  fem_unit_loads u;
  double        *phi, *lambda; /* [modes][n] in the order of the dofs, and of the factor */
  double        *phi_factor;
  double         shares[2]; /* least and greatest that was asked with */
  int            asked, most;
} scene;

static bool go_on(void *context, double share) {
  scene *s     = context;
  s->shares[0] = fmin(s->shares[0], share);
  s->shares[1] = fmax(s->shares[1], share);
  return ++s->asked <= s->most;
}

/* The lowest modes of the dense pencil. */
static void find_modes(scene *s, int modes) {
  const int    n   = s->of.f.n;
  const size_t all = (size_t)n * (size_t)n * sizeof(double);
  double      *K = malloc(all), *M = malloc(all);
  int         *fail = malloc((size_t)n * sizeof *fail), found;
  memcpy(K, s->of.K, all);
  memcpy(M, s->of.M, all);
  s->phi_factor = malloc(((size_t)n * (size_t)modes + 1) * sizeof *s->phi_factor);
  s->phi        = malloc(((size_t)n * (size_t)modes + 1) * sizeof *s->phi);
  s->lambda     = malloc((size_t)n * sizeof *s->lambda);
  assert_true(K && M && fail && s->phi && s->phi_factor && s->lambda);
  if (modes > 0)
    assert_int_equal(LAPACKE_dsygvx(LAPACK_COL_MAJOR, 1, 'V', 'I', 'L', n, K, n, M, n, 0, 0, 1,
                                    modes, 0, &found, s->lambda, s->phi_factor, n, fail),
                     0);
  for (int m = 0; m < modes; m++)
    for (int i = 0; i < n; i++) s->phi[m * n + i] = s->phi_factor[m * n + s->of.f.row[i]];
  free(K);
  free(M);
  free(fail);
}

static scene *make(block_grid grid, int modes, int loads) {
  scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  block_body_make(grid, loads, &s->of);
  find_modes(s, modes);
  s->shares[0] = INFINITY;
  s->most      = 1 << 30;
  s->u         = (fem_unit_loads){.tree        = {&s->of.f.panels, s->of.f.value, s->of.f.place},
                                  .node_start  = s->of.start,
                                  .node_column = s->of.column,
                                  .node_mass   = s->of.mass,
                                  .modes       = modes,
                                  .phi         = s->phi,
                                  .lambda      = s->lambda,
                                  .n_loads     = loads,
                                  .start       = s->of.load_start,
                                  .row         = s->of.dof,
                                  .weight      = s->of.weight,
                                  .go_on       = go_on,
                                  .context     = s,
                                  .room        = 1e9};
  return s;
}

static void drop(scene *s) {
  block_body_free(&s->of);
  free(s->phi);
  free(s->phi_factor);
  free(s->lambda);
  free(s);
}

/* X <- P K^-1 X of columns [count][n], P = 1 - phi phi^T M. */
static void answer(const scene *s, const double *L, int count, double *X) {
  const int n = s->of.f.n, modes = s->u.modes;
  LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, count, L, n, X, n);
  if (modes == 0) return;
  double *MX = malloc((size_t)(n * count) * sizeof *MX), *C = malloc((size_t)(modes * count) * 8);
  cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, n, count, 1, s->of.M, n, X, n, 0, MX, n);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, modes, count, n, 1, s->phi_factor, n, MX, n,
              0, C, modes);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, count, modes, -1, s->phi_factor, n, C,
              modes, 1, X, n);
  free(MX);
  free(C);
}

/* Greatest difference of R from b^T X, relative to its greatest entry. */
static double difference(const scene *s, const double *X, const double *R) {
  const int n = s->of.f.n, loads = s->u.n_loads;
  double   *wanted = malloc((size_t)(loads * loads) * sizeof *wanted), worst = 0, most = 0;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, loads, loads, n, 1, s->of.b, n, X, n, 0,
              wanted, loads);
  for (int i = 0; i < loads * loads; i++) {
    worst = fmax(worst, fabs(R[i] - wanted[i]));
    most  = fmax(most, fabs(wanted[i]));
  }
  free(wanted);
  return worst / most;
}

static void check(scene *s) {
  const size_t n = (size_t)s->of.f.n, loads = (size_t)s->u.n_loads;
  double      *R = malloc(loads * loads * 8), *R2 = malloc(loads * loads * 8);
  double      *L = malloc(n * n * 8), *V = malloc(n * loads * 8), *MV = malloc(n * loads * 8);
  assert_int_equal(fem_unit_loads_solve(&s->u, R, R2), FEM_LOADS_SOLVED);
  memcpy(L, s->of.K, n * n * sizeof *L);
  memcpy(V, s->of.b, n * loads * sizeof *V);
  assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)n, L, (int)n), 0);
  answer(s, L, (int)loads, V);
  const double first = difference(s, V, R);
  cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, (int)n, (int)loads, 1, s->of.M, (int)n, V,
              (int)n, 0, MV, (int)n);
  answer(s, L, (int)loads, MV);
  const double second = difference(s, MV, R2);
  print_message("%d rows, %d modes, %d loads: R %.1e, R2 %.1e\n", (int)n, s->u.modes, (int)loads,
                first, second);
  assert_below(first, 1e-13);
  assert_below(second, 1e-13);
  for (size_t i = 0; i < loads; i++)
    for (size_t j = 0; j < i; j++)
      assert_true(R[i * loads + j] == R[j * loads + i] && R2[i * loads + j] == R2[j * loads + i]);
  assert_true(s->asked > 0 && s->shares[0] >= 0 && s->shares[1] <= 1);
  free(R);
  free(R2);
  free(L);
  free(V);
  free(MV);
}

static block_grid bar(void) {
  return block_grid_make((const int[]){11, 4, 2}, 1, 1);
}

static void answers_without_the_modes(void **state) {
  (void)state;
  scene *s = make(bar(), 3, 23);
  check(s);
  drop(s);
}

static void answers_without_a_mode(void **state) {
  (void)state;
  scene *s = make(bar(), 0, 7);
  check(s);
  drop(s);
}

/* 170 loads are two blocks of columns. */
static void many_loads(void **state) {
  (void)state;
  scene *s = make(block_grid_make((const int[]){9, 3, 2}, 1, 1), 2, 170);
  check(s);
  drop(s);
}

static void two_bodies_and_small_ones(void **state) {
  (void)state;
  scene *two = make(block_grid_make((const int[]){5, 3, 2}, 1, 2), 2, 11);
  check(two);
  drop(two);
  for (int n = 1; n < 6; n++) {
    scene *s = make(block_grid_line(n, 1, false), 1, 3);
    check(s);
    drop(s);
  }
}

static void it_stops_when_asked_to(void **state) {
  (void)state;
  scene *s = make(bar(), 1, 5);
  double R[25], R2[25];
  assert_int_equal(fem_unit_loads_solve(&s->u, R, R2), FEM_LOADS_SOLVED);
  const int calls = s->asked;
  for (s->most = 0; s->most < calls; s->most++) {
    s->asked = 0;
    assert_int_equal(fem_unit_loads_solve(&s->u, R, R2), FEM_LOADS_STOPPED);
  }
  print_message("asked %d times\n", calls);
  assert_true(calls > 3);
  drop(s);
}

/* What does not fit is told before the work. */
static void what_does_not_fit_is_told(void **state) {
  (void)state;
  scene *s = make(bar(), 1, 5);
  double R[25], R2[25];
  s->u.room = 1e5;
  assert_int_equal(fem_unit_loads_solve(&s->u, R, R2), FEM_LOADS_NO_ROOM);
  assert_int_equal(s->asked, 0);
  drop(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(answers_without_the_modes),
      cmocka_unit_test(answers_without_a_mode),
      cmocka_unit_test(many_loads),
      cmocka_unit_test(two_bodies_and_small_ones),
      cmocka_unit_test(it_stops_when_asked_to),
      cmocka_unit_test(what_does_not_fit_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
