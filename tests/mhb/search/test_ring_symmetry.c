/* Rotations of a ring: the residual turns with the motion, and a wave is its own copy. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/numerics/vector.h"
#include "mhb/search/multistart.h"
#include "mhb/search/ring_symmetry.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = 6, M = 4 };

typedef struct {
  modal_model        blade;
  mhb_settings       settings;
  mhb_mistuned_ring *ring;
  mhb_balance       *balance;
} problem;

static void make(problem *g, const double *deviation, int order) {
  random_model(2, WITH_LEFT | WITH_RESIDUAL, 3, &g->blade);
  g->blade.n_load          = 1;
  g->settings              = random_settings(M);
  g->settings.blades       = N;
  g->settings.engine_order = 1;
  g->settings.subharmonics = order;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, deviation, 1, &g->ring));
  g->settings.ring = g->ring;
  assert_ok(mhb_balance_create(&g->ring->whole, &g->settings, &g->balance));
  mhb_balance_set_preload(g->balance, g->settings.n0[0]);
}

static void drop(problem *g) {
  mhb_balance_destroy(g->balance);
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->blade);
}

/* |r(copy) - copy of r| for all copies of a random motion, relative. order 2: no wave of two
 * periods closes around six blades at engine order 1. The ring is solved all the same. */
static void the_residual_turns_with_the_motion(void **state) {
  static const double deviation[][N] = {
      {0}, {0.02, -0.01, 0.02, -0.01, 0.02, -0.01}, {0.02, -0.01, 0, 0.02, -0.01, 0}};
  static const int rotations[] = {6, 3, 2};
  (void)state;
  for (int which = 0; which < 3; which++)
    for (int order = 1; order <= 2; order++) {
      problem g;
      double  worst = 0, least = INFINITY;
      make(&g, deviation[which], order);
      const mhb_balance *b    = g.balance;
      const size_t       size = sizeof(double) * (size_t)b->n;
      double *x = malloc(size), *turned = malloc(size), *r = malloc(size), *r_turned = malloc(size),
             *r_of_turned     = malloc(size);
      unsigned long long seed = 5;
      for (int i = 0; i < b->n; i++) x[i] = 3 * random_unit(&seed);
      mhb_balance_evaluate(g.balance, x, 1.1, r, NULL, NULL);
      assert_int_equal(mhb_ring_rotations(b), rotations[which]);
      assert_int_equal(mhb_motion_copies(b), order * rotations[which]);
      for (int j = 0; j < mhb_motion_copies(b); j++) {
        mhb_motion_copy(b, x, j, turned);
        mhb_motion_copy(b, r, j, r_turned);
        mhb_balance_evaluate(g.balance, turned, 1.1, r_of_turned, NULL, NULL);
        double moved = 0;
        for (int i = 0; i < b->n; i++) {
          worst = fmax(worst, fabs(r_of_turned[i] - r_turned[i]) / mhb_norm(r, b->n));
          moved += fabs(turned[i] - x[i]) / mhb_norm(x, b->n);
        }
        if (j > 0) least = fmin(least, moved);
      }
      print_message("%d rotations, order %d: %.1e\n", rotations[which], order, worst);
      assert_below(worst, 1e-8); /* the law's tolerance */
      assert_true(least > 0.1);
      free(x);
      free(turned);
      free(r);
      free(r_turned);
      free(r_of_turned);
      drop(&g);
    }
}

static void blades_that_all_differ_have_one_copy(void **state) {
  static const double deviation[N] = {0.03, -0.02, 0.01, 0, -0.04, 0.02};
  problem             g;
  (void)state;
  make(&g, deviation, 1);
  assert_int_equal(mhb_ring_rotations(g.balance), 1);
  assert_int_equal(mhb_ring_repeat(g.ring), N);
  assert_false(mhb_ring_has_waves(g.balance));
  drop(&g);
}

/* The part beside the wave is 0 for the wave, and all of a motion whose mean over rotations is 0.
 * All copies of a motion are one in a set; without them they are six. */
static void a_wave_is_its_own_copy(void **state) {
  static const double none[N] = {0};
  problem             g;
  (void)state;
  make(&g, none, 1);
  const mhb_balance *b = g.balance;
  double             x[b->n], wave[b->n], part[b->n], again[b->n];
  mhb_solution_set   set  = {0};
  unsigned long long seed = 8;
  assert_true(mhb_ring_has_waves(b));
  for (int i = 0; i < b->n; i++) x[i] = random_unit(&seed);
  mhb_ring_beside_wave(b, x, part);
  for (int i = 0; i < b->n; i++) wave[i] = x[i] - part[i];
  assert_true(mhb_norm(part, b->n) > 0.1 && mhb_norm(wave, b->n) > 0.1);
  mhb_ring_beside_wave(b, wave, again);
  assert_below(mhb_norm(again, b->n), 1e-14 * mhb_norm(x, b->n));
  mhb_ring_beside_wave(b, part, again);
  for (int i = 0; i < b->n; i++) again[i] -= part[i];
  assert_below(mhb_norm(again, b->n), 1e-14 * mhb_norm(x, b->n));
  mhb_solution_set_add_copies(&set, b, wave);
  assert_int_equal(set.n_solutions, 1);
  mhb_solution_set_add_copies(&set, b, x);
  assert_int_equal(set.n_solutions, 1 + N);
  for (int j = 0; j < N; j++) {
    mhb_ring_rotate(b, x, j, again);
    assert_true(mhb_solution_set_has(&set, again));
  }
  mhb_solution_set_free(&set);
  drop(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_residual_turns_with_the_motion),
                                     cmocka_unit_test(blades_that_all_differ_have_one_copy),
                                     cmocka_unit_test(a_wave_is_its_own_copy)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
