/* The contact over one period: against the force harmonics, the friction limit, the transitions and
 * the work. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/contact/time_history.h"
#include "mhb/numerics/fourier.h"

enum { M = 5, H = 15, NB = 2 * M + 1, NF = 2 * H + 1, DENSE = 1 << 14, SCENES = 12 };

typedef struct {
  const char      *name;
  mhb_law          law;
  double           motion[3][NB], force[3][NF];
  mhb_contact_info info;
  double           top; /* largest force, N */
} scene;

static mhb_contact_evaluator *workspace;
static mhb_contact_sample     sample[DENSE];

static int make_workspace(void **state) {
  (void)state;
  return mhb_contact_evaluator_create(M, H, 1e-10, &workspace) != SHB_OK;
}

static int free_workspace(void **state) {
  (void)state;
  mhb_contact_evaluator_destroy(workspace);
  return 0;
}

/* harmonic k of component i: amplitude a, as cos(kt + phase) */
static void set(scene *s, int i, int k, double a, double phase) {
  s->motion[i][k ? 2 * k - 1 : 0] = k ? a * cos(phase) : a;
  if (k) s->motion[i][2 * k] = a * sin(phase);
}

static void put_scene(int i, scene *s) {
  static const char *const names[SCENES] = {
      "one direction",  "ellipse",        "opening",          "gap",
      "skew Ku",        "frictionless",   "frictionless gap", "stuck",
      "stuck by force", "three openings", "always open",      "offsets"};
  *s = (scene){.name = names[i], .law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}, .n0 = 100}};
  set(s, 1, 1, 2e-4, .3);
  if (i > 0) set(s, 2, 1, 1.3e-4, 1.1);
  if (i > 0) set(s, 0, 1, 1.2e-4, .9);
  switch (i) {
    case 2:
      set(s, 0, 1, 3e-4, .9);
      break;
    case 3:
      s->law.n0 = -60;
      set(s, 0, 1, 3e-4, -.4);
      break;
    case 4:
      s->law.ku[1] = .5e6;
      set(s, 0, 1, 2.1e-4, 2);
      break;
    case 5:
    case 6:
      s->law.mu = 0;
      set(s, 0, 1, i == 5 ? 1e-4 : 3e-4, .9);
      break;
    case 7:
      s->law.n0 = 1000;
      break;
    case 8: /* the smallest admissible mean is not zero */
      set(s, 1, 1, 3.6e-5, .3);
      set(s, 2, 1, .5e-5, .3);
      set(s, 0, 1, 1.1e-4, .3);
      break;
    case 9:
      set(s, 0, 3, 4e-4, .2);
      set(s, 2, 2, .7e-4, 2);
      break;
    case 10:
      s->law.n0 = -1000;
      break;
    case 11:
      set(s, 0, 0, 1e-5, 0);
      set(s, 1, 0, 3e-5, 0);
      set(s, 2, 2, 1.7e-4, 2);
      set(s, 1, 5, .1e-4, 2);
      s->law.mean_offset = 100;
      break;
    default:
      break;
  }
}

static void evaluate(scene *s) {
  mhb_contact_force(workspace, &s->law, &s->motion[0][0], &s->force[0][0], NULL, &s->info);
  s->top = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < NF; j++) s->top = fmax(s->top, fabs(s->force[i][j]));
}

static void trace(scene *s, int n) {
  mhb_contact_time_history(workspace, &s->law, &s->motion[0][0], n, sample, &s->info);
  if (s->info.lost) fail_msg("%s: lost", s->name);
}

static void trace_uniform(scene *s, int n) {
  for (int i = 0; i < n; i++) sample[i].phase = (double)i / n;
  trace(s, n);
}

static double component(const mhb_contact_sample *at, int i) {
  return i ? at->f[i - 1] : at->n;
}

/* Largest difference of the trapezoidal harmonics from the law's. */
static double harmonics_off(scene *s, int n) {
  double sum[3][NF] = {{0}}, b[NF], worst = 0;
  trace_uniform(s, n);
  for (int i = 0; i < n; i++) {
    mhb_basis(H, SHB_TWO_PI * sample[i].phase, b, NULL);
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++) sum[a][j] += (j ? 2. : 1.) / n * b[j] * component(&sample[i], a);
  }
  sum[0][0] -= s->law.mean_offset;
  for (int a = 0; a < 3; a++)
    for (int j = 0; j < NF; j++) worst = fmax(worst, fabs(sum[a][j] - s->force[a][j]));
  return worst;
}

/* The force is continuous with kinks: the sampled harmonics err by 1/n^2, down to the tolerance of
 * the law. */
static void harmonics_at_second_order(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene  s;
    double rate = 0;
    put_scene(i, &s);
    evaluate(&s);
    for (int n = 256; n <= 1024; n *= 2) rate = fmax(rate, harmonics_off(&s, n) * n * n);
    double off = harmonics_off(&s, DENSE), bound = 4 * rate / DENSE / DENSE + 1e-10 * s.top;
    if (!(off <= bound) || rate > 100 * s.top) fail_msg("%s: %.2e > %.2e N", s.name, off, bound);
  }
}

enum { GAUSS = 5, CUTS = 150 };

/* Gauss points between transitions: smooth pieces are integrated far below the tolerance of the
 * law. */
static int gauss_points(const scene *s, double *weight) {
  static const double x[GAUSS] = {-.9061798459386640, -.5384693101056831, 0, .5384693101056831,
                                  .9061798459386640},
                      w[GAUSS] = {.2369268850561891, .4786286704993665, .5688888888888889,
                                  .4786286704993665, .2369268850561891};
  double edge[MHB_MAX_TRANSITIONS + 2];
  int    n = 0, count = 0;
  edge[n++] = 0;
  for (int i = 0; i < s->info.n_transitions; i++) edge[n++] = s->info.transition[i].phase;
  edge[n] = 1;
  for (int i = 1; i < n; i++) /* insertion sort */
    for (int j = i; j > 1 && edge[j] < edge[j - 1]; j--) {
      double swap = edge[j];
      edge[j]     = edge[j - 1];
      edge[j - 1] = swap;
    }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < CUTS; k++)
      for (int g = 0; g < GAUSS; g++) {
        double length       = (edge[i + 1] - edge[i]) / CUTS;
        weight[count]       = .5 * w[g] * length;
        sample[count].phase = edge[i] + (k + .5 + .5 * x[g]) * length;
        count++;
      }
  return count;
}

static void harmonics_and_work_by_pieces(void **state) {
  (void)state;
  static double weight[DENSE];
  for (int i = 0; i < SCENES; i++) {
    scene  s;
    double sum[3][NF] = {{0}}, work = 0, worst = 0;
    put_scene(i, &s);
    evaluate(&s);
    int n = gauss_points(&s, weight);
    assert_true(n <= DENSE);
    double loop = s.info.dissipation;
    trace(&s, n);
    for (int l = 0; l < n; l++) {
      double b[NF], slope[NF];
      mhb_basis(H, SHB_TWO_PI * sample[l].phase, b, slope);
      for (int a = 0; a < 3; a++)
        for (int j = 0; j < NF; j++)
          sum[a][j] += (j ? 2 : 1) * weight[l] * b[j] * component(&sample[l], a);
      for (int a = 1; a < 3; a++)
        for (int j = 0; j < NB; j++)
          work += SHB_TWO_PI * weight[l] * s.motion[a][j] * slope[j] * component(&sample[l], a);
    }
    sum[0][0] -= s.law.mean_offset;
    for (int a = 0; a < 3; a++)
      for (int j = 0; j < NF; j++) worst = fmax(worst, fabs(sum[a][j] - s.force[a][j]));
    if (!(worst <= 1e-9 * s.top))
      fail_msg("%s: harmonics off by %.2e of the largest", s.name, worst / s.top);
    if (!(fabs(work - loop) <= 1e-9 * fabs(loop) + 1e-16))
      fail_msg("%s: area %.15g, not %.15g J", s.name, work, loop);
  }
}

/* |f| <= mu n at any phase, = mu n where it slips, 0 where it is open. */
static void within_the_friction_limit(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene s;
    put_scene(i, &s);
    evaluate(&s);
    trace_uniform(&s, DENSE);
    double rounding = 1e-12 * (s.law.n0 > 0 ? s.law.n0 + s.top : s.top), share[3] = {0};
    for (int l = 0; l < DENSE; l++) {
      double size = hypot(sample[l].f[0], sample[l].f[1]), limit = s.law.mu * sample[l].n;
      share[sample[l].state] += 1. / DENSE;
      int within = size <= limit + rounding;
      if (sample[l].state == MHB_SLIDE) within = fabs(size - limit) <= rounding;
      if (sample[l].state == MHB_SEPARATE) within = size == 0 && sample[l].n == 0;
      if (!within)
        fail_msg("%s at %g, state %d: |f| = %.15g, mu n = %.15g", s.name, sample[l].phase,
                 sample[l].state, size, limit);
    }
    for (int k = 0; k < 3; k++)
      if (!(fabs(share[k] - s.info.share[k]) <= 12. / DENSE))
        fail_msg("%s: state %d for %g of the period, not %g", s.name, k, share[k], s.info.share[k]);
  }
}

/* On either side of a transition the state changes as reported, the force does not. */
static void continuous_across_transitions(void **state) {
  (void)state;
  const double step  = 1e-10;
  int          total = 0;
  for (int i = 0; i < SCENES; i++) {
    scene s;
    put_scene(i, &s);
    evaluate(&s);
    double load = s.top + fabs(s.law.n0);
    for (int k = 0; k < s.info.n_transitions; k++, total++) {
      double phase    = s.info.transition[k].phase;
      sample[0].phase = phase - step < 0 ? phase - step + 1 : phase - step;
      sample[1].phase = phase + step;
      int begins      = s.info.transition[k].state;
      trace(&s, 2);
      if ((int)sample[1].state != begins || sample[0].state == sample[1].state)
        fail_msg("%s: state %d before %g and %d after, not %d", s.name, sample[0].state, phase,
                 sample[1].state, begins);
      for (int a = 0; a < 3;
           a++) /* the slope of the force is at most M load a radian, times cond(Ku) */
        assert_true(fabs(component(&sample[1], a) - component(&sample[0], a)) <=
                    SHB_TWO_PI * 2 * step * 4 * M * load);
    }
  }
  assert_true(total >= 20);
}

/* No jump between panels, nor at the end of the period. */
static void continuous_throughout(void **state) {
  (void)state;
  for (int i = 0; i < SCENES; i++) {
    scene s;
    put_scene(i, &s);
    evaluate(&s);
    double jump = 0, load = s.top + fabs(s.law.n0);
    for (int l = 0; l < DENSE; l++) sample[l].phase = (double)l / (DENSE - 1); /* 0 and 1 */
    trace(&s, DENSE);
    for (int a = 0; a < 3; a++) {
      assert_true(fabs(component(&sample[0], a) - component(&sample[DENSE - 1], a)) <= 1e-9 * load);
      for (int l = 1; l < DENSE; l++)
        jump = fmax(jump, fabs(component(&sample[l], a) - component(&sample[l - 1], a)));
    }
    if (!(jump <= SHB_TWO_PI / DENSE * 4 * M * load)) fail_msg("%s: jump of %g N", s.name, jump);
  }
}

static unsigned long seed = 777;

static double uniform(void) {
  seed = seed * 6364136223846793005ul + 1442695040888963407ul;
  return (double)(seed >> 11) / 9007199254740992.;
}

static void put_random(scene *s) {
  double k = pow(10, 4 * uniform()), r = pow(10, 4 * uniform() - 2);
  *s = (scene){.name = "random", .law = {.mu = pow(10, 4 * uniform() - 2), .ku = {k, 0, k * r}}};
  s->law.kv = k * pow(10, 4 * uniform() - 2);
  if (uniform() < .5) s->law.ku[1] = (1.8 * uniform() - .9) * k * sqrt(r);
  int top = 1 + (int)(M * uniform());
  for (int a = 0; a < 3; a++)
    for (int h = 0; h <= top; h++) set(s, a, h, uniform() / (1 + h * h), SHB_TWO_PI * uniform());
  s->law.n0 = s->law.kv * (3 * uniform() - 1);
}

/* The scale of the law's tolerance: the largest force in sight. */
static double force_scale(const scene *s) {
  const double *ku = s->law.ku, *v = s->motion[0], *u = s->motion[1], *w = s->motion[2];
  double        load = fabs(s->law.n0), friction = 0;
  for (int j = 0; j < NB; j++) {
    load += s->law.kv * fabs(v[j]);
    friction += hypot(ku[0] * u[j] + ku[1] * w[j], ku[1] * u[j] + ku[2] * w[j]);
  }
  return fmax(load, friction);
}

/* For any start of the lap and any events: periodic, within the limit, shares of states as
 * reported. */
static void random_motions(void **state) {
  (void)state;
  enum { N = 401 };
  for (int i = 0; i < 3000; i++) {
    scene s;
    put_random(&s);
    for (int l = 0; l < N; l++) sample[l].phase = (double)l / (N - 1);
    mhb_contact_time_history(workspace, &s.law, &s.motion[0][0], N, sample, &s.info);
    if (s.info.lost) continue; /* reported, and bounded */
    double scale = force_scale(&s), share[3] = {0};
    for (int l = 0; l < N; l++) {
      double size = hypot(sample[l].f[0], sample[l].f[1]);
      if (size > s.law.mu * sample[l].n + 1e-12 * scale)
        fail_msg("motion %d at %g: |f| = %g, mu n = %g", i, sample[l].phase, size,
                 s.law.mu * sample[l].n);
      if (l > 0) share[sample[l].state] += 1. / (N - 1);
    }
    for (int a = 0; a < 3;
         a++) /* where slip is stiff the end of a lap is less accurate than its force */
      assert_true(fabs(component(&sample[0], a) - component(&sample[N - 1], a)) <= 5e-9 * scale);
    for (int k = 0; k < 3; k++)
      assert_true(fabs(share[k] - s.info.share[k]) <= (1. + s.info.n_transitions) / (N - 1));
  }
}

static void hostile_input(void **state) {
  (void)state;
  scene s;
  put_scene(2, &s);
  sample[0].phase = .2;
  sample[1].phase = .7;
  set(&s, 1, 1, NAN, 0);
  mhb_contact_time_history(workspace, &s.law, &s.motion[0][0], 2, sample, &s.info);
  assert_true(isnan(sample[1].n) && isnan(sample[0].f[0]) && s.info.lost);
  s = (scene){.name = "nothing", .law = {.mu = .4, .kv = 5e5, .ku = {1e6, 0, 1e6}}};
  trace(&s, 2);
  assert_true(sample[0].n == 0 && sample[0].f[0] == 0 && sample[1].f[1] == 0);
  s.law.n0 = 100;
  trace(&s, 2);
  assert_true(fabs(sample[1].n - 100) < 1e-12 && sample[1].state == MHB_STICK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(harmonics_at_second_order),
      cmocka_unit_test(harmonics_and_work_by_pieces),
      cmocka_unit_test(within_the_friction_limit),
      cmocka_unit_test(continuous_across_transitions),
      cmocka_unit_test(continuous_throughout),
      cmocka_unit_test(random_motions),
      cmocka_unit_test(hostile_input),
  };
  return cmocka_run_group_tests(tests, make_workspace, free_workspace);
}
