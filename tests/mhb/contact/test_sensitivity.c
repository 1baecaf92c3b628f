/* The derivative of friction: identities that hold without differences. */
#include "mhb/contact/contact.h"
#include "mhb/contact/internal.h"
#include "mhb/contact/sensitivity.h"
#include "tests/support/check.h"

enum { M = 3, H = 8, NB = 2 * M + 1, NF = 2 * H + 1 };

static const mhb_law SLIPPING = {.mu = .4, .kv = 1, .ku = {1, .2, .8}, .n0 = 3},
                     OPENING  = {.mu = .4, .kv = 1, .ku = {1, .2, .8}, .n0 = .3},
                     STUCK    = {.mu = 9, .kv = 1, .ku = {1, .2, .8}, .n0 = 3};

static const double MOTION[3 * NB] = {.1, .5,  .2, -.1, .05, .02, .07, /* v */
                                      .3, 3,   -1, .4,  .3,  -.2, .1,  /* u */
                                      .2, -.8, 1,  .2,  -.3, .1,  .2}; /* w */

/* Coefficients of dx/dt of signals[3][2m+1]. */
static void differentiate(int m, const double *a, double *slope) {
  for (int i = 0; i < 3; i++, a += 2 * m + 1, slope += 2 * m + 1) {
    slope[0] = 0;
    for (int k = 1; k <= m; k++) {
      slope[2 * k - 1] = -k * a[2 * k];
      slope[2 * k]     = k * a[2 * k - 1];
    }
  }
}

/* A shift of the motion in time shifts the force: J dx/dt = df/dt. */
static void time_shift(void **state) {
  (void)state;
  const mhb_law          laws[]  = {SLIPPING, OPENING, STUCK};
  const char            *names[] = {"slipping", "opening", "stuck"};
  mhb_contact_evaluator *c       = NULL;
  static double          force[3 * NF], J[3 * NF * 3 * NB], dx[3 * NB], df[3 * NF];
  mhb_contact_info       info;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  differentiate(M, MOTION, dx);
  for (int l = 0; l < 3; l++) {
    double worst = 0, top = 0;
    mhb_contact_force(c, &laws[l], MOTION, force, J, &info);
    differentiate(H, force, df);
    for (int i = 0; i < 3 * NF; i++) {
      double sum = -df[i];
      for (int j = 0; j < 3 * NB; j++) sum += J[i * 3 * NB + j] * dx[j];
      worst = fmax(worst, fabs(sum));
      top   = fmax(top, fabs(df[i]));
    }
    print_message("%s: %.1e of %.2f\n", names[l], worst, top);
    assert_true(worst < 1e-7 * top);
    assert_int_equal(info.undetermined, l == 2);
    assert_int_equal(info.share[MHB_SEPARATE] > 0, l == 1);
    assert_int_equal(info.share[MHB_SLIDE] > 0, l < 2);
  }
  mhb_contact_evaluator_destroy(c);
}

/* A mean of the tangential motion changes nothing: its columns vanish. */
static void mean_of_sliding_is_free(void **state) {
  (void)state;
  mhb_contact_evaluator *c = NULL;
  static double          force[3 * NF], J[3 * NF * 3 * NB];
  mhb_contact_info       info;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-10, &c));
  mhb_contact_force(c, &SLIPPING, MOTION, force, J, &info);
  for (int i = 0; i < 3 * NF; i++)
    for (int axis = 1; axis < 3; axis++) assert_near(J[i * 3 * NB + axis * NB], 0, 1e-7);
  mhb_contact_evaluator_destroy(c);
}

/* DP = d v^T: dz of mhb_sensitivity_close solves (I - DP) dz = r. */
static void newton_step_of_the_slider(void **state) {
  (void)state;
  const double           v[2] = {.3, -.7}, d[2] = {.5, .4}, r[2] = {1.1, -.6};
  mhb_contact_evaluator *c = NULL;
  double                 dz[2];
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-8, &c));
  mhb_sensitivity_clear(c);
  mhb_sensitivity_close(c, r, dz); /* no slip: DP is left out */
  assert_near(dz[0], r[0], 0);
  assert_near(dz[1], r[1], 0);
  assert_near(mhb_sensitivity_contraction(c), 1, 0);
  assert_near(mhb_sensitivity_roundoff(c), 0, 0);
  c->lap.slipped = 1;
  for (int k = 0; k < 2; k++) {
    c->lap.v[k]               = v[k];
    c->Z[k][c->slider_column] = d[k];
  }
  mhb_sensitivity_close(c, r, dz);
  for (int k = 0; k < 2; k++)
    assert_near(dz[k] - d[k] * (v[0] * dz[0] + v[1] * dz[1]), r[k], 1e-15);
  assert_near(mhb_sensitivity_contraction(c), hypot(v[0], v[1]) * hypot(d[0], d[1]), 1e-15);
  assert_near(mhb_sensitivity_roundoff(c), 4e-13 / (1 - v[0] * d[0] - v[1] * d[1]), 1e-25);
  mhb_contact_evaluator_destroy(c);
}

/* df does not jump from slip to stick, and back at once nothing is lost: T -> Z -> T. */
static void stick_and_slip_are_inverse(void **state) {
  (void)state;
  mhb_contact_evaluator *c = NULL;
  static double          force[3 * NF], J[3 * NF * 3 * NB], T[3 * NB + 8];
  mhb_contact_info       info;
  assert_ok(mhb_contact_evaluator_create(M, H, 1e-8, &c));
  mhb_contact_force(c, &SLIPPING, MOTION, force, J, &info); /* sets K, mu, the columns */
  for (int j = 0; j < c->slider_column; j++) T[j] = c->T[j] = sin(1 + j);
  T[c->slider_column] = c->T[c->slider_column] = .4;
  double t = 1.3, theta = .8, n = .21;
  mhb_sensitivity_slip_to_stick(c, t, theta, n);
  c->lap.slipped = 1;
  mhb_sensitivity_stick_to_slip(c, t, theta, n);
  for (int j = 0; j <= c->slider_column; j++) assert_near(c->T[j], T[j], 1e-13);
  mhb_contact_evaluator_destroy(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(time_shift),
      cmocka_unit_test(mean_of_sliding_is_free),
      cmocka_unit_test(newton_step_of_the_slider),
      cmocka_unit_test(stick_and_slip_are_inverse),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
