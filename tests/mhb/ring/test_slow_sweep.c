/* The slow sweep: on a ring of stuck contacts it follows the linear response. On the flanks of the
 * resonance, at 1.02 rad/s with a bandwidth of 0.02, the envelope lags; they are left out. */
#include "mesh/base/constants.h"
#include "mhb/ring/slow_sweep.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

/* Peak of the output in steady motion of one harmonic, by the balance. */
static double peak_at(const modal_model *model, const mhb_settings *s, double omega) {
  periodic       p;
  double complex force[3], motion[6];
  double         top = 0;
  periodic_create(model, s, omega, NULL, &p);
  mhb_balance_contact_force(p.residual, 1, force);
  mhb_receptance_update(p.residual->receptance, 1);
  mhb_receptance_probe(p.residual->receptance, 1, force, motion);
  for (int i = 0; i < 720; i++) {
    double square = 0;
    for (int c = 0; c < 3; c++) square += pow(creal(motion[c] * cexp(I * SHB_PI * i / 360)), 2);
    top = fmax(top, sqrt(square));
  }
  periodic_destroy(&p);
  return top;
}

static void start(modal_model *model, mhb_settings *s) {
  random_model(1, WITH_LEFT, 5, model);
  for (int i = 0; i < 6; i++) model->damping_ratio[i] = .01;
  for (int i = 0; i < 6; i++) model->modal_force[12 + i] = 0;
  *s       = random_settings(1);
  s->n0[0] = 500;
}

static void a_stuck_ring_follows_the_linear_response(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s;
  mhb_slow_sweep sweep;
  double complex none[3] = {0};
  double         low = .9, high = 1.1, worst = 0, top = 0, at = 0, peak[2] = {0};
  start(&model, &s);
  const mhb_wave wave = {low, 500, 0, none, 0};
  assert_ok(mhb_slow_sweep_run(&model, &s, &wave, high / SHB_TWO_PI, NULL, NULL, &sweep));
  assert_true(sweep.n > 10);
  for (int i = 4; i < sweep.n; i++) { /* the first windows hold the start's transient */
    double wanted = 0, half = sweep.frequency[1] - sweep.frequency[0]; /* windows overlap */
    for (int k = -4; k <= 4; k++)
      wanted += peak_at(&model, &s, SHB_TWO_PI * (sweep.frequency[i] + half * k / 4.5)) / 9;
    double beside = fabs(SHB_TWO_PI * sweep.frequency[i] - 1.02);
    if (beside > .022) worst = fmax(worst, fabs(sweep.mean[i] / wanted - 1));
    peak[0] = fmax(peak[0], sweep.mean[i]);
    peak[1] = fmax(peak[1], wanted);
    if (sweep.worst[i] > top) {
      top = sweep.worst[i];
      at  = sweep.frequency[i];
    }
    assert_true(sweep.worst[i] >= sweep.mean[i]);
  }
  print_message(
      "%d windows of %d periods, mean off by %.3f at most, peak by %+.3f; largest "
      "at %.4f rad/s\n",
      sweep.n, sweep.periods, worst, peak[0] / peak[1] - 1, SHB_TWO_PI * sweep.largest);
  assert_below(worst, .02);
  assert_within(peak[0], peak[1], .03);
  assert_near(SHB_TWO_PI * sweep.largest, SHB_TWO_PI * at, .01);
  mhb_slow_sweep_destroy(&sweep);
  modal_model_free(&model);
}

static bool few_calls(void *context) {
  return ++*(int *)context < 50;
}

static void an_interrupted_sweep_is_empty(void **state) {
  (void)state;
  modal_model    model;
  mhb_settings   s;
  mhb_slow_sweep sweep;
  double complex none[3] = {0};
  int            calls   = 0;
  start(&model, &s);
  const mhb_wave wave = {.9, 500, 0, none, 0};
  assert_ok(mhb_slow_sweep_run(&model, &s, &wave, 1.1 / SHB_TWO_PI, few_calls, &calls, &sweep));
  assert_int_equal(sweep.n, 0);
  assert_int_equal(calls, 50);
  mhb_slow_sweep_destroy(&sweep);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_stuck_ring_follows_the_linear_response),
      cmocka_unit_test(an_interrupted_sweep_is_empty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
