/* Flips and Neimark-Sacker points followed along a parameter against those of frequency sweeps, and
 * against time integration. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/numerics/vector.h"
#include "mhb/problem/parameter.h"
#include "mhb/tracking/tracked_response.h"
#include "tests/support/check.h"
#include "tests/support/disturbed.h"
#include "tests/support/main_curve.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

/* A model and what is followed in it. */
typedef struct {
  modal_model  model;
  mhb_settings settings;
  int          special; /* of sweeps */
} fixture;

static void set_up(fixture *f, bool flip, mhb_parameter parameter, double low, double high) {
  mhb_settings *s = &f->settings;
  if (flip) {
    one_degree_model(0.02, 0, 1, &f->model);
    *s = ground_settings(0, 9, 1, -1, 16);
  } else {
    three_degree_model(&f->model);
    *s = ground_settings(0.4, 0.8, 0.5, 0.1, 15);
  }
  s->frequency[0] = (flip ? 2 : 0.8) / SHB_TWO_PI;
  s->frequency[1] = (flip ? 3.6 : 1.7) / SHB_TWO_PI;
  s->track        = flip ? MHB_TRACK_FLIPS : MHB_TRACK_NEIMARK_SACKERS;
  s->parameter    = parameter;
  s->range[0]     = low;
  s->range[1]     = high;
  s->stability    = MHB_STABILITY_ALWAYS;
  f->special      = flip ? MHB_FLIP : MHB_NEIMARK_SACKER;
}

static mhb_response *follow(const fixture *f) {
  mhb_response *r;
  shb_progress  quiet = shb_progress_start("mhb", true, false);
  assert_ok(mhb_tracked_response(&f->model, &f->settings, NULL, NULL, &quiet, &r));
  assert_string_equal(r->track, mhb_track_word(f->settings.track));
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *k = &r->branch[b];
    print_message("%d points, %.9g to %.9g: %s\n", k->n_points, k->value[0],
                  k->value[k->n_points - 1], k->reason);
    for (int i = 0; i < k->n_points; i++) assert_below(fabs(cabs(k->multiplier[i]) - 1), 1e-6);
  }
  return r;
}

/* The bifurcation of a sweep, all of whose points are judged, that is nearest to a frequency; Hz.
 * NAN: it has none. */
static double swept(const fixture *f, double value, double frequency) {
  mhb_response       *r;
  mhb_settings        s    = f->settings;
  mhb_operating_point at   = mhb_operating_point_of(&s);
  double              best = NAN;
  mhb_parameter_set(&at, s.parameter, value);
  s.n0[0]        = at.n0;
  s.parameter    = MHB_IN_FREQUENCY;
  s.track        = MHB_TRACK_NOTHING;
  s.frequency[0] = 0.99 * frequency;
  s.frequency[1] = 1.01 * frequency;
  assert_ok(main_curve(&f->model, &s, s.harmonics, NULL, &r));
  for (int i = 0; i < r->branch[0].n_points; i++) {
    double there = r->branch[0].frequency[i];
    if (r->branch[0].special[i] == f->special &&
        !(fabs(there - frequency) >= fabs(best - frequency)))
      best = there;
  }
  mhb_response_destroy(r);
  return best;
}

/* Whether the curve turns in the parameter near a point. Between the two bifurcations of a sweep
 * there the multipliers stay within the verdict's margin. */
static bool near_turn(const mhb_branch *k, int point) {
  for (int i = 0; i < k->n_points; i++)
    if (k->special[i] == MHB_FOLD && fabs(k->value[i] / k->value[point] - 1) < 1e-2) return true;
  return false;
}

/* Every few points of all branches. Returns the number compared. */
static int compare(const fixture *f, const mhb_response *r, int every, double *worst) {
  int n  = 0;
  *worst = 0;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *k = &r->branch[b];
    for (int i = every / 2; i < k->n_points; i += every) {
      if (near_turn(k, i)) continue;
      double at = swept(f, k->value[i], k->frequency[i]), away = fabs(k->frequency[i] / at - 1);
      print_message("  n0 %10.6f: %.9f rad/s, sweep %.9f: %.1e\n", k->value[i],
                    SHB_TWO_PI * k->frequency[i], SHB_TWO_PI * at, away);
      assert_true(isfinite(at));
      *worst = fmax(*worst, away);
      n++;
    }
  }
  return n;
}

/* rad/s of a tracked branch at a value, between its points; near: the place wanted. */
static double tracked_at(const mhb_response *r, double value, double near) {
  double best = NAN;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) {
      double at = SHB_TWO_PI * r->branch[b].frequency[i];
      if (fabs(r->branch[b].value[i] - value) < 1e-12 && !(fabs(at - near) >= fabs(best - near)))
        best = at;
    }
  return best;
}

static void each_neimark_sacker_point_is_that_of_a_sweep(void **state) {
  (void)state;
  fixture f;
  double  worst;
  set_up(&f, false, MHB_IN_N0, 0.1, 0.3);
  mhb_response *r = follow(&f);
  assert_true(compare(&f, r, 6, &worst) >= 5);
  assert_below(worst, 1e-6);
  assert_near(tracked_at(r, 0.1, 1.2), 1.200587, 1e-6);
  assert_near(tracked_at(r, 0.1, 1.26), 1.256354, 1e-6);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

static void each_flip_is_that_of_a_sweep(void **state) {
  (void)state;
  fixture f;
  double  worst;
  set_up(&f, true, MHB_IN_N0, -1, -0.7);
  mhb_response *r = follow(&f);
  assert_int_equal(r->n_branches, 2);
  assert_true(compare(&f, r, 4, &worst) >= 3);
  assert_below(worst, 1e-6);
  assert_near(tracked_at(r, -1, 2.2), 2.213689, 1e-6);
  assert_near(tracked_at(r, -1, 3.1), 3.114557, 1e-6);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

/* A closed region of modulated motion, run through once. */
static void a_closed_curve_is_run_through_once(void **state) {
  (void)state;
  fixture f;
  int     turns = 0;
  set_up(&f, false, MHB_IN_N0, 0.05, 0.3);
  mhb_response *r = follow(&f);
  assert_int_equal(r->n_branches, 1);
  const mhb_branch *k = &r->branch[0];
  assert_string_equal(k->reason, "closed curve; closed curve");
  assert_near(k->value[0], k->value[k->n_points - 1], 1e-9);
  for (int i = 0; i < k->n_points; i++) turns += k->special[i] == MHB_FOLD;
  assert_int_equal(turns, 2);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

/* Through a preload of zero, from a gap to a pressed contact. */
static void a_curve_passes_a_preload_of_zero(void **state) {
  (void)state;
  fixture f;
  double  worst;
  set_up(&f, true, MHB_IN_N0, -0.2, 0.1);
  mhb_response *r = follow(&f);
  assert_int_equal(r->n_branches, 1);
  assert_true(compare(&f, r, 15, &worst) >= 2);
  assert_below(worst, 1e-6);
  assert_near(r->branch[0].value[0], -0.2, 1e-9);
  assert_near(r->branch[0].value[r->branch[0].n_points - 1], 0.1, 1e-9);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

/* Both multipliers of the pair are 1 at the end, and Re mu - 1 vanishes linearly towards it. */
static void a_pair_that_meets_ends_the_curve_there(void **state) {
  (void)state;
  fixture f;
  set_up(&f, false, MHB_IN_MU, 0.8, 2);
  f.settings.harmonics    = 9;
  f.settings.frequency[0] = 1.36 / SHB_TWO_PI;
  mhb_response *r         = follow(&f);
  int           ends      = 0;
  for (int b = 0; b < r->n_branches; b++) {
    const mhb_branch *k = &r->branch[b];
    if (!strstr(k->reason, "the pair of multipliers meets at +1")) continue;
    const bool first = k->reason[0] == 't';
    const int  end = first ? 0 : k->n_points - 1, step = first ? 1 : -1;
    double     at[2], q[2];
    for (int i = 0; i < 2; i++) {
      at[i] = pow(cimag(k->multiplier[end + (i + 1) * step]), 2);
      q[i]  = k->value[end + (i + 1) * step];
    }
    double line = q[0] - at[0] * (q[1] - q[0]) / (at[1] - at[0]);
    print_message("mu %.9f: multiplier %.9f%+.9fj; by the squares of two imaginary parts %.6f\n",
                  k->value[end], creal(k->multiplier[end]), cimag(k->multiplier[end]), line);
    assert_below(cabs(k->multiplier[end] - 1), 1e-5);
    assert_near(line, k->value[end], 1e-2 * k->value[end]);
    ends++;
  }
  assert_int_equal(ends, 1);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

/* Growth a period, by the logarithm, of a small disturbance of the solution: a time integration
 * that shares no code with the multipliers. */
static double growth(const fixture *f, double value, double omega) {
  enum { STEPS = 4000, SETTLE = 60, PERIODS = 240 };
  static const double size = 1e-5;
  periodic            p;
  disturbed           d;
  mhb_settings        s = f->settings;
  s.n0[0]               = value;
  periodic_create(&f->model, &s, omega, NULL, &p);
  disturbed_create(&f->model, &p.settings, p.residual, p.x, omega, STEPS, &d);
  double still[d.n], moved[d.n], before = 0, after = 0;
  disturbed_start(&d, still);
  for (int i = 0; i < SETTLE; i++) disturbed_period(&d, still); /* its own discretisation */
  memcpy(moved, still, sizeof moved);
  moved[0] += size * mhb_norm(p.x, p.residual->n);
  for (int i = 0; i < PERIODS; i++) {
    disturbed_period(&d, still);
    disturbed_period(&d, moved);
    double square = 0;
    for (int k = 0; k < f->model.n_modes; k++) square += pow(moved[k] - still[k], 2);
    before += i >= SETTLE && i < 2 * SETTLE ? square : 0;
    after += i >= PERIODS - SETTLE ? square : 0;
  }
  disturbed_destroy(&d);
  periodic_destroy(&p);
  return 0.5 * log(after / before) / (PERIODS - 2 * SETTLE);
}

/* At a tracked point that no sweep gave. */
static void a_disturbance_grows_on_one_side_only(void **state) {
  (void)state;
  fixture f;
  set_up(&f, false, MHB_IN_N0, 0.1, 0.3);
  mhb_response     *r  = follow(&f);
  const mhb_branch *k  = &r->branch[0];
  int               at = -1;
  for (int i = 0; i < k->n_points; i++)
    if (k->special[i] == MHB_ORDINARY && k->value[i] > 0.13 && k->value[i] < 0.18 &&
        SHB_TWO_PI * k->frequency[i] > 1.26)
      at = i;
  assert_true(at >= 0);
  double omega = SHB_TWO_PI * k->frequency[at], side[2], away = 5e-4;
  for (int i = 0; i < 2; i++) side[i] = growth(&f, k->value[at], omega * (1 + (i ? away : -away)));
  double zero = omega * (1 - away + 2 * away * side[0] / (side[0] - side[1]));
  print_message("n0 %.6f: growth a period %.2e and %.2e, zero at %.6f, tracked %.6f\n",
                k->value[at], side[0], side[1], zero, omega);
  assert_true(side[0] > 0 && side[1] < 0);
  assert_below(fabs(zero / omega - 1), 1e-4);
  mhb_response_destroy(r);
  modal_model_free(&f.model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_neimark_sacker_point_is_that_of_a_sweep),
                                     cmocka_unit_test(each_flip_is_that_of_a_sweep),
                                     cmocka_unit_test(a_closed_curve_is_run_through_once),
                                     cmocka_unit_test(a_curve_passes_a_preload_of_zero),
                                     cmocka_unit_test(a_pair_that_meets_ends_the_curve_there),
                                     cmocka_unit_test(a_disturbance_grows_on_one_side_only)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
