/* cases/mistuned_ring: forty blades that differ, and the numbers of its README. */
#include <stdlib.h>
#include <string.h>

#include "mhb/amplification/ring_peak.h"
#include "mhb/contact/law.h"
#include "tests/support/check.h"
#include "tests/support/scene.h"

enum { PRELOADS = 3 };

typedef struct {
  double n0, factor, worst, at, mean, tuned; /* N, -, mm, Hz, mm, mm */
  int    blade;
  double slip; /* share of the period, at most */
} row;

/* The table of the README, to its digits. */
static const row TABLE[PRELOADS] = {{20, 1.235, 2.702, 119.07, 2.166, 2.188, 4, 0.70},
                                    {40, 1.206, 3.732, 119.38, 3.054, 3.094, 4, 0.40},
                                    {200, 1.292, 7.542, 119.54, 5.484, 5.839, 0, 0}};

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

/* The largest share of the period of any contact at any point. */
static double most_of(const mhb_branch *b, mhb_state which) {
  double most = 0;
  for (int i = 0; i < b->n_points * response->n_pairs; i++)
    most = fmax(most, b->state[3 * i + (int)which]);
  return most;
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
    assert_near(most_of(b, MHB_SLIDE), TABLE[i].slip, 5e-3);
  }
}

/* What the README says of the table: equal blades, friction, opening, stability and errors. */
static void text_is_that_of_the_readme(void **state) {
  const mhb_branch *b[PRELOADS];
  int               judged[PRELOADS] = {0}, points = 0;
  double            truncation = 0;
  (void)state;
  for (int i = 0; i < PRELOADS; i++) {
    b[i]                       = scene_branch(response, MHB_BRANCH_NONLINEAR, TABLE[i].n0);
    const mhb_amplification *a = &b[i]->amplification;
    assert_within(a->mean, a->tuned, 0.07);
    points += b[i]->n_points;
    for (int p = 0; p < b[i]->n_points; p++) {
      assert_true(b[i]->stable[p] != 0);
      judged[i] += b[i]->stable[p] == 1;
      truncation = fmax(truncation, b[i]->error_truncation[p]);
    }
    print_message("%3.0f N: %d points, %d judged stable\n", TABLE[i].n0, b[i]->n_points, judged[i]);
  }
  print_message("%d points, errors by the harmonics left out at most %.2e\n", points, truncation);
  assert_near(points, 600, 30);
  assert_near(b[2]->amplification.worst / b[0]->amplification.worst, 2.8, 0.05);
  assert_true(most_of(b[0], MHB_SEPARATE) > 0);
  assert_true(most_of(b[1], MHB_SEPARATE) == 0 && most_of(b[2], MHB_SEPARATE) == 0);
  assert_near((double)judged[0] / b[0]->n_points, 0.9, 0.03);
  assert_int_equal(judged[1], b[1]->n_points);
  assert_int_equal(judged[2], b[2]->n_points);
  assert_near(truncation, 1.3e-3, 0.1e-3);
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
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(is_sound), cmocka_unit_test(numbers_are_those_of_the_readme),
      cmocka_unit_test(text_is_that_of_the_readme), cmocka_unit_test(stuck_ring_is_linear)};
  return cmocka_run_group_tests(tests, run_scene, clean);
}
