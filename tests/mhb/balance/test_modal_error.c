/* The estimated error by the modes left out against the solution with all modes. The points go
 * through a resonance of the blade with its contact, where the motion's error is many times that of
 * the receptance. */
#include "mesh/base/constants.h"
#include "mhb/balance/modal_error.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/balance/truncation_error.h"
#include "mhb/branches/forced_response.h"
#include "mhb/continuation/first_solution.h"
#include "modal/model/reduce.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { STEPS = 41 };

typedef struct {
  mhb_balance    *residual;
  mhb_newton     *newton;
  mhb_truncation *truncation;
  double         *x;
} balance;

static void balance_create(const modal_model *model, const mhb_settings *s, balance *b) {
  assert_int_equal(mhb_balance_create(model, s, &b->residual), SHB_OK);
  mhb_balance_set_preload(b->residual, s->n0[0]);
  b->newton = mhb_newton_create(b->residual->n);
  assert_int_equal(mhb_truncation_create(b->residual, &b->truncation), SHB_OK);
  b->x = calloc((size_t)b->residual->n, sizeof *b->x);
}

static void balance_destroy(balance *b) {
  mhb_truncation_destroy(b->truncation);
  mhb_newton_destroy(b->newton);
  mhb_balance_destroy(b->residual);
  free(b->x);
}

/* Damping ratio of all modes, or that of Rayleigh's stiffness part at the first mode. */
typedef struct {
  double ratio;
  bool   by_stiffness;
} damping;

static const damping USUAL = {0.002, false};

/* The lowest modes of a model and three terms for the others; the tail from its definition. few is
 * a copy of all. */
static void leave_out(int modes, damping by, modal_model *all, modal_model *few) {
  for (int i = 0; i < all->n_modes; i++)
    all->damping_ratio[i] = few->damping_ratio[i] =
        by.ratio * (by.by_stiffness ? all->frequency[i] / all->frequency[0] : 1);
  assert_int_equal(modal_model_reduce(few, modes, true), SHB_OK);
  modal_model_drop_residual_modes(few);
  few->tail_order   = 3;
  few->contact_tail = calloc(6, sizeof *few->contact_tail);
  few->load_tail    = calloc(2 * ((size_t)few->n_load + 1), sizeof *few->load_tail);
  for (int c = 0; c < 3; c++)
    for (int i = modes; i < all->n_modes; i++) {
      double lambda = pow(2 * SHB_PI * all->frequency[i], 2),
             phi    = all->right[c * all->n_modes + i];
      few->contact_tail[2 * c] += phi * phi / pow(lambda, 4);
      few->contact_tail[2 * c + 1] += phi * phi / pow(lambda, 5);
    }
}

static void few_modes(int modes, damping by, modal_model *all, modal_model *few) {
  tip_contact_beam_model(1, all);
  tip_contact_beam_model(1, few);
  leave_out(modes, by, all, few);
}

static void solve(balance *b, double omega) {
  int iterations;
  assert_int_equal(mhb_first_solution(b->newton, b->residual, omega, 1e-11, b->x, &iterations),
                   MHB_CONVERGED);
  mhb_balance_evaluate(b->residual, b->x, omega, b->newton->r, NULL, NULL);
}

/* Greatest error over the resonance, and how far the estimate is from it there and at worst. */
static void compare(const char *where, int modes, damping by, double level, double n0, double from,
                    double to, double least_error, double least_gain) {
  modal_model all, few;
  balance     exact, rough;
  few_modes(modes, by, &all, &few);
  mhb_settings s = ground_settings(.3, 2e6, 1e6, n0, 5);
  s.engine_order = 1;
  s.scale        = level;
  balance_create(&all, &s, &exact);
  balance_create(&few, &s, &rough);
  double worst = 0, low = INFINITY, high = 0, gain = 0, slips = 0;
  for (int i = 0; i < STEPS; i++) {
    const double omega = 2 * SHB_PI * (from + (to - from) * i / (STEPS - 1));
    solve(&exact, omega);
    solve(&rough, omega);
    mhb_truncation_error(rough.truncation, rough.x);
    mhb_truncation *t = rough.truncation;
    double          estimate =
        mhb_modal_error(rough.residual, rough.x, t->kind == MHB_TRUNCATION_NEWTON ? t : NULL);
    double off = 0, size = mhb_balance_vibration(rough.residual, rough.x), bare = 0;
    for (int j = 0; j < rough.residual->n; j++) off += pow(rough.x[j] - exact.x[j], 2);
    double error = sqrt(off) / size;
    for (int c = 0; c < 3; c++)
      bare = fmax(bare, modal_series_error(&few, omega, c) / few.residual_flexibility[4 * c + !c]);
    slips = fmax(slips, rough.residual->eval->info[0].share[MHB_SLIDE]);
    worst = fmax(worst, error);
    gain  = fmax(gain, error / bare);
    if (error < 1e-9) continue;
    low  = fmin(low, estimate / error);
    high = fmax(high, estimate / error);
  }
  print_message(
      "%s: slips for %.2f, error to %.1e, up to %.1f times that of the receptance; "
      "estimate over error %.2f to %.2f\n",
      where, slips, worst, gain, low, high);
  assert_true(worst > least_error && gain > least_gain);
  assert_true(low > 0.95 && high < 2);
  balance_destroy(&exact);
  balance_destroy(&rough);
  modal_model_free(&all);
  modal_model_free(&few);
}

static void stuck(void **state) {
  (void)state;
  compare("stuck, 3 modes of 20", 3, USUAL, 1, 1e5, 700, 1050, 1e-2, 5);
  compare("stuck, 6 modes", 6, USUAL, 1, 1e5, 1500, 3500, 1e-4, 0);
}

static void slipping(void **state) {
  (void)state;
  compare("slip, 6 modes", 6, USUAL, 100, 60, 600, 1100, 1e-7, 0);
  compare("slip, 6 modes, hard", 6, USUAL, 400, 60, 600, 1100, 1e-7, 0);
  compare("slip, 4 modes", 4, USUAL, 100, 60, 600, 900, 1e-5, 3);
}

/* Far below the modes left out the residual terms are good to 1e-9, but for damping. Near the
 * stuck peak that alone is the error. */
static void damping_beyond_the_modes(void **state) {
  (void)state;
  compare("modal damping, 10 modes", 10, (damping){0.02, false}, 1, 1e5, 800, 1000, 1e-5, 100);
  compare("Rayleigh damping, 10 modes", 10, (damping){0.001, true}, 1, 1e5, 800, 1000, 5e-4, 100);
  compare("Rayleigh damping, slip", 10, (damping){0.001, true}, 100, 60, 600, 1000, 1e-5, 100);
}

/* Error of the vibration over its size. The mean motion of a stuck pair goes with its mean
 * friction, which is a convention. */
static double true_error(const balance *exact, const balance *rough) {
  const int nb  = rough->residual->nb;
  double    off = 0;
  for (int j = 0; j < rough->residual->n; j++)
    if (j % nb > 0) off += pow(rough->x[j] - exact->x[j], 2);
  return sqrt(off) / mhb_balance_vibration(rough->residual, rough->x);
}

/* Estimate of the rough solution, with Newton's step where there is one. */
static double told_error(const balance *rough) {
  mhb_truncation_error(rough->truncation, rough->x);
  mhb_truncation *t = rough->truncation;
  return mhb_modal_error(rough->residual, rough->x, t->kind == MHB_TRUNCATION_NEWTON ? t : NULL);
}

typedef struct {
  int    n;
  double least, most, logarithms;
} ratios;

static void add(double ratio, ratios *to) {
  to->least = to->n ? fmin(to->least, ratio) : ratio;
  to->most  = to->n ? fmax(to->most, ratio) : ratio;
  to->logarithms += log(ratio);
  to->n++;
}

enum { BLADES = 80, PLACES = 4, RANDOM_HARMONICS = 9 };

/* Six random modes, of which the lowest three to five are kept. The others are above all harmonics.
 * Contact and load have shapes of their own. */
static void random_blade(int index, ratios *to) {
  unsigned long long seed = 977 + 31ULL * (unsigned)index;
  const int          kept = 3 + index % 3;
  modal_model        all, few;
  balance            exact, rough;
  for (int k = 0; k < 5; k++) random_unit(&seed);
  random_model(1, 0, 5 + (unsigned)index, &all);
  random_model(1, 0, 5 + (unsigned)index, &few);
  all.n_load = few.n_load = 1;
  for (int k = kept; k < all.n_modes; k++) few.frequency[k] = all.frequency[k] *= RANDOM_HARMONICS;
  leave_out(kept, (damping){pow(10, -2.2 + random_unit(&seed)), index % 3 == 0}, &all, &few);
  mhb_settings s = random_settings(RANDOM_HARMONICS);
  s.n0[0]        = index % 2 ? 1e3 : 0.3 + 0.3 * random_unit(&seed);
  s.preload      = MHB_EQUILIBRIUM;
  s.to_ground    = true;
  s.blades       = 1;
  s.kv           = pow(10, random_unit(&seed));
  s.ku[0] = s.ku[2] = 0.6 * s.kv;
  s.ku[1]           = 0;
  balance_create(&all, &s, &exact);
  balance_create(&few, &s, &rough);
  const double top = 0.9 * SHB_TWO_PI * few.frequency[kept - 1];
  for (int k = 0; k < PLACES; k++) {
    const double omega = top * (0.7 + 0.3 * random_unit(&seed));
    solve(&exact, omega);
    solve(&rough, omega);
    const double error = true_error(&exact, &rough);
    if (error > 1e-8 && error < 0.2) add(told_error(&rough) / error, to);
  }
  balance_destroy(&exact);
  balance_destroy(&rough);
  modal_model_free(&all);
  modal_model_free(&few);
}

/* The parts by load and by contact are not orthogonal, and one may cancel most of the other. */
static void random_blades_are_told_no_less_than_their_error(void **state) {
  (void)state;
  ratios found = {0};
  for (int i = 0; i < BLADES; i++) random_blade(i, &found);
  print_message("%d points of random blades: told over true %.3f to %.2f, mean %.2f\n", found.n,
                found.least, found.most, exp(found.logarithms / found.n));
  assert_true(found.n > 2 * BLADES);
  assert_true(found.least > 0.95 && found.most < 4);
}

/* Without damping the terms left out begin with w^6. */
static void the_estimate_has_the_order_of_the_error(void **state) {
  (void)state;
  static const double hz[] = {150, 300};
  double              told[2], error[2];
  modal_model         all, few;
  balance             exact, rough;
  few_modes(4, (damping){1e-12, false}, &all, &few);
  mhb_settings s = ground_settings(.3, 2e6, 1e6, 1e5, 5);
  s.engine_order = 1;
  balance_create(&all, &s, &exact);
  balance_create(&few, &s, &rough);
  for (int i = 0; i < 2; i++) {
    solve(&exact, SHB_TWO_PI * hz[i]);
    solve(&rough, SHB_TWO_PI * hz[i]);
    error[i] = true_error(&exact, &rough);
    told[i]  = told_error(&rough);
  }
  const double order = log2(error[1] / error[0]), own = log2(told[1] / told[0]);
  print_message("error %.2e and %.2e: order %.2f, told %.2f\n", error[0], error[1], order, own);
  assert_true(fabs(own - order) < 0.1 && order > 5.5);
  balance_destroy(&exact);
  balance_destroy(&rough);
  modal_model_free(&all);
  modal_model_free(&few);
}

/* At a fold the linearised change has no bound: it is up to five times the motion here. The
 * shortened one goes with the root of the fold's shift, 1e-3 of the frequency. */
static void folds(void **state) {
  (void)state;
  modal_model   few, all;
  mhb_response *r     = NULL;
  mhb_settings  s     = ground_settings(.3, 2e6, 1e6, -2e-5, 7);
  double        least = INFINITY, most = 0;
  int           n = 0;
  s.engine_order  = 1;
  s.scale         = 40;
  s.frequency[0]  = 150;
  s.frequency[1]  = 200;
  few_modes(2, USUAL, &all, &few);
  assert_ok(mhb_forced_response(&few, &s, NULL, NULL, NULL, &r));
  for (int k = 0; k < r->n_branches; k++)
    for (int i = 0; i < r->branch[k].n_points; i++) {
      if (r->branch[k].special[i] != MHB_FOLD) continue;
      n++;
      least = fmin(least, r->branch[k].error_modal[i]);
      most  = fmax(most, r->branch[k].error_modal[i]);
    }
  print_message("%d folds, estimates %.3f to %.3f\n", n, least, most);
  assert_true(n >= 4 && least > 0.01 && most < 0.15);
  mhb_response_destroy(r);
  modal_model_free(&all);
  modal_model_free(&few);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stuck),
      cmocka_unit_test(slipping),
      cmocka_unit_test(damping_beyond_the_modes),
      cmocka_unit_test(random_blades_are_told_no_less_than_their_error),
      cmocka_unit_test(the_estimate_has_the_order_of_the_error),
      cmocka_unit_test(folds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
