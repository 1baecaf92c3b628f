/* A mode at 0 Hz: a body that only its contact holds. */
#include <complex.h>
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/structure/stiffness_check.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { H = 7 };

/* A mass of 1 kg, free along one axis (0 v, 1 u), or on a spring of hz. */
static mhb_response *curve_of(int axis, double hz, mhb_settings s) {
  modal_model   model;
  mhb_response *response;
  one_degree_model(0, axis, 0.1, &model);
  model.frequency[0] = hz;
  s.frequency[0]     = 0.8 / SHB_TWO_PI;
  s.frequency[1]     = 2.2 / SHB_TWO_PI;
  s.harmonics        = H;
  assert_ok(main_curve(&model, &s, H, NULL, &response));
  modal_model_free(&model);
  return response;
}

static double first(const mhb_branch *b, int point, int axis) {
  return cabs(b->motion[((size_t)point * 3 + (size_t)axis) * (H + 1) + 1]);
}

/* Pressed on throughout: F/(kv - w^2). */
static void a_body_on_its_contact_stiffness(void **state) {
  (void)state;
  double        worst    = 0;
  mhb_response *response = curve_of(0, 0, ground_settings(0.3, 9, 1, 5, H));
  mhb_branch   *b        = &response->branch[0];
  assert_true(b->n_points > 2);
  for (int i = 0; i < b->n_points; i++) {
    const double w = SHB_TWO_PI * b->frequency[i];
    worst          = fmax(worst, fabs(first(b, i, 0) * (9 - w * w) / 0.1 - 1));
  }
  print_message("largest error %.1e\n", worst);
  assert_below(worst, 1e-9);
  mhb_response_destroy(response);
}

/* It slips about its resonance; a spring of 1e-4 of the range's frequency makes no difference. */
static void a_body_that_slips(void **state) {
  (void)state;
  const mhb_settings s     = ground_settings(0.3, 1, 2, 0.2, H);
  mhb_response      *free_ = curve_of(1, 0, s), *held = curve_of(1, 1e-4 / SHB_TWO_PI, s);
  double             top[2] = {0, 0};
  mhb_response      *both[] = {free_, held};
  for (int k = 0; k < 2; k++) {
    mhb_branch *b = &both[k]->branch[0];
    assert_true(b->complete);
    for (int i = 0; i < b->n_points; i++) top[k] = fmax(top[k], first(b, i, 1));
  }
  print_message("peaks %.9f and %.9f\n", top[0], top[1]);
  assert_true(top[0] > 0.15 && fabs(top[0] / top[1] - 1) < 1e-7);
  mhb_response_destroy(free_);
  mhb_response_destroy(held);
}

/* m w^2 of the body counts. */
static void its_inertia_limits_the_contact_stiffness(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(0, 0, 0.1, &model);
  model.frequency[0] = 0;
  for (int over = 0; over < 2; over++) {
    mhb_settings    s = ground_settings(0.3, 1, 1, 1, H);
    mhb_receptance *receptance;
    s.frequency[0] = s.frequency[1] = 2 / SHB_TWO_PI;
    s.kv                            = (over ? 1.001 : 0.999) * 4 * MHB_STIFFNESS_LIMIT;
    assert_ok(mhb_receptance_create(&model, &s, H, &receptance));
    assert_int_equal(mhb_stiffness_check(receptance, &s), over ? SHB_ERR_INPUT : SHB_OK);
    mhb_receptance_destroy(receptance);
  }
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_body_on_its_contact_stiffness),
                                     cmocka_unit_test(a_body_that_slips),
                                     cmocka_unit_test(its_inertia_limits_the_contact_stiffness)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
