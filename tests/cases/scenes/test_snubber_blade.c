/* cases/snubber_blade: two contact interfaces from a solid to the report; the numbers of its
 * README. One case has an interface that never closes. */
#include <stdlib.h>

#include "tests/support/scene.h"

static char          folder[SCRATCH_PATH];
static mhb_response *both;

/* Preload of the shroud, N; highest peak of the tip, m, at Hz. */
static const double track[4][3] = {{-200, 331.0e-6, 176.10},
                                   {20, 94.0e-6, 279.40},
                                   {60, 122.5e-6, 302.25},
                                   {1000, 1.307e-3, 312.39}};

static int run_scene(void **state) {
  (void)state;
  char command[4 * SCRATCH_PATH];
  scratch_create(folder);
  snprintf(command, sizeof command, "cp '%s/blade.geo' '%s'", SCENE, folder);
  assert_int_equal(system(command), 0);
  scene_run(folder, SCENE, "case.yaml", "snubber_blade", &both);
  return 0;
}

static int clean(void **state) {
  (void)state;
  mhb_response_destroy(both);
  scratch_remove(folder);
  return 0;
}

static void limits_and_peaks(void **state) {
  (void)state;
  const scene_peak open  = scene_highest(both, scene_branch(both, MHB_BRANCH_OPEN, 0), 100, 300);
  const scene_peak stuck = scene_highest(both, scene_branch(both, MHB_BRANCH_STUCK, 0), 200, 390);
  print_message("open %.4g mm at %.2f Hz, stuck %.4g mm at %.2f Hz\n", 1e3 * open.amplitude,
                open.frequency, 1e3 * stuck.amplitude, stuck.frequency);
  assert_within(open.frequency, 159.36, 1e-3);
  assert_within(open.amplitude, 2.839e-3, .01);
  assert_within(stuck.frequency, 312.40, 1e-3);
  assert_within(stuck.amplitude, 1.474e-3, .01);
  for (int i = 0; i < 4; i++) {
    const mhb_branch *b    = scene_branch(both, MHB_BRANCH_NONLINEAR, track[i][0]);
    scene_peak        peak = scene_highest(both, b, 91, 399);
    print_message("n0 = %g N: %.4g um at %.2f Hz\n", track[i][0], 1e6 * peak.amplitude,
                  peak.frequency);
    assert_within(peak.amplitude, track[i][1], .01);
    assert_within(peak.frequency, track[i][2], 2e-3);
  }
  scene_is_sound(both);
}

/* Each interface has its own preload and its own share of the work. */
static void interfaces_are_told_apart(void **state) {
  (void)state;
  assert_int_equal(both->n_interfaces, 2);
  assert_string_equal(both->interface_name[0], "shroud");
  assert_string_equal(both->interface_name[1], "snubber");
  const mhb_branch *b = scene_branch(both, MHB_BRANCH_NONLINEAR, 60);
  assert_true(b->interface_n0[0] == 60 && b->interface_n0[1] == 10);
  scene_peak    peak = scene_highest(both, b, 91, 399);
  const double *work = b->dissipation + 2 * peak.point;
  print_message("at the peak the shroud takes %.3g mJ a cycle, the snubber %.3g mJ\n",
                1e3 * work[0], 1e3 * work[1]);
  assert_true(work[0] > 0 && work[1] > 0);
}

static void derive(const char *name, const char *script) {
  char command[8 * SCRATCH_PATH];
  snprintf(command, sizeof command,
           "cd '%s' && sed -e 's/^name: .*/name: %s/' -e 's/harmonics: auto/harmonics: 7/' -e '/^  "
           "tolerance/d' -e "
           "'/n0/s/-200 N, 20 N, 60 N, 1 kN/60 N/' "
           "-e '%s' case.yaml > %s.yaml && '%s' run --quiet %s.yaml >/dev/null",
           folder, name, script, name, SHROUDHB, name);
  assert_int_equal(system(command), 0);
}

static mhb_response *read_response(const char *name) {
  char          path[2 * SCRATCH_PATH];
  mhb_response *response;
  snprintf(path, sizeof path, "%s/%s.response.h5", folder, name);
  assert_int_equal(mhb_response_read(path, &response), SHB_OK);
  return response;
}

/* A snubber too far apart to touch gives the curve of the shroud alone, with as many harmonics. */
static void an_interface_that_stays_open_is_not_there(void **state) {
  (void)state;
  derive("far", "/snubber,/s/n0: .*]/n0: -100 kN/");
  derive("alone", "/name: snubber,/d");
  mhb_response *response[2] = {read_response("far"), read_response("alone")};
  scene_peak    peak[2];
  for (int i = 0; i < 2; i++) {
    peak[i] =
        scene_highest(response[i], scene_branch(response[i], MHB_BRANCH_NONLINEAR, 60), 91, 399);
    print_message("%s: %.9g um at %.6f Hz\n", i ? "alone" : "far", 1e6 * peak[i].amplitude,
                  peak[i].frequency);
  }
  assert_int_equal(response[0]->n_interfaces, 2);
  assert_within(peak[0].amplitude, peak[1].amplitude, 1e-8);
  assert_within(peak[0].frequency, peak[1].frequency, 1e-8);
  for (int i = 0; i < 2; i++) mhb_response_destroy(response[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(limits_and_peaks),
      cmocka_unit_test(interfaces_are_told_apart),
      cmocka_unit_test(an_interface_that_stays_open_is_not_there),
  };
  return cmocka_run_group_tests(tests, run_scene, clean);
}
