/* Pairs in a linear state: the stuck system has the linear limit as its solution, harmonic by
 * harmonic, and linear points are recognised. */
#include "mhb/balance/stick_stiffness.h"

#include "mhb/balance/balance.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { M = 3 };

static double complex harmonic(const double *row, int k) {
  return k ? CMPLX(row[2 * k - 1], row[2 * k]) : row[0];
}

/* (I + R_k S) u_k = free_k, k > 0, for the first pair stuck and the second open. */
static void solves_the_linear_limit(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(M);
  mhb_balance *b;
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 8, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  b->law[1].n0 = -1; /* a gap */
  double         x[b->n];
  mhb_pair_kind  kind[2] = {MHB_PAIR_STUCK, MHB_PAIR_OPEN};
  double complex A[36];
  assert_ok(mhb_balance_linear_limit(b, s.frequency[0] + 1.3, MHB_BY_PRELOAD, x));
  for (int k = 1; k <= M; k++) {
    mhb_stick_matrix(2, b->law, kind, k, b->receptance->R + 36 * k, A);
    for (int i = 0; i < 6; i++) {
      double complex sum = -b->receptance->free[k * 6 + i];
      for (int j = 0; j < 6; j++) sum += A[j * 6 + i] * harmonic(x + j * b->nb, k);
      assert_small(cabs(sum), 1e-13);
    }
  }
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* S is symmetric, with no tangential stiffness at k = 0. */
static void springs(void **state) {
  (void)state;
  const mhb_law        law  = {.kv = 2.3, .ku = {1.7, 0.4, 1.1}};
  const double complex x[3] = {CMPLX(0.3, -1), CMPLX(-0.7, 0.2), CMPLX(1.9, 0.6)};
  double complex       p[3];
  mhb_stick_force(&law, 2, x, p);
  assert_small(cabs(p[0] - 2.3 * x[0]), 1e-15);
  assert_small(cabs(p[1] - (1.7 * x[1] + 0.4 * x[2])), 1e-15);
  assert_small(cabs(p[2] - (0.4 * x[1] + 1.1 * x[2])), 1e-15);
  mhb_stick_force(&law, 0, x, p);
  assert_true(p[1] == 0 && p[2] == 0);
}

static void recognises_linear_points(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(M);
  mhb_balance *b;
  random_model(2, WITH_LEFT, 8, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  double x[b->n], r[b->n];
  for (int i = 0; i < b->n; i++) x[i] = i % b->nb ? 0.3 : 0;
  static const struct {
    double n0;
    bool   linear;
  } rows[] = {{1e3, true}, {0.3, false}, {-1e3, true}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    mhb_balance_set_preload(b, rows[i].n0);
    mhb_balance_evaluate(b, x, 1.1, r, NULL, NULL);
    assert_int_equal(mhb_balance_is_linear(b), rows[i].linear);
  }
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solves_the_linear_limit),
      cmocka_unit_test(springs),
      cmocka_unit_test(recognises_linear_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
