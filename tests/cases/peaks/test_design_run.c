/* Peaks of random designs against sweeps of the whole range with many harmonics. */
#include "cases/peaks/design_run.h"

#include <math.h>
#include <string.h>

#include "cases/designs/study_keys.h"
#include "mesh/base/constants.h"
#include "mhb/amplification/ring_response.h"
#include "mhb/branches/forced_response.h"
#include "postproc/analysis/outputs.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { DESIGNS = 6, OUTPUTS = 2 };

/* Numbers between 0 and 1 (Lehmer, modulus 2^31 - 1). */
static double next_random(unsigned long *state) {
  *state = *state * 48271UL % 2147483647UL;
  return (double)*state / 2147483647.;
}

static double highest(const mhb_response *r) {
  post_output first = post_output_primary(r);
  double      most  = 0;
  for (int k = 0; k < r->n_branches; k++) {
    const mhb_branch *b = &r->branch[k];
    if (b->kind != MHB_BRANCH_NONLINEAR) continue;
    for (int i = 0; i < b->n_points; i++)
      most = fmax(most, post_amplitude(r, b, i, first, post_first_harmonic(b)));
  }
  return most;
}

static double swept(const case_model *model) {
  mhb_settings  full    = model->settings;
  mhb_response *r       = NULL;
  full.motion_tolerance = 0;
  full.harmonics        = 13;
  shb_status status     = mhb_forced_response(&model->model, &full, NULL, NULL, NULL, &r);
  assert_true(status == SHB_OK || status == SHB_NOT_CONVERGED);
  double most = highest(r);
  mhb_response_destroy(r);
  return most;
}

static case_model lone_blade(void) {
  case_model model = {.settings = ground_settings(0.4, 0.8, 0.5, 0.3, 31)};
  three_degree_model(&model.model);
  model.settings.motion_tolerance = 0.01;
  model.settings.frequency[0]     = 0.6 / SHB_TWO_PI;
  model.settings.frequency[1]     = 2 / SHB_TWO_PI;
  model.settings.stability        = MHB_STABILITY_NEVER;
  model.settings.tolerance        = 1e-6;
  return model;
}

static const study_output output[OUTPUTS] = {{.quantity = STUDY_PEAK},
                                             {.quantity = STUDY_FREQUENCY}};

static study_design *run(const case_model *model, design_study *one) {
  assert_ok(design_study_create(0, OUTPUTS, study_derivatives(OUTPUTS, output), one));
  study_design *design = design_study_add(one, NULL);
  assert_ok(design_run(NULL, model, NULL, OUTPUTS, output, design));
  return design;
}

/* The peak of a design is the highest of a sweep, and its error is no lower than told. */
static void no_peak_of_random_designs_is_missed(void **state) {
  unsigned long seed  = 20261;
  case_model    model = lone_blade();
  (void)state;
  for (int i = 0; i < DESIGNS; i++) {
    design_study one;
    model.settings.n0[0]    = 0.03 * pow(40, next_random(&seed));
    model.settings.mu       = 0.1 + 0.5 * next_random(&seed);
    double        reference = swept(&model);
    study_design *design    = run(&model, &one);
    assert_int_equal(design->state, STUDY_DONE);
    double error = design->value[0] / reference - 1, told = design->error[0] / design->value[0];
    printf("n0 %.3f mu %.3f: peak %.6g, error %+.1e, told %.1e\n", model.settings.n0[0],
           model.settings.mu, design->value[0], error, told);
    assert_below(-error, told + 1e-4);
    assert_below(error, told + 1e-3); /* the sweep's points lie beside its peak */
    design_study_free(&one);
  }
  modal_model_free(&model.model);
}

/* The told error is that of the harmonics left out: against the same peak with 31. */
static void the_told_error_is_that_of_the_harmonics_left_out(void **state) {
  unsigned long seed  = 5;
  case_model    model = lone_blade();
  (void)state;
  for (int i = 0; i < DESIGNS; i++) {
    design_study one, fixed;
    const double tolerance = model.settings.motion_tolerance;
    model.settings.n0[0]   = 0.03 * pow(40, next_random(&seed));
    model.settings.mu      = 0.1 + 0.5 * next_random(&seed);
    study_design *design   = run(&model, &one);

    model.settings.motion_tolerance = 0;
    const double reference          = run(&model, &fixed)->value[0];
    model.settings.motion_tolerance = tolerance;
    const double error = fabs(design->value[0] - reference), told = design->error[0];
    printf("n0 %.3f: error %.1e, told %.1e\n", model.settings.n0[0], error / reference,
           told / reference);
    assert_int_equal(design->state, STUDY_DONE);
    assert_below(error, 3 * told + 1e-7 * reference); /* law and comparison */
    assert_below(told, tolerance * reference);
    design_study_free(&one);
    design_study_free(&fixed);
  }
  modal_model_free(&model.model);
}

/* Where the peak lies beyond the range, its end has the amplitude of a curve with many harmonics,
 * which the sweep with three has not. */
static void the_end_of_a_range_is_solved_with_enough_harmonics(void **state) {
  enum { ENDS = 4 };
  static const double end[ENDS] = {1.18, 1.19, 1.2, 1.204}; /* rad/s, below the peak */
  case_model          model     = lone_blade();
  (void)state;
  model.settings.n0[0] = 0.15;
  for (int i = 0; i < ENDS; i++) {
    design_study one;
    model.settings.frequency[1] = end[i] / SHB_TWO_PI;
    double        reference     = swept(&model);
    study_design *design        = run(&model, &one);
    double error = design->value[0] / reference - 1, told = design->error[0] / design->value[0];
    printf("to %.2f rad/s: %.6g at %.4f rad/s, error %+.1e, told %.1e (%s)\n", end[i],
           design->value[0], SHB_TWO_PI * design->value[1], error, told, design->reason);
    assert_near(SHB_TWO_PI * design->value[1], end[i], 1e-12);
    assert_below(fabs(error), told + 2e-5); /* 13 harmonics */
    assert_below(told, 0.01);
    design_study_free(&one);
  }
  modal_model_free(&model.model);
}

/* A ring of four blades of which the last three are equal, as rotor.mistuning gives it.
 *   model  out  the ring points into it */
static void ring_of_blades(case_model *model) {
  static const double deviation[] = {-0.02, 0.01, 0.01, 0.01};
  *model                          = (case_model){.settings = random_settings(3)};
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 3, &model->tuned);
  model->settings.blades       = 4;
  model->settings.scale        = 2;
  model->settings.frequency[0] = 1.25 / SHB_TWO_PI;
  model->settings.frequency[1] = 1.55 / SHB_TWO_PI;
  model->settings.stability    = MHB_STABILITY_NEVER;
  model->settings.max_points   = 3000;
  model->settings.tolerance    = 1e-8;
  assert_ok(mhb_mistuned_ring_create(&model->tuned, &model->settings, deviation, 1, &model->ring));
  model->model         = model->ring->whole;
  model->settings.ring = model->ring;
}

/* The peak of a ring of different blades is that of its worst blade. */
static void a_ring_has_the_peak_of_its_worst_blade(void **state) {
  const study_output stress = {.quantity = STUDY_STRESS, .name = "stress"};
  mhb_response      *r      = NULL;
  case_model         model;
  design_study       one, refused;
  (void)state;
  ring_of_blades(&model);
  mhb_settings  s      = model.settings;
  study_design *design = run(&model, &one);
  shb_status    status = mhb_ring_response(&s, NULL, NULL, NULL, NULL, &r);
  assert_true(status == SHB_OK || status == SHB_NOT_CONVERGED);
  const mhb_amplification *own = &r->branch[2].amplification;
  printf("blade %d: %.6g, told error %.1e, factor %.3f\n", own->blade, design->value[0],
         design->error[0] / design->value[0], own->factor);
  assert_int_equal(design->state, STUDY_DONE);
  assert_near(design->value[0], own->worst, 1e-14);
  assert_near(design->value[1], own->worst_at, 1e-14);
  assert_true(own->factor > 1 && design->error[0] > 0 && design->error[0] < design->value[0]);
  double most = 0;
  for (int i = 0; i < design->curve.n; i++) most = fmax(most, design->curve.amplitude[i]);
  assert_near(most, own->worst, 1e-14);
  mhb_response_destroy(r);
  design_study_free(&one);
  assert_ok(design_study_create(0, 1, 0, &refused));
  design = design_study_add(&refused, NULL);
  assert_ok(design_run(NULL, &model, NULL, 1, &stress, design));
  assert_int_equal(design->state, STUDY_FAILED);
  assert_non_null(strstr(design->reason, "stress: is not computed for a ring of different blades"));
  design_study_free(&refused);
  mhb_mistuned_ring_destroy(model.ring);
  modal_model_free(&model.tuned);
}

/* A study may vary the members of rotor.mistuning that are numbers. */
static void deviations_are_a_key_of_a_study(void **state) {
  case_issues issues = {0};
  case_node   node   = {0};
  study_key   key;
  (void)state;
  assert_true(study_key_start(&issues, &node, "rotor.mistuning.deviation", &key));
  assert_false(key.whole);
  assert_true(study_key_start(&issues, &node, "rotor.mistuning.seed", &key));
  assert_true(key.whole);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_peak_of_random_designs_is_missed),
      cmocka_unit_test(the_told_error_is_that_of_the_harmonics_left_out),
      cmocka_unit_test(the_end_of_a_range_is_solved_with_enough_harmonics),
      cmocka_unit_test(a_ring_has_the_peak_of_its_worst_blade),
      cmocka_unit_test(deviations_are_a_key_of_a_study)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
