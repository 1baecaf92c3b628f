/* The example cases/bring_your_own. h5py writes the modal file, shroudhb-mhb sweeps it, and the
 * peaks are those of its README. Arguments: python, the example's folder, shroudhb-mhb. Exit code
 * 77: h5py is missing. */
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/response/response.h"
#include "tests/support/files.h"

static const char *python, *example, *command;

/* Peaks of the sliding motion u, first harmonic. Time integration and harmonic balance of other
 * programs agree with them to 5e-5 (amplitude) and 2e-4 rad/s. */
static const struct {
  double n0, amplitude, omega; /* N, m, rad/s */
} peaks[] = {
    {-.2, .255795, .960521}, {-.2, .887011, 1.158727}, {-.2, .631926, 1.311043},
    {0, .270514, 1.030220},  {0, .532418, 1.190037},   {0, .566835, 1.329447},
    {.3, .250643, 1.245374}, {.3, .398957, 1.416445},  {1, .560424, 1.362896},
    {1, .45509, 1.50950},
};

static double amplitude_at(const mhb_response *response, const mhb_branch *b, int point) {
  int k = response->n_harmonics + 1;
  return cabs(b->motion[((size_t)point * 3 + 1) * (size_t)k + 1]);
}

/* Has the branch a local maximum close enough to the peak? */
static bool has_peak(const mhb_response *response, const mhb_branch *b, double amplitude,
                     double omega) {
  for (int i = 1; i + 1 < b->n_points; i++) {
    double here = amplitude_at(response, b, i);
    if (here < amplitude_at(response, b, i - 1) || here < amplitude_at(response, b, i + 1))
      continue;
    if (fabs(here / amplitude - 1) < 2e-4 && fabs(SHB_TWO_PI * b->frequency[i] - omega) < 1e-3)
      return true;
  }
  return false;
}

static void test_peaks(void **state) {
  (void)state;
  char line[2048];
  snprintf(
      line, sizeof line,
      "cp '%s'/case.yaml '%s'/ && cd '%s' && '%s' '%s'/write_modal.py && '%s' case.yaml --quiet",
      example, scratch_folder, scratch_folder, python, example, command);
  assert_int_equal(system(line), 0);
  mhb_response *response;
  assert_ok(mhb_response_read(scratch("three_degree.response.h5"), &response));
  assert_int_equal(response->n_harmonics, 7);
  assert_string_equal(response->probe_name[0], "mass");
  for (size_t p = 0; p < sizeof peaks / sizeof *peaks; p++) {
    bool found = false;
    for (int i = 0; i < response->n_branches; i++) {
      const mhb_branch *b = &response->branch[i];
      if (b->kind != MHB_BRANCH_NONLINEAR || b->n_points == 0 || b->n0[0] != peaks[p].n0) continue;
      found = found || has_peak(response, b, peaks[p].amplitude, peaks[p].omega);
    }
    if (!found)
      fail_msg("n0 = %g: no peak %g at %g", peaks[p].n0, peaks[p].amplitude, peaks[p].omega);
  }
  mhb_response_destroy(response);
}

int main(int argc, char **argv) {
  if (argc != 4) return 2;
  python  = argv[1];
  example = argv[2];
  command = argv[3];
  char line[1024];
  snprintf(line, sizeof line, "'%s' -c 'import h5py, numpy' 2>/dev/null", python);
  if (system(line) != 0) return 77;
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_peaks)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
