/* Stability in a sweep: marked flips and Neimark-Sacker points, unstable parts, numbers of threads,
 * points that are not judged. */
#include <complex.h>
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

static mhb_response *sweep(const modal_model *model, mhb_settings *s, double from, double to) {
  mhb_response *response;
  s->frequency[0] = from / SHB_TWO_PI;
  s->frequency[1] = to / SHB_TWO_PI;
  if (mhb_forced_response(model, s, NULL, NULL, NULL, &response) != SHB_OK)
    fail_msg("%s", shb_message());
  return response;
}

static double omega(const mhb_branch *b, int point) {
  return SHB_TWO_PI * b->frequency[point];
}

static double complex multiplier(const mhb_response *r, const mhb_branch *b, int point, int i) {
  return b->multipliers[point * r->n_multipliers + i];
}

static int specials(const mhb_branch *b, int special, int *at) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++)
    if (b->special[i] == special && n < 16) at[n++] = i;
  return n;
}

/* Between the two points the solution exists, and time integration leaves it. The reference sampled
 * its friction events: 2e-4. */
static void neimark_sacker_points_are_marked(void **state) {
  (void)state;
  static const double wanted[2][2] = {{1.20060, 1.200586}, {1.25635, 1.256349}};
  modal_model         model;
  three_degree_model(&model);
  mhb_settings      s = ground_settings(0.4, 0.8, 0.5, 0.1, 15);
  mhb_response     *r = sweep(&model, &s, 0.8, 1.7);
  const mhb_branch *b = &r->branch[2];
  int               at[16];
  assert_int_equal(specials(b, MHB_NEIMARK_SACKER, at), 2);
  assert_int_equal(specials(b, MHB_FLIP, at + 2), 0);
  for (int i = 0; i < 2; i++) {
    double complex mu = multiplier(r, b, at[i], 0);
    print_message("%.6f: %.6f%+0.6fj\n", omega(b, at[i]), creal(mu), cimag(mu));
    assert_near(omega(b, at[i]), wanted[i][0], 2e-4);
    assert_near(omega(b, at[i]), wanted[i][1], 2e-5);
    assert_near(cabs(mu), 1, 1e-5);
    assert_true(fabs(cimag(mu)) > 0.1);
    assert_true(conj(mu) == multiplier(r, b, at[i], 1));
    assert_true(b->error_newton[at[i]] < 1e-9);
  }
  assert_true(at[1] > at[0] + 3);
  for (int i = at[0] + 1; i < at[1]; i++) {
    assert_true(omega(b, i) > omega(b, i - 1)); /* in order along the curve */
    assert_int_equal(b->stable[i], 0);
    assert_int_equal(b->loss[i], MHB_LOSS_NEIMARK_SACKER);
    assert_int_equal(b->judged[i], MHB_BY_MULTIPLIERS);
    assert_true(cabs(multiplier(r, b, i, 0)) > 1.001);
  }
  for (int i = 0; i < at[0]; i++) assert_int_equal(b->stable[i], 1);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* The middle branch is unstable, the others are not; no flip, no pair. */
static void middle_branches_are_unstable(void **state) {
  (void)state;
  static const struct { double n0, F; } rows[] = {{-4.5, 0.1}, {1, 0.06}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(0.02, 0, rows[i].F, &model);
    mhb_settings      s = ground_settings(0, 9, 1, rows[i].n0, 31);
    mhb_response     *r = sweep(&model, &s, 0.5, 3.6);
    const mhb_branch *b = &r->branch[2];
    int               fold[16], between = 0;
    assert_int_equal(specials(b, MHB_FOLD, fold), 2);
    for (int p = 0; p < b->n_points; p++) {
      if (p == fold[0] || p == fold[1]) continue; /* a multiplier at 1 */
      int inside = p > fold[0] && p < fold[1];
      assert_int_equal(b->stable[p], !inside);
      assert_int_equal(b->loss[p], inside ? MHB_LOSS_FOLD : MHB_NO_LOSS);
      assert_true(b->special[p] < MHB_FLIP);
      between +=
          inside && b->judged[p] == MHB_BY_MULTIPLIERS && creal(multiplier(r, b, p, 0)) > 1.001;
    }
    print_message("%d of %d between the folds by multipliers\n", between, fold[1] - fold[0] - 1);
    assert_true(between > 5 && between >= fold[1] - fold[0] - 3);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
}

/* A gap with a hard contact: the motion doubles its period, and returns to it. The reference of the
 * upper point is a bisection of |mu| = 1. */
static void flips_are_marked(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(0.02, 0, 0.5, &model);
  mhb_settings      s = ground_settings(0, 9, 1, -0.5, 31);
  mhb_response     *r = sweep(&model, &s, 2.0, 3.6);
  const mhb_branch *b = &r->branch[2];
  int               at[16];
  assert_int_equal(specials(b, MHB_FLIP, at), 2);
  for (int i = 0; i < 2; i++) {
    print_message("%.6f: %.7f\n", omega(b, at[i]), creal(multiplier(r, b, at[i], 0)));
    assert_near(cabs(multiplier(r, b, at[i], 0) + 1), 0, 1e-5);
  }
  for (int i = at[0] + 1; i < at[1]; i++) {
    assert_int_equal(b->stable[i], 0);
    assert_int_equal(b->loss[i], MHB_LOSS_FLIP);
  }
  assert_int_equal(b->stable[at[0] - 1], 1);
  assert_int_equal(b->stable[at[1] + 1], 1);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* never: no multipliers are kept. Beyond an odd number of folds a motion is unstable, elsewhere
 * nothing is claimed. */
static void never_goes_by_folds(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s  = ground_settings(0.4, 0.8, 0.5, 0.3, 11);
  s.stability     = MHB_STABILITY_NEVER;
  mhb_response *r = sweep(&model, &s, 0.8, 1.7);
  mhb_branch   *b = &r->branch[2];
  int           fold[16];
  assert_int_equal(r->n_multipliers, 0);
  assert_int_equal(specials(b, MHB_FOLD, fold), 2);
  for (int i = 0; i < b->n_points; i++) {
    int beyond = i > fold[0] && i < fold[1];
    assert_int_equal(b->judged[i], beyond ? MHB_BY_FOLDS : MHB_NOT_JUDGED);
    assert_int_equal(b->stable[i], beyond ? 0 : -1);
    assert_int_equal(b->loss[i], beyond ? MHB_LOSS_FOLD : MHB_NO_LOSS);
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static void assert_same_curves(const mhb_response *a, const mhb_response *b) {
  assert_int_equal(a->n_branches, b->n_branches);
  for (int i = 2; i < a->n_branches; i++) {
    const mhb_branch *x = &a->branch[i], *y = &b->branch[i];
    size_t            n = (size_t)x->n_points, k = (size_t)a->n_multipliers;
    assert_int_equal(x->n_points, y->n_points);
    assert_memory_equal(x->frequency, y->frequency, n * sizeof *x->frequency);
    assert_memory_equal(x->multipliers, y->multipliers, n * k * sizeof *x->multipliers);
    assert_memory_equal(x->stable, y->stable, n * sizeof *x->stable);
    assert_memory_equal(x->judged, y->judged, n * sizeof *x->judged);
    assert_memory_equal(x->loss, y->loss, n * sizeof *x->loss);
    assert_memory_equal(x->special, y->special, n * sizeof *x->special);
  }
}

/* Bit by bit the same: a blade on the ground, and a ring of which only some points are judged. */
static void threads_change_nothing(void **state) {
  (void)state;
  for (int ring = 0; ring < 2; ring++) {
    modal_model  model;
    mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.1, 7);
    if (ring) {
      random_model(1, WITH_LEFT, 7, &model);
      s              = random_settings(3);
      s.blades       = 20; /* 280 states: dear */
      s.engine_order = 3;
      s.tolerance    = 1e-8;
      s.max_points   = 2000;
      s.scale        = 1;
    } else {
      three_degree_model(&model);
    }
    s.n_preloads = 3;
    memcpy(s.n0, (double[3]){0.05, 0.1, 0.3}, 3 * sizeof(double));
    s.frequency[0]     = 0.9 / SHB_TWO_PI;
    s.frequency[1]     = 1.5 / SHB_TWO_PI;
    mhb_response *r[2] = {NULL, NULL};
    for (int k = 0; k < 2; k++) {
      omp_set_num_threads(1 + 2 * k);
      shb_status status = mhb_forced_response(&model, &s, NULL, NULL, NULL, &r[k]);
      if (status != SHB_OK && status != SHB_NOT_CONVERGED) fail_msg("%s", shb_message());
    }
    int count[MHB_N_JUDGED] = {0};
    for (int i = 2; i < r[0]->n_branches; i++)
      for (int p = 0; p < r[0]->branch[i].n_points; p++) count[r[0]->branch[i].judged[p]]++;
    print_message(
        "%s: not judged %d, by multipliers %d, marginal %d, undecided %d, neighbours %d, "
        "folds %d\n",
        ring ? "ring" : "ground", count[0], count[1], count[2], count[3], count[4], count[5]);
    assert_true(count[MHB_BY_MULTIPLIERS] > 5);
    assert_true((count[MHB_BY_NEIGHBOURS] > 0) == (ring == 1));
    assert_same_curves(r[0], r[1]);
    mhb_response_destroy(r[0]);
    mhb_response_destroy(r[1]);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(neimark_sacker_points_are_marked),
      cmocka_unit_test(middle_branches_are_unstable),
      cmocka_unit_test(flips_are_marked),
      cmocka_unit_test(never_goes_by_folds),
      cmocka_unit_test(threads_change_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
