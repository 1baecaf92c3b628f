/* cases/paper_fig8: three resonances between open and stuck; the numbers of its README. */
#include "tests/support/scene.h"

enum { MODES = 3 };

static char          folder[SCRATCH_PATH];
static mhb_response *response;

/* Ranges with one resonance each, Hz, and the results: frequency over that of the first open mode,
 * and amplitude, m. */
static const struct {
  double from, to, ratio, amplitude;
} open_mode[MODES]  = {{80, 200, 1, 3.3930e-3},
                       {300, 400, 3.1725, 1.7120e-4},
                       {400, 500, 3.7450, 4.0980e-4}},
  stuck_mode[MODES] = {
      {300, 500, 3.7269, 5.981e-4}, {550, 700, 5.2391, 8.028e-5}, {1000, 1200, 9.5219, 6.025e-6}};

/* Reduction of each peak from open to stuck. */
static const double reduction[MODES] = {.8237, .5312, .98530};

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "paper_fig8", &response);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(response);
  scratch_remove(folder);
  return 0;
}

static void three_modes_shift_and_fall(void **state) {
  (void)state;
  const mhb_branch *open  = scene_branch(response, MHB_BRANCH_OPEN, 0);
  const mhb_branch *stuck = scene_branch(response, MHB_BRANCH_STUCK, 0);
  double            first = scene_highest(response, open, 80, 200).frequency;
  assert_within(first, 115.699, 2e-3);
  for (int i = 0; i < MODES; i++) {
    scene_peak a = scene_highest(response, open, open_mode[i].from, open_mode[i].to);
    scene_peak b = scene_highest(response, stuck, stuck_mode[i].from, stuck_mode[i].to);
    print_message("mode %d: %.4f (%.4g mm) to %.4f (%.4g mm), peak reduced by %.2f %%\n", i + 1,
                  a.frequency / first, 1e3 * a.amplitude, b.frequency / first, 1e3 * b.amplitude,
                  100 * (1 - b.amplitude / a.amplitude));
    assert_within(a.frequency / first, open_mode[i].ratio, 2e-3);
    assert_within(b.frequency / first, stuck_mode[i].ratio, 2e-3);
    assert_within(a.amplitude, open_mode[i].amplitude, .01);
    assert_within(b.amplitude, stuck_mode[i].amplitude, .01);
    assert_within(1 - b.amplitude / a.amplitude, reduction[i], .005);
  }
}

/* The limits are those of a gap wider than any motion, and of a preload beyond slip: point by
 * point. */
static void widest_gap_and_highest_preload_are_the_limits(void **state) {
  (void)state;
  static const double n0[2] = {-30e3, 4e3};
  for (int stuck = 0; stuck < 2; stuck++) {
    const mhb_branch *limit = scene_branch(response, stuck ? MHB_BRANCH_STUCK : MHB_BRANCH_OPEN, 0);
    const mhb_branch *b     = scene_branch(response, MHB_BRANCH_NONLINEAR, n0[stuck]);
    for (int p = 0; p < b->n_points; p++) {
      assert_true(b->state[3 * p + (stuck ? 0 : 2)] == 1);
      assert_true(fabs(b->dissipation[p]) < 1e-12);
    }
    for (int i = 0; i < MODES; i++) {
      double     from = (stuck ? stuck_mode : open_mode)[i].from;
      double     to   = (stuck ? stuck_mode : open_mode)[i].to;
      scene_peak x    = scene_highest(response, b, from, to);
      scene_peak y    = scene_highest(response, limit, from, to);
      assert_within(x.frequency, y.frequency, 3e-5);
      assert_within(x.amplitude, y.amplitude, 1e-3);
    }
  }
}

/* Peaks near the stuck resonances against preload: friction lowers them, more preload raises
 * them. */
static void friction_lowers_the_peaks(void **state) {
  (void)state;
  static const double n0[3]          = {30, 100, 300};
  static const double peak[3][MODES] = {{3.425e-5, 9.264e-6, 2.847e-6},
                                        {9.319e-5, 2.258e-5, 6.025e-6},
                                        {2.628e-4, 6.227e-5, 6.024e-6}};
  for (int j = 0; j < 3; j++) {
    const mhb_branch *b = scene_branch(response, MHB_BRANCH_NONLINEAR, n0[j]);
    for (int i = 0; i < MODES; i++) {
      scene_peak x = scene_highest(response, b, stuck_mode[i].from, stuck_mode[i].to);
      print_message("n0 = %g N, mode %d: %.4g um at %.2f Hz\n", n0[j], i + 1, 1e6 * x.amplitude,
                    x.frequency);
      assert_within(x.amplitude, peak[j][i], .01);
    }
  }
}

static void all_is_sound(void **state) {
  (void)state;
  scene_is_sound(response);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_modes_shift_and_fall),
      cmocka_unit_test(widest_gap_and_highest_preload_are_the_limits),
      cmocka_unit_test(friction_lowers_the_peaks),
      cmocka_unit_test(all_is_sound),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
