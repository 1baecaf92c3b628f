/* Verdicts along curves against independent evidence: disturbances integrated in time, and the same
 * curve with every point judged. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/integration/integrator.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { H = 11, STEPS = 48, SETTLING = 50, LONGER = 120, PERIODS = 80, WANTED = 10 };

typedef enum { STABLE, MODULATED, BEYOND_FOLD, N_KINDS } kind;

static const char *const NAME[] = {"stable", "modulated", "beyond a fold"};

static mhb_response *sweep(const modal_model *model, mhb_settings *s, double from, double to) {
  mhb_response *response;
  s->frequency[0]   = from / SHB_TWO_PI;
  s->frequency[1]   = to / SHB_TWO_PI;
  shb_status status = mhb_forced_response(model, s, NULL, NULL, NULL, &response);
  if (status != SHB_OK && status != SHB_NOT_CONVERGED) fail_msg("%s", shb_message());
  return response;
}

static kind kind_at(const mhb_branch *b, int point) {
  if (b->stable[point] == 1) return STABLE;
  return b->loss[point] == MHB_LOSS_FOLD ? BEYOND_FOLD : MODULATED;
}

static mhb_integrator *start(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                             const mhb_branch *b, int point) {
  mhb_integrator *g;
  int             n = 3 * r->n_pairs, K = b->n_harmonics + 1;
  double complex  force[n * K];
  for (int row = 0; row < n; row++)
    for (int k = 0; k < K; k++)
      force[k * n + row] = b->force[((size_t)point * (size_t)n + (size_t)row) * (size_t)K + k];
  assert_ok(mhb_integrator_create(model, s, s->harmonics, &g));
  mhb_integrator_set(g, SHB_TWO_PI * b->frequency[point], s->n0[0], STEPS);
  mhb_integrator_balance(g, b->n_harmonics, force);
  return g;
}

/* Norm of the difference of the velocities. A displacement that friction holds does not count. */
static double apart(const mhb_integrator *a, const mhb_integrator *b) {
  int    n   = a->blades * a->modes;
  double sum = 0;
  for (int i = n; i < 2 * n; i++) sum += pow(a->z[i] - b->z[i], 2);
  return sqrt(sum);
}

/* Growth a period of a small disturbance. Two motions start together, one of them disturbed. The
 * slope of the logarithm of their distance is found by least squares. The first periods are left
 * out: modes that decay faster die out then. */
static double growth(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                     const mhb_branch *b, int point, int settling) {
  mhb_integrator    *g[2];
  unsigned long long seed = 11;
  double             size = 0, sums[4] = {0};
  for (int i = 0; i < 2; i++) g[i] = start(model, s, r, b, point);
  int n = g[0]->blades * g[0]->modes;
  for (int i = 0; i < 2 * n; i++) size = fmax(size, fabs(g[0]->z[i]));
  for (int i = 0; i < 2 * n; i++) g[1]->z[i] += 1e-7 * size * random_unit(&seed);
  for (int k = 0; k < settling + PERIODS; k++) {
    for (int i = 0; i < 2; i++) assert_true(mhb_integrator_period(g[i]));
    double away = apart(g[0], g[1]), t = k - settling - 0.5 * (PERIODS - 1);
    if (k < settling) continue;
    sums[0] += t * log(away);
    sums[1] += t * t;
  }
  for (int i = 0; i < 2; i++) mhb_integrator_destroy(g[i]);
  return exp(sums[0] / sums[1]);
}

/* Points of one kind of a model, until there are enough. Where a disturbance grows by more than
 * 3.5 % a period, the motion leaves the solution before the growth can be measured. */
static void compare(const modal_model *model, const mhb_settings *s, const mhb_response *r, kind of,
                    int most, int *found, double *worst) {
  for (int i = 2; i < r->n_branches; i++) {
    const mhb_branch *b    = &r->branch[i];
    int               step = of == BEYOND_FOLD ? 2 : 1 + b->n_points / 25;
    for (int p = 0; p < b->n_points && *found < most; p += step) {
      double largest = cabs(b->multipliers[(size_t)p * (size_t)r->n_multipliers]);
      if (b->judged[p] != MHB_BY_MULTIPLIERS || kind_at(b, p) != of || b->special[p]) continue;
      if (fabs(largest - 1) < 0.004 || largest > 1.035 || largest < 0.95) continue;
      double measured = growth(model, s, r, b, p, of == STABLE ? LONGER : SETTLING);
      *worst          = fmax(*worst, fabs(measured - largest));
      assert_true((measured > 1) == (of != STABLE));
      ++*found;
      print_message("%s, w %.4f, slip %.2f: multiplier %.4f, grows by %.4f\n", NAME[of],
                    SHB_TWO_PI * b->frequency[p], b->state[3 * (size_t)p + 1], largest, measured);
    }
  }
}

static mhb_settings ring(unsigned seed, modal_model *model) {
  mhb_settings s = random_settings(H);
  random_model(1, WITH_LEFT, seed, model);
  s.blades       = 3;
  s.engine_order = 1;
  s.n0[0]        = 0.1;
  s.tolerance    = 1e-8;
  s.stability    = MHB_STABILITY_ALWAYS;
  return s;
}

static void noise_grows_as_the_multipliers_say(void **state) {
  (void)state;
  int    found[N_KINDS] = {0};
  double worst[N_KINDS] = {0};
  for (unsigned seed = 1; seed < 60; seed++) {
    modal_model  model;
    mhb_settings s    = ring(seed, &model);
    bool         done = true;
    for (int k = 0; k < N_KINDS; k++) done = done && found[k] >= WANTED;
    if (!done) {
      mhb_response *r = sweep(&model, &s, 1.4, 1.95);
      for (int k = 0; k < N_KINDS; k++) {
        int most = found[k] + 4 < WANTED ? found[k] + 4 : WANTED;
        compare(&model, &s, r, (kind)k, most, &found[k], &worst[k]);
      }
      mhb_response_destroy(r);
    }
    modal_model_free(&model);
  }
  for (int k = 0; k < N_KINDS; k++) {
    print_message("%s: %d points, worst %.4f\n", NAME[k], found[k], worst[k]);
    assert_int_equal(found[k], WANTED);
    assert_true(worst[k] < 0.01);
  }
}

/* Every point of a curve judged by its own multipliers, and the same with auto, on dear rings. A
 * verdict is the same or is missing. */
static void auto_claims_nothing_else(void **state) {
  (void)state;
  static const struct {
    unsigned seed;
    int      blades, order;
  } rows[] = {{7, 20, 3}, {3, 24, 5}, {5, 30, 4}};
  for (int i = 0; i < 3; i++) {
    modal_model   model;
    mhb_response *r[2];
    int           opposite = 0, unknown = 0, slipping = 0;
    double        worst = 0;
    for (int all = 0; all < 2; all++) {
      mhb_settings s = random_settings(3);
      if (all) modal_model_free(&model);
      random_model(1, WITH_LEFT, rows[i].seed, &model);
      s.blades       = rows[i].blades;
      s.engine_order = rows[i].order;
      s.stability    = all ? MHB_STABILITY_ALWAYS : MHB_STABILITY_AUTO;
      s.n0[0]        = 0.1;
      s.tolerance    = 1e-8;
      r[all]         = sweep(&model, &s, 0.9, 1.5);
    }
    const mhb_branch *a = &r[0]->branch[2], *b = &r[1]->branch[2];
    for (int p = 0, q = 0; p < a->n_points; p++, q++) {
      while (p < a->n_points && a->special[p] >= MHB_FLIP) p++;
      while (q < b->n_points && b->special[q] >= MHB_FLIP) q++;
      if (p == a->n_points) break;
      assert_true(a->frequency[p] == b->frequency[q]);
      if (a->state[3 * p] >= 1 || a->state[3 * p + 2] >= 1) continue;
      slipping++;
      unknown += a->stable[p] < 0;
      opposite += a->stable[p] >= 0 && a->stable[p] != b->stable[q];
      if (a->judged[p] == MHB_BY_MULTIPLIERS)
        worst = fmax(worst, fabs(cabs(a->multipliers[p * r[0]->n_multipliers]) -
                                 cabs(b->multipliers[q * r[1]->n_multipliers])));
    }
    print_message("%d blades: %d slipping points, %d opposite, %d not judged, multipliers %.1e\n",
                  rows[i].blades, slipping, opposite, unknown, worst);
    assert_true(slipping > 30 && 100 * opposite <= slipping);
    assert_true(worst < 5e-3);
    for (int k = 0; k < 2; k++) mhb_response_destroy(r[k]);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(noise_grows_as_the_multipliers_say),
                                     cmocka_unit_test(auto_claims_nothing_else)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
