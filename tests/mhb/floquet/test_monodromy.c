/* Multipliers against brute force: every direction of the state disturbed and integrated through one period, or many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/check.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

/* What the variational problem cannot hold is taken off the model: residual inertia, residual response to the load. */
static void integrable(modal_model *model) {
  free(model->residual_inertia);
  free(model->load_residual);
  free(model->load_inertia);
  model->residual_inertia = NULL;
  model->load_residual    = NULL;
  model->load_inertia     = NULL;
}

typedef struct {
  const char *name;
  int         pairs, parts, blades, engine_order; /* blades 0: ground */
  double      mu, n0;
  double      soft;  /* multiplies the residual flexibility */
  int         stuck; /* multipliers 1 that brute force sees */
  double      tolerance;
} scene;

/* The last of two pairs moves little: it stays stuck. */
static void quiet_pair(modal_model *model) {
  int m = model->n_modes;
  for (int k = 3 * m; k < 6 * m; k++) model->right[k] *= .1;
}

static periodic solve(const scene *s, modal_model *model) {
  mhb_settings settings = random_settings(s->parts & WITH_RESIDUAL ? 25 : 15);
  periodic     p;
  random_model(s->pairs, s->parts | (s->blades ? WITH_LEFT : 0), 11, model);
  integrable(model);
  int nc = 3 * s->pairs * (s->blades ? 2 : 1);
  for (int k = 0; (s->parts & WITH_RESIDUAL) && k < nc * nc; k++)
    model->residual_flexibility[k] *= s->soft;
  if (s->stuck && s->pairs == 2) quiet_pair(model);
  settings.to_ground    = s->blades == 0;
  settings.blades       = s->blades ? s->blades : 1;
  settings.engine_order = s->engine_order;
  settings.mu           = s->mu;
  settings.n0[0]        = s->n0;
  periodic_create(model, &settings, 1.1, NULL, &p);
  return p;
}

/* What happens in all contacts together: closings that stick and that slip, ends of slip. */
static void tell(const periodic *p, char text[64]) {
  int seen[3][3] = {{0}};
  for (int a = 0; a < p->residual->n_pairs; a++) {
    const mhb_contact_info *info = &p->residual->eval->info[a];
    for (int i = 0, n = info->n_transitions; i < n; i++)
      seen[info->transition[(i + n - 1) % n].state][info->transition[i].state]++;
  }
  snprintf(text, 64, "%d+%d close, %d open, %d+%d turn", seen[2][0], seen[2][1],
           seen[0][2] + seen[1][2], seen[0][1], seen[1][0]);
}

/* Everything at once: several pairs, skew stiffness, residual flexibility, rings with and without common divisors. The march is of
 * first order where friction slips, and where a soft contact closes it errs a little at any step. */
static void one_period_by_brute_force(void **state) {
  (void)state;
  enum { RESIDUAL = WITH_RESIDUAL, AREAS = WITH_AREAS };
  static const scene scenes[] = {
      {"one pair", 1, 0, 0, 0, .4, .05, 1, 0, 3e-4},
      {"one pair, closing to stick", 1, 0, 0, 0, 3, .05, 1, 0, 3e-4},
      {"two pairs", 2, AREAS, 0, 0, .4, .05, 1, 0, 3e-4},
      {"one of two pairs stuck", 2, AREAS, 0, 0, .4, .05, 1, 2, 3e-4},
      {"residual", 1, RESIDUAL, 0, 0, .4, .05, 1, 0, 3e-4},
      {"residual, two pairs", 2, RESIDUAL, 0, 0, .4, .05, 1, 0, 5e-4},
      {"residual, one of two stuck", 2, RESIDUAL, 0, 0, .4, .05, 1, 2, 1e-3},
      {"soft, closing to stick", 1, RESIDUAL, 0, 0, 3, .05, 5, 0, 3e-3},
      {"soft, two pairs", 2, RESIDUAL, 0, 0, 3, .05, 5, 0, 3e-3},
      {"ring of 3, order 1", 1, 0, 3, 1, .4, .05, 1, 0, 3e-4},
      {"ring of 4, order 2", 1, 0, 4, 2, .4, .05, 1, 0, 1e-3},
      {"ring of 4, in phase", 1, 0, 4, 0, .4, .05, 1, 0, 1e-3},
      {"ring of 6, order 3", 1, 0, 6, 3, .4, .05, 1, 0, 1e-3},
      {"ring of 3, residual", 1, RESIDUAL, 3, 1, .4, .05, 1, 0, 1e-3},
      {"ring of 3, stuck", 1, 0, 3, 1, .4, 3, 1, 6, 3e-5}};
  for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
    modal_model model;
    periodic    p = solve(&scenes[i], &model);
    disturbed   d;
    char        events[64];
    disturbed_create(&model, &p.settings, p.residual, p.x, p.omega, scenes[i].blades ? 2000 : 4000,
                     &d);
    double complex  brute[d.n], mine[d.n];
    mhb_multipliers out = periodic_multipliers(&p, 512, mine);
    disturbed_multipliers(&d, 1e-6, brute);
    double off = distance_to(mine, out.n, brute, d.n);
    tell(&p, events);
    print_message("%-26s %s: %2d of %2d, largest %.5f, off by %.1e\n", scenes[i].name, events,
                  out.n, d.n, out.largest, off);
    assert_int_equal(out.n_stuck, scenes[i].stuck);
    assert_int_equal(out.n + out.n_stuck + out.n_zero, d.n);
    assert_near(off, 0, scenes[i].tolerance);
    int ones = 0, zeros = 0;
    for (int k = 0; k < d.n; k++) {
      ones += cabs(brute[k] - 1) < 1e-6;
      zeros += cabs(brute[k]) < 1e-4;
    }
    assert_int_equal(ones, scenes[i].stuck);
    assert_true(zeros >= out.n_zero);
    disturbed_destroy(&d);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* Two runs from neighbouring starts, period by period; their distance obeys d[k+2] = a d[k+1] - b d[k] once the largest pair of
 * multipliers is left, b = |mu|^2. */
static double growth(disturbed *d, int from, int to) {
  int    n = d->n, rows = to - from;
  double a[n], b[n], history[rows][n], xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  disturbed_start(d, a);
  memcpy(b, a, sizeof a);
  b[0] += 1e-6;
  for (int k = 0; k < to; k++) {
    disturbed_period(d, a);
    disturbed_period(d, b);
    for (int i = 0; i < n && k >= from; i++) history[k - from][i] = b[i] - a[i];
  }
  for (int k = 0; k + 2 < rows; k++) /* least squares */
    for (int i = 0; i < n; i++) {
      double x = history[k + 1][i], y = -history[k][i], z = history[k + 2][i];
      xx += x * x;
      xy += x * y;
      yy += y * y;
      xz += x * z;
      yz += y * z;
    }
  return sqrt((xx * yz - xy * xz) / (xx * yy - xy * xy));
}

static void many_periods_by_brute_force(void **state) {
  (void)state;
  static const struct {
    double n0, w;
    int    from, to;
  } rows[] = {{.1, 1.25, 40, 80}, {.3, 1.42, 50, 75}};
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 2; i++) {
    mhb_settings   s = ground_settings(.4, .8, .5, rows[i].n0, 21);
    periodic       p;
    disturbed      d;
    double complex mine[8];
    periodic_create(&model, &s, rows[i].w, NULL, &p);
    mhb_multipliers out = periodic_multipliers(&p, 256, mine);
    disturbed_create(&model, &p.settings, p.residual, p.x, p.omega, 4000, &d);
    double seen = growth(&d, rows[i].from, rows[i].to);
    print_message("n0 %.1f W %.2f: %.6f a period, integrated %.6f\n", rows[i].n0, rows[i].w,
                  out.largest, seen);
    assert_near(seen, out.largest, 5e-4);
    assert_int_equal(out.verdict, seen > 1 ? MHB_UNSTABLE : MHB_STABLE);
    disturbed_destroy(&d);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Extrapolated, the error falls with the fourth power of the sub-step. With residual flexibility what is left is not the sub-steps': the
 * slip directions of the balance, of finitely many harmonics, do not meet at the events. */
static void fourth_order(void **state) {
  (void)state;
  static const scene  scenes[] = {{"one pair", 1, 0, 0, 0, .4, .05, 1, 0, 0},
                                  {"ring of 3, order 1", 1, 0, 3, 1, .4, .05, 1, 0, 0},
                                  {"residual, two pairs", 2, WITH_RESIDUAL, 0, 0, .4, .05, 1, 0, 0}};
  static const double least[] = {3.4, 3, 0}, most[] = {1e-5, 3e-4, 1e-4};
  for (int i = 0; i < 3; i++) {
    modal_model    model;
    periodic       p = solve(&scenes[i], &model);
    double complex fine[64], coarse[64];
    double         error[4];
    int            n = periodic_multipliers(&p, 4096, fine).n;
    for (int k = 0; k < 4; k++) {
      periodic_multipliers(&p, 64 << k, coarse);
      error[k] = distance_to(fine, n, coarse, n);
    }
    double order = log2(error[0] / error[3]) / 3;
    print_message("%-24s %.1e %.1e %.1e %.1e: order %.2f\n", scenes[i].name, error[0], error[1],
                  error[2], error[3], order);
    assert_true(order > least[i]);
    assert_true(error[0] < most[i]);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_period_by_brute_force),
      cmocka_unit_test(many_periods_by_brute_force),
      cmocka_unit_test(fourth_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
