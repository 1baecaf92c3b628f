/* Residual modes from the moments of known modes: exact with few of them, moments matched with
 * many. */
#include "modal/condense/residual_modes.h"

#include "tests/support/check.h"

enum { COLUMNS = 2, BLOCKS = MODAL_RESIDUAL_BLOCKS, MOMENTS = 2 * BLOCKS, MAX_MODES = 12 };

typedef struct {
  int    n;
  double lambda[MAX_MODES], psi[COLUMNS][MAX_MODES];
} modes;

static modes some_modes(int n) {
  modes m = {.n = n};
  for (int i = 0; i < n; i++) {
    m.lambda[i] = 3.1 + 2.3 * i + 0.4 * i * i;
    m.psi[0][i] = 0.7 + 0.21 * i;
    m.psi[1][i] = (i % 2 ? -0.9 : 1.3) + 0.11 * i;
  }
  return m;
}

/* mu_j = sum psi psi^T/lambda^j */
static double moment_of(int n, const double *lambda, const double *a, const double *b, int j) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i] / pow(lambda[i], j);
  return sum;
}

/* The residual modes of m and their shapes psi [COLUMNS][n]. */
static modal_residual_modes solve(const modes *m, double psi[COLUMNS][BLOCKS * COLUMNS]) {
  static double        store[MOMENTS][COLUMNS * COLUMNS];
  double              *moment[MOMENTS];
  modal_residual_modes out;
  for (int j = 0; j < MOMENTS; j++) {
    moment[j] = store[j];
    for (int a = 0; a < COLUMNS; a++)
      for (int b = 0; b < COLUMNS; b++)
        store[j][a * COLUMNS + b] = moment_of(m->n, m->lambda, m->psi[a], m->psi[b], j + 1);
  }
  assert_ok(modal_residual_modes_create(COLUMNS, moment, &out));
  for (int c = 0; c < COLUMNS; c++) /* psi = sum_i (B^T V_i) y_i, B^T V_i = mu_(i+1) */
    for (int k = 0; k < out.n; k++) {
      psi[c][k] = 0;
      for (int i = 0; i < BLOCKS; i++)
        for (int a = 0; a < COLUMNS; a++)
          psi[c][k] += store[i][c * COLUMNS + a] * out.weight[(i * COLUMNS + a) * out.n + k];
    }
  return out;
}

/* As many modes as the Krylov space has vectors: the Ritz modes are the modes. */
static void few_modes_are_exact(void **state) {
  (void)state;
  const modes          m = some_modes(4);
  double               psi[COLUMNS][BLOCKS * COLUMNS];
  modal_residual_modes found = solve(&m, psi);
  assert_int_equal(found.n, 4);
  for (int i = 0; i < 4; i++) {
    assert_near(found.lambda[i] / m.lambda[i], 1, 1e-6);
    for (int a = 0; a < COLUMNS; a++)
      for (int b = 0; b < COLUMNS; b++)
        assert_near(psi[a][i] * psi[b][i], m.psi[a][i] * m.psi[b][i], 1e-5);
  }
  modal_residual_modes_free(&found);
}

/* Twelve modes, six Ritz modes: theta is at least the lowest lambda, and mu_1 .. mu_6 agree. */
static void moments_are_matched(void **state) {
  (void)state;
  const modes          m = some_modes(MAX_MODES);
  double               psi[COLUMNS][BLOCKS * COLUMNS];
  modal_residual_modes found = solve(&m, psi);
  assert_int_equal(found.n, BLOCKS * COLUMNS);
  assert_true(found.lambda[0] >= m.lambda[0] * (1 - 1e-9));
  for (int i = 1; i < found.n; i++) assert_true(found.lambda[i] >= found.lambda[i - 1]);
  for (int j = 1; j <= MOMENTS; j++)
    for (int a = 0; a < COLUMNS; a++)
      for (int b = 0; b < COLUMNS; b++) {
        const double wanted = moment_of(m.n, m.lambda, m.psi[a], m.psi[b], j);
        assert_near(moment_of(found.n, found.lambda, psi[a], psi[b], j), wanted,
                    1e-7 * moment_of(m.n, m.lambda, m.psi[0], m.psi[0], j));
      }
  modal_residual_modes_free(&found);
}

/* psi = 1 at lambda = 10, 20, 40 and s = 5. Left out, these modes change the receptance by
 * s^3/lambda^3/(lambda - s): 2.5e-2, 1.04e-3 and 5.6e-5. */
static void fewest_modes_are_kept(void **state) {
  (void)state;
  double                     lambda[3] = {10, 20, 40}, psi[3] = {1, 1, 1}, scale = 1;
  const modal_residual_modes m = {.n = 3, .lambda = lambda};
  assert_int_equal(modal_residual_modes_needed(&m, 1, psi, &scale, 5, 1e-5), 3);
  assert_int_equal(modal_residual_modes_needed(&m, 1, psi, &scale, 5, 1e-4), 2);
  assert_int_equal(modal_residual_modes_needed(&m, 1, psi, &scale, 5, 1.05e-3), 2);
  assert_int_equal(modal_residual_modes_needed(&m, 1, psi, &scale, 5, 1.1e-3), 1);
  assert_int_equal(modal_residual_modes_needed(&m, 1, psi, &scale, 5, 0.03), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(few_modes_are_exact),
                                     cmocka_unit_test(moments_are_matched),
                                     cmocka_unit_test(fewest_modes_are_kept)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
