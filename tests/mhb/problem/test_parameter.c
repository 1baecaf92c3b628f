/* Curves in another parameter than the frequency: exact slopes, and the same solutions as at fixed
 * parameters. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/main_branch.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { PAIRS = 2, M = 4, N = 3 * PAIRS * (2 * M + 1) };

/* Central difference of the residual in the parameter, at fixed x. */
static void difference(mhb_balance *b, const double *x, double value, double h, double *out) {
  double r[2][N];
  for (int side = 0; side < 2; side++)
    mhb_balance_evaluate(b, x, value + (side ? h : -h), r[side], NULL, NULL);
  for (int i = 0; i < N; i++) out[i] = (r[1][i] - r[0][i]) / (2 * h);
}

/* All states occur: two pairs, amplitudes from well stuck to mostly open. */
static void slopes_are_exact(void **state) {
  (void)state;
  modal_model model;
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL | WITH_AREAS, 31, &model);
  for (int what = 0; what < MHB_N_PARAMETERS; what++) {
    double worst = 0, shares[3] = {0, 0, 0};
    for (unsigned long long seed = 1; seed <= 24; seed++) {
      mhb_settings       s    = random_settings(M);
      unsigned long long draw = seed;
      s.preload               = seed % 2 ? MHB_EQUILIBRIUM : MHB_INTERFERENCE;
      s.tolerance             = 1e-12;
      s.kv                    = seed % 5 ? s.kv : 0;
      mhb_balance *b;
      double       x[N], r[N], exact[N], wanted[N], size = 0, far = 0;
      assert_int_equal(mhb_balance_create(&model, &s, &b), SHB_OK);
      mhb_balance_set_preload(b, seed % 3 || seed % 5 == 0 ? .3 : -.1);
      mhb_operating_point at = b->eval->at;
      at.omega               = 1.13;
      mhb_balance_set_operating_point(b, &at);
      mhb_balance_set_parameter(b, (mhb_parameter)what);
      for (int i = 0; i < N; i++) {
        int k = (i % (2 * M + 1) + 1) / 2;
        x[i]  = (double)(seed % 4 + 1) * .2 * random_unit(&draw) / (k ? k * k : 4);
      }
      double value = mhb_parameter_get(&b->eval->at, b->parameter);
      if (value > 0 || what == MHB_IN_N0) {
        mhb_balance_linearise(b, x, value, r, exact);
        for (int a = 0; a < PAIRS; a++)
          for (int i = 0; i < 3; i++) shares[i] += b->eval->info[a].share[i] / (24 * PAIRS);
        difference(b, x, value, 1e-5, wanted);
        for (int i = 0; i < N; i++) {
          far  = fmax(far, fabs(exact[i] - wanted[i]));
          size = fmax(size, fabs(wanted[i]));
        }
        worst = fmax(worst, far / fmax(size, 1e-3));
      }
      mhb_balance_destroy(b);
    }
    print_message("%-9s %.1e (stuck %.2f, slipping %.2f, open %.2f)\n", mhb_parameter_name(what),
                  worst, shares[0], shares[1], shares[2]);
    assert_true(shares[0] > .02 && shares[1] > .1 && shares[2] > .05);
    assert_below(worst, 1e-6);
  }
  modal_model_free(&model);
}

static mhb_settings ground(double mu, double kv, double ku, double n0, int harmonics) {
  mhb_settings s = ground_settings(mu, kv, ku, n0, harmonics);
  s.tolerance    = 1e-10;
  return s;
}

static mhb_response *sweep(const modal_model *model, const mhb_settings *s) {
  mhb_response *response;
  if (mhb_forced_response(model, s, NULL, NULL, NULL, &response) != SHB_OK)
    fail_msg("%s", shb_message());
  return response;
}

/* |r| of a recorded point in the balance of a case with the value of the point as its own; relative
 * to the motion. */
static double residual_of(const modal_model *model, mhb_settings s, const mhb_response *response,
                          int point) {
  const mhb_branch *branch = &response->branch[2];
  int               K = response->n_harmonics + 1, nb = 2 * K - 1;
  double            x[3 * nb], r[3 * nb], value = branch->value[point];
  mhb_balance      *b;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < K; k++) {
      double complex a                = branch->motion[(point * 3 + c) * K + k];
      x[c * nb + (k ? 2 * k - 1 : 0)] = creal(a);
      if (k) x[c * nb + 2 * k] = cimag(a);
    }
  if (s.parameter == MHB_IN_N0) s.n0[0] = value;
  if (s.parameter == MHB_IN_SCALE) s.scale = value;
  if (s.parameter == MHB_IN_MU) s.mu = value;
  if (s.parameter == MHB_IN_KV) s.kv = value;
  for (int i = 0; s.parameter == MHB_IN_KU && i < 3; i += 2) s.ku[i] = value;
  assert_int_equal(mhb_balance_create(model, &s, &b), SHB_OK);
  mhb_balance_evaluate(b, x, SHB_TWO_PI * s.frequency[0], r, NULL, NULL);
  double size = mhb_norm(r, 3 * nb) / mhb_norm(x, 3 * nb);
  mhb_balance_destroy(b);
  return size;
}

/* Three degrees of freedom to ground: every parameter over a wide range. */
static void every_parameter_is_followed(void **state) {
  (void)state;
  static const double ranges[MHB_N_PARAMETERS][2] = {[MHB_IN_N0]    = {-.3, 1},
                                                     [MHB_IN_SCALE] = {.05, 3},
                                                     [MHB_IN_MU]    = {0, 2},
                                                     [MHB_IN_KU]    = {.05, 5},
                                                     [MHB_IN_KV]    = {.05, 5}};
  modal_model         model;
  three_degree_model(&model);
  for (int what = MHB_IN_N0; what < MHB_N_PARAMETERS; what++) {
    mhb_settings s = ground(.4, .8, .5, .2, 5);
    s.parameter    = (mhb_parameter)what;
    s.frequency[0] = s.frequency[1] = 1.27 / SHB_TWO_PI;
    memcpy(s.range, ranges[what], sizeof s.range);
    mhb_response     *response = sweep(&model, &s);
    const mhb_branch *b        = &response->branch[2];
    double            worst    = 0;
    assert_true(b->complete);
    for (int i = 0; i < b->n_points; i += 3)
      worst = fmax(worst, residual_of(&model, s, response, i));
    print_message("%-5s %3d points from %g to %g, worst residual %.1e\n", mhb_parameter_name(what),
                  b->n_points, b->value[0], b->value[b->n_points - 1], worst);
    assert_true(b->value[0] == s.range[0]);
    assert_below(fabs(b->value[b->n_points - 1] - s.range[1]), 1e-9);
    assert_below(worst, 2e-9);
    for (int limit = 0; limit < 2; limit++) {
      const mhb_branch *l = &response->branch[limit];
      assert_below(fabs(l->value[0] - s.range[0]) + fabs(l->value[l->n_points - 1] - s.range[1]),
                   1e-9);
    }
    mhb_response_destroy(response);
  }
  modal_model_free(&model);
}

/* While stuck nothing changes with mu: no peaks there, and no turning back. */
static void stuck_means_nothing_changes(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 6; i++) {
    mhb_settings s = ground(.4, .8, .5, 1, 3 + 2 * (i % 3));
    s.parameter    = MHB_IN_MU;
    s.frequency[0] = s.frequency[1] = (1.1 + .07 * i) / SHB_TWO_PI;
    s.range[0]                      = .02;
    s.range[1]                      = 5;
    mhb_response     *response      = sweep(&model, &s);
    const mhb_branch *b             = &response->branch[2];
    int               stuck         = 0;
    for (int p = 1; p < b->n_points; p++) {
      if (b->state[3 * p] < 1 || b->state[3 * p - 3] < 1) continue;
      stuck++;
      assert_true(b->value[p] > b->value[p - 1]);
      assert_int_equal(b->special[p], MHB_ORDINARY);
    }
    assert_true(stuck > 3);
    mhb_response_destroy(response);
  }
  modal_model_free(&model);
}

/* Hertz of the fold nearest to w of the curve in frequency at this scale. */
static double fold_in_frequency(const modal_model *model, mhb_settings s, double scale, double w) {
  double best                = INFINITY;
  s.parameter                = MHB_IN_FREQUENCY;
  s.scale                    = scale;
  s.frequency[0]             = .5 * w / SHB_TWO_PI;
  s.frequency[1]             = 2 * w / SHB_TWO_PI;
  mhb_response     *response = sweep(model, &s);
  const mhb_branch *b        = &response->branch[2];
  for (int i = 0; i < b->n_points; i++) {
    double at = SHB_TWO_PI * b->frequency[i];
    if (b->special[i] == MHB_FOLD && fabs(at - w) < fabs(best - w)) best = at;
  }
  mhb_response_destroy(response);
  return best;
}

/* A fold of the curve in the scale lies on the same edge of the folded surface as one in frequency.
 * The middle part is unstable. */
static void folds_are_those_in_frequency(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(.02, 0, .1, &model);
  mhb_settings s = ground(0, 9, 1, -4.5, 15);
  s.parameter    = MHB_IN_SCALE;
  s.frequency[0] = s.frequency[1] = 1.3 / SHB_TWO_PI;
  s.range[0]                      = .2;
  s.range[1]                      = 8;
  mhb_response     *response      = sweep(&model, &s);
  const mhb_branch *b             = &response->branch[2];
  int               folds = 0, unstable = 0;
  for (int i = 0; i < b->n_points; i++) {
    if (b->special[i] == MHB_FOLD) {
      double at = fold_in_frequency(&model, s, b->value[i], 1.3);
      print_message("fold at scale %.9f: in frequency at %.9f\n", b->value[i], at);
      assert_below(fabs(at - 1.3), 1.3e-6);
      folds++;
    }
    if (folds == 1 && b->special[i] != MHB_FOLD) unstable += b->stable[i] == 0;
  }
  assert_int_equal(folds, 2);
  assert_true(unstable > 3);
  mhb_response_destroy(response);
  modal_model_free(&model);
}

/* The contact opens and slips over a millionth of the range only: it must not be stepped over. */
static void wide_ranges_of_preload_are_resolved(void **state) {
  (void)state;
  static const double wide[] = {1, 50, 1e6, 1e12};
  modal_model         model;
  double              least[4];
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    mhb_settings s = ground(.4, .8, .5, .3, 5);
    s.parameter    = MHB_IN_N0;
    s.frequency[0] = s.frequency[1] = .2;
    s.range[0]                      = -wide[i];
    s.range[1]                      = 5 * wide[i];
    mhb_response     *response      = sweep(&model, &s);
    const mhb_branch *b             = &response->branch[2];
    int               K = response->n_harmonics + 1, near = 0;
    least[i] = INFINITY;
    for (int p = 0; p < b->n_points; p++) {
      least[i] = fmin(least[i], cabs(b->motion[(p * 3 + 1) * K + 1]));
      near += b->value[p] > -1 && b->value[p] < 3;
    }
    print_message("to %g N: %d points, %d near 0, least motion %.5g\n", s.range[1], b->n_points,
                  near, least[i]);
    assert_true(near > 50 && b->n_points < 400);
    assert_below(fabs(least[i] / least[0] - 1),
                 2e-2); /* the least of the points, not of the curve */
    mhb_response_destroy(response);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slopes_are_exact), cmocka_unit_test(every_parameter_is_followed),
      cmocka_unit_test(stuck_means_nothing_changes), cmocka_unit_test(folds_are_those_in_frequency),
      cmocka_unit_test(wide_ranges_of_preload_are_resolved)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
