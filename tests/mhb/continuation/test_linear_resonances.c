/* Resonances of the linear limits, and curves over modes that hardly move the contact. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <lapacke.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/event_location.h"
#include "tests/support/random_model.h"
#include "tests/support/solution.h"
#include "tests/support/three_degree.h"

static const double SECOND = 1.437;

enum { M = 5, UNKNOWNS = 3 * (2 * M + 1) };

/* Contact along u alone. */
static mhb_settings ground(double n0) {
  mhb_settings s = random_settings(M);
  s.to_ground    = true;
  s.mu           = 0.3;
  s.kv           = 1;
  s.ku[0] = s.ku[2] = 1;
  s.ku[1]           = 0;
  s.n0[0]           = n0;
  s.frequency[0]    = 0.8 / SHB_TWO_PI;
  s.frequency[1]    = 2 / SHB_TWO_PI;
  s.stability       = MHB_STABILITY_NEVER;
  return s;
}

/* ---- one nodal diameter ---- */

enum { BLADES = 6, MODES = 6, RING = BLADES * MODES };

/* All natural frequencies of the ring with springs between the blades, from its whole matrix. The
 * spring of blade b joins its right side to the left side of blade b + 1. */
static void solve_ring(const modal_model *m, const mhb_settings *s, double square[RING]) {
  double S[3][3]       = {{s->kv, 0, 0}, {0, s->ku[0], s->ku[1]}, {0, s->ku[1], s->ku[2]}};
  double K[RING][RING] = {{0}};
  for (int b = 0; b < BLADES; b++) {
    double row[3][RING] = {{0}};
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < MODES; i++) {
        row[c][b * MODES + i] += m->right[c * MODES + i];
        row[c][(b + 1) % BLADES * MODES + i] -= m->left[c * MODES + i];
      }
    for (int i = 0; i < RING; i++)
      for (int j = 0; j < RING; j++)
        for (int c = 0; c < 3; c++)
          for (int d = 0; d < 3; d++) K[i][j] += row[c][i] * S[c][d] * row[d][j];
    for (int i = 0; i < MODES; i++)
      K[b * MODES + i][b * MODES + i] += pow(SHB_TWO_PI * m->frequency[i], 2);
  }
  assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', RING, K[0], RING, square), 0);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The frequencies of all nodal diameters, those between 0 and 3 twice, are those of the ring. */
static void stuck_frequencies_are_those_of_the_ring(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(3);
  double       square[RING], all[RING], worst = 0;
  int          n = 0;
  random_model(1, WITH_LEFT, 11, &model);
  solve_ring(&model, &s, square);
  for (int diameter = 0; diameter <= BLADES / 2; diameter++)
    for (int twice = 0; twice < (diameter % (BLADES / 2) ? 2 : 1); twice++, n += MODES)
      assert_int_equal(mhb_stuck_frequencies(&model, &s, diameter, MODES, all + n), SHB_OK);
  assert_int_equal(n, RING);
  qsort(all, RING, sizeof *all, ascending);
  for (int i = 0; i < RING; i++)
    worst = fmax(worst, fabs(SHB_TWO_PI * all[i] / sqrt(square[i]) - 1));
  print_message("ring of %d: %.1e\n", BLADES, worst);
  assert_true(worst < 1e-10);
  modal_model_free(&model);
}

/* One mode and a residual flexibility r: w^2 = 1 + 1/(1/ku + r). */
static void residual_flexibility_softens_the_contact(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground(0.1);
  double       f, r = 0.4;
  one_degree_model(0.01, 1, 0.05, &model);
  model.residual_flexibility    = calloc(9, sizeof(double));
  model.residual_flexibility[4] = r;
  assert_int_equal(mhb_stuck_frequencies(&model, &s, 0, 1, &f), SHB_OK);
  assert_true(fabs(SHB_TWO_PI * f / sqrt(1 + 1 / (1 + r)) - 1) < 1e-10);
  modal_model_free(&model);
}

/* ---- places ---- */

static int has(const mhb_resonances *all, double value, double half, int k) {
  for (int i = 0; i < all->n; i++) {
    const mhb_resonance *a = &all->at[i];
    if (a->k == k && fabs(a->value / value - 1) < 1e-9 && fabs(a->half_width / half - 1) < 1e-9)
      return 1;
  }
  return 0;
}

/* Two modes on a spring: w^2 of [1 + a^2, a b; a b, w2^2 + b^2] in closed form, the damping by the
 * eigenvector. */
static void places_are_those_of_both_limits(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s = ground(0.1);
  mhb_balance   *residual;
  mhb_resonances all;
  double         b = 0.7, z2 = 0.003, p = 2, q = SECOND * SECOND + b * b;
  two_mode_model(SECOND, z2, b, 1, 0.02, &model);
  assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
  mhb_resonances_create(residual, 0.25, 2, &all);
  for (int i = 0; i < 2; i++) {
    double square = 0.5 * (p + q) + (i ? 0.5 : -0.5) * sqrt((p - q) * (p - q) + 4 * b * b);
    double part   = b * b / (b * b + (square - p) * (square - p)); /* of the first mode */
    assert_true(has(&all, sqrt(square), part * 0.01 + (1 - part) * z2 * SECOND, 1));
  }
  for (int k = 1; k <= 3; k++) {
    assert_true(has(&all, 1. / k, 0.01 / k, k));
    assert_true(has(&all, SECOND / k, z2 * SECOND / k, k));
  }
  for (int i = 1; i < all.n; i++) assert_true(all.at[i].value >= all.at[i - 1].value);
  mhb_resonances_destroy(&all);
  mhb_balance_set_parameter(residual, MHB_IN_N0);
  mhb_resonances_create(residual, 0.25, 2, &all);
  assert_int_equal(all.n, 0);
  mhb_resonances_destroy(&all);
  mhb_balance_destroy(residual);
  modal_model_free(&model);
}

/* Upper root of the closed form above. */
static double upper(double p, double q, double b) {
  return sqrt(0.5 * (p + q) + 0.5 * sqrt((p - q) * (p - q) + 4 * b * b));
}

/* The free and the stuck place of a mode are as far apart as 32 half widths. The places between
 * leave no gap wider than two. */
static void near_limits_leave_no_gap(void **state) {
  (void)state;
  for (double contact = 0.003; contact < 0.2; contact *= 1.5) {
    modal_model    model;
    mhb_settings   s = ground(0.1);
    mhb_balance   *residual;
    mhb_resonances all;
    two_mode_model(SECOND, 1e-3, contact, 1, 0.02, &model);
    assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
    mhb_resonances_create(residual, 0.8, 2, &all);
    double half = 1e-3 * SECOND, last = SECOND,
           gap = upper(2, SECOND * SECOND + contact * contact, contact) - SECOND;
    for (int i = 0; i < all.n && gap < 31 * half; i++) {
      if (all.at[i].k != 1 || all.at[i].mode != 1) continue;
      assert_true(all.at[i].value - last <= 2.001 * half);
      last = all.at[i].value;
    }
    print_message("contact %.3f: %.2f half widths apart, places over %.2f\n", contact, gap / half,
                  (last - SECOND) / half);
    if (gap < 31 * half) assert_true(fabs(last - SECOND - gap) < 0.5 * half);
    mhb_resonances_destroy(&all);
    mhb_balance_destroy(residual);
    modal_model_free(&model);
  }
}

/* ---- curves ---- */

/* Axis c at probe[c stride]. */
static double probe_at(const double complex *probe, int stride) {
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) sum += pow(cabs(probe[axis * stride]), 2);
  return sqrt(sum);
}

static mhb_response *sweep(const modal_model *model, const mhb_settings *s) {
  mhb_response *r = NULL;
  if (mhb_forced_response(model, s, NULL, NULL, NULL, &r) != SHB_OK) fail_msg("%s", shb_message());
  return r;
}

/* Largest motion of the probe about the second mode, and the peaks located there. */
static double highest(const mhb_response *r, double width, int *peaks) {
  const mhb_branch *b   = &r->branch[2];
  int               K   = b->n_harmonics + 1;
  double            top = 0;
  *peaks                = 0;
  for (int p = 0; p < b->n_points; p++) {
    if (fabs(SHB_TWO_PI * b->frequency[p] - SECOND) > width) continue;
    top = fmax(top, probe_at(b->probe + (size_t)p * 3 * (size_t)K + 1, K));
    *peaks += b->special[p] == MHB_PEAK;
  }
  return top;
}

/* Solutions at fixed frequencies, each without a guess. */
static double truth(const modal_model *model, const mhb_settings *s, double half) {
  double         top = 0, x[UNKNOWNS], r[UNKNOWNS];
  mhb_balance   *residual;
  double complex p[3], q[3];
  assert_int_equal(mhb_balance_create(model, s, &residual), SHB_OK);
  mhb_balance_set_preload(residual, s->n0[0]);
  for (int i = -4; i <= 4; i++) {
    double omega = SECOND + 0.1 * i * half;
    cold_solution(model, s, omega, 1e-10, x);
    mhb_balance_evaluate(residual, x, omega, r, NULL, NULL);
    mhb_balance_contact_force(residual, 1, p);
    mhb_receptance_update(residual->receptance, 1);
    mhb_receptance_probe(residual->receptance, 1, p, q);
    top = fmax(top, probe_at(q, 1));
  }
  mhb_balance_destroy(residual);
  return top;
}

/* Steps are up to 0.1 of the range, the resonance is 1e-3 to 1e-4 of it. Its peak is on the curve,
 * and located. */
static void light_modes_are_not_passed_over(void **state) {
  (void)state;
  static const double zeta[] = {2e-3, 3e-4, 5e-5}, contact[] = {1e-4, 7e-4, 3e-3},
                      n0[] = {0.05, 0.2};
  for (int i = 0; i < 18; i++) {
    modal_model  model;
    mhb_settings s    = ground(n0[i / 9]);
    double       half = zeta[i % 3] * SECOND;
    int          peaks;
    two_mode_model(SECOND, zeta[i % 3], contact[i / 3 % 3], 1, 0.02, &model);
    mhb_response *r   = sweep(&model, &s);
    double        top = highest(r, half, &peaks), wanted = truth(&model, &s, half);
    print_message("zeta %.0e, contact %.0e, n0 %.2f: %.5f of %.5f, %d points\n", zeta[i % 3],
                  contact[i / 3 % 3], s.n0[0], top, wanted, r->branch[2].n_points);
    assert_true(r->branch[2].complete && r->branch[2].n_points < 250);
    assert_true(top > 0.999 * wanted && top < 1.01 * wanted);
    assert_true(peaks >= 1);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
}

/* A mode that nothing drives or that nothing shows changes no point of the curve. */
static void what_is_not_felt_costs_nothing(void **state) {
  (void)state;
  modal_model   model;
  mhb_settings  s = ground(0.1);
  mhb_response *r[3];
  for (int i = 0; i < 3; i++) {
    if (i == 0)
      one_degree_model(0.01, 1, 0.05, &model);
    else
      two_mode_model(SECOND, 1e-3, 0, i == 1 ? 1 : 0, i == 1 ? 0 : 0.02, &model);
    r[i] = sweep(&model, &s);
    modal_model_free(&model);
  }
  for (int i = 1; i < 3; i++) {
    const mhb_branch *a = &r[0]->branch[2], *b = &r[i]->branch[2];
    assert_int_equal(a->n_points, b->n_points);
    for (int p = 0; p < a->n_points; p++)
      assert_true(fabs(a->frequency[p] - b->frequency[p]) < 1e-9 * a->frequency[p]);
  }
  for (int i = 0; i < 3; i++) mhb_response_destroy(r[i]);
}

/* ---- location ---- */

/* Jumps from -1000 to 1 at a value, as the tangent does where a curve folds in a kink. Illinois
 * gains a thousandth at a time, and every fourth step halves. */
static double jumping(mhb_arclength *path, const mhb_curve_point *point, void *context) {
  (void)path;
  return point->value < *(double *)context ? -1e3 : 1;
}

static void jumps_are_located(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s = ground(0.1);
  mhb_balance   *residual;
  mhb_arclength *path;
  double         x[UNKNOWNS], at;
  one_degree_model(0.01, 1, 0.05, &model);
  assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
  mhb_balance_set_preload(residual, 0.1);
  path = mhb_balance_curve_create(residual, 0.8, 2);
  cold_solution(&model, &s, 1.6, 1e-10, x);
  assert_int_equal(mhb_arclength_start(path, x, 1.6, 1), MHB_CONVERGED);
  for (int i = 0; i < 6; i++) {
    assert_int_equal(mhb_arclength_step(path), MHB_ARCLENGTH_ON);
    double width = path->next.value - path->current.value;
    for (int j = 1; j < 20; j++) {
      double place = path->current.value + 0.05 * j * width;
      assert_int_equal(mhb_arclength_locate(path, jumping, &place, -1e3, 1, 0, &at), 1);
      if (!(fabs(path->trial.value - place) < 1e-5 * width))
        fail_msg("told as located %.1e of the step away", (path->trial.value - place) / width);
    }
    mhb_arclength_advance(path);
  }
  mhb_arclength_destroy(path);
  mhb_balance_destroy(residual);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stuck_frequencies_are_those_of_the_ring),
      cmocka_unit_test(residual_flexibility_softens_the_contact),
      cmocka_unit_test(places_are_those_of_both_limits),
      cmocka_unit_test(near_limits_leave_no_gap),
      cmocka_unit_test(light_modes_are_not_passed_over),
      cmocka_unit_test(what_is_not_felt_costs_nothing),
      cmocka_unit_test(jumps_are_located),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
