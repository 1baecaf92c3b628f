/* The solution next to that of another balance: it is a solution, in the plane asked for, and
 * another one. */
#include "mesh/base/constants.h"
#include "mhb/continuation/nearest_solution.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/numerics/fourier.h"
#include "tests/support/solution.h"
#include "tests/support/three_degree.h"

enum { FEW = 1, MANY = 5, NB = 2 * MANY + 1, N = 3 * NB };

static mhb_settings settings_of(int harmonics) {
  return (mhb_settings){.to_ground    = true,
                        .blades       = 1,
                        .mu           = 0.4,
                        .kv           = 0.8,
                        .ku           = {0.5, 0, 0.5},
                        .n_preloads   = 1,
                        .n0           = {0.3},
                        .frequency    = {0.8 / SHB_TWO_PI, 1.6 / SHB_TWO_PI},
                        .harmonics    = harmonics,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8};
}

/* The motion of few harmonics at w as a guess for many. */
static void guess_at(const modal_model *model, double w, double *x) {
  mhb_settings s  = settings_of(FEW);
  int          nb = mhb_real_size(FEW);
  double       few[3 * 3];
  cold_solution(model, &s, w, 1e-11, few);
  memset(x, 0, N * sizeof *x);
  for (int c = 0; c < 3; c++) memcpy(x + c * NB, few + c * nb, (size_t)nb * sizeof *few);
}

typedef struct {
  modal_model  model;
  mhb_settings settings;
  mhb_balance *residual;
  mhb_newton  *newton;
} fixture;

static fixture begin(void) {
  fixture f = {.settings = settings_of(MANY)};
  three_degree_model(&f.model);
  return f;
}

static void make(fixture *f) {
  assert_int_equal(mhb_balance_create(&f->model, &f->settings, &f->residual), SHB_OK);
  mhb_balance_set_preload(f->residual, 0.3);
  f->newton = mhb_newton_create(N);
}

static void end(fixture *f) {
  mhb_newton_destroy(f->newton);
  mhb_balance_destroy(f->residual);
  modal_model_free(&f->model);
}

static double residual_at(fixture *f, const double *x, double omega) {
  double r[N];
  mhb_balance_evaluate(f->residual, x, omega, r, NULL, NULL);
  return mhb_norm(r, N) / mhb_norm(x, N);
}

static void at_the_same_frequency(void **state) {
  (void)state;
  fixture f = begin();
  double  x[N], wanted[N], normal[N + 1] = {0}, omega = 1.37;
  make(&f);
  guess_at(&f.model, omega, x);
  cold_solution(&f.model, &f.settings, omega, 1e-12, wanted);
  assert_true(residual_at(&f, x, omega) > 1e-4);
  normal[N] = 1;
  assert_int_equal(
      mhb_nearest_solution(f.newton, f.residual, normal, mhb_norm(x, N), 0.8, 1e-10, x, &omega), 1);
  assert_true(fabs(omega - 1.37) < 1e-14);
  assert_true(residual_at(&f, x, omega) <= 1e-10);
  for (int i = 0; i < N; i++) assert_true(fabs(x[i] - wanted[i]) < 1e-8 * mhb_norm(wanted, N));
  end(&f);
}

/* In y = [x/scale, omega/span], along the curve between two neighbours. */
static void in_the_plane_across(void **state) {
  (void)state;
  fixture f     = begin();
  int     moved = 0;
  make(&f);
  for (int i = 0; i < 12; i++) {
    double w = 1.1 + 0.04 * i, x[N], y[N], before[N], after[N], normal[N + 1], omega = w, sum = 0,
           size = 0;
    guess_at(&f.model, w, x);
    guess_at(&f.model, w - 0.01, before);
    guess_at(&f.model, w + 0.01, after);
    for (int k = 0; k < N; k++) normal[k] = after[k] - before[k];
    normal[N]    = 0.02;
    double scale = mhb_norm(x, N);
    memcpy(y, x, sizeof y);
    assert_int_equal(
        mhb_nearest_solution(f.newton, f.residual, normal, scale, 0.8, 1e-10, y, &omega), 1);
    assert_true(residual_at(&f, y, omega) <= 1e-10);
    for (int k = 0; k < N; k++) {
      sum += normal[k] / scale * (y[k] - x[k]) / scale;
      size += normal[k] / scale * normal[k] / scale;
    }
    sum += normal[N] / 0.8 * (omega - w) / 0.8;
    assert_true(fabs(sum) < 1e-10 * sqrt(size));
    assert_true(fabs(omega - w) < 0.05);
    moved += residual_at(&f, x, w) > 1e-6 && omega != w; /* not where the contact stays linear */
  }
  assert_true(moved >= 6);
  end(&f);
}

static void nothing_near(void **state) {
  (void)state;
  fixture f    = begin();
  double  x[N] = {0}, normal[N + 1] = {0}, omega = 1.37;
  make(&f);
  x[1]      = 50; /* far beyond any solution */
  normal[N] = 1;
  assert_int_equal(mhb_nearest_solution(f.newton, f.residual, normal, 1, 0.8, 1e-10, x, &omega), 0);
  end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(at_the_same_frequency),
                                     cmocka_unit_test(in_the_plane_across),
                                     cmocka_unit_test(nothing_near)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
