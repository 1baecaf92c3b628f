/* The spatial estimate against the error that it estimates: the difference from the solution with
 * all pairs at the same frequency. */
#include "mhb/balance/spatial_error.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/continuation/first_solution.h"
#include "tests/support/check.h"
#include "tests/support/shroud_face.h"

enum { PAIRS = 16, HARMONICS = 5 };
static const double FORCE = 150, HERTZ = 232;

/* A balance with its solution. */
typedef struct {
  modal_model     model;
  mhb_settings    settings;
  mhb_other_pairs pairs;
  modal_joining   joining;
  mhb_balance    *balance;
  mhb_newton     *newton;
  double         *x, omega;
} solved;

static void solve(solved *s) {
  int iterations;
  if (mhb_balance_create(&s->model, &s->settings, &s->balance) != SHB_OK)
    fail_msg("%s", shb_message());
  mhb_balance_set_preload(s->balance, s->settings.n0[0]);
  s->newton = mhb_newton_create(s->balance->n);
  s->x      = calloc((size_t)s->balance->n, sizeof *s->x);
  assert_int_equal(mhb_first_solution(s->newton, s->balance, s->omega, 1e-12, s->x, &iterations),
                   MHB_CONVERGED);
}

static void open_face(solved *s) {
  *s = (solved){.settings = shroud_face_settings(HARMONICS), .omega = SHB_TWO_PI * HERTZ};
  smooth_face_model(PAIRS, FORCE, &s->model);
}

static void open_patches(const modal_model *all, int patches, solved *s) {
  *s = (solved){.settings = shroud_face_settings(HARMONICS), .omega = SHB_TWO_PI * HERTZ};
  assert_int_equal(modal_joining_create(all, patches, &s->joining), SHB_OK);
  modal_join(all, &s->joining, &s->model);
  s->pairs                = (mhb_other_pairs){.model = all, .joining = &s->joining, .finer = true};
  s->settings.other_pairs = &s->pairs;
}

static void close_solved(solved *s) {
  mhb_newton_destroy(s->newton);
  mhb_balance_destroy(s->balance);
  modal_joining_free(&s->joining);
  modal_model_free(&s->model);
  free(s->x);
}

/* |a - b - c| over the vibration of b; c may be NULL. All pairs have the same share. */
static double distance(const mhb_balance *all, const double *a, const double *b, const double *c) {
  double sum = 0, size = 0;
  for (int i = 0; i < all->n; i++) {
    sum += pow(a[i] - b[i] - (c ? c[i] : 0), 2);
    size += i % all->nb ? b[i] * b[i] : 0;
  }
  return sqrt(sum / size);
}

static int slipping(const mhb_balance *b) {
  int n = 0;
  for (int a = 0; a < b->n_pairs; a++) n += b->eval->kind[a] == MHB_PAIR_NONLINEAR;
  return n;
}

/* From patches on: the estimate is the error, and what its step leaves is of second order. */
static void estimate_is_the_error(void **state) {
  (void)state;
  solved all;
  double before = 0;
  open_face(&all);
  solve(&all);
  print_message("%d of %d pairs slip\n", slipping(all.balance), PAIRS);
  assert_true(slipping(all.balance) > 3);
  for (int patches = 1; patches <= 8; patches *= 2) {
    solved             few;
    mhb_spatial_error *e;
    open_patches(&all.model, patches, &few);
    solve(&few);
    assert_int_equal(mhb_spatial_error_create(few.balance, &e), SHB_OK);
    double estimate = mhb_spatial_error_at(e, few.x);
    double error    = distance(all.balance, e->x, all.x, NULL);
    double left     = distance(all.balance, e->x, all.x, e->step);
    print_message("%d patches: error %.2e, estimate %.2e, left by its step %.1e = %.2g error^2\n",
                  patches, error, estimate, left, left / error / error);
    assert_true(estimate > 0);
    if (error < .1) {
      assert_below(fabs(estimate / error - 1), .1);
      assert_below(left, 10 * error * error);
    }
    if (patches > 1) assert_below(error, before / 1.8); /* 1/n at least */
    before = error;
    mhb_spatial_error_destroy(e);
    close_solved(&few);
  }
  assert_below(before, .03);
  close_solved(&all);
}

/* As many patches as pairs, or a face that moves as one: no error. */
static void exact_where_nothing_is_lost(void **state) {
  (void)state;
  for (int rigid = 0; rigid < 2; rigid++) {
    solved             all = {0}, few;
    mhb_spatial_error *e;
    open_face(&all);
    for (int i = 3; rigid && i < 3 * PAIRS; i++)
      memcpy(all.model.right + i * all.model.n_modes, all.model.right + (i % 3) * all.model.n_modes,
             (size_t)all.model.n_modes * sizeof(double));
    if (rigid) {
      free(all.model.residual_flexibility);
      free(all.model.residual_inertia);
      all.model.residual_flexibility = all.model.residual_inertia = NULL;
    }
    open_patches(&all.model, rigid ? 3 : PAIRS, &few);
    solve(&few);
    assert_int_equal(mhb_spatial_error_create(few.balance, &e), SHB_OK);
    double estimate = mhb_spatial_error_at(e, few.x);
    print_message("%s: %.1e\n", rigid ? "a rigid face" : "all pairs", estimate);
    assert_true(estimate >= 0);
    assert_below(estimate, 1e-7);
    mhb_spatial_error_destroy(e);
    close_solved(&few);
    close_solved(&all);
  }
}

/* From n/2 to n pairs: the estimate is their difference, which bounds the error of n. */
static void coarser_pairs_bound_the_error(void **state) {
  (void)state;
  solved all, n, half;
  open_face(&all);
  solve(&all);
  open_patches(&all.model, 8, &n);
  solve(&n);
  const double error = distance(all.balance, all.x, all.x, NULL);
  assert_true(error == 0);
  open_patches(&n.model, 4, &half); /* 8 pairs joined to 4 */
  n.pairs                   = (mhb_other_pairs){.model = &half.model, .joining = &half.joining};
  n.balance->settings       = &n.settings;
  n.settings.other_pairs    = &n.pairs;
  half.settings.other_pairs = NULL;
  mhb_spatial_error *coarse, *fine;
  solve(&half);
  assert_int_equal(mhb_spatial_error_create(n.balance, &coarse), SHB_OK);
  double told = mhb_spatial_error_at(coarse, n.x);
  double size = 0, sum = 0;
  for (int i = 0; i < half.balance->n; i++) { /* mean of n against the solution of n/2 */
    sum += pow(coarse->x[i] - half.x[i], 2);
    size += i % half.balance->nb ? pow(coarse->x[i], 2) : 0;
  }
  n.pairs = (mhb_other_pairs){.model = &all.model, .joining = &n.joining, .finer = true};
  assert_int_equal(mhb_spatial_error_create(n.balance, &fine), SHB_OK);
  double left = mhb_spatial_error_at(fine, n.x);
  print_message("8 pairs: from 4 told %.2e, true %.2e; error to 16 %.2e\n", told, sqrt(sum / size),
                left);
  assert_below(fabs(told / sqrt(sum / size) - 1), .1);
  assert_below(left, 2 * told);
  mhb_spatial_error_destroy(coarse);
  mhb_spatial_error_destroy(fine);
  close_solved(&half);
  close_solved(&n);
  close_solved(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(estimate_is_the_error),
      cmocka_unit_test(exact_where_nothing_is_lost),
      cmocka_unit_test(coarser_pairs_bound_the_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
