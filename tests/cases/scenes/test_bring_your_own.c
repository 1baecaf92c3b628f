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

/* Semi-major axis a of the probe's first harmonic c: 2 a^2 = |c|^2 + |c^T c|. */
static double probe_amplitude(const mhb_response *response, const mhb_branch *b, int point) {
  double         size   = 0;
  double complex square = 0;
  for (int i = 0; i < 3; i++) {
    const size_t         at = ((size_t)point * 3 + (size_t)i) * (size_t)(response->n_harmonics + 1);
    const double complex c  = b->probe[at + 1];
    size += creal(c * conj(c));
    square += c * c;
  }
  return sqrt(0.5 * (size + cabs(square)));
}

static int highest(const mhb_response *response, const mhb_branch *b) {
  int best = 0;
  for (int i = 1; i < b->n_points; i++)
    if (probe_amplitude(response, b, i) > probe_amplitude(response, b, best)) best = i;
  return best;
}

static const mhb_branch *curve(const mhb_response *response, mhb_branch_kind kind, double n0) {
  for (int i = 0; i < response->n_branches; i++) {
    const mhb_branch *b = &response->branch[i];
    if (b->kind == kind && (kind != MHB_BRANCH_NONLINEAR || b->n0[0] == n0)) return b;
  }
  fail_msg("no curve at n0 = %g", n0);
  return NULL;
}

/* Modes by nodal diameter. Highest peak of the blade's first harmonic, m, at Hz. */
static void test_sectors(void **state) {
  static const struct {
    mhb_branch_kind kind;
    double          n0, amplitude, at; /* N, m, Hz */
    int             stable;
  } rows[] = {{MHB_BRANCH_OPEN, 0, 15.102, 0.071164, 1},
              {MHB_BRANCH_NONLINEAR, 0.5, 1.1248, 0.100216, 0},
              {MHB_BRANCH_NONLINEAR, 2, 2.9083, 0.104482, 0},
              {MHB_BRANCH_STUCK, 0, 4.6856, 0.105790, 1}};
  char line[2048];
  (void)state;
  snprintf(line, sizeof line,
           "cp '%s'/ring.yaml '%s'/ && cd '%s' && '%s' '%s'/write_sectors.py && '%s' ring.yaml "
           "--quiet",
           example, scratch_folder, scratch_folder, python, example, command);
  assert_int_equal(system(line), 0);
  mhb_response *response;
  assert_ok(mhb_response_read(scratch("ring.response.h5"), &response));
  assert_false(response->lacks_diameters);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const mhb_branch *b    = curve(response, rows[i].kind, rows[i].n0);
    const int         peak = highest(response, b);
    const double      size = probe_amplitude(response, b, peak);
    print_message("%g N: %.5f m at %.6f Hz\n", rows[i].n0, size, b->frequency[peak]);
    assert_within(size, rows[i].amplitude, 1e-3);
    assert_within(b->frequency[peak], rows[i].at, 1e-4);
    assert_int_equal(b->stable[peak], rows[i].stable);
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_peaks), cmocka_unit_test(test_sectors)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
