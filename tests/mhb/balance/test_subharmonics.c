/* Subharmonic embedding, restriction, time shift and order of a motion. */
#include "mesh/base/constants.h"
#include "mhb/balance/subharmonics.h"
#include "mhb/numerics/vector.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"

enum { M = 3, FACTOR = 4, ROWS = 6, NB = 2 * M + 1, WIDE = M * FACTOR, WIDE_NB = 2 * WIDE + 1 };

static void fill(int n, double *x) {
  unsigned long long seed = 11;
  for (int i = 0; i < n; i++) x[i] = random_unit(&seed);
}

/* Value of one row in real form at an angle of its fundamental. */
static double value_at(const double *a, int m, double angle) {
  double sum = a[0];
  for (int k = 1; k <= m; k++) sum += a[2 * k - 1] * cos(k * angle) - a[2 * k] * sin(k * angle);
  return sum;
}

/* The embedded motion is the same motion, and restriction undoes it. */
static void embeds_and_restricts(void **state) {
  (void)state;
  double x[ROWS * NB], wide[ROWS * WIDE_NB], back[ROWS * NB];
  fill(ROWS * NB, x);
  mhb_subharmonic_embed(ROWS, x, M, FACTOR, wide, WIDE);
  for (int row = 0; row < ROWS; row++)
    assert_near(value_at(wide + row * WIDE_NB, WIDE, 0.3), value_at(x + row * NB, M, 0.3 * FACTOR),
                1e-14);
  mhb_subharmonic_restrict(ROWS, wide, WIDE, FACTOR, back, M);
  assert_memory_equal(x, back, sizeof x);
  mhb_subharmonic_embed(ROWS, x, M, FACTOR, wide, WIDE - 1); /* no room for the last harmonic */
  assert_near(mhb_norm(wide, 2 * WIDE - 1) * mhb_norm(wide, 2 * WIDE - 1),
              mhb_norm(x, NB - 2) * mhb_norm(x, NB - 2), 1e-13);
}

/* A balance of order 6: shifts, parts and orders. */
static void shifts_and_orders(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.3, 12);
  mhb_balance *b;
  s.subharmonics = 6;
  random_model(2, 0, 3, &model);
  assert_ok(mhb_balance_create(&model, &s, &b));
  int    n = b->n;
  double x[n], y[n], z[n], part[n];
  fill(n, x);
  mhb_subharmonic_shift(b, x, 1, y);
  assert_near(value_at(y, b->m, 0.4), value_at(x, b->m, 0.4 + SHB_TWO_PI / 6), 1e-13);
  memcpy(z, x, sizeof z);
  for (int j = 0; j < 6; j++) {
    mhb_subharmonic_shift(b, z, 1, y);
    memcpy(z, y, sizeof z);
  }
  for (int i = 0; i < n; i++) assert_near(z[i], x[i], 1e-13);
  assert_int_equal(mhb_subharmonic_period(b, x), 6);
  for (int d = 1; d <= 3; d++) { /* x less the part that does not repeat after d periods */
    mhb_subharmonic_component(b, x, d, part);
    for (int i = 0; i < n; i++) y[i] = x[i] - part[i];
    assert_int_equal(mhb_subharmonic_period(b, y), d);
    mhb_subharmonic_shift(b, y, d, z);
    for (int i = 0; i < n; i++) assert_near(z[i], y[i], 1e-13);
  }
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(embeds_and_restricts),
      cmocka_unit_test(shifts_and_orders),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
