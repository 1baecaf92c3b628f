/* Tracked peaks and optima of two shipped scenes against sweeps of the frequency. */
#include <stdlib.h>

#include "cases/commands/load_model.h"
#include "cases/schema/case.h"
#include "tests/support/peak_scan.h"
#include "tests/support/scene.h"

static char folder[SCRATCH_PATH];

static int set_up(void **state) {
  (void)state;
  scratch_create(folder);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  return scene_remove(folder);
}

/* Mesh and modes of a scene, and its settings with a fixed number of harmonics. */
static case_model scene_model(const char *name, int harmonics) {
  char       line[6 * SCRATCH_PATH], path[2 * SCRATCH_PATH];
  case_file  file;
  case_model model;
  snprintf(line, sizeof line, "'%s' modal --quiet --into '%s' '%s/%s/case.yaml'", SHROUDHB, folder,
           SCENE, name);
  if (system(line) != 0) fail_msg("failed: %s", line);
  snprintf(path, sizeof path, "%s/%s/case.yaml", SCENE, name);
  assert_ok(case_read(path, CASE_MHB, stderr, &file));
  snprintf(path, sizeof path, "%s/%s.modal.h5", folder, name);
  assert_ok(case_model_read(&file, path, 0, true, &model));
  case_free(&file);
  mhb_settings *s     = &model.settings;
  s->harmonics        = harmonics;
  s->motion_tolerance = 0;
  s->tolerance        = 1e-10;
  s->stability        = MHB_STABILITY_NEVER;
  s->lasting          = MHB_LASTING_NEVER;
  s->track            = MHB_TRACK_PEAKS;
  s->n_preloads       = 1;
  return model;
}

/* Every peak that is followed along the preload is the peak of a sweep there.
 *   least     in  number of peaks, at least
 *   on_curve  in  of these, peaks that a sweep resolves by its curve alone, at most */
static void peaks_are_those_of_sweeps(const char *name, int harmonics, double low, double high,
                                      int least, int on_curve) {
  case_model    model    = scene_model(name, harmonics);
  mhb_settings *s        = &model.settings;
  s->parameter           = MHB_IN_N0;
  s->range[0]            = low;
  s->range[1]            = high;
  s->n0[0]               = low;
  const peak_scan scan   = {&model.model, s};
  mhb_response   *r      = peak_scan_follow(&scan);
  peak_agreement  agrees = peak_scan_compare(&scan, r);
  assert_true(agrees.n >= least);
  assert_true(agrees.n_on_curve <= on_curve);
  assert_below(agrees.amplitude, 1e-6);
  assert_below(agrees.frequency, 1e-6);
  assert_true(r->optimum.verified);
  mhb_response_destroy(r);
  case_model_free(&model);
}

static void peaks_of_z_notch_blade_are_those_of_sweeps(void **state) {
  (void)state;
  peaks_are_those_of_sweeps("z_notch_blade", 7, 10, 500, 100, 4);
}

static void peaks_of_paper_fig9_are_those_of_sweeps(void **state) {
  (void)state;
  peaks_are_those_of_sweeps("paper_fig9", 3, 10, 1500, 100, 6);
}

/* The optimum of one parameter of z_notch_blade at a preload is that of a scan of sweeps. */
static void optimum_is_that_of_a_scan(mhb_parameter parameter, double n0, double low, double high) {
  case_model    model  = scene_model("z_notch_blade", 7);
  mhb_settings *s      = &model.settings;
  s->parameter         = parameter;
  s->range[0]          = low;
  s->range[1]          = high;
  s->n0[0]             = n0;
  s->tolerance         = 1e-6;
  const peak_scan scan = {&model.model, s};
  mhb_response   *r    = peak_scan_follow(&scan);
  peak_scan_check_optimum(&scan, r);
  mhb_response_destroy(r);
  case_model_free(&model);
}

static void the_optimum_of_the_preload_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_N0, 10, 10, 20);
}

static void the_optimum_of_the_friction_coefficient_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_MU, 12, 0.2, 0.5);
}

static void the_optimum_of_the_stiffness_is_that_of_a_scan(void **state) {
  (void)state;
  optimum_is_that_of_a_scan(MHB_IN_KU, 6, 1.5e6, 4e6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(peaks_of_z_notch_blade_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_paper_fig9_are_those_of_sweeps),
      cmocka_unit_test(the_optimum_of_the_preload_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_friction_coefficient_is_that_of_a_scan),
      cmocka_unit_test(the_optimum_of_the_stiffness_is_that_of_a_scan)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
