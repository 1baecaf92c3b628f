/* The contact law over a step with its own changes of state: against small steps, energy, and the
 * collocated step where nothing changes. */
#include "mhb/integration/contact_path.h"
#include "tests/support/check.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, FINE = 4096 };

static const mhb_law LAW = {.mu = 0.5, .kv = 3, .ku = {2, 0.3, 1.5}, .n0 = 1.2};

/* m/N of the contact itself */
static const double OWN[3][3] = {{0.05, 0.01, 0}, {0.01, 0.08, 0.02}, {0, 0.02, 0.06}};

typedef struct {
  mhb_radau          rule;
  mhb_contact_spring spring;
} problem;

static problem begin(void) {
  problem p;
  mhb_radau_create(&p.rule);
  mhb_contact_spring_set(&LAW, OWN, &p.spring);
  return p;
}

/* A smooth motion that sticks, slips, opens and closes, s. */
static void motion(double t, double *w) {
  w[0] = 0.45 * sin(1.3 * t);
  w[1] = 0.9 * sin(t);
  w[2] = 0.5 * cos(1.7 * t) - 0.5;
}

/* At rest, closed and stuck, at t = 0. */
static mhb_contact_point rest(const problem *p) {
  mhb_contact_point point = {.state = MHB_STICK};
  double            w[3], x[3];
  motion(0, w);
  x[0] = LAW.kv * w[0] + LAW.n0;
  x[1] = LAW.ku[0] * w[1] + LAW.ku[1] * w[2];
  x[2] = LAW.ku[1] * w[1] + LAW.ku[2] * w[2];
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) point.p[c] += p->spring.stuck[c][k] * x[k];
  for (int c = 0; c < 3; c++) {
    point.u[c] = w[c];
    for (int k = 0; k < 3; k++) point.u[c] -= OWN[c][k] * point.p[k];
  }
  return point;
}

/* Steps of h from t = 0 on. sum[3] <- integral of p; returns the last point. */
static mhb_contact_point follow(const problem *p, double h, int steps, double sum[3], double *work,
                                int *events) {
  mhb_contact_point point = rest(p);
  *work = *events = 0;
  for (int c = 0; c < 3; c++) sum[c] = 0;
  for (int k = 0; k < steps; k++) {
    mhb_contact_path path;
    double           start[3], w[F];
    motion(k * h, start);
    for (int i = 0; i < S; i++) motion((k + p->rule.c[i]) * h, w + 3 * i);
    assert_true(mhb_contact_path_follow(&p->rule, &p->spring, h, &point, start, w, LAW.n0, &path));
    assert_near(path.share[0] + path.share[1] + path.share[2], 1, 1e-9);
    assert_int_equal(path.forced, 0);
    for (int j = 0; j < S; j++)
      for (int c = 0; c < 3; c++) sum[c] += h * p->rule.A[S - 1][j] * path.p[3 * j + c];
    *work += path.work;
    *events += path.events;
    point = path.end;
  }
  return point;
}

/* Impulse, work and end of a motion with many changes of state, by steps that hold several of them.
 * The motion is a cubic in each step, so its error is of order four, and so is that of the rest. */
static void many_events(void **state) {
  (void)state;
  enum { LEVELS = 4 };
  const double            t = 20;
  problem                 p = begin();
  double                  sum[3], exact[3], work, exact_work, error[LEVELS];
  int                     events, exact_events;
  const mhb_contact_point end = follow(&p, t / FINE, FINE, exact, &exact_work, &exact_events);
  for (int k = 0; k < LEVELS; k++) {
    const int               steps = 40 << k;
    const mhb_contact_point at    = follow(&p, t / steps, steps, sum, &work, &events);
    error[k]                      = fabs(work - exact_work) / exact_work;
    for (int c = 0; c < 3; c++) error[k] = fmax(error[k], fabs(sum[c] - exact[c]) / LAW.n0);
    for (int c = 0; c < 3; c++) error[k] = fmax(error[k], fabs(at.p[c] - end.p[c]) / LAW.n0);
    print_message("%3d steps: %d events, error %.1e\n", steps, events, error[k]);
    assert_int_equal(events, exact_events);
    assert_int_equal(at.state, end.state);
  }
  assert_true(exact_events >= 8);
  const double order = log2(error[0] / error[LEVELS - 1]) / (LEVELS - 1);
  print_message("order %.2f\n", order);
  assert_true(order > 3.5);
  assert_true(error[LEVELS - 1] < 1e-6);
}

/* Without a change of state the forces are those of the collocated step. */
static void no_event(void **state) {
  (void)state;
  problem           p     = begin();
  mhb_contact_point point = rest(&p);
  mhb_contact_path  path;
  mhb_contact_step  step;
  mhb_stuck_factor  stuck = {.pivot = {-1}};
  double            start[3], w[F];
  motion(0, start);
  for (int i = 0; i < S; i++) motion(0.1 * p.rule.c[i], w + 3 * i);
  assert_true(mhb_contact_path_follow(&p.rule, &p.spring, 0.1, &point, start, w, LAW.n0, &path));
  assert_int_equal(path.events, 0);
  assert_true(
      mhb_contact_step_solve(&p.rule, &LAW, &point, p.spring.square, &stuck, w, LAW.n0, &step));
  for (int i = 0; i < F; i++) assert_near(path.p[i], step.p[i], 1e-13);
  mhb_contact_step_advance(&LAW, &step, 0.1, &point);
  for (int c = 0; c < 3; c++) assert_near(path.end.u[c], point.u[c], 1e-13);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_event), cmocka_unit_test(many_events)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
