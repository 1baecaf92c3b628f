/* Hard cases 9 and 10: a mode at three times the excitation, two modes that almost coincide. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "mhb/numerics/fourier.h"
#include "tests/hard/verdict.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

/* Two modes along one direction at the contact; the load drives each by its force. */
static void two_modes(const double w[2], double zeta, const double shape[2], const double force[2],
                      modal_model *model) {
  three_degree_model(model); /* for its allocations */
  model->n_modes = 2;
  for (int c = 0; c < 6; c++) model->right[c] = model->probe[c] = 0;
  for (int i = 0; i < 2; i++) {
    model->frequency[i]     = w[i] / SHB_TWO_PI;
    model->damping_ratio[i] = zeta;
    model->right[2 + i] = model->probe[2 + i] = shape[i];
    model->modal_force[i]                     = 0;
    model->modal_force[2 + i]                 = force[i];
  }
}

/* Amplitudes of harmonics 1 and 3 of u after 300 periods of time integration. */
static void march(const modal_model *model, const periodic *p, double a[2]) {
  enum { STEPS = 2000, PERIODS = 300 };
  disturbed      d;
  double         y[8];
  double complex A[2] = {0, 0};
  disturbed_create(model, &p->settings, p->residual, p->x, p->omega, STEPS, &d);
  disturbed_start(&d, y);
  for (int i = 0; i < PERIODS; i++) disturbed_period(&d, y);
  for (int i = 0; i < STEPS; i++) {
    for (int k = 0; k < 2; k++)
      A[k] += 2. / STEPS * d.u[1] * cexp(-SHB_TWO_PI * I * (1 + 2 * k) * i / STEPS);
    disturbed_step(&d, y, i);
  }
  for (int k = 0; k < 2; k++) a[k] = cabs(A[k]);
  disturbed_destroy(&d);
}

/* The second mode is driven by nothing but the third harmonic of friction. */
static void one_to_three(void **state) {
  (void)state;
  static const double w[] = {1, 3.55}, shape[] = {1, 1}, force[] = {.5, 0};
  static const int    H[] = {21, 1, 2, 3, 5, 9};
  const double        W   = 1.18;
  modal_model         model;
  double              truth[2];
  two_modes(w, .005, shape, force, &model);
  for (int i = 0; i < 6; i++) {
    mhb_settings s = ground_settings(1, 1, 1, .6, H[i]);
    periodic     p;
    double       a[2] = {0, 0};
    periodic_create(&model, &s, W, NULL, &p);
    const double *u = p.x + p.residual->nb;
    for (int k = 0; k < 2 && 2 * k + 1 <= H[i]; k++) a[k] = hypot(u[4 * k + 1], u[4 * k + 2]);
    if (i == 0) march(&model, &p, truth);
    double off = hypot(a[0] - truth[0], a[1] - truth[1]) / hypot(truth[0], truth[1]);
    print_message("  H %d: u_1 %.6f u_3 %.6f (time integration %.6f %.6f)\n", H[i], a[0], a[1],
                  truth[0], truth[1]);
    if (H[i] < 3)
      verdict_count(off > .1, 1, "9 H %d: missed, off by %.2f", H[i], off);
    else
      verdict(off, H[i] == 3 ? .05 : 1e-2, "9 H %d: found", H[i]);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
  verdict_all();
}

enum { MOST = 8 };

/* Peaks of u along a branch: frequency and amplitude. */
static int peaks(const mhb_response *r, const mhb_branch *b, double at[MOST], double top[MOST]) {
  int n = 0;
  for (int i = 1; i + 1 < b->n_points && n < MOST; i++) {
    double here = harmonic_of(r, b, i, 1, 1);
    if (here < harmonic_of(r, b, i - 1, 1, 1) || here <= harmonic_of(r, b, i + 1, 1, 1)) continue;
    at[n]    = SHB_TWO_PI * b->frequency[i];
    top[n++] = here;
  }
  return n;
}

/* .1 % apart, each peak a ten-thousandth of the range wide: none is missed, none is wrong. */
static void two_near_modes(void **state) {
  (void)state;
  static const double w[] = {1, 1.001}, shape[] = {1, .8}, force[] = {1e-3, 1e-3};
  static const double n0[] = {-1e6, 1e-4, 5e-4, 1e6};
  modal_model         model;
  two_modes(w, 1e-4, shape, force, &model);
  for (int i = 0; i < 4; i++) {
    double at[2][MOST], top[2][MOST], far[2] = {0, 0};
    int    n[2], folds[2];
    for (int k = 0; k < 2; k++) {
      mhb_settings  s = ground_settings(1, 1, 1e-4, n0[i], 5);
      mhb_response *r = covered_sweep(&model, &s, k ? .998 : .5, k ? 1.004 : 1.5);
      n[k]            = peaks(r, &r->branch[2], at[k], top[k]);
      folds[k]        = count_special(&r->branch[2], MHB_FOLD);
      mhb_response_destroy(r);
    }
    verdict_count(n[0], 2, "10 n0 %.0e, range .5 to 1.5: peaks", n0[i]);
    verdict_count(n[1], 2, "10 n0 %.0e, range .998 to 1.004: peaks", n0[i]);
    verdict_count(folds[0], folds[1], "10 n0 %.0e: folds of both", n0[i]);
    for (int p = 0; p < n[0] && p < n[1]; p++) {
      far[0] = fmax(far[0], fabs(at[0][p] / at[1][p] - 1));
      far[1] = fmax(far[1], fabs(top[0][p] / top[1][p] - 1));
    }
    verdict(far[0], 1e-6, "10 n0 %.0e: frequencies of both", n0[i]);
    verdict(far[1], 1e-6, "10 n0 %.0e: amplitudes of both", n0[i]);
  }
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_to_three),
      cmocka_unit_test(two_near_modes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
