/* Sweeps along an engine order. Every point is a solution at its own speed, with its own
 * multipliers, and time integration agrees. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/record.h"
#include "mhb/continuation/linear_resonances.h"
#include "mhb/integration/integration_sweep.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/spinning.h"

enum { MAIN = 2 }; /* after the linear limits */

static mhb_speed_table *make_run_up(spinning_kind kind, int n, mhb_settings *s) {
  modal_speeds     speeds;
  mhb_speed_table *run_up = NULL;
  spinning_speeds(kind, n, 0, 1, true, &speeds);
  assert_ok(
      mhb_speed_table_create(&speeds, "blade.modal.h5", s->engine_order, s->frequency, &run_up));
  s->run_up = run_up;
  return run_up;
}

static mhb_response *sweep(const modal_model *model, const mhb_settings *s) {
  mhb_response *response = NULL;
  assert_ok(mhb_forced_response(model, s, NULL, NULL, NULL, &response));
  return response;
}

static double apart(const double complex *a, const double complex *b, int n) {
  double sum = 0, size = 0;
  for (int i = 0; i < n; i++) {
    sum += pow(cabs(a[i] - b[i]), 2);
    size += pow(cabs(b[i]), 2);
  }
  return size > 0 ? sqrt(sum / size) : sqrt(sum);
}

/* A recorded point against the structure made for its speed: motion and multipliers. */
static void check_point(const mhb_settings *plain, spinning_kind kind, const mhb_response *response,
                        int branch, int point, double worst[2], int *judged) {
  const mhb_branch *b     = &response->branch[branch];
  double            omega = SHB_TWO_PI * b->frequency[point];
  modal_model       model;
  periodic          at;
  spinning_model(kind, omega / plain->engine_order, &model, NULL);
  double       guess[3 * (2 * b->n_harmonics + 1)];
  mhb_balance *shape;
  assert_ok(mhb_balance_create(&model, plain, &shape));
  mhb_recorded_motion(b, point, shape, guess);
  mhb_balance_destroy(shape);
  periodic_create(&model, plain, omega, guess, &at);
  double sum = 0;
  for (int i = 0; i < at.residual->n; i++) sum += pow(at.x[i] - guess[i], 2);
  worst[0] = fmax(worst[0], sqrt(sum) / mhb_norm(at.x, at.residual->n));
  if (b->judged[point] == MHB_BY_MULTIPLIERS) {
    double complex  copy[512];
    mhb_multipliers m       = periodic_multipliers(&at, 256, copy);
    double          largest = cabs(b->multipliers[(size_t)point * (size_t)response->n_multipliers]);
    worst[1]                = fmax(worst[1], fabs(m.largest - largest) / fmax(m.largest, 1e-3));
    ++*judged;
  }
  periodic_destroy(&at);
  modal_model_free(&model);
}

/* Of peaks of two outputs near each other on a step one is marked: the first that the step meets.
 */
static int has_mark(const mhb_branch *b, int special, double frequency) {
  const double same = special == MHB_PEAK ? 2e-5 : 1e-7;
  for (int i = 0; i < b->n_points; i++)
    if (b->special[i] == special && fabs(b->frequency[i] / frequency - 1) < same) return 1;
  return 0;
}

/* The same structure at every speed. The linear limits are those of the plain sweep, at the points
 * that both have: places near the natural frequencies differ by round-off. On the curve round-off
 * changes the lengths of the steps, so only folds and peaks are at the same places. */
static void what_does_not_change_gives_the_plain_curve(void **state) {
  (void)state;
  mhb_settings plain = spinning_settings(), s = plain;
  modal_model  model;
  spinning_model(SPINNING_STEADY, 0, &model, NULL);
  mhb_speed_table *run_up = make_run_up(SPINNING_STEADY, 3, &s);
  mhb_response    *a = sweep(&model, &plain), *b = sweep(&model, &s);
  double           worst[2] = {0, 0};
  int              judged = 0, n3 = 3 * (plain.harmonics + 1);
  assert_int_equal(a->n_branches, b->n_branches);
  for (int i = 0; i < a->n_branches; i++) {
    const mhb_branch *p = &a->branch[i], *q = &b->branch[i];
    const bool        linear = i < MAIN;
    int               marks = 0, met = 0;
    int               shared = 0;
    for (int j = 0, k = 0; j < p->n_points && linear; j++) {
      while (k < q->n_points && q->frequency[k] < p->frequency[j]) k++;
      if (k == q->n_points || q->frequency[k] != p->frequency[j]) continue;
      shared++;
      assert_below(apart(q->motion + k * n3, p->motion + j * n3, n3), 1e-12);
      assert_below(apart(q->probe + k * n3, p->probe + j * n3, n3), 1e-12);
    }
    if (linear) assert_true(shared > 0.8 * p->n_points);
    for (int j = 0; j < p->n_points && !linear; j++) {
      if (p->special[j] == MHB_ORDINARY) continue;
      marks++;
      met += has_mark(q, p->special[j], p->frequency[j]);
    }
    print_message("branch %d: %d points, %d of %d marks met\n", i, q->n_points, met, marks);
    assert_int_equal(met, marks);
    for (int j = 0; j < q->n_points && !linear; j += 11)
      check_point(&plain, SPINNING_STEADY, b, i, j, worst, &judged);
  }
  assert_below(worst[0], 1e-9);
  assert_below(worst[1], 1e-9);
  mhb_response_destroy(a);
  mhb_response_destroy(b);
  modal_model_free(&model);
  mhb_speed_table_destroy(run_up);
}

/* Points that stick or are open throughout are judged, each at its speed. A passive structure is
 * stable. Returns their number. */
static int linear_points_are_stable(const mhb_branch *b) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++) {
    if (b->state[3 * i] < 1 && b->state[3 * i + 2] < 1) continue;
    assert_int_equal(b->judged[i], MHB_BY_MULTIPLIERS);
    assert_int_equal(b->stable[i], 1);
    n++;
  }
  return n;
}

static void points_are_solutions_at_their_speed(void **state) {
  (void)state;
  static const struct {
    spinning_kind kind;
    int           n, harmonics, subharmonics;
    bool          to_ground;
    double        bound;
  } all[]      = {{SPINNING_TURNING, 17, 3, 1, false, 2e-6},
                  {SPINNING_VEERING, 17, 5, 1, true, 2e-7},
                  {SPINNING_STRAIGHT, 3, 4, 2, false, 1e-9}};
  int n_linear = 0;
  for (int c = 0; c < 3; c++) {
    mhb_settings plain         = spinning_settings(), s;
    plain.harmonics            = all[c].harmonics;
    plain.subharmonics         = all[c].subharmonics;
    plain.to_ground            = all[c].to_ground;
    s                          = plain;
    mhb_speed_table  *run_up   = make_run_up(all[c].kind, all[c].n, &s);
    mhb_response     *response = sweep(run_up->common, &s);
    const mhb_branch *b        = &response->branch[MAIN];
    double            worst[2] = {0, 0};
    int               judged = 0, looked = 0;
    assert_true(b->complete && response->run_up);
    for (int i = 0; i < b->n_points; i += 1 + b->n_points / 25, looked++)
      check_point(&plain, all[c].kind, response, MAIN, i, worst, &judged);
    print_message("%d points of %d: motions differ by %.1e, multipliers at %d of them by %.1e\n",
                  looked, b->n_points, worst[0], judged, worst[1]);
    assert_true(judged > 0);
    n_linear += linear_points_are_stable(b);
    assert_below(worst[0], all[c].bound);
    assert_below(worst[1], 1e-3);
    mhb_response_destroy(response);
    mhb_speed_table_destroy(run_up);
  }
  print_message("%d linear points\n", n_linear);
  assert_true(n_linear > 20);
}

/* Another parameter, at one frequency: the structure is that of its speed. */
static void other_parameters_take_one_speed(void **state) {
  (void)state;
  mhb_settings plain = spinning_settings(), s;
  modal_model  model;
  plain.frequency[0] = plain.frequency[1] = 1.21 / SHB_TWO_PI;
  plain.parameter                         = MHB_IN_SCALE;
  plain.range[0]                          = 0.2;
  plain.range[1]                          = 2;
  s                                       = plain;
  spinning_model(SPINNING_TURNING, 1.21 / plain.engine_order, &model, NULL);
  mhb_speed_table  *run_up = make_run_up(SPINNING_TURNING, 33, &s);
  mhb_response     *a = sweep(&model, &plain), *b = sweep(&model, &s);
  const mhb_branch *p = &a->branch[MAIN], *q = &b->branch[MAIN];
  int               n3 = 3 * (p->n_harmonics + 1);
  assert_true(p->complete && q->complete);
  for (int end = 0; end < 2; end++)
    assert_below(apart(q->motion + end * (q->n_points - 1) * n3,
                       p->motion + end * (p->n_points - 1) * n3, n3),
                 1e-6);
  mhb_response_destroy(a);
  mhb_response_destroy(b);
  modal_model_free(&model);
  mhb_speed_table_destroy(run_up);
}

/* The same point by the structure of that speed alone. */
static void check_alone(const mhb_settings *s, const mhb_integration_settings *asked,
                        const mhb_response *from, const mhb_branch *b, int point, int n3,
                        double *off) {
  modal_model              model;
  mhb_settings             plain = *s;
  mhb_integration_settings one   = *asked;
  mhb_response            *alone = NULL;
  plain.run_up                   = NULL;
  one.n_frequencies              = 1;
  one.listed                     = true;
  one.frequency[0]               = b->frequency[point];
  spinning_model(SPINNING_VEERING, SHB_TWO_PI * b->frequency[point] / s->engine_order, &model,
                 NULL);
  assert_ok(mhb_integration_sweep(&model, &plain, &one, from, NULL, NULL, NULL, &alone));
  *off = apart(alone->branch[0].motion, b->motion + point * n3, n3);
  mhb_response_destroy(alone);
  modal_model_free(&model);
}

/* Integration from rest, at the speed of each frequency, and from the curve of the balance. A state
 * is that of one structure. */
static void integration_agrees(void **state) {
  (void)state;
  mhb_settings s                   = spinning_settings();
  s.to_ground                      = true;
  s.harmonics                      = 7;
  mhb_speed_table         *run_up  = make_run_up(SPINNING_VEERING, 17, &s);
  mhb_response            *balance = sweep(run_up->common, &s), *points = NULL;
  mhb_integration_settings asked = {.n_frequencies = 3,
                                    .start         = MHB_START_FROM_STATE,
                                    .direction     = MHB_SWEEP_BOTH,
                                    .steps         = 64,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 4000};
  assert_int_equal(
      mhb_integration_sweep(run_up->common, &s, &asked, NULL, NULL, NULL, NULL, &points),
      SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "integrate.start"));
  for (int start = MHB_START_FROM_BALANCE; start <= MHB_START_FROM_REST; start++) {
    const mhb_response *from = start == MHB_START_FROM_BALANCE ? balance : NULL;
    asked.start              = (mhb_integration_start)start;
    assert_ok(mhb_integration_sweep(run_up->common, &s, &asked, from, NULL, NULL, NULL, &points));
    const mhb_branch *b = &points->branch[0];
    assert_int_equal(b->n_points, 3);
    for (int i = 0; i < b->n_points; i++) {
      const int n3  = 3 * (b->n_harmonics + 1);
      double    off = INFINITY;
      check_alone(&s, &asked, from, b, i, n3, &off);
      print_message("start %d at %.4f rad/s: differ by %.1e\n", start, SHB_TWO_PI * b->frequency[i],
                    off);
      assert_below(off, 1e-6);
    }
    mhb_response_destroy(points);
  }
  mhb_response_destroy(balance);
  mhb_speed_table_destroy(run_up);
}

/* All solutions of omega = nu w_i(omega)/k. They are as wide as the angle between the curves makes
 * them. */
static void resonances_are_where_curves_meet(void **state) {
  (void)state;
  mhb_settings     s      = spinning_settings();
  mhb_speed_table *run_up = make_run_up(SPINNING_STRAIGHT, 5, &s);
  mhb_balance     *b;
  mhb_resonances   all;
  int              found = 0, wanted = 0;
  const double     low = 0.4, high = 1.9, E = s.engine_order;
  assert_ok(mhb_balance_create(run_up->common, &s, &b));
  mhb_balance_set_parameter(b, MHB_IN_FREQUENCY);
  mhb_resonances_create(b, low, high, &all);
  for (int mode = 0; mode < SPINNING_MODES; mode++) /* a + slope omega^2 = (k omega)^2 */
    for (int k = 1; k <= s.harmonics; k++) {
      double square[2], lambda[2], at[2] = {0, 0.9};
      for (int i = 0; i < 2; i++) {
        modal_model model;
        spinning_model(SPINNING_STRAIGHT, at[i], &model, NULL);
        /* the second and third cross at 0.7: below it by place, above by the other's */
        int place = i == 1 && (mode == 1 || mode == 2) ? 3 - mode : mode;
        lambda[i] = pow(SHB_TWO_PI * model.frequency[place], 2);
        square[i] = at[i] * at[i];
        modal_model_free(&model);
      }
      double b_    = (lambda[1] - lambda[0]) / (square[1] - square[0]) / (E * E);
      double omega = sqrt(lambda[0] / (k * k - b_));
      if (!(omega > low && omega < high)) continue;
      wanted++;
      double half = 0.012 * omega / (1 - b_ / (k * k)); /* zeta w_i/k over the angle */
      for (int i = 0; i < all.n; i++)
        if (all.at[i].k == k && fabs(all.at[i].value - omega) < 1e-9 &&
            fabs(all.at[i].half_width / half - 1) < 1e-2) {
          found++;
          break;
        }
    }
  print_message("%d of %d resonances of the free blade\n", found, wanted);
  assert_true(wanted > 5);
  assert_int_equal(found, wanted);
  mhb_resonances_destroy(&all);
  mhb_balance_destroy(b);
  mhb_speed_table_destroy(run_up);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_does_not_change_gives_the_plain_curve),
                                     cmocka_unit_test(points_are_solutions_at_their_speed),
                                     cmocka_unit_test(other_parameters_take_one_speed),
                                     cmocka_unit_test(integration_agrees),
                                     cmocka_unit_test(resonances_are_where_curves_meet)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
