/* cases/mistuned_ring: forty blades that differ, and the numbers of its README. */
#include <stdlib.h>
#include <string.h>

#include "mhb/amplification/ring_peak.h"
#include "tests/support/check.h"
#include "tests/support/scene.h"

enum { PRELOADS = 3 };

typedef struct {
  double n0, factor, worst, at, mean, tuned; /* N, -, mm, Hz, mm, mm */
  int    blade;
} row;

/* The table of the README, to its digits. */
static const row TABLE[PRELOADS] = {{20, 1.235, 2.702, 119.07, 2.166, 2.188, 4},
                                    {40, 1.206, 3.732, 119.38, 3.054, 3.094, 4},
                                    {200, 1.292, 7.542, 119.54, 5.484, 5.839, 0}};

static char          folder[SCRATCH_PATH];
static mhb_response *response;

static int run_scene(void **state) {
  (void)state;
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "mistuned_ring", &response);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(response);
  scratch_remove(folder);
  return 0;
}

static void is_sound(void **state) {
  (void)state;
  assert_int_equal(response->ring, 40);
  assert_int_equal(response->n_pairs, 40);
  assert_int_equal(response->n_probes, 40);
  assert_string_equal(response->probe_name[39], "tip.39");
  scene_is_sound(response);
}

static void numbers_are_those_of_the_readme(void **state) {
  (void)state;
  for (int i = 0; i < PRELOADS; i++) {
    const mhb_branch        *b = scene_branch(response, MHB_BRANCH_NONLINEAR, TABLE[i].n0);
    const mhb_amplification *a = &b->amplification;
    assert_near(a->factor, TABLE[i].factor, 1e-3);
    assert_near(1e3 * a->worst, TABLE[i].worst, 2e-3);
    assert_near(1e3 * a->mean, TABLE[i].mean, 2e-3);
    assert_near(1e3 * a->tuned, TABLE[i].tuned, 2e-3);
    assert_near(a->worst_at, TABLE[i].at, 0.02);
    assert_int_equal(a->blade, TABLE[i].blade);
    int judged = 0;
    for (int p = 0; p < b->n_points; p++) {
      assert_true(b->stable[p] != 0);
      judged += b->stable[p] == 1;
    }
    assert_true(judged > 0.8 * b->n_points);
    if (TABLE[i].n0 > 20) assert_int_equal(judged, b->n_points);
  }
}

/* At 200 N all contacts stick: the curve is the stuck limit, which is computed without Newton's
 * method. Every blade has its peak there. */
static void stuck_ring_is_linear(void **state) {
  const mhb_branch *b     = scene_branch(response, MHB_BRANCH_NONLINEAR, 200);
  const mhb_branch *stuck = scene_branch(response, MHB_BRANCH_STUCK, 0);
  (void)state;
  for (int p = 0; p < b->n_points; p++) assert_true(mhb_response_is_linear(response, b, p));
  assert_within(mhb_ring_peak_of(response, stuck).worst, b->amplification.worst, 2e-3);
  for (int blade = 0; blade < 40; blade++) {
    double most[2] = {0, 0};
    for (int p = 0; p < b->n_points; p++)
      most[0] = fmax(most[0], mhb_blade_amplitude(response, b, p, blade));
    for (int p = 0; p < stuck->n_points; p++)
      most[1] = fmax(most[1], mhb_blade_amplitude(response, stuck, p, blade));
    assert_within(most[0], most[1], 0.05); /* peaks of single blades are between points */
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(is_sound),
                                     cmocka_unit_test(numbers_are_those_of_the_readme),
                                     cmocka_unit_test(stuck_ring_is_linear)};
  return cmocka_run_group_tests(tests, run_scene, clean);
}
