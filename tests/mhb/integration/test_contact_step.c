/* The contact law over one step of prescribed motion: forces in each state, the place of each
 * event, the slider after slip. Without compliance (S = 0) the motion at the stages is y. */
#include "mhb/integration/contact_step.h"
#include "tests/support/check.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES };

static const mhb_law LAW = {.mu = 0.5, .kv = 3, .ku = {2, 0, 2}, .n0 = 1.2};

static const double NO_COMPLIANCE[F * F];

typedef struct {
  mhb_law           law;
  mhb_radau         rule;
  mhb_contact_point point;
  mhb_contact_step  step;
  mhb_stuck_factor  stuck;
} problem;

/* A stuck contact at rest, u = 0, without friction. */
static void begin(problem *p) {
  *p                = (problem){.law = LAW, .point = {.state = MHB_STICK, .p = {LAW.n0, 0, 0}}};
  p->stuck.pivot[0] = -1;
  mhb_radau_create(&p->rule);
}

/* Step of 1 s in which the contact moves to u(1) = end at constant speed. Returns its status. */
static int move(problem *p, const double end[3]) {
  double y[F];
  for (int i = 0; i < F; i++)
    y[i] = p->point.u[i % 3] + p->rule.c[i / 3] * (end[i % 3] - p->point.u[i % 3]);
  mhb_contact_step_guess(&p->law, &p->point, 1, &p->step);
  return mhb_contact_step_solve(&p->rule, &p->law, &p->point, NO_COMPLIANCE, &p->stuck, y, LAW.n0,
                                &p->step);
}

/* Stick is a spring; it ends where the spring's force reaches the friction limit. */
static void stick_then_slip(void **state) {
  (void)state;
  problem           p;
  mhb_contact_event event;
  begin(&p);
  assert_true(move(&p, (double[]){0.1, 0.6, 0}));
  const double *last = p.step.p + F - 3;
  assert_near(last[0], LAW.n0 + 0.3, 1e-14);
  assert_near(last[1], 1.2, 1e-14);
  /* 1.2 tau = 0.5 (1.2 + 0.3 tau) */
  double tau = mhb_contact_step_first(&p.rule, &p.law, &p.point, &p.step, 1e-12, &event);
  assert_int_equal(event, MHB_STICK_TO_SLIP);
  assert_near(tau, 0.6 / 1.05, 1e-13);
}

/* Slip: |f| = mu n along the motion, the slider follows. Back: slip ends at once. */
static void slip_then_stick(void **state) {
  (void)state;
  problem           p;
  mhb_contact_event event;
  begin(&p);
  p.point.u[1] = 0.3; /* at the limit: 2 * 0.3 = 0.5 * 1.2 */
  p.point.p[1] = 0.6;
  mhb_contact_step_change(&p.law, MHB_SLIDE, 0, &p.point);
  assert_true(move(&p, (double[]){0, 1, 0}));
  for (int i = 0; i < S; i++) {
    assert_near(p.step.p[3 * i + 1], 0.6, 1e-12);
    assert_small(p.step.p[3 * i + 2], 1e-12);
  }
  assert_near(mhb_contact_step_first(&p.rule, &p.law, &p.point, &p.step, 1e-10, &event), 2, 0);
  mhb_contact_step_advance(&p.law, &p.step, 1, &p.point);
  assert_near(p.point.zeta[0], 2 * 1 - 0.6, 1e-12);
  assert_near(p.point.lambda, 0.7, 1e-11);
  assert_near(mhb_contact_step_excess(&p.rule, &p.law, &p.point, &p.step, MHB_SLIP_TO_STICK, 0.5),
              -2 * 0.7, 1e-11);
  assert_true(move(&p, (double[]){0, 0.9, 0})); /* the slider cannot go back */
  double tau = mhb_contact_step_first(&p.rule, &p.law, &p.point, &p.step, 1e-10, &event);
  assert_int_equal(event, MHB_SLIP_TO_STICK);
  assert_small(tau, 1e-10);
}

/* Opening where n0 + kv v = 0, closing at the same place. Without friction: with it slip comes
 * first, at the same time. */
static void open_and_close(void **state) {
  (void)state;
  problem           p;
  mhb_contact_event event;
  begin(&p);
  p.law.mu = 0;
  assert_true(move(&p, (double[]){-0.5, 0, 0}));
  double tau = mhb_contact_step_first(&p.rule, &p.law, &p.point, &p.step, 1e-12, &event);
  assert_int_equal(event, MHB_CONTACT_OPENS);
  assert_near(tau, 0.8, 1e-13);
  mhb_contact_step_change(&p.law, MHB_SEPARATE, 0, &p.point);
  p.point.u[0] = -0.5;
  assert_true(move(&p, (double[]){-0.1, 0.2, 0}));
  for (int i = 0; i < F; i++) assert_true(p.step.p[i] == 0);
  tau = mhb_contact_step_first(&p.rule, &p.law, &p.point, &p.step, 1e-12, &event);
  assert_int_equal(event, MHB_CONTACT_CLOSES);
  assert_near(tau, 0.25, 1e-13);
}

/* A closing contact sticks if Ku s' is below mu n' (eq. 13): 2 s' against 0.5 * 3 v'. */
static void closing(void **state) {
  (void)state;
  problem p;
  double  direction;
  for (int slides = 0; slides < 2; slides++) {
    begin(&p);
    p.point.u[0] = -0.4;
    p.point.p[0] = 0;
    mhb_contact_step_change(&p.law, MHB_STICK, 0, &p.point);
    assert_true(move(&p, (double[]){-0.4 + 0.1, 0, slides ? 0.08 : 0.07}));
    double rate = mhb_contact_step_closing(&p.rule, &p.law, &p.point, &p.step, &direction);
    assert_near(rate, 2 * (slides ? 0.08 : 0.07) - 0.15, 1e-13);
    assert_near(direction, acos(0), 1e-12);
  }
}

/* Without friction a contact has no tangential spring. */
static void frictionless(void **state) {
  (void)state;
  mhb_law law = LAW;
  law.mu      = 0;
  law         = mhb_contact_step_law(&law);
  assert_true(law.ku[0] == 0 && law.ku[1] == 0 && law.ku[2] == 0 && law.kv == LAW.kv);
  assert_true(mhb_contact_step_law(&LAW).ku[0] == LAW.ku[0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stick_then_slip), cmocka_unit_test(slip_then_stick),
      cmocka_unit_test(open_and_close),  cmocka_unit_test(closing),
      cmocka_unit_test(frictionless),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
