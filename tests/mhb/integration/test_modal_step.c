/* One step of the modes: Radau's rule, the exact propagation of an oscillator, the semigroup, and
 * the response to a polynomial force. */
#include "mhb/integration/modal_step.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"

enum { S = MHB_STAGES };

/* A integrates t^0..t^2 exactly from 0 to c_i, and inverse is its inverse. */
static void radau(void **state) {
  (void)state;
  mhb_radau r;
  mhb_radau_create(&r);
  for (int i = 0; i < S; i++)
    for (int p = 0; p < S; p++) {
      double integral = 0, identity = 0;
      for (int j = 0; j < S; j++) {
        integral += r.A[i][j] * pow(r.c[j], p);
        identity += r.A[i][j] * r.inverse[j][p];
      }
      assert_near(integral, pow(r.c[i], p + 1) / (p + 1), 1e-14);
      assert_near(identity, i == p, 1e-13);
    }
  assert_true(r.c[S - 1] == 1);
}

typedef struct {
  modal_model     model;
  mhb_settings    settings;
  mhb_receptance *receptance;
  mhb_ring_step   ring;
  mhb_modal_step  step;
} problem;

static void create(problem *p) {
  random_model(1, WITH_RESIDUAL, 4, &p->model);
  p->settings = ground_settings(0.4, 0.8, 0.5, 0.3, 3);
  assert_ok(mhb_receptance_create(&p->model, &p->settings, 3, &p->receptance));
  assert_ok(mhb_ring_step_create(p->receptance, &p->settings, &p->ring));
  mhb_modal_step_create(&p->ring, true, &p->step);
}

static void destroy(problem *p) {
  mhb_modal_step_destroy(&p->step);
  mhb_ring_step_destroy(&p->ring);
  mhb_receptance_destroy(p->receptance);
  modal_model_free(&p->model);
}

static double row(const problem *p, int row, int mode) {
  return p->step.mode[row * p->ring.s.modes + mode];
}

/* Short and long steps, by series and in closed form, against exp(-zeta w h) cos, sin. */
static void free_motion(void **state) {
  (void)state;
  problem p;
  create(&p);
  for (double h = 1e-4; h < 50; h *= 3) {
    mhb_modal_step_length(&p.ring, h, &p.step);
    for (int i = 0; i < p.ring.s.modes; i++) {
      double w = p.ring.s.omega[i], a = p.ring.s.zeta[i] * w, wd = sqrt(w * w - a * a);
      double decay = exp(-a * h), c = cos(wd * h), s = sin(wd * h) / wd;
      assert_near(row(&p, MHB_END_Z, i), decay * (c + a * s), 1e-13);
      assert_near(row(&p, MHB_END_V, i), decay * s, 1e-13);
      assert_near(row(&p, MHB_RATE_Z, i), -w * w * decay * s, 1e-12);
      assert_near(row(&p, MHB_RATE_V, i), decay * (c - a * s), 1e-13);
    }
  }
  destroy(&p);
}

/* z = t^2 solves the equation for f = 2 + 2 a 2 t + w^2 t^2: end, rate, and stages are exact. */
static void polynomial_force(void **state) {
  (void)state;
  problem p;
  create(&p);
  for (double h = 0.01; h < 4; h *= 3) {
    mhb_modal_step_length(&p.ring, h, &p.step);
    for (int i = 0; i < p.ring.s.modes; i++) {
      double w = p.ring.s.omega[i], a = p.ring.s.zeta[i] * w, end = 0, rate = 0;
      for (int j = 0; j < S; j++) {
        double t = p.ring.rule.c[j] * h, f = 2 + 4 * a * t + w * w * t * t;
        end += row(&p, MHB_END_F + j, i) * f;
        rate += row(&p, MHB_RATE_F + j, i) * f;
      }
      assert_within(end, h * h, 1e-11);
      assert_within(rate, 2 * h, 1e-11);
    }
  }
  destroy(&p);
}

/* The stages of a motion at rest at z = 1: with a small step they are 1 less terms of (w h)^2. */
static void stages_follow_the_motion(void **state) {
  (void)state;
  problem p;
  create(&p);
  double h = 1e-3;
  mhb_modal_step_length(&p.ring, h, &p.step);
  for (int i = 0; i < p.ring.s.modes; i++)
    for (int k = 0; k < S; k++) {
      double t = p.ring.rule.c[k] * h, w = p.ring.s.omega[i];
      assert_near(row(&p, MHB_STAGE_Z + k, i), 1 - w * w * t * t / 2, 3 * pow(w * h, 3));
      assert_near(row(&p, MHB_STAGE_V + k, i), t, 3 * w * h * h);
    }
  destroy(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(radau),
      cmocka_unit_test(free_motion),
      cmocka_unit_test(polynomial_force),
      cmocka_unit_test(stages_follow_the_motion),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
