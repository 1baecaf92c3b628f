/* The contact law: closed forms, identities, derivative, extreme input, comparison with time
 * marching. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/contact/contact.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/check.h"

enum { M = 7, H = 15, NB = 2 * M + 1, NF = 2 * H + 1 };

typedef struct {
  mhb_law          law;
  double           motion[3][NB], force[3][NF];
  double           jacobian[3 * NF * 3 * NB];
  mhb_contact_info info;
} evaluation;

static mhb_contact_evaluator *workspace;

static int make_workspace(void **state) {
  (void)state;
  return mhb_contact_evaluator_create(M, H, 1e-10, &workspace) != SHB_OK;
}

static int free_workspace(void **state) {
  (void)state;
  mhb_contact_evaluator_destroy(workspace);
  return 0;
}

static void evaluate(evaluation *e, int derivative) {
  mhb_contact_force(workspace, &e->law, &e->motion[0][0], &e->force[0][0],
                    derivative ? e->jacobian : NULL, &e->info);
}

/* harmonic k of component i: amplitude a, as cos(kt + phase) */
static void set(evaluation *e, int i, int k, double a, double phase) {
  if (k == 0) {
    e->motion[i][0] = a;
    return;
  }
  e->motion[i][2 * k - 1] = a * cos(phase);
  e->motion[i][2 * k]     = a * sin(phase);
}

static double largest(const evaluation *e) {
  double top = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < NF; j++) top = fmax(top, fabs(e->force[i][j]));
  return top;
}

static void one_direction(void **state) {
  (void)state;
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  set(&e, 1, 1, 2e-4, 0);
  evaluate(&e, 0);
  double A = 2e-4, k = 1e6, S = 40, th = acos(1 - 2 * S / (k * A));
  assert_near(e.force[1][1] / A, k / SHB_PI * (th - sin(2 * th) / 2), 1e-10 * k);
  assert_near(e.force[1][1] / A, 142378.49, .01);
  assert_near(e.force[1][2] / A, 4 * S / (SHB_PI * A) * (1 - S / (k * A)), 1e-10 * k);
  assert_near(e.info.dissipation, 4 * S * (A - S / k), 1e-12);
  assert_near(e.info.slip_work, .0256, 1e-12);
  assert_near(e.force[2][1], 0, 1e-10);
  assert_near(e.info.share[0] + e.info.share[1], 1, 1e-12);
  assert_int_equal(e.info.n_transitions, 4);
}

static void normal_force_of_opening_contact(void **state) {
  (void)state;
  double     kv = 3e5, B = 2.385e-4, n0 = 31.7, al = -n0 / (kv * B), tc = acos(al);
  evaluation e = {.law = {.mu = .3, .kv = kv, .ku = {1e6, 0, 1e6}, .n0 = n0}};
  set(&e, 0, 1, B, 0);
  evaluate(&e, 0);
  assert_near(e.force[0][0], kv * B / SHB_PI * (sin(tc) - al * tc), 1e-10 * kv * B);
  assert_near(e.force[0][1], kv * B / SHB_PI * (tc - sin(2 * tc) / 2), 1e-10 * kv * B);
  for (int k = 2; k <= H; k++) {
    double wanted = 2 * kv * B / SHB_PI *
                    (sin((k - 1) * tc) / (2 * (k - 1)) + sin((k + 1) * tc) / (2 * (k + 1)) -
                     al * sin(k * tc) / k);
    assert_near(e.force[0][2 * k - 1], wanted, 1e-10 * kv * B);
  }
  assert_near(e.info.share[MHB_SEPARATE], 1 - tc / SHB_PI, 1e-12);
}

/* v = cos kt at n0 = 0 opens k times a period: n = max(v, 0) has mean 1/pi and amplitude 0.5 at any
 * k. */
static void every_opening_counts(void **state) {
  (void)state;
  static const int many[] = {1, 63, 65, 128};
  for (int i = 0; i < 4; i++) {
    int                    k = many[i], n = 2 * k + 1;
    mhb_contact_evaluator *own;
    mhb_law                law = {.mu = .3, .kv = 1, .ku = {1, 0, 1}};
    mhb_contact_info       info;
    double                *motion = calloc(6 * (size_t)n, sizeof(double)), *force = motion + 3 * n;
    assert_int_equal(mhb_contact_evaluator_create(k, k, 1e-8, &own), SHB_OK);
    motion[2 * k - 1] = 1;
    mhb_contact_force(own, &law, motion, force, NULL, &info);
    assert_near(force[0], 1 / SHB_PI, 1e-8);
    assert_near(force[2 * k - 1], .5, 1e-8);
    assert_near(info.share[MHB_SEPARATE], .5, 1e-10);
    assert_int_equal(info.lost, 0);
    mhb_contact_evaluator_destroy(own);
    free(motion);
  }
}

static void circle(void **state) {
  (void)state;
  double     R = 1e-4, k = 1e6, S = 40, s = S / (k * R);
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {k, 0, k}, .n0 = 100}};
  set(&e, 1, 1, R, 0);
  set(&e, 2, 1, R, -SHB_PI / 2);
  evaluate(&e, 0);
  assert_near(e.force[1][1] / R, S * S / (k * R * R), 1e-10 * k);
  assert_near(e.force[1][2] / R, S / R * sqrt(1 - s * s), 1e-10 * k);
  assert_near(e.info.dissipation, SHB_TWO_PI * R * S * sqrt(1 - s * s), 1e-12);
  for (int i = 1; i < 3; i++)
    for (int j = 3; j < NF; j++) assert_near(e.force[i][j], 0, 1e-9);
}

static void in_phase_normal_load(void **state) {
  (void)state;
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  set(&e, 1, 1, 2e-4, 0);
  set(&e, 0, 1, 1e-4, 0);
  evaluate(&e, 0);
  double kA = 200, S = 40, g = 20;
  double t1 = acos((kA - 2 * S - g) / (kA + g)),
         t2 = SHB_TWO_PI - acos((2 * S - g - kA) / (kA - g));
  (void)t2;
  assert_int_equal(e.info.n_transitions, 4);
  int found = 0;
  for (int i = 0; i < 4; i++) {
    double phase = e.info.transition[i].phase;
    if (e.info.transition[i].state != MHB_SLIDE) continue;
    found += fabs(phase - t1 / SHB_TWO_PI) < 1e-12 || fabs(phase * 360 - 218.9424) < 1e-4;
  }
  assert_int_equal(found, 2);
  assert_near(e.info.dissipation, 0.024565657, 1e-9);
  assert_near(e.info.slip_work, e.info.dissipation, 1e-10 * e.info.dissipation);
  assert_near(e.force[1][0], 10.836, 1e-3);
}

static void quadrature_normal_load(void **state) {
  (void)state;
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  set(&e, 1, 1, 2e-4, 0);
  set(&e, 0, 1, 1e-4, -SHB_PI / 2);
  evaluate(&e, 0);
  double stop = atan2(-20., -200.) / SHB_TWO_PI;
  int    hits = 0;
  for (int i = 0; i < e.info.n_transitions; i++) {
    if (e.info.transition[i].state != MHB_STICK) continue;
    double phase = e.info.transition[i].phase;
    hits += fabs(phase - (1 + stop)) < 1e-12 || fabs(phase - 185.711 / 360) < 1e-5 ||
            fabs(phase - 354.289 / 360) < 1e-5;
  }
  assert_int_equal(hits, 2);
  assert_near(e.info.dissipation, .0255046, 1e-7);
  assert_near(e.force[1][1] / 2e-4, 141368.4, .1);
  assert_near(e.force[1][2] / 2e-4, 202958.8, .1);
}

/* ---- a suite of motions ---- */

enum { SUITE = 12 };

static const char *suite(int i, evaluation *e) {
  memset(e, 0, sizeof *e);
  e->law = (mhb_law){.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100};
  set(e, 1, 1, 2e-4, .3);
  switch (i) {
    case 0:
      set(e, 2, 1, 1.3e-4, 1.1);
      return "ellipse, constant load";
    case 1:
      set(e, 0, 1, 1e-4, .9);
      set(e, 2, 1, .7e-4, 2);
      return "ellipse, varying load";
    case 2:
      set(e, 0, 1, 3e-4, .9);
      set(e, 2, 1, .7e-4, 2);
      return "opening";
    case 3:
      e->law.n0 = -60;
      set(e, 0, 1, 3e-4, -.4);
      set(e, 2, 1, .9e-4, 2.4);
      return "gap";
    case 4:
      set(e, 0, 1, 3e-4, .9);
      set(e, 0, 3, 1.5e-4, .2);
      set(e, 1, 2, 1e-4, 2);
      set(e, 2, 1, .7e-4, 2);
      set(e, 2, 3, .3e-4, 1);
      return "three harmonics";
    case 5:
      e->law.ku[0] = 1.2e6;
      e->law.ku[1] = .35e6;
      e->law.ku[2] = .6e6;
      set(e, 0, 1, 1.5e-4, .9);
      set(e, 2, 1, 1.2e-4, 2);
      return "skew Ku";
    case 6:
      e->law.ku[1] = .5e6;
      set(e, 0, 1, 3e-4, 2);
      set(e, 0, 2, 1e-4, 0);
      set(e, 2, 1, 1.2e-4, 2.3);
      return "skew Ku, opening";
    case 7:
      set(e, 0, 1, 1.99e-4, .9);
      set(e, 2, 1, 1.2e-4, 2.3);
      return "nearly opening";
    case 8:
      e->law.mu = 3;
      set(e, 0, 1, 3e-4, .9);
      set(e, 2, 1, .7e-4, 2);
      return "sticking after closing";
    case 9:
      set(e, 0, 1, 1e-4, .3);
      set(e, 1, 1, .5e-4, .3);
      set(e, 2, 1, .1e-4, 1);
      return "slip just begun";
    case 10:
      set(e, 0, 0, 1e-5, 0);
      set(e, 1, 0, 3e-5, 0);
      set(e, 0, 1, 1e-4, .9);
      set(e, 2, 1, .7e-4, 2);
      set(e, 2, 2, 1.7e-4, 2);
      set(e, 1, 7, .1e-4, 2);
      return "offsets and a ripple";
    default:
      e->law.mu = .05;
      set(e, 0, 1, 2.2e-4, .9);
      set(e, 2, 1, .7e-4, 2);
      return "slippery, opening";
  }
}

/* Radial return on N samples until periodic: first order, so that two grids extrapolate. Isotropic
 * Ku. */
static void march(const evaluation *e, int N, double out[3][NF]) {
  double f[2] = {0, 0}, x0[2] = {0, 0}, n = 0, before = 0;
  memset(out, 0, sizeof(double) * 3 * NF);
  for (int step = 0; step <= 12 * N; step++) {
    double t = SHB_TWO_PI * (step % N) / N, b[NF], y[3] = {0, 0, 0};
    mhb_basis(H, t, b, NULL);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < NB; j++) y[i] += e->motion[i][j] * b[j];
    double x[2] = {e->law.ku[0] * y[1], e->law.ku[0] * y[2]};
    double load = e->law.n0 + e->law.kv * y[0], part = before / (before - load);
    if (step == 0) memcpy(x0, x, sizeof x);
    for (int k = 0; k < 2 && before < 0 && load > 0; k++) x0[k] += part * (x[k] - x0[k]);
    before = load;
    n      = fmax(0, load);
    for (int k = 0; k < 2; k++) f[k] += x[k] - x0[k];
    double size = hypot(f[0], f[1]), limit = e->law.mu * n;
    if (size > limit)
      for (int k = 0; k < 2; k++) f[k] *= limit / size;
    memcpy(x0, x, sizeof x);
    if (step <= 11 * N) continue;
    for (int j = 0; j < NF; j++) {
      double w = (j ? 2. : 1.) / N * b[j];
      out[0][j] += w * n;
      out[1][j] += w * f[0];
      out[2][j] += w * f[1];
    }
  }
}

static void against_marching(void **state) {
  (void)state;
  static double coarse[3][NF], fine[3][NF];
  for (int i = 0; i < SUITE; i++) {
    evaluation  e;
    const char *name = suite(i, &e);
    if (e.law.ku[1] != 0) continue;
    evaluate(&e, 0);
    march(&e, 1 << 14, coarse);
    march(&e, 1 << 15, fine);
    double worst = 0, top = largest(&e);
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++)
        worst = fmax(worst, fabs((2 * fine[a][j] - coarse[a][j]) - e.force[a][j]));
    if (worst > 2e-6 * top || e.info.lost)
      fail_msg("%s: %.2e, lost %d", name, worst / top, e.info.lost);
  }
}

/* Refined panels must not change the result: the order of the error shows a wrong formula. */
static void tolerance_is_met(void **state) {
  (void)state;
  mhb_contact_evaluator *coarse, *fine;
  assert_int_equal(mhb_contact_evaluator_create(M, H, 1e-8, &coarse), SHB_OK);
  assert_int_equal(mhb_contact_evaluator_create(M, H, 1e-14, &fine), SHB_OK);
  for (int i = 0; i < SUITE; i++) {
    evaluation  e, f;
    const char *name = suite(i, &e);
    suite(i, &f);
    mhb_contact_force(coarse, &e.law, &e.motion[0][0], &e.force[0][0], NULL, &e.info);
    mhb_contact_force(fine, &f.law, &f.motion[0][0], &f.force[0][0], NULL, &f.info);
    double worst = 0;
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++) worst = fmax(worst, fabs(e.force[a][j] - f.force[a][j]));
    if (worst > 1e-8 * largest(&f)) fail_msg("%s: %.2e", name, worst / largest(&f));
  }
  mhb_contact_evaluator_destroy(coarse);
  mhb_contact_evaluator_destroy(fine);
}

static void derivative_against_differences(void **state) {
  (void)state;
  static evaluation      e, p, q;
  mhb_contact_evaluator *sharp, *usual = workspace; /* differences magnify the error */
  assert_int_equal(mhb_contact_evaluator_create(M, H, 1e-14, &sharp), SHB_OK);
  for (int i = 0; i < SUITE; i++) {
    const char *name = suite(i, &e);
    workspace        = usual;
    evaluate(&e, 1);
    workspace   = sharp;
    double norm = 0, worst = 0;
    for (int j = 0; j < 3 * NB; j++) {
      double column = 0, off = 0, d[2] = {2e-8, 1e-8};
      double slope[2][3 * NF];
      for (int s = 0; s < 2; s++) {
        suite(i, &p);
        suite(i, &q);
        (&p.motion[0][0])[j] += d[s];
        (&q.motion[0][0])[j] -= d[s];
        evaluate(&p, 0);
        evaluate(&q, 0);
        for (int r = 0; r < 3 * NF; r++)
          slope[s][r] = ((&p.force[0][0])[r] - (&q.force[0][0])[r]) / (2 * d[s]);
      }
      for (int r = 0; r < 3 * NF; r++) {
        double wanted = (4 * slope[1][r] - slope[0][r]) / 3;
        column        = fmax(column, fabs(wanted));
        off           = fmax(off, fabs(wanted - e.jacobian[r * 3 * NB + j]));
      }
      norm  = fmax(norm, column);
      worst = fmax(worst, off);
    }
    workspace = usual;
    if (!(worst < 1e-7 * norm)) fail_msg("%s: %.2e of %.2e", name, worst, norm);
  }
  mhb_contact_evaluator_destroy(sharp);
}

static void time_shift_shifts_the_force(void **state) {
  (void)state;
  for (int i = 0; i < SUITE; i++) {
    evaluation  e, s;
    const char *name = suite(i, &e);
    suite(i, &s);
    double shift = .7312;
    for (int a = 0; a < 3; a++) {
      for (int k = 1; k <= M; k++) {
        double c = cos(k * shift), n = sin(k * shift), x = e.motion[a][2 * k - 1],
               y               = e.motion[a][2 * k];
        s.motion[a][2 * k - 1] = c * x - n * y;
        s.motion[a][2 * k]     = n * x + c * y;
      }
    }
    evaluate(&e, 0);
    evaluate(&s, 0);
    double worst = 0;
    for (int a = 0; a < 3; a++) {
      worst = fmax(worst, fabs(e.force[a][0] - s.force[a][0]));
      for (int k = 1; k <= H; k++) {
        double c = cos(k * shift), n = sin(k * shift), x = e.force[a][2 * k - 1],
               y = e.force[a][2 * k];
        worst    = fmax(worst, fabs(c * x - n * y - s.force[a][2 * k - 1]));
        worst    = fmax(worst, fabs(n * x + c * y - s.force[a][2 * k]));
      }
    }
    if (worst > 1e-9 * largest(&e)) fail_msg("%s: %.2e", name, worst / largest(&e));
    if (fabs(e.info.slip_work - e.info.dissipation) > 1e-9 * e.info.dissipation + 1e-16)
      fail_msg("%s: work %.12g, loop %.12g", name, e.info.slip_work, e.info.dissipation);
  }
}

static void units_do_not_matter(void **state) {
  (void)state;
  for (int i = 0; i < SUITE; i++) {
    evaluation e, s;
    suite(i, &e);
    suite(i, &s); /* um, MN: stiffness in MN/um = 1e-12 N/m */
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NB; j++) s.motion[a][j] *= 1e6;
    s.law.kv *= 1e-12;
    s.law.n0 *= 1e-6;
    for (int j = 0; j < 3; j++) s.law.ku[j] *= 1e-12;
    evaluate(&e, 0);
    evaluate(&s, 0);
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++)
        assert_near(1e6 * s.force[a][j], e.force[a][j], 1e-12 * largest(&e));
  }
}

static void stuck_and_open_are_linear(void **state) {
  (void)state;
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 2e5, .7e6}, .n0 = 1000}};
  set(&e, 0, 0, 1e-5, 0);
  set(&e, 0, 1, 1e-4, 0);
  set(&e, 1, 0, 4e-5, 0);
  set(&e, 1, 1, 1e-4, 1);
  set(&e, 2, 2, .5e-4, 2);
  evaluate(&e, 1);
  assert_true(e.info.undetermined);
  assert_near(e.force[0][0], 1005, 1e-9);
  assert_near(e.force[1][0], 0, 1e-12);
  assert_near(e.force[1][1], 1e6 * e.motion[1][1], 1e-9);
  assert_near(e.force[1][3], 2e5 * e.motion[2][3], 1e-9);
  assert_near(e.jacobian[(NF + 1) * 3 * NB + NB + 1], 1e6, 1e-3);
  e.law.n0 = -1000;
  evaluate(&e, 1);
  assert_near(largest(&e), 0, 0);
  assert_near(e.info.share[MHB_SEPARATE], 1, 0);
}

/* At slip onset the smallest admissible mean joins the slipping solution without a jump. */
static void continuous_through_onset(void **state) {
  (void)state;
  evaluation e, before;
  double     jump    = 0;
  int        slipped = 0, stuck = 0;
  for (int i = 0; i <= 4000; i++) {
    double a = (.15 + .1e-3 * i) * 1e-4;
    memset(&e, 0, sizeof e);
    e.law = (mhb_law){.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100};
    set(&e, 1, 1, 2 * a, .3);
    set(&e, 0, 1, a, .5);
    set(&e, 2, 1, .5 * a, 1);
    evaluate(&e, 0);
    slipped += e.info.share[MHB_SLIDE] > 0;
    stuck += e.info.undetermined;
    for (int k = 0; k < 3 && i; k++)
      for (int j = 0; j < NF; j++) jump = fmax(jump, fabs(e.force[k][j] - before.force[k][j]));
    before = e;
  }
  assert_true(slipped > 100 && stuck > 100);
  assert_near(jump, 0, .2); /* of 40 N, at 4000 steps; a jump of the mean would be several N */
}

static unsigned long seed = 12345;

static double uniform(void) {
  seed = seed * 6364136223846793005ul + 1442695040888963407ul;
  return (double)(seed >> 11) / 9007199254740992.;
}

/* Closed for less than a cell of any grid: n is a parabola of height g, and slip keeps its
 * direction, so that
 *   mean n = (4/3) g sqrt(2 g/n'')/(2 pi),   |mean f| = mu mean n,
 * up to terms of order g and the rounding of n. */
static void grazing(void **state) {
  (void)state;
  double kv = 3e5, B = 2.385e-4, mu = .3;
  for (int i = 1; i <= 9; i++) {
    double     g = kv * B * pow(10, -i), load = 4. / 3 * g * sqrt(2 * g / (kv * B)) / SHB_TWO_PI;
    evaluation e = {.law = {.mu = mu, .kv = kv, .ku = {4e5, 2e4, 5e5}, .n0 = g - kv * B}};
    set(&e, 0, 1, B, .7 * i);
    set(&e, 1, 1, .7 * B, 1.1);
    set(&e, 1, 2, .2 * B, .3);
    set(&e, 2, 1, .5 * B, -1.4);
    evaluate(&e, 1);
    double friction = hypot(e.force[1][0], e.force[2][0]), off = pow(10, -i) + 1e-14 * pow(10, i);
    assert_int_equal(e.info.lost, 0);
    assert_true(e.info.error < 1e-8);
    assert_near(e.info.share[0] + e.info.share[1] + e.info.share[2], 1, 1e-9);
    assert_near(e.force[0][0], load, off * load);
    assert_near(friction, mu * load, (3 * off + pow(10, -.5 * i)) * load);
  }
}

static void random_cases_are_sane(void **state) {
  (void)state;
  int lost = 0, total = 20000;
  for (int i = 0; i < total; i++) {
    evaluation e;
    memset(&e, 0, sizeof e);
    double k = pow(10, 4 * uniform()), r = pow(10, 4 * uniform() - 2);
    e.law.mu    = pow(10, 4 * uniform() - 2);
    e.law.kv    = k * pow(10, 4 * uniform() - 2);
    e.law.ku[0] = k;
    e.law.ku[2] = k * r;
    e.law.ku[1] = uniform() < .5 ? 0 : (1.8 * uniform() - .9) * k * sqrt(r);
    int top     = 1 + (int)(M * uniform());
    for (int a = 0; a < 3; a++)
      for (int h = 0; h <= top; h++) set(&e, a, h, uniform() / (1 + h * h), SHB_TWO_PI * uniform());
    e.law.n0 = e.law.kv * (3 * uniform() - 1);
    evaluate(&e, i % 4 == 0);
    lost += e.info.lost;
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++) assert_true(isfinite(e.force[a][j]));
    for (int j = 0; i % 4 == 0 && j < 3 * NF * 3 * NB; j++) assert_true(isfinite(e.jacobian[j]));
    if (!e.info.lost && e.info.dissipation < -1e-8 * k)
      fail_msg("case %d: %.3e", i, e.info.dissipation);
  }
  if (lost > total / 1000) fail_msg("%d of %d lost", lost, total);
}

static void zero_motion_and_zero_friction(void **state) {
  (void)state;
  evaluation e = {.law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  evaluate(&e, 1);
  assert_near(e.force[0][0], 100, 1e-12);
  assert_near(e.jacobian[(NF + 1) * 3 * NB + NB + 1], 1e6, 1e-3);
  e.law.n0 = 0;
  evaluate(&e, 1);
  assert_near(largest(&e), 0, 0);
  suite(2, &e);
  e.law.mu = 0;
  evaluate(&e, 1);
  for (int j = 0; j < NF; j++) assert_near(e.force[1][j], 0, 0);
  assert_near(e.info.dissipation, 0, 0);
}

/* In a child, whose address space holds 64 MB more than now: 1000 harmonics need 200 MB. */
static void without_memory_it_returns_an_error(void **state) {
  (void)state;
#ifdef __SANITIZE_ADDRESS__
  skip(); /* it needs addresses of its own */
#endif
  int         end;
  const pid_t child = fork();
  if (child == 0) {
    mhb_contact_evaluator *evaluator = NULL;
    long                   pages     = 0;
    FILE                  *file      = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%ld", &pages) != 1) _exit(1);
    const rlim_t most = (rlim_t)(pages * sysconf(_SC_PAGESIZE)) + (64 << 20);
    setrlimit(RLIMIT_AS, &(struct rlimit){most, most});
    const shb_status status = mhb_contact_evaluator_create(1000, 1000, 1e-6, &evaluator);
    _exit(status == SHB_ERR_IO && strstr(shb_message(), "out of memory") ? 0 : 2);
  }
  assert_int_equal(waitpid(child, &end, 0), child);
  assert_true(WIFEXITED(end));
  assert_int_equal(WEXITSTATUS(end), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_direction),
      cmocka_unit_test(normal_force_of_opening_contact),
      cmocka_unit_test(every_opening_counts),
      cmocka_unit_test(circle),
      cmocka_unit_test(in_phase_normal_load),
      cmocka_unit_test(quadrature_normal_load),
      cmocka_unit_test(against_marching),
      cmocka_unit_test(tolerance_is_met),
      cmocka_unit_test(derivative_against_differences),
      cmocka_unit_test(time_shift_shifts_the_force),
      cmocka_unit_test(units_do_not_matter),
      cmocka_unit_test(stuck_and_open_are_linear),
      cmocka_unit_test(continuous_through_onset),
      cmocka_unit_test(grazing),
      cmocka_unit_test(random_cases_are_sane),
      cmocka_unit_test(zero_motion_and_zero_friction),
      cmocka_unit_test(without_memory_it_returns_an_error),
  };
  return cmocka_run_group_tests(tests, make_workspace, free_workspace);
}
