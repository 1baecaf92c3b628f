/* Slip panel by panel against closed forms: the rule, the direction, the end of slip. */
#include "mesh/base/constants.h"
#include "mhb/contact/slip.h"
#include "tests/support/check.h"

enum { M = 3, SIZE = 2 * M + 1 };

/* Exact for polynomials: the integral of s^k up to each node, and the value at 1 of s^7. */
static void rule_is_exact_for_polynomials(void **state) {
  (void)state;
  mhb_collocation rule;
  assert_int_equal(mhb_collocation_create(&rule), SHB_OK);
  for (int k = 0; k < 2 * MHB_NODES; k++) {
    double sum = 0, end = 0;
    for (int i = 0; i < MHB_NODES; i++) sum += rule.weight[i] * pow(rule.node[i], k);
    assert_near(sum, 1. / (k + 1), 1e-14);
    if (k >= MHB_NODES) continue;
    for (int i = 0; i < MHB_NODES; i++) {
      double part = 0;
      for (int j = 0; j < MHB_NODES; j++) part += rule.A[j][i] * pow(rule.node[j], k);
      assert_near(part, pow(rule.node[i], k + 1) / (k + 1), 1e-12);
      end += rule.end[i] * pow(rule.node[i], k);
    }
    assert_near(end, 1, 1e-12);
  }
}

typedef struct {
  mhb_signals     signals;
  mhb_collocation rule;
  mhb_slip        slip;
} fixture;

static void start(fixture *f, const double *n, const double *x1, const double *x2, double mu) {
  assert_ok(mhb_collocation_create(&f->rule));
  assert_ok(mhb_signals_create(M, &f->signals));
  mhb_signals_set(&f->signals, (const double *const[3]){n, x1, x2});
  f->slip = (mhb_slip){.signals       = &f->signals,
                       .rule          = &f->rule,
                       .K             = {{1, 0}, {0, 1}},
                       .mean          = 1,
                       .mu            = mu,
                       .peak_load     = 10,
                       .top_harmonic  = M,
                       .longest_panel = 1,
                       .newton_mild   = 3,
                       .tolerance     = 1e-11};
}

/* Constant load, x = R (cos t, sin t), Ku = I: with phi = theta - t and r = R/(mu n) > 1,
 * phi' = r cos phi - 1, so u = tan(phi/2) = c tanh(c (r + 1) t/2 + b), c^2 = (r - 1)/(r + 1). */
static void circular_motion(void **state) {
  (void)state;
  const double n[SIZE] = {2}, x1[SIZE] = {0, 3}, x2[SIZE] = {0, 0, -3}, mu = .4;
  const double r = 3 / (mu * 2), c = sqrt((r - 1) / (r + 1)), phi0 = .3;
  const double b = atanh(tan(phi0 / 2) / c), end = 5;
  double       t = 0, theta = phi0, suggested = 1;
  fixture      f;
  mhb_panel    panel = {.error = INFINITY};
  start(&f, n, x1, x2, mu);
  int              panels  = 0;
  double           worst   = 0;
  mhb_slip_outcome outcome = MHB_SLIP_CONTINUES;
  for (; outcome == MHB_SLIP_CONTINUES; panels++) {
    outcome = mhb_slip_panel(&f.slip, t, theta, end, 0, &suggested, &panel);
    t       = panel.t0 + panel.h;
    theta   = panel.theta1;
    worst   = fmax(worst, fabs(theta - t - 2 * atan(c * tanh(c * (r + 1) * t / 2 + b))));
  }
  print_message("%d panels, error %.1e\n", panels, worst);
  assert_int_equal(outcome, MHB_SLIP_INTERVAL_ENDS);
  assert_near(t, end, 1e-15);
  assert_true(worst < 1e-10);
  mhb_signals_destroy(&f.signals);
}

/* The linearised panel of the same motion, of length h. mild = 0: by the inverted matrix; large: by
 * separation of the mean of F_theta. Returns T at the nodes for the drive cos 3t. *end: the
 * same at the end. *miss: of the growth, against the closed form. */
static mhb_lanes linearised_panel(double mild, double h, double *end, double *miss) {
  const double n[SIZE] = {2}, x1[SIZE] = {0, 3}, x2[SIZE] = {0, 0, -3}, mu = .4;
  const double r = 3 / (mu * 2), c = sqrt((r - 1) / (r + 1)), phi0 = .3;
  const double b = atanh(tan(phi0 / 2) / c), late = b + c * (r + 1) * h / 2;
  double       suggested = h, growth    = 1;
  mhb_lanes    response[MHB_NODES], sum = lanes_all(0), drive;
  fixture      f;
  mhb_panel    panel = {.error = INFINITY};
  start(&f, n, x1, x2, mu);
  f.slip.linearized = 1;
  f.slip.mild       = mild;
  f.slip.tolerance  = 1e-6; /* one panel */
  assert_int_equal(mhb_slip_panel(&f.slip, 0, phi0, 9, 0, &suggested, &panel), MHB_SLIP_CONTINUES);
  assert_int_equal(panel.dense, mild == 0);
  for (int i = 0; i < 2; i++) { /* dtheta/db late over dtheta/db at 0 */
    double T = tanh(i ? b : late), slope = (1 - T * T) / (1 + c * c * T * T);
    growth = i ? growth / slope : slope;
  }
  *miss = fabs(panel.growth - growth);
  mhb_slip_response(&f.slip, &panel, response);
  for (int q = 0; q < MHB_NODES; q++) {
    drive[q] = cos(3 * h * f.rule.node[q]);
    sum += response[q] * drive[q];
  }
  *end = h * lanes_sum(f.rule.weight * (panel.F_theta * sum + drive));
  mhb_signals_destroy(&f.signals);
  return sum;
}

/* Both ways differ by about the eighth power of the panel's length at the nodes, and by more at the
 * end. */
static void panels_are_linearised_without_an_inverse(void **state) {
  (void)state;
  double nodes[2], ends[2], miss[2][2];
  for (int half = 0; half < 2; half++) {
    double    h     = half ? .3 : .6, end[2];
    mhb_lanes dense = linearised_panel(0, h, &end[0], &miss[half][0]),
              other = linearised_panel(100, h, &end[1], &miss[half][1]);
    nodes[half]     = lanes_top(lanes_abs(dense - other)) / lanes_top(lanes_abs(dense));
    ends[half]      = fabs(end[0] - end[1]) / fabs(end[0]);
    print_message("h %.1f: nodes %.1e, end %.1e apart, growth %.1e and %.1e off\n", h, nodes[half],
                  ends[half], miss[half][0], miss[half][1]);
  }
  assert_true(nodes[0] < 3e-5 && nodes[0] > 100 * nodes[1]);
  assert_true(ends[0] < 1e-8 && ends[0] > 500 * ends[1]);
  for (int way = 0; way < 2; way++)
    assert_true(miss[0][way] < 2e-9 && miss[0][way] > 1024 * miss[1][way]);
}

/* Along a line, x = 2 sin t, slip ends where x turns: t = pi/2. */
static void slip_ends_where_the_motion_turns(void **state) {
  (void)state;
  const double n[SIZE] = {1}, x1[SIZE] = {0, 0, -2}, x2[SIZE] = {0};
  double       t = .6, theta = 0, suggested = 1;
  fixture      f;
  mhb_panel    panel = {.error = INFINITY};
  start(&f, n, x1, x2, .5);
  mhb_slip_outcome outcome = MHB_SLIP_CONTINUES;
  while (outcome == MHB_SLIP_CONTINUES) {
    outcome = mhb_slip_panel(&f.slip, t, theta, SHB_TWO_PI, 0, &suggested, &panel);
    t       = panel.t0 + panel.h;
    theta   = panel.theta1;
  }
  assert_int_equal(outcome, MHB_SLIP_ENDS);
  assert_near(t, SHB_PI / 2, 1e-11);
  assert_near(theta, 0, 1e-14);
  mhb_signals_destroy(&f.signals);
}

/* With mu n' > |x'| throughout, the slip rate is negative at once: a panel of no length. */
static void slip_may_end_at_once(void **state) {
  (void)state;
  const double n[SIZE] = {4, 0, -3}, x1[SIZE] = {0, 0, -1}, x2[SIZE] = {0};
  double       suggested = 1;
  fixture      f;
  mhb_panel    panel = {.error = INFINITY};
  start(&f, n, x1, x2, .9);
  assert_int_equal(mhb_slip_panel(&f.slip, .2, 0, 1, 0, &suggested, &panel), MHB_SLIP_ENDS);
  assert_near(panel.h, 0, 0);
  mhb_signals_destroy(&f.signals);
}

/* beta = qKe/eKe and its derivative, by differences. */
static void direction_by_differences(void **state) {
  (void)state;
  const double K[2][2] = {{1.3, .4}, {.4, .8}}, h = 1e-5;
  for (double theta = -3; theta < 3; theta += .41) {
    mhb_direction d = mhb_slip_direction(K, theta), up = mhb_slip_direction(K, theta + h),
                  down = mhb_slip_direction(K, theta - h);
    double Ke[2]       = {K[0][0] * d.e[0] + K[0][1] * d.e[1], K[1][0] * d.e[0] + K[1][1] * d.e[1]};
    assert_near(d.beta, (d.q[0] * Ke[0] + d.q[1] * Ke[1]) / (d.e[0] * Ke[0] + d.e[1] * Ke[1]),
                1e-15);
    assert_near(d.beta_theta, (up.beta - down.beta) / (2 * h), 1e-9);
  }
}

/* (a I + lambda K) d = x: x - a d is parallel to K d, in the same sense. */
static void return_solves_its_equation(void **state) {
  (void)state;
  const double K[2][2] = {{1.3, .4}, {.4, .8}}, a[] = {0, .3, 1, 1.9};
  for (int i = 0; i < 4; i++)
    for (double angle = 0; angle < 6; angle += .7) {
      double x[2] = {2 * cos(angle), 2 * sin(angle)}, d[2];
      mhb_slip_return(K, a[i], x, d);
      double rest[2] = {x[0] - a[i] * d[0], x[1] - a[i] * d[1]};
      double Kd[2]   = {K[0][0] * d[0] + K[0][1] * d[1], K[1][0] * d[0] + K[1][1] * d[1]};
      assert_near(hypot(d[0], d[1]), 1, 1e-15);
      assert_near(rest[0] * Kd[1] - rest[1] * Kd[0], 0, 1e-13);
      assert_true(rest[0] * Kd[0] + rest[1] * Kd[1] >= 0);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rule_is_exact_for_polynomials),
      cmocka_unit_test(circular_motion),
      cmocka_unit_test(panels_are_linearised_without_an_inverse),
      cmocka_unit_test(slip_ends_where_the_motion_turns),
      cmocka_unit_test(slip_may_end_at_once),
      cmocka_unit_test(direction_by_differences),
      cmocka_unit_test(return_solves_its_equation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
