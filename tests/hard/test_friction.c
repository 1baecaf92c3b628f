/* Hard cases 3, 6, 7: friction from a cold start, nearly rigid friction springs, no friction and
 * infinite friction. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/main_branch.h"
#include "mhb/numerics/fourier.h"
#include "tests/hard/verdict.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

/* Largest displacement along u over a period. */
static double largest(const periodic *p) {
  int    nb = p->residual->nb;
  double basis[nb], top = 0;
  for (int i = 0; i < 20000; i++) {
    double sum = 0;
    mhb_basis(p->residual->m, SHB_TWO_PI * i / 20000, basis, NULL);
    for (int j = 0; j < nb; j++) sum += basis[j] * p->x[nb + j];
    top = fmax(top, fabs(sum));
  }
  return top;
}

static void oscillator_from_a_cold_start(void **state) {
  (void)state;
  static const double rows[][2] = {
      {1.0, .79984}, {1.1, 1.01470}, {1.18, 2.39365184}, {1.30, 2.02243853}};
  modal_model model;
  one_degree_model(.01, 1, .8, &model);
  for (int i = 0; i < 4; i++) {
    mhb_settings s = ground_settings(1, 1, 1, 1, 31);
    periodic     p;
    periodic_create(&model, &s, rows[i][0], NULL, &p);
    verdict(fabs(largest(&p) / rows[i][1] - 1), 2e-5, "3 oscillator at W %.2f: amplitude",
            rows[i][0]);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
  verdict_all();
}

/* Den Hartog 1931: Coulomb friction without stops, r = friction/F, b = W/wn. */
static double den_hartog(double b, double r) {
  double V = 1 / (1 - b * b), U = sin(SHB_PI / b) / (b * (1 + cos(SHB_PI / b)));
  return sqrt(V * V - r * r * U * U);
}

/* Largest displacement after many periods of time integration that begins at the solution. */
static double marched(const modal_model *model, const periodic *p) {
  enum { STEPS = 4000, PERIODS = 60 };
  disturbed d;
  double    y[4], top = 0;
  disturbed_create(model, &p->settings, p->residual, p->x, p->omega, STEPS, &d);
  disturbed_start(&d, y);
  for (int i = 0; i < PERIODS; i++) disturbed_period(&d, y);
  for (int i = 0; i < STEPS; i++) {
    disturbed_step(&d, y, i);
    top = fmax(top, fabs(y[0]));
  }
  disturbed_destroy(&d);
  return top;
}

/* The closed form has no elastic stage. With ku 1e3 the exact solution differs from it by 1.5 % and
 * 1.1 %, hence a second reference. */
static void stiff_friction(void **state) {
  (void)state;
  static const double rows[][2] = {{.7, .5}, {2, .2}}, stiff[] = {1e3, 1e4, 1e5, 1e6};
  modal_model         model;
  one_degree_model(0, 1, 1, &model);
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 4; k++) {
      mhb_settings s = ground_settings(rows[i][1], 1, stiff[k], 1, 31);
      periodic     p;
      periodic_create(&model, &s, rows[i][0], NULL, &p);
      if (k > 0)
        verdict(fabs(largest(&p) / den_hartog(rows[i][0], rows[i][1]) - 1), 1e-2,
                "6 Den Hartog b %.1f r %.1f, ku %.0e", rows[i][0], rows[i][1], stiff[k]);
      else
        verdict(fabs(largest(&p) / marched(&model, &p) - 1), 1e-2,
                "6 time integration b %.1f r %.1f, ku %.0e (Den Hartog: %.1e)", rows[i][0],
                rows[i][1], stiff[k], largest(&p) / den_hartog(rows[i][0], rows[i][1]) - 1);
      periodic_destroy(&p);
    }
    mhb_settings  s = ground_settings(rows[i][1], 1, 1e6, 1, 31);
    mhb_response *r = covered_sweep(&model, &s, i ? 1.5 : .6, i ? 3 : .9);
    verdict_count(r->branch[2].complete, 1, "6 ku 1e6, r %.1f: curve covered", rows[i][1]);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
  verdict_all();
}

static double solved(const modal_model *model, const mhb_settings *s, double w, double *x) {
  periodic p;
  periodic_create(model, s, w, NULL, &p);
  double slip = p.residual->eval->info[0].share[MHB_SLIDE];
  for (int i = 0; i < p.residual->n; i++) x[i] = p.x[i];
  periodic_destroy(&p);
  return slip;
}

static double difference(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(a, n);
}

/* mu = 0: the tangential stiffness means nothing. Endless friction: never slips while closed. */
static void extreme_friction(void **state) {
  (void)state;
  enum { M = 7, N = 3 * (2 * M + 1) };
  static const double w[] = {.9, 1.1, 1.3, 1.5}, n0[] = {-.1, 0, .2};
  modal_model         model;
  double              x[2][N], worst[3] = {0, 0, 0};
  three_degree_model(&model);
  for (int i = 0; i < 12; i++) {
    mhb_settings s = ground_settings(0, .8, .5, n0[i / 4], M);
    solved(&model, &s, w[i % 4], x[0]);
    s.ku[0] = s.ku[2] = 7;
    solved(&model, &s, w[i % 4], x[1]);
    worst[0]    = fmax(worst[0], difference(x[0], x[1], N));
    s           = ground_settings(1e6, .8, .5, n0[i / 4], M);
    double slip = solved(&model, &s, w[i % 4], x[0]);
    s.mu        = 2e6;
    solved(&model, &s, w[i % 4], x[1]);
    worst[1] = fmax(worst[1], difference(x[0], x[1], N));
    worst[2] = fmax(worst[2], slip);
  }
  verdict(worst[0], 1e-10, "7 mu 0: ku .5 against 7, 12 points");
  verdict(worst[1], 1e-4, "7 mu 1e6 against 2e6, 12 points");
  verdict(worst[2], 1e-2, "7 mu 1e6: share of the period in slip");
  for (int i = 0; i < 6; i++) {
    mhb_settings  s = ground_settings(i % 2 ? 1e6 : 0, .8, .5, n0[i / 2], M);
    mhb_response *r = covered_sweep(&model, &s, .8, 1.7);
    verdict_count(r->branch[2].complete, 1, "7 mu %.0e n0 %.1f: curve covered, %d points", s.mu,
                  s.n0[0], r->branch[2].n_points);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(oscillator_from_a_cold_start),
      cmocka_unit_test(stiff_friction),
      cmocka_unit_test(extreme_friction),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
