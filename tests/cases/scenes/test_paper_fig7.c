/* cases/paper_fig7: harmonic balance and time integration, shroud to ground; the numbers of its
 * README. */
#include <complex.h>
#include <stdlib.h>
#include <string.h>

#include "cases/schema/case.h"
#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/integration/inertia_modes.h"
#include "postproc/analysis/outputs.h"
#include "tests/support/check.h"
#include "tests/support/scene.h"

enum { PRELOADS = 7, FREQUENCIES = 24 };

static const double n0[PRELOADS] = {-400, -40, 20, 40, 80, 160, 320};

static char          folder[SCRATCH_PATH];
static mhb_response *three, *one, *time_domain;
static case_file     file;
static modal_model   model, structure;

static int run_scene(void **state) {
  (void)state;
  char line[3 * SCRATCH_PATH];
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "paper_fig7", &three);
  scene_run(folder, SCENE, "single.yaml", "paper_fig7_single", &one);
  snprintf(line, sizeof line, "'%s' integrate --quiet '%s/case.yaml'", SHROUDHB, folder);
  assert_int_equal(system(line), 0);
  snprintf(line, sizeof line, "%s/paper_fig7.integration.h5", folder);
  assert_ok(mhb_response_read(line, &time_domain));
  snprintf(line, sizeof line, "%s/case.yaml", folder);
  assert_ok(case_read(line, CASE_MHB, stderr, &file));
  snprintf(line, sizeof line, "%s/paper_fig7.modal.h5", folder);
  assert_ok(modal_model_read(line, &model));
  assert_ok(mhb_inertia_modes(&model, &structure));
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(three);
  mhb_response_destroy(one);
  mhb_response_destroy(time_domain);
  mhb_inertia_free(&structure);
  modal_model_free(&model);
  case_free(&file);
  scratch_remove(folder);
  return 0;
}

/* A balance with a number of harmonics, solved at the frequencies of the dots. */
typedef struct {
  mhb_settings settings;
  mhb_balance *residual;
  mhb_newton  *newton;
} balance;

static void create_balance(const modal_model *of, int harmonics, balance *b) {
  b->settings           = file.mhb;
  b->settings.harmonics = harmonics;
  assert_ok(mhb_balance_create(of, &b->settings, &b->residual));
  b->newton = mhb_newton_create(b->residual->n);
  mhb_newton_bind(b->newton, b->residual);
}

static void destroy_balance(balance *b) {
  mhb_newton_destroy(b->newton);
  mhb_balance_destroy(b->residual);
}

/* Compares its solution next to a dot: first harmonic of the probe, relative errors of the
 * amplitude and of the motion as a vector. */
static void compare(balance *b, const mhb_branch *dots, int p, double error[2]) {
  const int      m = b->residual->m, nb = 2 * m + 1, K = dots->n_harmonics + 1;
  double         x[3 * nb], off = 0, norm = 0;
  double complex force[3], probe[3];
  int            iterations;
  mhb_balance_set_preload(b->residual, dots->n0[p]);
  for (int c = 0; c < 3; c++)
    for (int k = 0; k <= m; k++) {
      double complex z = dots->motion[(p * 3 + c) * K + k];
      if (k == 0) x[c * nb] = creal(z);
      if (k > 0) x[c * nb + 2 * k - 1] = creal(z);
      if (k > 0) x[c * nb + 2 * k] = cimag(z);
    }
  mhb_reason reason = mhb_newton_solve(b->newton, b->residual, SHB_TWO_PI * dots->frequency[p],
                                       1e-11, x, &iterations);
  if (reason != MHB_CONVERGED)
    fail_msg("%g N, %g Hz: Newton ended with %d", dots->n0[p], dots->frequency[p], reason);
  mhb_balance_contact_force(b->residual, 1, force);
  mhb_receptance_probe(b->residual->receptance, 1, force, probe);
  const double complex *dot = dots->probe + (size_t)(p * 3 * K);
  double complex        there[3];
  for (int a = 0; a < 3; a++) {
    there[a] = dot[a * K + 1];
    off += pow(cabs(probe[a] - there[a]), 2);
    norm += pow(cabs(there[a]), 2);
  }
  error[0] = fabs(post_semi_major_axis(3, probe, 1) / post_semi_major_axis(3, there, 1) - 1);
  error[1] = sqrt(off / norm);
}

/* Largest errors over all dots of all preloads. */
static void worst_over_dots(const modal_model *of, int harmonics, double worst[2]) {
  balance b;
  create_balance(of, harmonics, &b);
  worst[0] = worst[1] = 0;
  for (int i = 0; i < time_domain->n_branches; i++) {
    const mhb_branch *dots    = &time_domain->branch[i];
    double            here[2] = {0, 0}, error[2];
    for (int p = 0; p < dots->n_points; p++) {
      assert_int_equal(dots->multiple[p], 1);
      compare(&b, dots, p, error);
      for (int j = 0; j < 2; j++) here[j] = fmax(here[j], error[j]);
    }
    print_message("%2d harmonics, n0 = %4g N: %2d dots, amplitude %.1e, motion %.1e off\n",
                  harmonics, dots->n0[0], dots->n_points, here[0], here[1]);
    for (int j = 0; j < 2; j++) worst[j] = fmax(worst[j], here[j]);
  }
  destroy_balance(&b);
}

/* There are seven curves of dots. That of the gap and those of the two lowest preloads have both
 * branches where two exist. */
static void there_are_dots_on_every_curve(void **state) {
  (void)state;
  assert_int_equal(time_domain->n_branches, PRELOADS);
  int dots = 0;
  for (int i = 0; i < PRELOADS; i++) {
    const mhb_branch *b = &time_domain->branch[i];
    assert_true(b->kind == MHB_BRANCH_INTEGRATION && b->complete && b->n0[0] == n0[i]);
    assert_true(b->n_points >= FREQUENCIES);
    dots += b->n_points;
  }
  print_message("%d dots\n", dots);
  assert_true(dots > PRELOADS * FREQUENCIES);
}

static void three_harmonics_are_within_a_percent(void **state) {
  (void)state;
  double worst[2];
  worst_over_dots(&model, 3, worst);
  assert_true(worst[0] < .01);
}

static void fifteen_are_within_a_ten_thousandth(void **state) {
  (void)state;
  double worst[2];
  worst_over_dots(&model, 15, worst);
  assert_true(worst[0] < 1e-4);
}

/* Amplitudes agree, and the motion as a vector within 5e-5; its phase is sensitive next to a jump.
 * Both use one structure: time integration has residual modes where the balance has residual
 * inertia. */
static void thirty_one_are_the_integration(void **state) {
  (void)state;
  double worst[2];
  worst_over_dots(&structure, 31, worst);
  assert_true(worst[0] < 1e-5 && worst[1] < 5e-5);
}

/* The linear limits, open and stuck. */
static void preloads_go_from_separate_to_stuck(void **state) {
  (void)state;
  for (int stuck = 0; stuck < 2; stuck++) {
    const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, n0[stuck ? PRELOADS - 1 : 0]);
    for (int p = 0; p < b->n_points; p++) assert_true(b->state[3 * p + (stuck ? 0 : 2)] == 1);
    scene_peak top = scene_highest(three, b, 100, 160);
    assert_within(top.frequency, stuck ? 138.23 : 115.70, 2e-3);
    assert_within(top.amplitude, stuck ? 2.833e-3 : 3.393e-3, .01);
  }
}

/* Peaks between the limits; the lowest at 80 N. */
static void peaks_against_preload(void **state) {
  (void)state;
  static const double peak[PRELOADS - 2][2] = {{2.440e-3, 121.19},
                                               {2.171e-3, 128.70},
                                               {1.901e-3, 132.49},
                                               {1.513e-3, 137.73},
                                               {2.526e-3, 138.20}};
  for (int i = 1; i < PRELOADS - 1; i++) {
    scene_peak top =
        scene_highest(three, scene_branch(three, MHB_BRANCH_NONLINEAR, n0[i]), 100, 160);
    print_message("n0 = %g N: %.4g mm at %.3f Hz\n", n0[i], 1e3 * top.amplitude, top.frequency);
    assert_within(top.amplitude, peak[i - 1][0], .01);
    assert_within(top.frequency, peak[i - 1][1], 1e-3);
  }
}

/* With the gap the resonance bends to higher frequencies and folds. A dot at the peak shows the
 * error of one harmonic. */
static void the_gap_hardens_and_jumps(void **state) {
  (void)state;
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, -40), *dots = NULL;
  int               fold[8];
  assert_int_equal(scene_folds(b, 8, fold), 2);
  double     up = b->frequency[fold[0]], down = b->frequency[fold[1]];
  scene_peak top     = scene_highest(three, b, 100, 160);
  scene_peak poor    = scene_highest(one, scene_branch(one, MHB_BRANCH_NONLINEAR, -40), 100, 160);
  double     highest = 0, at = 0;
  for (int i = 0; i < time_domain->n_branches; i++)
    if (time_domain->branch[i].n0[0] == -40) dots = &time_domain->branch[i];
  assert_non_null(dots);
  for (int p = 0; p < dots->n_points; p++) {
    double here = scene_amplitude(time_domain, dots, p, 1);
    if (here > highest) at = dots->frequency[p];
    highest = fmax(highest, here);
  }
  print_message(
      "folds %.3f and %.3f Hz; peak %.4g mm at %.3f Hz, dot %.4g mm at %.1f Hz, one harmonic %.4g "
      "mm "
      "at %.3f Hz\n",
      up, down, 1e3 * top.amplitude, top.frequency, 1e3 * highest, at, 1e3 * poor.amplitude,
      poor.frequency);
  assert_true(up > down && down > 1.01 * 115.70);
  assert_within(up, 121.29, 2e-3);
  assert_within(down, 117.82, 2e-3);
  assert_within(top.frequency, at, 2e-3);
  assert_within(top.amplitude, highest, .02);
  assert_true(poor.amplitude > 1.05 * highest);
}

static void all_is_sound(void **state) {
  (void)state;
  scene_is_sound(three);
  scene_is_sound(one);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(there_are_dots_on_every_curve),
      cmocka_unit_test(three_harmonics_are_within_a_percent),
      cmocka_unit_test(fifteen_are_within_a_ten_thousandth),
      cmocka_unit_test(thirty_one_are_the_integration),
      cmocka_unit_test(preloads_go_from_separate_to_stuck),
      cmocka_unit_test(peaks_against_preload),
      cmocka_unit_test(the_gap_hardens_and_jumps),
      cmocka_unit_test(all_is_sound),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
