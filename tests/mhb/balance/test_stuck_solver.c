/* Many stuck pairs: refinement with one factor against a factor at every frequency. */
#include "mhb/balance/stuck_solver.h"

#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/balance/balance.h"
#include "mhb/numerics/lu.h"
#include "tests/support/check.h"
#include "tests/support/shroud_face.h"

enum { PAIRS = 20, N = 3 * PAIRS };

typedef struct {
  modal_model     model;
  mhb_settings    settings;
  mhb_balance    *balance;
  mhb_receptance *receptance;
  mhb_law         law[PAIRS];
  double          middle; /* rad/s */
} face;

static void open_face(face *f) {
  shroud_face_model(PAIRS, 150, &f->model);
  f->settings = shroud_face_settings(3);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  f->receptance = f->balance->receptance;
  for (int a = 0; a < PAIRS; a++) f->law[a] = f->balance->law[a];
  f->middle = SHB_TWO_PI * 232;
}

static void close_face(face *f) {
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static double distance(const double complex *a, const double complex *b) {
  double away = 0, size = 0;
  for (int i = 0; i < N; i++) {
    away = fmax(away, cabs(a[i] - b[i]));
    size = fmax(size, cabs(b[i]));
  }
  return away / size;
}

/* Distance of both solutions for the load at a frequency, rad/s. */
static double at(face *f, mhb_stuck_solver *solver, int k, double omega,
                 const mhb_pair_kind *kind) {
  static double complex A[N * N], wanted[N], u[N];
  int                   pivot[N];
  mhb_receptance_set_frequency(f->receptance, omega);
  mhb_receptance_update(f->receptance, k);
  for (int i = 0; i < N; i++) wanted[i] = u[i] = f->receptance->free[k * N + i];
  mhb_stick_matrix(PAIRS, f->law, kind, k, f->receptance->R + (size_t)k * N * N, A);
  assert_true(mhb_factor_complex(N, A, pivot));
  mhb_solve_complex(N, A, pivot, 1, wanted);
  assert_true(mhb_stuck_solver_solve(solver, k, f->middle, f->law, kind, u));
  return distance(u, wanted);
}

/* From far below the middle of the range to twice it, through the resonances of the stuck face. */
static void solutions_are_those_of_the_factor(void **state) {
  face              f;
  mhb_stuck_solver *solver;
  mhb_pair_kind     kind[PAIRS];
  (void)state;
  open_face(&f);
  solver = mhb_stuck_solver_create(f.balance->product, 3);
  for (int open = 0; open < PAIRS; open += 7) {
    double worst = 0;
    for (int a = 0; a < PAIRS; a++) kind[a] = a < open ? MHB_PAIR_OPEN : MHB_PAIR_STUCK;
    for (int i = 1; i <= 80; i++) worst = fmax(worst, at(&f, solver, 1, f.middle * i / 40, kind));
    print_message("%d of %d pairs open: %.1e apart\n", open, PAIRS, worst);
    assert_below(worst, 1e-9);
  }
  mhb_stuck_solver_destroy(solver);
  close_face(&f);
}

/* Other stiffness: the factor is made anew. */
static void stiffness_may_change(void **state) {
  face              f;
  mhb_stuck_solver *solver;
  mhb_pair_kind     kind[PAIRS];
  (void)state;
  open_face(&f);
  solver = mhb_stuck_solver_create(f.balance->product, 3);
  for (int a = 0; a < PAIRS; a++) kind[a] = MHB_PAIR_STUCK;
  assert_below(at(&f, solver, 1, f.middle, kind), 1e-11);
  for (int a = 0; a < PAIRS; a++) f.law[a].kv *= 3;
  assert_below(at(&f, solver, 1, f.middle, kind), 1e-11);
  f.law[3].ku[2] *= 2;
  assert_below(at(&f, solver, 1, 1.01 * f.middle, kind), 1e-11);
  mhb_stuck_solver_destroy(solver);
  close_face(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(solutions_are_those_of_the_factor),
                                     cmocka_unit_test(stiffness_may_change)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
