/* The condensed linear system has the solution of the whole one for any number of threads. Tracing
 * a curve allocates nothing. */
#include <lapacke.h>
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/first_solution.h"
#include "tests/support/allocations.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/shroud_face.h"
#include "tests/support/three_degree.h"

/* ---------------------------------------------------------------- the same solution */

enum { PAIRS = 30, M = 2, N = 3 * PAIRS * (2 * M + 1) };

/* Kinds of the pairs: m moving, s stuck, h stuck with a mean friction that depends on the motion, o
 * open. */
static mhb_balance *mixed_residual(const modal_model *model, const mhb_settings *s,
                                   const char *kinds) {
  mhb_balance *b;
  if (mhb_balance_create(model, s, &b) != SHB_OK) fail_msg("%s", shb_message());
  mhb_balance_set_preload(b, s->n0[0]);
  for (int a = 0; a < b->n_pairs; a++) {
    char kind             = kinds[a % (int)strlen(kinds)];
    b->law[a].n0          = strchr("sh", kind) ? 1e3 : kind == 'o' ? -1e3 : .001 * (a % 3);
    b->law[a].mean_offset = 0;
  }
  return b;
}

static void random_vector(int n, double size, unsigned long long seed, double *x) {
  for (int i = 0; i < n; i++) x[i] = size * random_unit(&seed);
}

/* About zero: what has little preload opens. */
static void random_motion(unsigned long long seed, double *x) {
  random_vector(N, .3, seed, x);
  for (int i = 0; i < N; i += 2 * M + 1) x[i] = 0;
}

/* The load is least when the friction is largest: zero is no admissible mean. */
static void hold_pairs(const mhb_balance *b, const char *kinds, double *x) {
  for (int a = 0; a < b->n_pairs; a++) {
    const mhb_law *law = &b->law[a];
    double        *v = x + 3 * a * b->nb, *u = v + b->nb;
    if (kinds[a % (int)strlen(kinds)] != 'h') continue;
    v[1] = -.5 * law->n0 / law->kv;
    u[1] = .9 * law->mu * law->n0 / law->ku[0];
  }
}

/* x <- the solution of [J column; row] x = rhs by a dense factorization; sign of the
 * determinant. */
static int solve_whole(int n, const double *J, const double *column, const double *row, double *x) {
  int     one = n + (column != NULL), sign = 1;
  int    *pivot = calloc((size_t)one, sizeof(int));
  double *A     = calloc((size_t)one * (size_t)one, sizeof(double));
  for (int j = 0; j < n; j++) {
    memcpy(A + j * one, J + j * n, sizeof(double) * (size_t)n);
    if (row) A[j * one + n] = row[j];
  }
  if (column) memcpy(A + n * one, column, sizeof(double) * (size_t)one);
  assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, one, 1, A, one, pivot, x, one), 0);
  for (int i = 0; i < one; i++) {
    if (A[i * one + i] < 0) sign = -sign;
    if (pivot[i] != i + 1) sign = -sign;
  }
  free(A);
  free(pivot);
  return sign;
}

static double difference(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(b, n);
}

static void check_kinds(const mhb_balance *b, const char *kinds) {
  for (int a = 0; a < b->n_pairs; a++) {
    char          c      = kinds[a % (int)strlen(kinds)];
    mhb_pair_kind wanted = c == 's'   ? MHB_PAIR_STUCK
                           : c == 'h' ? MHB_PAIR_AT_LIMIT
                           : c == 'o' ? MHB_PAIR_OPEN
                                      : MHB_PAIR_NONLINEAR;
    assert_int_equal(b->eval->kind[a], wanted);
  }
}

/* Many pairs are condensed none the less. */
static void leave_low_rank(mhb_condensation *s) {
  mhb_woodbury_destroy(s->low_rank);
  s->low_rank = NULL;
}

/* At one motion: with and without a border, evaluated twice so that pairs known to be still are met
 * too. */
static double compare_at(mhb_balance *b, const char *kinds, int condensed,
                         unsigned long long seed) {
  static double     x[N], r[N + 1], column[N + 1], row[N + 1], rhs[N + 1], wanted[N + 1];
  mhb_condensation *s;
  double *J = malloc(sizeof(double) * N * N), worst = 0, omega = 1.1 + .01 * (double)(seed % 7);
  assert_int_equal(b->n, N);
  s = mhb_condensation_create(b);
  if (condensed) leave_low_rank(s);
  s->accuracy = 1e-15;
  random_motion(seed, x);
  hold_pairs(b, kinds, x);
  random_vector(N + 1, 1, seed + 1, column);
  random_vector(N + 1, 1, seed + 2, row);
  row[N] = column[N];
  for (int round = 0; round < 2; round++)
    for (int border = 0; border < 2; border++) {
      mhb_balance_evaluate(b, x, omega, r, J, NULL);
      check_kinds(b, kinds);
      random_vector(N + 1, 1, seed + 3, rhs);
      memcpy(wanted, rhs, sizeof rhs);
      int sign = solve_whole(N, J, border ? column : NULL, border ? row : NULL, wanted);
      mhb_balance_linearise(b, x, omega, r, NULL);
      assert_true(mhb_condensation_factor(s, border ? column : NULL, border ? row : NULL));
      assert_true(mhb_condensation_solve(s, rhs));
      assert_int_equal(mhb_condensation_sign(s), sign);
      worst = fmax(worst, difference(rhs, wanted, N + border));
    }
  mhb_condensation_destroy(s);
  free(J);
  return worst;
}

static void condensed_is_whole(void **state) {
  (void)state;
  static const char *const kinds[] = {"m",
                                      "s",
                                      "o",
                                      "msso",
                                      "ssssm",
                                      "oom",
                                      "so",
                                      "smmmmmmmmmmmmmo",
                                      "ssssssssssssssssssmo",
                                      "h",
                                      "hoooo",
                                      "hssso",
                                      "hmsso",
                                      "ssssssssshssssm",
                                      "hm"};
  modal_model              model;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 77, &model);
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    mhb_settings s     = random_settings(M);
    double       worst = 0;
    mhb_balance *b     = mixed_residual(&model, &s, kinds[i]);
    for (unsigned long long seed = 0; seed < 6; seed++)
      worst = fmax(worst, compare_at(b, kinds[i], seed < 3, 10 * (seed % 3) + i));
    print_message("%-20s %.1e\n", kinds[i], worst);
    assert_below(worst, 1e-12);
    mhb_balance_destroy(b);
  }
  modal_model_free(&model);
}

/* A change of stiffness at the same frequency must not meet old factors. */
static void a_new_law_is_factored_anew(void **state) {
  (void)state;
  modal_model       model;
  mhb_settings      s = random_settings(M);
  static double     x[N], r[N], first[N], again[N];
  mhb_condensation *system;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 78, &model);
  s.n0[0]        = 1e4;
  mhb_balance *b = mixed_residual(&model, &s, "s");
  system         = mhb_condensation_create(b);
  random_vector(N, .1, 1, x);
  for (int round = 0; round < 2; round++) {
    double             *out = round ? again : first;
    mhb_operating_point at  = b->eval->at;
    at.kv                   = round ? 1.6 : .8;
    at.n0                   = 1e4;
    mhb_balance_set_operating_point(b, &at);
    mhb_balance_linearise(b, x, 1.2, r, NULL);
    random_vector(N, 1, 2, out);
    assert_true(mhb_condensation_factor(system, NULL, NULL) && mhb_condensation_solve(system, out));
  }
  assert_true(difference(first, again, N) > 1e-3);
  mhb_condensation_destroy(system);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- threads */

typedef struct {
  double r[N], slope[N], p[N], step[N + 1];
  int    sign;
} outcome;

static void evaluate_with(int threads, const modal_model *model, outcome *out) {
  mhb_settings      s = random_settings(M);
  static double     x[N], column[N + 1], row[N + 1];
  mhb_condensation *system;
  omp_set_num_threads(threads);
  mhb_balance *b = mixed_residual(model, &s, "sssmo");
  assert_int_equal(b->n_threads, threads);
  system = mhb_condensation_create(b);
  random_motion(5, x);
  random_vector(N + 1, 1, 6, column);
  random_vector(N + 1, 1, 7, row);
  random_vector(N + 1, 1, 8, out->step);
  mhb_balance_linearise(b, x, 1.3, out->r, out->slope);
  memcpy(out->p, b->eval->p, sizeof out->p);
  assert_true(mhb_condensation_factor(system, column, row) &&
              mhb_condensation_solve(system, out->step));
  out->sign = mhb_condensation_sign(system);
  mhb_condensation_destroy(system);
  mhb_balance_destroy(b);
}

static void threads_change_no_bit(void **state) {
  (void)state;
  static outcome one, several;
  modal_model    model;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 79, &model);
  int before = omp_get_max_threads();
  evaluate_with(1, &model, &one);
  for (int threads = 2; threads <= 5; threads += 3) {
    evaluate_with(threads, &model, &several);
    assert_memory_equal(&one.r, &several.r, sizeof one.r);
    assert_memory_equal(&one.slope, &several.slope, sizeof one.slope);
    assert_memory_equal(&one.p, &several.p, sizeof one.p);
    assert_memory_equal(&one.step, &several.step, sizeof one.step);
    assert_int_equal(one.sign, several.sign);
  }
  omp_set_num_threads(before);
  modal_model_free(&model);
}

/* ---------------------------------------------------------------- the loop */

static void walk(const modal_model *model, const mhb_settings *s, double start, int steps) {
  mhb_balance   *b;
  mhb_arclength *path;
  int            iterations, moved = 0;
  assert_int_equal(mhb_balance_create(model, s, &b), SHB_OK);
  mhb_balance_set_preload(b, s->n0[0]);
  path = mhb_balance_curve_create(b, SHB_TWO_PI * s->frequency[0], SHB_TWO_PI * s->frequency[1]);
  double *x = calloc((size_t)b->n, sizeof(double));
  assert_int_equal(mhb_first_solution(mhb_balance_curve_of(path)->newton, b, start, path->tolerance,
                                      x, &iterations),
                   MHB_CONVERGED);
  assert_int_equal(mhb_arclength_start(path, x, start, 1), MHB_CONVERGED);
  allocations = 0;
  for (int i = 0; i < steps; i++) {
    assert_int_equal(mhb_arclength_step(path), MHB_ARCLENGTH_ON);
    for (int a = 0; a < b->n_pairs; a++) moved += b->eval->kind[a] == MHB_PAIR_NONLINEAR;
    mhb_arclength_advance(path);
  }
  int counted = allocations;
  print_message("%d pairs, %d steps, %d with a moving pair: %d allocations\n", b->n_pairs, steps,
                moved, counted);
  assert_true(moved > 0);
  assert_int_equal(counted, 0);
  free(x);
  mhb_arclength_destroy(path);
  mhb_balance_destroy(b);
}

static void the_loop_allocates_nothing(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = shroud_face_settings(5);
  s.n0[0]        = 100;
  tip_contact_beam_model(20, &model);
  walk(&model, &s, SHB_TWO_PI * 215, 40);
  modal_model_free(&model);
  s = shroud_face_settings(3);
  shroud_face_model(10, 150, &model);
  walk(&model, &s, SHB_TWO_PI * 255, 8);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(condensed_is_whole),
      cmocka_unit_test(a_new_law_is_factored_anew),
      cmocka_unit_test(threads_change_no_bit),
      cmocka_unit_test(the_loop_allocates_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
