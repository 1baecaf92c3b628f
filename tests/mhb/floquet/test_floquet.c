/* Verdicts and their margin, bifurcation points, identities, limits, what cannot be decided,
 * allocation and time. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "tests/support/allocations.h"
#include "tests/support/check.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { N = 256, MOST = 64 };

/* From the motion in x, and into it; a cold start where x is NULL. */
static mhb_multipliers at(const modal_model *model, const mhb_settings *s, double w, double *x,
                          double complex *mu) {
  periodic p;
  periodic_create(model, s, w, x, &p);
  mhb_multipliers out = periodic_multipliers(&p, N, mu);
  if (x) memcpy(x, p.x, sizeof(double) * (size_t)p.residual->n);
  periodic_destroy(&p);
  return out;
}

enum { UNKNOWNS = 3 * 63 };

/* Where the largest modulus is `level` on the branch that begins with a cold start at `low`: small
 * steps, then bisection. */
static double crossing_of(const modal_model *model, const mhb_settings *s, double level, double low,
                          double step, double complex *mu) {
  double   x[UNKNOWNS], next[UNKNOWNS];
  periodic p;
  periodic_create(model, s, low, NULL, &p);
  memcpy(x, p.x, sizeof(double) * (size_t)p.residual->n);
  periodic_destroy(&p);
  int above = at(model, s, low, x, mu).largest > level, steps = 0;
  while (step > 1e-9) {
    memcpy(next, x, sizeof x);
    if ((at(model, s, low + step, next, mu).largest > level) != above) {
      step *= .5;
      continue;
    }
    low += step;
    memcpy(x, next, sizeof x);
    assert_true(steps++ < 100);
  }
  at(model, s, low, x, mu);
  return low;
}

/* The reference sampled its friction events: 2e-4. */
static void neimark_sacker_points(void **state) {
  (void)state;
  static const double rows[2][2] = {{1.198, 1.20060}, {1.252, 1.25635}};
  modal_model         model;
  three_degree_model(&model);
  mhb_settings   s = ground_settings(.4, .8, .5, .1, 15);
  double complex mu[MOST];
  for (int i = 0; i < 2; i++) {
    double w = crossing_of(&model, &s, 1, rows[i][0], 5e-4, mu);
    print_message("at %.6f (%.5f): %.5f %+.5fj\n", w, rows[i][1], creal(mu[0]), cimag(mu[0]));
    assert_near(w, rows[i][1], 2e-4);
    assert_true(fabs(cimag(mu[0])) > .1);
  }
  modal_model_free(&model);
}

/* Stable up to 1, marginal up to 1 + max(1e-3, change), unstable beyond. */
static void margin(void **state) {
  (void)state;
  static const struct {
    double      level;
    mhb_verdict verdict;
  } rows[] = {{.9995, MHB_STABLE}, {1.0005, MHB_MARGINAL}, {1.0015, MHB_UNSTABLE}};
  modal_model model;
  three_degree_model(&model);
  mhb_settings   s = ground_settings(.4, .8, .5, .1, 15);
  double complex mu[MOST];
  for (int i = 0; i < 3; i++) {
    double          w   = crossing_of(&model, &s, rows[i].level, 1.198, 1e-3, mu);
    mhb_multipliers out = at(&model, &s, w, NULL, mu);
    assert_near(out.largest, rows[i].level, 1e-5);
    assert_int_equal(out.verdict, rows[i].verdict);
    assert_int_equal(out.n_unstable, rows[i].verdict == MHB_UNSTABLE ? 2 : 0);
    assert_true(out.change >= 0 && out.change < 5e-4);
  }
  periodic p;
  periodic_create(&model, &s, 1.2015, NULL, &p);
  double fine = periodic_multipliers(&p, 1024, mu).largest;
  for (int steps = 1; steps <= 64; steps *= 2) { /* however few to begin with: enough in the end */
    mhb_multipliers out = periodic_multipliers(&p, steps, mu);
    print_message("%2d sub-steps: %.5f (%.5f), change %.1e, verdict %d\n", steps, out.largest, fine,
                  out.change, (int)out.verdict);
    assert_true(fabs(out.largest - fine) <= fmax(out.change, 2e-4));
    if (out.verdict == MHB_UNDECIDED) continue;
    assert_int_equal(out.verdict == MHB_UNSTABLE, fine > 1 + fmax(1e-3, out.change));
  }
  periodic_destroy(&p);
  modal_model_free(&model);
}

/* Far below its resonance a closed contact vibrates ten times a period: however few sub-steps it
 * begins with, the verdict is that of many. A fixed number of 32 calls most of the unstable ones
 * stable. */
static void slow_motions_are_resolved(void **state) {
  (void)state;
  modal_model    model;
  double complex mu[MOST];
  int            unstable = 0;
  one_degree_model(.02, 0, .5, &model);
  mhb_settings s = ground_settings(0, 9, 1, -.5, 21);
  for (int i = 0; i < 24; i++) {
    periodic p;
    double   w = .3 + .02 * i;
    periodic_create(&model, &s, w, NULL, &p);
    mhb_multipliers few  = periodic_multipliers(&p, 32, mu),
                    many = periodic_multipliers(&p, 2048, mu);
    print_message("W %.2f: %.4f, %.4f\n", w, few.largest, many.largest);
    assert_int_equal(few.verdict, many.verdict);
    assert_true(fabs(few.largest - many.largest) <= .1 * fabs(many.largest - 1) + 1e-3);
    unstable += many.verdict == MHB_UNSTABLE;
    periodic_destroy(&p);
  }
  assert_true(unstable >= 3);
  modal_model_free(&model);
}

/* A gap closed hard near twice its own frequency: the motion doubles its period. */
static void flip(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(.02, 0, .5, &model);
  mhb_settings   s = ground_settings(0, 9, 1, -.5, 31);
  periodic       p;
  disturbed      d;
  double complex mu[MOST], brute[4];
  periodic_create(&model, &s, 2.7, NULL, &p);
  mhb_multipliers out = periodic_multipliers(&p, 1024, mu);
  disturbed_create(&model, &p.settings, p.residual, p.x, p.omega, 8000, &d);
  disturbed_multipliers(&d, 1e-6, brute);
  print_message("multipliers %.5f %.5f, integrated %.5f %.5f\n", creal(mu[0]), creal(mu[1]),
                creal(brute[0]), creal(brute[1]));
  assert_int_equal(out.verdict, MHB_UNSTABLE);
  assert_int_equal(out.crossing, MHB_THROUGH_MINUS_ONE);
  assert_near(creal(mu[0]), creal(brute[0]), 2e-3);
  assert_near(creal(mu[1]), creal(brute[1]), 2e-3);
  double w = crossing_of(&model, &s, 1, 3.05, .01, mu);
  print_message("at %.6f: %.6f\n", w, creal(mu[0]));
  assert_near(cabs(mu[0] + 1), 0, 1e-5);
  disturbed_destroy(&d);
  periodic_destroy(&p);
  modal_model_free(&model);
}

/* A constant normal load makes friction a contraction: no multiplier is beyond 1, however stiff the
 * contact and coarse the steps. */
static void friction_alone_is_stable(void **state) {
  (void)state;
  unsigned long long seed    = 5;
  double             top     = 0;
  int                slipped = 0;
  for (int i = 0; i < 40; i++) {
    modal_model    model;
    mhb_settings   s = random_settings(7);
    periodic       p;
    double complex mu[MOST];
    random_model(1 + i % 2, WITH_AREAS, 100 + (unsigned)i, &model);
    for (int k = 0; k < model.n_modes; k++) model.damping_ratio[k] *= 1e-3;
    double stiff = pow(10, 1.5 * (1 + random_unit(&seed)) - 1), skew = .9 * random_unit(&seed);
    s.to_ground = true;
    s.kv        = 0;
    s.n0[0]     = .02 + .1 * (1 + random_unit(&seed));
    s.ku[0]     = stiff;
    s.ku[2]     = stiff * (1.2 + random_unit(&seed));
    s.ku[1]     = skew * sqrt(s.ku[0] * s.ku[2]);
    periodic_create(&model, &s, 1 + .5 * random_unit(&seed), NULL, &p);
    for (int steps = 16; steps <= 256; steps *= 4) {
      mhb_multipliers out = periodic_multipliers(&p, steps, mu);
      if (!(out.largest < 1))
        fail_msg("case %d, stiffness %.3g, %d sub-steps: %.6f", i, stiff, steps, out.largest);
      assert_int_equal(out.verdict, MHB_STABLE);
      top = fmax(top, out.largest);
    }
    slipped += p.residual->eval->info[0].share[MHB_SLIDE] > .05;
    periodic_destroy(&p);
    modal_model_free(&model);
  }
  print_message("largest %.6f, %d of 40 slipping\n", top, slipped);
  assert_true(slipped > 20);
}

/* Den Hartog's oscillator: a contact a million times stiffer than the structure. */
static void stiff_contact(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(.01, 1, 1, &model);
  for (int i = 0; i < 6; i++) {
    mhb_settings   s = ground_settings(.5, 1, pow(10, 1 + i), 1, 15);
    double complex mu[MOST];
    periodic       p;
    periodic_create(&model, &s, .7, NULL, &p);
    for (int steps = 16; steps <= 1024; steps *= 4) {
      mhb_multipliers out = periodic_multipliers(&p, steps, mu);
      assert_int_equal(out.verdict, MHB_STABLE);
    }
    print_message("ku 1e%d: %.5f %.5f\n", 1 + i, cabs(mu[0]), cabs(mu[1]));
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Other units, another phase of the excitation: the same multipliers. */
static void identities(void **state) {
  (void)state;
  modal_model    plain, other;
  double complex mu[MOST], same[MOST];
  mhb_settings   s = ground_settings(.4, .8, .5, .1, 9);
  three_degree_model(&plain);
  int n = at(&plain, &s, 1.25, NULL, mu).n;

  three_degree_model(&other); /* micrometres and meganewtons */
  for (int k = 0; k < 9; k++) other.right[k] *= 1e6;
  mhb_settings small = ground_settings(.4, .8e-12, .5e-12, .1e-6, 9);
  assert_int_equal(at(&other, &small, 1.25, NULL, same).n, n);
  assert_near(distance_to(mu, n, same, n), 0, 1e-7);
  modal_model_free(&other);

  three_degree_model(&other);
  for (int k = 0; k < 3; k++) other.modal_force[3 + k] *= cexp(2.1 * I);
  assert_int_equal(at(&other, &s, 1.25, NULL, same).n, n);
  assert_near(distance_to(mu, n, same, n), 0, 1e-6);
  modal_model_free(&other);
  modal_model_free(&plain);
}

/* A mode near the excitation that has no dynamics: the multipliers are not judged. */
static void a_mode_near_the_excitation_is_not_left_out(void **state) {
  (void)state;
  modal_model     model;
  mhb_settings    s = random_settings(9);
  periodic        p;
  mhb_floquet    *stability;
  mhb_multipliers out;
  random_model(1, WITH_LEFT, 11, &model);
  s.blades = 3;
  s.n0[0]  = .05;
  periodic_create(&model, &s, 1.25, NULL, &p);
  assert_int_equal(mhb_floquet_create(p.residual->receptance, &s, N, 6 * 5 + 6, &stability),
                   SHB_OK);
  mhb_floquet_evaluate(stability, &p.solution, &out);
  print_message("5 of 6 modes, the last at %.2f of the excitation: %s\n",
                SHB_TWO_PI * model.frequency[5] / 1.25, out.reason);
  assert_true(SHB_TWO_PI * model.frequency[5] < 2 * 1.25);
  assert_int_equal(out.verdict, MHB_UNDECIDED);
  assert_non_null(strstr(out.reason, "too few modes"));
  mhb_floquet_destroy(stability);
  periodic_destroy(&p);
  modal_model_free(&model);
}

/* A ring with fewer modes than the model has; none at all; a contact that was lost; no
 * sub-steps. */
static void limits(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s = random_settings(9);
  periodic       p;
  mhb_floquet   *stability;
  double complex full[MOST];
  random_model(1, WITH_LEFT, 11, &model);
  for (int i = 3; i < 6; i++) model.frequency[i] *= 3;
  s.blades = 3;
  s.n0[0]  = .05;
  periodic_create(&model, &s, 1.1, NULL, &p);
  mhb_multipliers whole = periodic_multipliers(&p, N, full), out;
  assert_int_equal(whole.modes, 6);
  const mhb_receptance *r = p.residual->receptance;
  for (int modes = 5; modes >= 3; modes--) {
    assert_int_equal(mhb_floquet_create(r, &s, N, 6 * modes + 6, &stability), SHB_OK);
    mhb_floquet_evaluate(stability, &p.solution, &out);
    print_message("%d modes: largest %.5f (%.5f)\n", modes, out.largest, whole.largest);
    assert_int_equal(out.modes, modes);
    assert_int_equal(out.n + out.n_zero, 6 * modes + 6);
    assert_near(out.largest, whole.largest, 3e-2);
    mhb_floquet_destroy(stability);
  }
  assert_int_equal(mhb_floquet_create(r, &s, N, 11, &stability), SHB_OK);
  mhb_floquet_evaluate(stability, &p.solution, &out);
  assert_int_equal(out.verdict, MHB_UNDECIDED);
  assert_non_null(strstr(out.reason, "max_states"));
  mhb_floquet_destroy(stability);
  p.residual->eval->info[0].lost = 1;
  assert_int_equal(periodic_multipliers(&p, N, full).verdict, whole.verdict);
  p.residual->eval->info[0].error = 1e-3;
  assert_int_equal(periodic_multipliers(&p, N, full).verdict, MHB_UNDECIDED);
  assert_int_equal(mhb_floquet_create(r, &s, 0, 0, &stability), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "sub-step"));
  periodic_destroy(&p);
  modal_model_free(&model);
}

/* 20 modes, a contact that sticks and slips; and stuck, where the exponents are kept. */
static void nothing_is_allocated(void **state) {
  (void)state;
  static const double hertz[] = {266, 300};
  modal_model         model;
  tip_contact_beam_model(8, &model);
  mhb_settings s = ground_settings(.3, 2e5, 2e5, 100, 7);
  for (int i = 0; i < 2; i++) {
    periodic        p;
    mhb_floquet    *stability;
    mhb_multipliers out;
    periodic_create(&model, &s, SHB_TWO_PI * hertz[i], NULL, &p);
    assert_int_equal(mhb_floquet_create(p.residual->receptance, &s, N, 0, &stability), SHB_OK);
    mhb_floquet_evaluate(stability, &p.solution, &out);
    long before = allocations;
    for (int k = 0; k < 5; k++) mhb_floquet_evaluate(stability, &p.solution, &out);
    assert_int_equal(allocations, before);
    assert_true(before > 0);
    print_message("%.0f Hz, %d multipliers, slip %.2f\n", hertz[i], out.n,
                  p.residual->eval->info[0].share[MHB_SLIDE]);
    mhb_floquet_destroy(stability);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(neimark_sacker_points),
      cmocka_unit_test(slow_motions_are_resolved),
      cmocka_unit_test(margin),
      cmocka_unit_test(flip),
      cmocka_unit_test(friction_alone_is_stable),
      cmocka_unit_test(stiff_contact),
      cmocka_unit_test(identities),
      cmocka_unit_test(a_mode_near_the_excitation_is_not_left_out),
      cmocka_unit_test(limits),
      cmocka_unit_test(nothing_is_allocated),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
