/* The example from mesh to report: the numbers of its README, repeated runs without work,
 * memory. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "mhb/branches/main_branch.h"
#include "mhb/response/response.h"
#include "tests/support/scene.h"

static char          folder[SCRATCH_PATH];
static mhb_response *response;

static char *path_of(const char *suffix) {
  static char path[SCRATCH_PATH + 64];
  snprintf(path, sizeof path, "%s/z_notch_blade%s", folder, suffix);
  return path;
}

static int run(void) {
  char command[4 * SCRATCH_PATH];
  snprintf(command, sizeof command, "'%s' run --quiet '%s/case.yaml'", SHROUDHB, folder);
  return system(command);
}

static int run_scene(void **state) {
  (void)state;
  char command[4 * SCRATCH_PATH];
  scratch_create(folder);
  snprintf(command, sizeof command, "cp '%s' '%s/case.yaml'", SCENE, folder);
  if (system(command) != 0 || run() != 0) return 1;
  return mhb_response_read(path_of(".response.h5"), &response) != SHB_OK;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(response);
  scratch_remove(folder);
  return 0;
}

/* Amplitude of the probe's first harmonic over its three axes, m. */
static double amplitude(const mhb_branch *b, int point) {
  int    K   = response->n_harmonics + 1;
  double sum = 0;
  for (int axis = 0; axis < 3; axis++)
    sum += pow(cabs(b->probe[(size_t)((point * 3 + axis) * K + 1)]), 2);
  return sqrt(sum);
}

static double peak(const mhb_branch *b, double *frequency) {
  *frequency = 0;
  double top = 0;
  for (int i = 0; i < b->n_points; i++) {
    if (amplitude(b, i) <= top) continue;
    top        = amplitude(b, i);
    *frequency = b->frequency[i];
  }
  return top;
}

static void frequency_shifts_from_open_to_stuck(void **state) {
  (void)state;
  double open, stuck;
  assert_within(peak(scene_branch(response, MHB_BRANCH_OPEN, 0), &open), 6.007e-3, .01);
  assert_within(peak(scene_branch(response, MHB_BRANCH_STUCK, 0), &stuck), 2.866e-3, .01);
  assert_within(open, 115.706, 2e-3);
  assert_within(stuck, 243.56, 2e-3);
}

static void peaks_against_preload_have_an_optimum(void **state) {
  (void)state;
  static const double rows[][3] = {{-250, 5.458e-4, 121.27}, {10, 3.580e-5, 212.40},
                                   {15, 3.543e-5, 215.18},   {25, 4.756e-5, 234.30},
                                   {50, 8.424e-5, 239.41},   {100, 1.590e-4, 241.54},
                                   {250, 3.784e-4, 242.97},  {1000, 1.438e-3, 243.55}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    double            frequency;
    const mhb_branch *b = scene_branch(response, MHB_BRANCH_NONLINEAR, rows[i][0]);
    assert_true(b->complete);
    assert_within(peak(b, &frequency), rows[i][1], .01);
    assert_within(frequency, rows[i][2], 3e-3);
  }
}

/* Frequencies of the folds, and their number. */
static int folds(const mhb_branch *b, double list[8]) {
  int point[8], n = scene_folds(b, 8, point);
  for (int i = 0; i < n; i++) list[i] = b->frequency[point[i]];
  return n;
}

/* With preload the upper fold is passed first and the lower lies below it. With a gap the curve
 * bends to the right. */
static void softening_and_hardening_jump(void **state) {
  (void)state;
  double list[8];
  assert_int_equal(folds(scene_branch(response, MHB_BRANCH_NONLINEAR, 25), list), 2);
  assert_within(list[0], 222.80, 3e-4);
  assert_within(list[1], 221.395, 3e-4);
  assert_int_equal(folds(scene_branch(response, MHB_BRANCH_NONLINEAR, 10), list), 2);
  assert_within(list[0], 212.764, 3e-4);
  assert_within(list[1], 212.22, 3e-4);
  assert_int_equal(folds(scene_branch(response, MHB_BRANCH_NONLINEAR, -250), list), 2);
  assert_within(list[0], 121.435, 3e-4);
  assert_within(list[1], 118.88, 3e-4);
}

static void every_point_balances(void **state) {
  (void)state;
  scene_is_sound(response);
}

/* On a ring of forty blades some points of each curve have multipliers, and all points without
 * slip; these are stable. What is not judged is said to be not judged, at most a third. */
static void some_points_are_judged(void **state) {
  (void)state;
  int slipping = 0, unknown = 0, total = 0;
  assert_int_equal(response->n_multipliers, 8);
  for (int i = 2; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    for (int p = 0; p < b->n_points; p++) {
      const double *share     = b->state + 3 * p;
      bool          linear    = share[0] >= 1 || share[2] >= 1;
      double        size      = cabs(b->multipliers[8 * p]);
      int           how       = b->judged[p];
      bool          undecided = how == MHB_JUDGED_UNDECIDED; /* within the multiplier's error */
      assert_int_equal(b->stable[p] < 0, how == MHB_NOT_JUDGED || undecided);
      /* neighbours and folds decide where the multiplier is within its error, too */
      if (how == MHB_BY_MULTIPLIERS || how == MHB_JUDGED_MARGINAL) assert_true(size > 0);
      if (how == MHB_NOT_JUDGED) assert_true(size == 0);
      if (how == MHB_BY_MULTIPLIERS) assert_int_equal(b->stable[p], size < 1.0005);
      if (how == MHB_BY_FOLDS) assert_int_equal(b->stable[p], 0);
      if (linear) assert_true(how == MHB_BY_MULTIPLIERS && b->stable[p] == 1 && size < 1);
      total += !linear;
      slipping += !linear && size > 0;
      unknown += !linear && b->stable[p] < 0;
    }
  }
  print_message("%d slipping points, %d judged, %d not known\n", total, slipping, unknown);
  assert_true(3 * unknown <= total);
  assert_true(slipping >= 16);
}

static void results_are_there_and_a_second_run_leaves_them(void **state) {
  (void)state;
  static const char *const suffix[] = {".msh", ".modal.h5", ".response.h5"};
  struct stat              before[3], after;
  assert_int_equal(stat(path_of(".html"), &after), 0);
  assert_int_equal(stat(path_of(".csv"), &after), 0);
  assert_int_equal(stat(path_of(".svg"), &after), 0);
  for (int i = 0; i < 3; i++) assert_int_equal(stat(path_of(suffix[i]), &before[i]), 0);
  assert_int_equal(run(), 0);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(stat(path_of(suffix[i]), &after), 0);
    assert_true(after.st_ino == before[i].st_ino && after.st_mtime == before[i].st_mtime);
  }
}

/* post warns if the response was made from another case. */
static void a_stale_response_is_told(void **state) {
  (void)state;
  char command[8 * SCRATCH_PATH];
  snprintf(
      command, sizeof command,
      "cd '%s' && sed -i 's/10 N, 15 N/11 N, 15 N/' case.yaml && '%s' post --quiet case.yaml 2>&1"
      " | grep -q 'response.h5 was made from other settings'",
      folder, SHROUDHB);
  assert_int_equal(system(command), 0);
}

static void memory_stays_below_two_gigabytes(void **state) {
  (void)state;
  struct rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  assert_true(usage.ru_maxrss > 0 && usage.ru_maxrss < 2L * 1024 * 1024);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frequency_shifts_from_open_to_stuck),
      cmocka_unit_test(peaks_against_preload_have_an_optimum),
      cmocka_unit_test(softening_and_hardening_jump),
      cmocka_unit_test(every_point_balances),
      cmocka_unit_test(some_points_are_judged),
      cmocka_unit_test(results_are_there_and_a_second_run_leaves_them),
      cmocka_unit_test(a_stale_response_is_told),
      cmocka_unit_test(memory_stays_below_two_gigabytes),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
