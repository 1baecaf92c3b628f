/* The open and the stuck limit in ranges so wide that a resonance is a needle. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/linear_limits.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

static void limit(const modal_model *model, mhb_settings *s, bool stuck, double from, double to,
                  mhb_response **out) {
  mhb_balance *balance;
  int          index;
  s->frequency[0] = from;
  s->frequency[1] = to;
  assert_ok(mhb_balance_create(model, s, &balance));
  *out = mhb_response_create(model->n_pairs, model->n_probes, s->harmonics);
  assert_non_null(*out);
  index = mhb_response_branch(*out, stuck ? MHB_BRANCH_STUCK : MHB_BRANCH_OPEN);
  assert_ok(mhb_linear_limits(balance, *out, index));
  mhb_balance_destroy(balance);
}

/* Amplitude of the first probe's harmonic k. */
static double amplitude(const mhb_response *r, int point, int k) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    const size_t at =
        ((size_t)point * (size_t)r->n_probes * 3 + (size_t)axis) * (size_t)(r->n_harmonics + 1) +
        (size_t)k;
    sum += pow(cabs(r->branch[0].probe[at]), 2);
  }
  return sqrt(sum);
}

static bool is_peak(const mhb_response *r, int i) {
  return amplitude(r, i, 1) > amplitude(r, i - 1, 1) && amplitude(r, i, 1) > amplitude(r, i + 1, 1);
}

/* Height of the peak nearest to a frequency. */
static double peak_at(const mhb_response *r, double frequency) {
  double nearest = INFINITY, height = 0;
  for (int i = 1; i + 1 < r->branch[0].n_points; i++) {
    const double away = fabs(r->branch[0].frequency[i] - frequency);
    if (!is_peak(r, i) || away > nearest) continue;
    nearest = away;
    height  = amplitude(r, i, 1);
  }
  return height;
}

/* Compare the peak at f with that of a sweep of 2 % around it. */
static double peak_error(const modal_model *model, mhb_settings *s, bool stuck,
                         const mhb_response *wide, double f) {
  mhb_response *near;
  limit(model, s, stuck, 0.98 * f, 1.02 * f, &near);
  const double error = peak_at(wide, f) / peak_at(near, f) - 1;
  mhb_response_destroy(near);
  return fabs(error);
}

/* A beam of 20 modes from 1 Hz to 1 MHz: every peak is as high as that of a sweep around it. A free
 * mode has its peak where the load drives it. */
static void needles_are_found(void **state) {
  (void)state;
  for (int stuck = 0; stuck < 2; stuck++) {
    modal_model   model;
    mhb_response *wide;
    mhb_settings  s     = ground_settings(0.3, 8e5, 5e5, 10, 3);
    int           n     = 0;
    double        worst = 0;
    tip_contact_beam_model(1, &model);
    limit(&model, &s, stuck, 1, 1e6, &wide);
    for (int i = 1; i + 1 < wide->branch[0].n_points; i++) {
      if (!is_peak(wide, i)) continue;
      worst = fmax(worst, peak_error(&model, &s, stuck, wide, wide->branch[0].frequency[i]));
      n++;
    }
    for (int i = 0; i < model.n_modes && !stuck; i++)
      if (model.modal_force[model.n_modes + i] != 0)
        worst = fmax(worst, peak_error(&model, &s, stuck, wide, model.frequency[i]));
    print_message("%s: %d points, %d peaks, worst %.1e off\n", stuck ? "stuck" : "open",
                  wide->branch[0].n_points, n, worst);
    assert_true(n >= 10 && worst < 1e-3);
    mhb_response_destroy(wide);
    modal_model_free(&model);
  }
}

/* The natural frequencies of harmonic k of the load are points, at f/k. */
static void natural_frequencies_are_points(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *open;
  mhb_settings  s = random_settings(4);
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 7, &model);
  limit(&model, &s, false, 1e-3, 1e3, &open);
  for (int k = 1; k <= 2; k++)
    for (int i = 0; i < model.n_modes; i++) {
      const double wanted = model.frequency[i] / k;
      double       off    = INFINITY;
      for (int p = 0; p < open->branch[0].n_points; p++)
        off = fmin(off, fabs(open->branch[0].frequency[p] / wanted - 1));
      assert_true(off < 1e-12);
    }
  mhb_response_destroy(open);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(needles_are_found),
      cmocka_unit_test(natural_frequencies_are_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
