/* cases/paper_fig10: softening and the jump of the third mode. The numbers are those of its
 * README. */
#include <complex.h>

#include "cases/schema/case.h"
#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "tests/support/scene.h"

enum { PERIODS = 300, STEPS = 48 };

static char          folder[SCRATCH_PATH];
static mhb_response *ring, *three, *one;

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "paper_fig10", &ring);
  scene_run(folder, SCENE, "two_blades.yaml", "paper_fig10_two_blades", &three);
  scene_run(folder, SCENE, "single.yaml", "paper_fig10_single", &one);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(ring);
  mhb_response_destroy(three);
  mhb_response_destroy(one);
  scratch_remove(folder);
  return 0;
}

/* The two folds. A sweep upwards leaves the lower branch at [0]; one downwards leaves the upper at
 * [1]. */
static void jumps(const mhb_response *response, double frequency[2], double amplitude[2],
                  int point[2]) {
  const mhb_branch *b = scene_branch(response, MHB_BRANCH_NONLINEAR, 160);
  int               all[8];
  assert_int_equal(scene_folds(b, 8, all), 2);
  for (int i = 0; i < 2; i++) {
    point[i]     = all[i];
    frequency[i] = b->frequency[all[i]];
    amplitude[i] = scene_amplitude(response, b, all[i], 1);
  }
}

/* There are three solutions between the folds, and the curve bends to lower frequencies. */
static void the_curve_leans_left_and_folds(void **state) {
  (void)state;
  double f[2], a[2];
  int    p[2];
  jumps(three, f, a, p);
  print_message("folds at %.3f Hz (%.2f um) and %.3f Hz (%.2f um)\n", f[0], 1e6 * a[0], f[1],
                1e6 * a[1]);
  assert_within(f[0], 656.92, 1e-3);
  assert_within(f[1], 599.14, 1e-3);
  assert_within(a[0], 95e-6, .01);
  assert_within(a[1], 185e-6, .01);
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, 160);
  for (int i = p[0]; i < p[1]; i++) assert_true(b->frequency[i + 1] <= b->frequency[i] * 1.00002);
  double stuck = scene_highest(three, scene_branch(three, MHB_BRANCH_STUCK, 0), 600, 700).frequency;
  assert_within(stuck, 659.04, 2e-3);
  assert_true(f[1] < .92 * stuck);
  scene_peak top = scene_highest(three, b, 560, 720);
  print_message("peak %.2f um at %.2f Hz; stuck at %.2f Hz\n", 1e6 * top.amplitude, top.frequency,
                stuck);
  assert_within(top.frequency, 599.3, 2e-3);
}

/* Stability by Floquet multipliers. The lower branch is stable. The middle branch is unstable by a
 * multiplier beyond +1. The upper branch is stable next to its fold and near the stuck resonance.
 * Between them a pair of multipliers leaves the unit circle over some 2.5 % of the frequency. Up to
 * 0.1 % above the fold three harmonics do not suffice: their motion has a multiplier of 1.006. */
static void the_middle_is_unstable(void **state) {
  (void)state;
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, 160);
  double            f[2], a[2];
  int               p[2];
  jumps(three, f, a, p);
  for (int i = 0; i < b->n_points; i++) {
    if (fabs(b->frequency[i] / f[0] - 1) < 1e-4 || fabs(b->frequency[i] / f[1] - 1) < 1e-3)
      continue;
    bool middle = i > p[0] && i < p[1];
    if (middle || i < p[0] || b->frequency[i] < 632 || b->frequency[i] > 651) {
      if (b->stable[i] != !middle)
        fail_msg("point %d, %.3f Hz: stable %d", i, b->frequency[i], b->stable[i]);
    }
  }
}

/* One harmonic gives another motion next to the jump: larger, and at lower frequencies. */
static void one_harmonic_overestimates(void **state) {
  (void)state;
  double f3[2], a3[2], f1[2], a1[2];
  int    p[2];
  jumps(three, f3, a3, p);
  jumps(one, f1, a1, p);
  print_message("one harmonic: folds at %.3f and %.3f Hz (%.2f um, %+.1f %%)\n", f1[0], f1[1],
                1e6 * a1[1], 100 * (a1[1] / a3[1] - 1));
  assert_within(f1[0], f3[0], 1e-5);
  assert_within(f1[1], 580.83, 1e-3);
  assert_true(a1[1] > 1.05 * a3[1] && f1[1] < .98 * f3[1]);
}

/* Two blades half a period apart equal the ring of forty at engine order twenty. */
static void two_blades_are_the_ring(void **state) {
  (void)state;
  double f2[2], a2[2], f40[2], a40[2];
  int    p[2];
  jumps(three, f2, a2, p);
  jumps(ring, f40, a40, p);
  for (int i = 0; i < 2; i++) {
    assert_within(f40[i], f2[i], 1e-9);
    assert_within(a40[i], a2[i], 1e-6);
  }
}

/* Updates the largest sum of squares of the modal displacements. */
static void watch_size(void *context, const mhb_integrator *g, double t0, double h) {
  double sum = 0, *most = context;
  (void)t0;
  (void)h;
  for (int i = 0; i < g->blades * g->modes; i++) sum += g->z[i] * g->z[i];
  *most = fmax(*most, sum);
}

/* Starts on a point of the curve. Returns the size of its motion over the first period. */
static double start_on(mhb_integrator *g, const mhb_branch *b, int point, double *most) {
  const int      K = b->n_harmonics + 1;
  double complex force[3 * K];
  for (int k = 0; k < K; k++)
    for (int c = 0; c < 3; c++) force[k * 3 + c] = b->force[(point * 3 + c) * K + k];
  mhb_integrator_set(g, SHB_TWO_PI * b->frequency[point], 160, STEPS);
  mhb_integrator_balance(g, b->n_harmonics, force);
  *most = 0;
  assert_true(mhb_integrator_period(g));
  return *most;
}

/* Sweeps the frequency in steps from state to state, until the size leaves [least, most] times its
 * value at the fold. Returns the frequency before and the one at which it leaves. */
static void sweep(mhb_integrator *g, double from, double step, const double bound[2], double *most,
                  double left[2]) {
  for (int i = 1; i <= 60; i++) {
    left[0] = from + (i - 1) * step;
    left[1] = from + i * step;
    mhb_integrator_set(g, SHB_TWO_PI * left[1], 160, STEPS);
    for (int period = 0; period < PERIODS; period++) {
      *most = 0;
      assert_true(mhb_integrator_period(g));
    }
    if (*most < bound[0] || *most > bound[1]) return;
  }
  fail_msg("no jump from %g to %g Hz", from, left[1]);
}

static int point_near(const mhb_branch *b, int first, int last, double frequency) {
  int best = first;
  for (int p = first; p <= last; p++)
    if (fabs(b->frequency[p] - frequency) < fabs(b->frequency[best] - frequency)) best = p;
  return best;
}

/* Both blades are integrated independently. Upwards the motion jumps from the lower to the upper
 * branch, downwards back, at the folds of the balance. */
static void sweeps_jump_at_the_folds(void **state) {
  (void)state;
  char              path[SCRATCH_PATH + 64];
  case_file         file;
  modal_model       model;
  mhb_integrator   *g;
  double            f[2], a[2], most, left[2];
  int               p[2];
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, 160);
  jumps(three, f, a, p);
  snprintf(path, sizeof path, "%s/two_blades.yaml", folder);
  assert_int_equal(case_read(path, CASE_MHB, stderr, &file), SHB_OK);
  snprintf(path, sizeof path, "%s/paper_fig10.modal.h5", folder);
  assert_int_equal(modal_model_read(path, &model), SHB_OK);
  assert_int_equal(mhb_integrator_create(&model, &file.mhb, 3, &g), SHB_OK);
  assert_int_equal(g->blades, 2);
  g->watch        = watch_size;
  g->context      = &most;
  double upper[2] = {0, 1.1 * start_on(g, b, p[0], &most)};
  int    start    = point_near(b, 0, p[0], f[0] - 1);
  start_on(g, b, start, &most);
  sweep(g, b->frequency[start], .1, upper, &most, left);
  print_message("upwards: jump between %.2f and %.2f Hz, fold at %.2f Hz\n", left[0], left[1],
                f[0]);
  assert_within(left[0], f[0], 1e-3);
  assert_within(left[1], f[0], 1e-3);
  double lower[2] = {.25 * start_on(g, b, p[1], &most), 1e300};
  start           = point_near(b, p[1], b->n_points - 1, f[1] + 2);
  start_on(g, b, start, &most);
  sweep(g, b->frequency[start], -.1, lower, &most, left);
  print_message("downwards: jump between %.2f and %.2f Hz, fold at %.2f Hz\n", left[0], left[1],
                f[1]);
  assert_within(left[0], f[1], 1e-3);
  assert_within(left[1], f[1], 1e-3);
  mhb_integrator_destroy(g);
  modal_model_free(&model);
  case_free(&file);
}

static void all_is_sound(void **state) {
  (void)state;
  scene_is_sound(ring);
  scene_is_sound(three);
  scene_is_sound(one);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_curve_leans_left_and_folds), cmocka_unit_test(the_middle_is_unstable),
      cmocka_unit_test(one_harmonic_overestimates),     cmocka_unit_test(two_blades_are_the_ring),
      cmocka_unit_test(sweeps_jump_at_the_folds),       cmocka_unit_test(all_is_sound),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
