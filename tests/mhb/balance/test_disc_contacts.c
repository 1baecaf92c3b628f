/* Many contact pairs on a disc: the low-rank solver against the whole matrix. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "tests/support/check.h"
#include "tests/support/random_disc.h"
#include "tests/support/shroud_face.h"

enum { PAIRS = 12, BLADES = 6, HARMONICS = 3 };

/* The balance with its product, or without: then the receptances are matrices. */
static mhb_balance *balance_of(const modal_nodal_diameters *disc, const mhb_settings *s,
                               bool whole) {
  mhb_balance *b;
  assert_ok(mhb_balance_create(&disc->model[0], s, &b));
  assert_non_null(b->product);
  mhb_balance_set_preload(b, s->n0[0]);
  if (whole) {
    mhb_receptance_product_destroy(b->product);
    b->product = NULL;
  }
  return b;
}

/* x <- solution at a frequency; returns how many pairs neither stick nor stay open. */
static int solve(mhb_balance *b, double omega, double *limit, double *x) {
  mhb_newton *newton;
  int         iterations, moving = 0;
  newton = mhb_newton_create(b->n);
  mhb_newton_bind(newton, b);
  assert_ok(mhb_balance_linear_limit(b, omega, 1, limit));
  memcpy(x, limit, sizeof *x * (size_t)b->n);
  assert_true(mhb_newton_solve(newton, b, omega, 1e-13, x, &iterations) > 0);
  for (int a = 0; a < b->n_pairs; a++)
    moving += b->eval->info[a].share[MHB_STICK] < 1 && b->eval->info[a].share[MHB_SEPARATE] < 1;
  mhb_newton_destroy(newton);
  return moving;
}

static double apart(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(b, n);
}

static void compare(double coriolis, int order) {
  modal_model           face;
  modal_nodal_diameters disc;
  mhb_settings          s    = shroud_face_settings(HARMONICS);
  int                   most = 0;
  shroud_face_model(PAIRS, 150, &face);
  face_disc(&face, BLADES, coriolis, &disc);
  modal_model_free(&face);
  s.nodal_diameters = &disc;
  s.blades          = BLADES;
  s.engine_order    = order;
  mhb_balance *few = balance_of(&disc, &s, false), *whole = balance_of(&disc, &s, true);
  double      *x[2], *limit[2];
  for (int i = 0; i < 2; i++) {
    x[i]     = calloc((size_t)whole->n, sizeof(double));
    limit[i] = calloc((size_t)whole->n, sizeof(double));
  }
  for (double hz = 216; hz < 320; hz += 12) {
    const int moving = solve(few, SHB_TWO_PI * hz, limit[0], x[0]);
    assert_int_equal(solve(whole, SHB_TWO_PI * hz, limit[1], x[1]), moving);
    print_message("order %d, %g Hz: %d of %d move; stuck %.1e, solution %.1e apart\n", order, hz,
                  moving, PAIRS, apart(limit[0], limit[1], whole->n), apart(x[0], x[1], whole->n));
    assert_below(apart(limit[0], limit[1], whole->n), 1e-10);
    assert_below(apart(x[0], x[1], whole->n), 1e-10);
    most = moving > most ? moving : most;
  }
  assert_true(most > 0);
  for (int i = 0; i < 2; i++) {
    free(x[i]);
    free(limit[i]);
  }
  mhb_balance_destroy(few);
  mhb_balance_destroy(whole);
  modal_nodal_diameters_free(&disc);
}

static void waves_forwards_and_backwards(void **state) {
  (void)state;
  compare(0, 1);
  compare(0, 5);
}

static void with_coriolis_terms(void **state) {
  (void)state;
  compare(60, 1);
  compare(60, 5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(waves_forwards_and_backwards),
                                     cmocka_unit_test(with_coriolis_terms)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
