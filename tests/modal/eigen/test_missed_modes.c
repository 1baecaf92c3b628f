/* Search for missed modes: a basis without one mode, and the bound of the probability. */
#include "modal/eigen/missed_modes.h"

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

enum { WHOLE = 9, KEPT = 8, COLUMNS = 4 };

/* A basis of the reference's modes without one of them, as after a converged run. */
static void make_basis(const fem_system *system, const modal_eigen *reference, int hidden,
                       modal_block_basis *b) {
  const double *phi;
  int           columns = 0;
  ST            st;
  KSP           ksp;
  EPSGetST(reference->eps, &st);
  STGetKSP(st, &ksp);
  assert_int_equal(modal_block_basis_create(system->M, ksp, COLUMNS, KEPT / COLUMNS + 1, b), 0);
  MatDenseGetArrayRead(reference->phi, &phi);
  for (int i = 0; i < WHOLE && columns < KEPT; i++) {
    if (i == hidden) continue;
    const int to = KEPT - 1 - columns; /* theta ascending */
    if (!b->Q[to / COLUMNS]) b->Q[to / COLUMNS] = malloc((size_t)(b->rows * COLUMNS) * sizeof *phi);
    memcpy(b->Q[to / COLUMNS] + (size_t)(to % COLUMNS) * (size_t)b->rows,
           phi + (size_t)i * (size_t)b->rows, (size_t)b->rows * sizeof *phi);
    b->theta[to]         = 1 / reference->lambda[i];
    b->H[to * KEPT + to] = 1;
    columns++;
  }
  b->n = KEPT / COLUMNS;
  MatDenseRestoreArrayRead(reference->phi, &phi);
}

/* Each of nine modes is hidden in turn. It is found to be missing unless it is the last one. */
static void hidden_mode_is_noticed(void **state) {
  (void)state;
  const double               size[3]  = {0.2, 0.031, 0.011};
  const int                  cells[3] = {14, 4, 2};
  const modal_eigen_settings settings = {.modes = WHOLE};
  mesh_fe                    mesh     = make_box(size, cells);
  fem_system                 system;
  modal_eigen                reference;
  assemble(&mesh, &system);
  solve(&system, &settings, &reference);
  for (int hidden = 0; hidden < WHOLE; hidden++) {
    const double       last = reference.lambda[hidden == WHOLE - 1 ? WHOLE - 2 : WHOLE - 1];
    modal_block_basis  basis;
    modal_missed_modes rest;
    make_basis(&system, &reference, hidden, &basis);
    assert_int_equal(modal_missed_modes_search(&basis, 1 / (last * (1 - 1e-6)), &rest), 0);
    print_message("mode %d hidden: ratio %.6f after %d solves, chance %.1e\n", hidden + 1,
                  rest.ratio, rest.steps, rest.probability);
    assert_int_equal(rest.count, KEPT - 1);
    if (hidden < WHOLE - 1) {
      assert_int_equal(rest.verdict, MODAL_VERDICT_MISSING);
      assert_true(rest.ratio <= last / reference.lambda[hidden] * (1 + 1e-9)); /* a lower bound */
    } else {
      assert_int_equal(rest.verdict, MODAL_VERDICT_COMPLETE);
      assert_true(rest.probability <= 1e-9);
      check_close(rest.ratio, last / reference.lambda[WHOLE - 1], 0.05, "the next mode");
    }
    modal_block_basis_destroy(&basis);
  }
  modal_eigen_destroy(&reference);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* One column, one step: T_0 = 1, so the bound is sqrt(eta^2 N / 2a) / Gamma(3/2) with eta^2 = x/(1
 * - x). Two columns, two steps: eta^2 N / 2a with eta^2 = x/(1 - x)/(2/x - 1)^2. */
static void probability_is_the_closed_form(void **state) {
  (void)state;
  const double N = 3, a = 0.05, x = 1e-3;
  check_close(modal_missed_modes_probability(x, 1, 1, N),
              sqrt(x / (1 - x) * N / (2 * a)) / tgamma(1.5), 1e-12, "one column, one step");
  check_close(modal_missed_modes_probability(0.1, 2, 2, N), 0.1 / 0.9 / (19. * 19) * N / (2 * a),
              1e-12, "two columns, two steps");
}

/* Largest Ritz value of diag(value) after the given steps from a random vector, n <= 64, by Lanczos
 * with full orthogonalisation. */
static double ritz(int n, const double *value, int steps, uint64_t *random) {
  double Q[8][64], T[64] = {0}, w[8], work[64];
  for (int i = 0; i < n; i++) { /* normal: twelve uniform ones */
    Q[0][i] = -6;
    for (int k = 0; k < 12; k++) {
      *random = *random * 6364136223846793005u + 1442695040888963407u;
      Q[0][i] += (double)(*random >> 11) * 0x1p-53;
    }
  }
  for (int k = 0; k < steps; k++) {
    for (int pass = 0; pass < 2; pass++)
      for (int j = 0; j < k; j++) {
        double dot = 0;
        for (int i = 0; i < n; i++) dot += Q[j][i] * Q[k][i];
        for (int i = 0; i < n; i++) Q[k][i] -= dot * Q[j][i];
      }
    double norm = 0;
    for (int i = 0; i < n; i++) norm += Q[k][i] * Q[k][i];
    for (int i = 0; i < n; i++) Q[k][i] /= sqrt(norm);
    for (int j = 0; j <= k; j++)
      for (int i = 0; i < n; i++) T[k * steps + j] += Q[j][i] * value[i] * Q[k][i];
    for (int i = 0; i < n && k + 1 < steps; i++) Q[k + 1][i] = value[i] * Q[k][i];
  }
  PetscBLASInt m = steps, size = 64, info;
  LAPACKsyev_("N", "U", &m, T, &m, w, work, &size, &info);
  assert_int_equal(info, 0);
  return w[steps - 1];
}

/* The bound against 100,000 draws with one column. Counted are draws in which no Ritz value reveals
 * the eigenvalue 1 while the others reach 0.3. The bound holds within a factor of 1000, of which
 * the mass ratio a makes about ten. */
static void chance_holds(void **state) {
  (void)state;
  enum { N = 40, DRAWS = 100000 };
  double   value[N] = {1};
  uint64_t random   = 5;
  for (int i = 1; i < N; i++) value[i] = 0.3 * i / (N - 1);
  for (int steps = 2; steps <= 4; steps++) {
    const double ratio = 0.3;
    int          blind = 0;
    for (int d = 0; d < DRAWS; d++) blind += ritz(N, value, steps, &random) <= ratio;
    const double drawn = (double)blind / DRAWS,
                 bound = modal_missed_modes_probability(ratio, steps, 1, N);
    print_message("%d steps: blind in %.1e of the draws, bound %.1e\n", steps, drawn, bound);
    assert_true(drawn <= bound);
    assert_true(blind == 0 || bound < 1000 * drawn);
    assert_true(steps > 2 || blind > 0);
  }
  assert_true(modal_missed_modes_probability(1, 9, 4, 1e5) == 1);
  assert_true(modal_missed_modes_probability(0.5, 9, 4, 1e5) <
              modal_missed_modes_probability(0.5, 8, 4, 1e5));
  assert_true(modal_missed_modes_probability(0.5, 9, 4, 1e5) >
              modal_missed_modes_probability(0.4, 9, 4, 1e5));
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(hidden_mode_is_noticed),
                                     cmocka_unit_test(probability_is_the_closed_form),
                                     cmocka_unit_test(chance_holds)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
