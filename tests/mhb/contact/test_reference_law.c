/* The reference law itself: closed forms, two orders and tolerances on every motion of the suite,
 * turned axes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "tests/support/check.h"
#include "tests/support/motion_suite.h"
#include "tests/support/reference_law.h"

enum { M = SUITE_HARMONICS, H = 15, NF = 2 * H + 1 };

static void solve(const suite_motion *s, reference *out) {
  reference_force(&s->law, M, &s->motion[0][0], H, 24, 1e-18, out);
  assert_int_equal(out->lost, 0);
}

static double largest(const reference *r) {
  double top = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < NF; j++) top = fmax(top, fabs(r->force[i][j]));
  return top;
}

static suite_motion plain(void) {
  return (suite_motion){.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
}

static void one_direction(void **state) {
  (void)state;
  suite_motion s = plain();
  reference    r;
  suite_add(&s, 1, 1, 2e-4, 0);
  solve(&s, &r);
  double A = 2e-4, k = 1e6, S = 40, th = acos(1 - 2 * S / (k * A));
  assert_near(r.force[1][1] / A, k / SHB_PI * (th - sin(2 * th) / 2), 1e-14 * k);
  assert_near(r.force[1][2] / A, 4 * S / (SHB_PI * A) * (1 - S / (k * A)), 1e-14 * k);
  assert_near(r.work, 4 * S * (A - S / k), 1e-16);
  assert_int_equal(r.n_transitions, 4);
}

static void normal_force(void **state) {
  (void)state;
  double       kv = 3e5, B = 2.385e-4, n0 = 31.7, al = -n0 / (kv * B), tc = acos(al), F = kv * B;
  suite_motion s = {.law = {.mu = .3, .kv = kv, .ku = {1e6, 0, 1e6}, .n0 = n0}};
  reference    r;
  suite_add(&s, 0, 1, B, 0);
  solve(&s, &r);
  assert_near(r.force[0][0], F / SHB_PI * (sin(tc) - al * tc), 1e-14 * F);
  assert_near(r.force[0][1], F / SHB_PI * (tc - sin(2 * tc) / 2), 1e-14 * F);
  for (int k = 2; k <= H; k++) {
    double a = sin((k - 1) * tc) / (2 * (k - 1)), b = sin((k + 1) * tc) / (2 * (k + 1));
    assert_near(r.force[0][2 * k - 1], 2 * F / SHB_PI * (a + b - al * sin(k * tc) / k), 1e-14 * F);
  }
}

static void circle(void **state) {
  (void)state;
  double       R = 1e-4, k = 1e6, S = 40, s1 = S / (k * R);
  suite_motion s = plain();
  reference    r;
  suite_add(&s, 1, 1, R, 0);
  suite_add(&s, 2, 1, R, -SHB_PI / 2);
  solve(&s, &r);
  assert_near(r.force[1][1] / R, S * S / (k * R * R), 1e-13 * k);
  assert_near(r.force[1][2] / R, S / R * sqrt(1 - s1 * s1), 1e-13 * k);
  assert_near(r.work, SHB_TWO_PI * R * S * sqrt(1 - s1 * s1), 1e-15);
  for (int i = 1; i < 3; i++)
    for (int j = 3; j < NF; j++) assert_near(r.force[i][j], 0, 1e-13 * S);
}

/* One direction, n = S/mu + (g/mu) cos t, u = A cos t: every piece is a polynomial in c = cos t. */
typedef struct {
  double k, A, S, g;
} in_phase;

/* integrals of f du and of f dt over a stick from (c0, f0), and over a slip of the given sign */
static void stick_piece(const in_phase *p, double f0, double t0, double t1, double sum[2]) {
  double c0 = cos(t0), c1 = cos(t1), kA = p->k * p->A;
  sum[0] += p->A * (kA * (c1 * c1 - c0 * c0) / 2 + (f0 - kA * c0) * (c1 - c0));
  sum[1] += kA * (sin(t1) - sin(t0)) + (f0 - kA * c0) * (t1 - t0);
}

static void slip_piece(const in_phase *p, double sign, double t0, double t1, double sum[2]) {
  double c0 = cos(t0), c1 = cos(t1);
  sum[0] += sign * p->A * (p->S * (c1 - c0) + p->g * (c1 * c1 - c0 * c0) / 2);
  sum[1] += sign * (p->S * (t1 - t0) + p->g * (sin(t1) - sin(t0)));
}

static void load_in_phase(void **state) {
  (void)state;
  suite_motion s = suite_at(3);
  in_phase     p = {.k = 1e6, .A = 2e-4, .S = 40, .g = 20};
  reference    r;
  solve(&s, &r);
  double kA = p.k * p.A, t1 = acos((kA - 2 * p.S - p.g) / (kA + p.g));
  double t2 = SHB_TWO_PI - acos((2 * p.S - p.g - kA) / (kA - p.g)), sum[2] = {0, 0};
  stick_piece(&p, p.S + p.g, 0, t1, sum);
  slip_piece(&p, -1, t1, SHB_PI, sum);
  stick_piece(&p, -(p.S - p.g), SHB_PI, t2, sum);
  slip_piece(&p, 1, t2, SHB_TWO_PI, sum);
  assert_near(sum[0], .024565657, 1e-9);
  assert_near(r.work, sum[0], 1e-15);
  assert_near(r.force[1][0], sum[1] / SHB_TWO_PI, 1e-12);
  const double when[4] = {0, t1 / SHB_TWO_PI, .5, t2 / SHB_TWO_PI};
  assert_int_equal(r.n_transitions, 4);
  for (int i = 0; i < 4; i++) {
    double nearest = 1;
    for (int j = 0; j < 4; j++) nearest = fmin(nearest, fabs(remainder(r.phase[i] - when[j], 1)));
    assert_near(nearest, 0, 1e-15);
  }
}

static void load_in_quadrature(void **state) {
  (void)state;
  suite_motion s = suite_at(4);
  reference    r;
  solve(&s, &r);
  double stop = atan2(20, 200) / SHB_TWO_PI;
  int    hits = 0;
  for (int i = 0; i < r.n_transitions; i++)
    if (r.state[i] == MHB_STICK)
      hits += fabs(r.phase[i] - .5 - stop) < 1e-14 || fabs(r.phase[i] - 1 + stop) < 1e-14;
  assert_int_equal(hits, 2);
  assert_near(r.work, .0255046, 5e-8);
  assert_near(r.force[1][1] / 2e-4, 141368.4, .05);
  assert_near(r.force[1][2] / 2e-4, 202958.8, .05);
}

static void two_tolerances_agree(void **state) {
  (void)state;
  for (int i = 0; i < suite_size(); i++) {
    suite_motion s = suite_at(i);
    reference    fine, coarse;
    solve(&s, &fine);
    reference_force(&s.law, M, &s.motion[0][0], H, 17, 1e-15, &coarse);
    double worst = 0;
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++) worst = fmax(worst, fabs(fine.force[a][j] - coarse.force[a][j]));
    assert_int_equal(fine.stuck, 0);
    assert_near(worst, 0, 1e-13 * largest(&fine));
    assert_near(coarse.work, fine.work, 1e-12 * fine.work);
  }
}

/* A loose tolerance is seen in the result. No error common to both solutions hides it. */
static void coarse_steps_are_seen(void **state) {
  (void)state;
  suite_motion s = suite_at(7);
  reference    fine, coarse;
  solve(&s, &fine);
  reference_force(&s.law, M, &s.motion[0][0], H, 8, 1e-5, &coarse);
  double worst = 0;
  for (int a = 1; a < 3; a++)
    for (int j = 0; j < NF; j++) worst = fmax(worst, fabs(fine.force[a][j] - coarse.force[a][j]));
  assert_true(worst > 1e-9 * largest(&fine));
  assert_true(worst < 1e-3 * largest(&fine));
}

/* Ku, motion and force in turned axes. */
static void turn(suite_motion *s, double angle) {
  double c = cos(angle), n = sin(angle), a = s->law.ku[0], b = s->law.ku[1], d = s->law.ku[2];
  s->law.ku[0] = c * c * a - 2 * c * n * b + n * n * d;
  s->law.ku[1] = c * n * (a - d) + (c * c - n * n) * b;
  s->law.ku[2] = n * n * a + 2 * c * n * b + c * c * d;
  for (int j = 0; j < SUITE_WIDTH; j++) {
    double u = s->motion[1][j], w = s->motion[2][j];
    s->motion[1][j] = c * u - n * w;
    s->motion[2][j] = n * u + c * w;
  }
}

static void axes_do_not_matter(void **state) {
  (void)state;
  for (int i = 5; i < suite_size(); i += 2) {
    suite_motion s = suite_at(i), t = s;
    double       angle = .831, c = cos(angle), n = sin(angle);
    reference    r, q;
    s.law.ku[2] *= .37;
    t = s;
    turn(&t, angle);
    solve(&s, &r);
    solve(&t, &q);
    for (int j = 0; j < NF; j++) {
      assert_near(q.force[1][j], c * r.force[1][j] - n * r.force[2][j], 1e-12 * largest(&r));
      assert_near(q.force[2][j], n * r.force[1][j] + c * r.force[2][j], 1e-12 * largest(&r));
    }
  }
}

/* Loop integral of f.s' is the work summed over slip. */
static void energy_balances(void **state) {
  (void)state;
  for (int i = 0; i < suite_size(); i++) {
    suite_motion s = suite_at(i);
    reference    r;
    double       loop = 0;
    solve(&s, &r);
    for (int a = 1; a < 3; a++)
      for (int k = 1; k <= M; k++)
        loop += SHB_PI * k *
                (r.force[a][2 * k] * s.motion[a][2 * k - 1] -
                 r.force[a][2 * k - 1] * s.motion[a][2 * k]);
    assert_near(r.work, loop, 1e-13 * loop);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_direction),
      cmocka_unit_test(normal_force),
      cmocka_unit_test(circle),
      cmocka_unit_test(load_in_phase),
      cmocka_unit_test(load_in_quadrature),
      cmocka_unit_test(two_tolerances_agree),
      cmocka_unit_test(coarse_steps_are_seen),
      cmocka_unit_test(axes_do_not_matter),
      cmocka_unit_test(energy_balances),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
