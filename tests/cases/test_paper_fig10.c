/* cases/paper_fig10: softening and the jump of the third mode; the numbers of its README. */
#include "tests/cases/scene.h"

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

/* The two folds: [0] where a sweep upwards falls off the lower branch, [1] where one downwards falls off the upper. */
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

/* Three solutions between the folds; the curve leans to lower frequencies. */
static void the_curve_leans_left_and_folds(void **state) {
  (void)state;
  double f[2], a[2];
  int    p[2];
  jumps(three, f, a, p);
  print_message("folds at %.3f Hz (%.2f um) and %.3f Hz (%.2f um)\n", f[0], 1e6 * a[0], f[1],
                1e6 * a[1]);
  assert_within(f[0], 658.05, 1e-3);
  assert_within(f[1], 603.22, 1e-3);
  assert_within(a[0], 95e-6, .01);
  assert_within(a[1], 182e-6, .01);
  const mhb_branch *b = scene_branch(three, MHB_BRANCH_NONLINEAR, 160);
  for (int i = p[0]; i < p[1]; i++) assert_true(b->frequency[i + 1] <= b->frequency[i] * 1.00002);
  double stuck = scene_highest(three, scene_branch(three, MHB_BRANCH_STUCK, 0), 600, 700).frequency;
  assert_within(stuck, 660.33, 2e-3);
  assert_true(f[1] < .92 * stuck);
  scene_peak top = scene_highest(three, b, 560, 720);
  print_message("peak %.2f um at %.2f Hz; stuck at %.2f Hz\n", 1e6 * top.amplitude, top.frequency,
                stuck);
  assert_within(top.frequency, 603.4, 2e-3);
}

/* By multipliers: lower branch stable, middle one not (a multiplier beyond +1), upper one stable next to its fold and near the
 * stuck resonance; between them a pair of multipliers leaves the circle for some 2.5 % of the frequency. (Next to the
 * fold three harmonics are not enough to tell: their motion has a multiplier of 1.006 up to .1 % above it.) */
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
    if (middle || i < p[0] || b->frequency[i] < 635 || b->frequency[i] > 653) {
      if (b->stable[i] != !middle)
        fail_msg("point %d, %.3f Hz: stable %d", i, b->frequency[i], b->stable[i]);
    }
  }
}

/* One harmonic finds another motion next to the jump: higher, and at lower frequencies. */
static void one_harmonic_overestimates(void **state) {
  (void)state;
  double f3[2], a3[2], f1[2], a1[2];
  int    p[2];
  jumps(three, f3, a3, p);
  jumps(one, f1, a1, p);
  print_message("one harmonic: folds at %.3f and %.3f Hz (%.2f um, %+.1f %%)\n", f1[0], f1[1],
                1e6 * a1[1], 100 * (a1[1] / a3[1] - 1));
  assert_within(f1[0], f3[0], 1e-5);
  assert_within(f1[1], 586.44, 1e-3);
  assert_true(a1[1] > 1.05 * a3[1] && f1[1] < .98 * f3[1]);
}

/* Two blades half a period apart are the ring of forty at engine order twenty. */
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

static void all_is_sound(void **state) {
  (void)state;
  scene_is_sound(ring);
  scene_is_sound(three);
  scene_is_sound(one);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_curve_leans_left_and_folds),
      cmocka_unit_test(the_middle_is_unstable),
      cmocka_unit_test(one_harmonic_overestimates),
      cmocka_unit_test(two_blades_are_the_ring),
      cmocka_unit_test(all_is_sound),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
