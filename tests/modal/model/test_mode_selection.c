/* Number of modes for a tolerance: the fewest, and none below 1.2 times the band left out. */
#include "mesh/base/constants.h"
#include "modal/model/mode_selection.h"

#include "modal/model/reduce.h"
#include "modal/model/residual_series.h"
#include "tests/support/check.h"

enum { MODES = 9, BEYOND = 30, SIDE = 3 };

static double frequency[MODES], damping[MODES], right[SIDE * MODES], R[3][SIDE * SIDE],
    tail[2 * SIDE];

static double lambda_of(int mode) {
  return pow(SHB_TWO_PI * 50 * (mode + 1), 2);
}

static double shape_of(int dof, int mode) {
  return (0.5 + 0.1 * dof) * cos(1.7 * mode + dof);
}

/* A model of modes at 50, 100, ... Hz; the modes from MODES to BEYOND are its residual terms and
 * tail. */
static modal_model make(void) {
  memset(R, 0, sizeof R);
  memset(tail, 0, sizeof tail);
  for (int i = 0; i < BEYOND; i++)
    for (int p = 0; p < SIDE; p++) {
      if (i < MODES) {
        frequency[i]         = sqrt(lambda_of(i)) / SHB_TWO_PI;
        damping[i]           = 0.02;
        right[p * MODES + i] = shape_of(p, i);
        continue;
      }
      for (int t = 0; t < 3; t++)
        for (int l = 0; l < SIDE; l++)
          R[t][p * SIDE + l] += shape_of(p, i) * shape_of(l, i) / pow(lambda_of(i), t + 1);
      for (int j = 0; j < 2; j++)
        tail[2 * p + j] += pow(shape_of(p, i), 2) / pow(lambda_of(i), 4 + j);
    }
  return (modal_model){.n_modes              = MODES,
                       .n_pairs              = 1,
                       .frequency            = frequency,
                       .damping_ratio        = damping,
                       .right                = right,
                       .residual_flexibility = R[0],
                       .residual_inertia     = R[1],
                       .residual_fourth      = R[2],
                       .contact_tail         = tail,
                       .tail_order           = 3};
}

static void band_limits_the_number(void **state) {
  (void)state;
  const modal_model m = make();
  int               modes;
  double            error;
  assert_ok(modal_select_modes(&m, 100, 1, &modes, &error));
  assert_int_equal(modes, 2); /* 100 Hz stays below 120 Hz */
  assert_ok(modal_select_modes(&m, 130, 1, &modes, &error));
  assert_int_equal(modes, 3); /* 150 Hz stays below 156 Hz */
  assert_ok(modal_select_modes(&m, 400, 1e-12, &modes, &error));
  assert_int_equal(modes, 0); /* the last mode, 450 Hz, is below 480 Hz */
}

/* A smaller tolerance needs no fewer modes, and the error reported is within it. */
static void tolerance_is_kept(void **state) {
  (void)state;
  const modal_model m    = make();
  int               last = 0;
  for (double tolerance = 1e-4; tolerance > 1e-9; tolerance /= 10) {
    int    modes;
    double error;
    assert_ok(modal_select_modes(&m, 80, tolerance, &modes, &error));
    print_message("tolerance %.0e: %d modes, error %.1e\n", tolerance, modes, error);
    if (modes == 0) {
      assert_true(error > tolerance);
      continue;
    }
    assert_true(error <= tolerance && modes >= last);
    last = modes;
  }
  assert_int_equal(last, 2);
}

static void terms_are_needed(void **state) {
  (void)state;
  modal_model m = make();
  int         modes;
  double      error;
  m.contact_tail = NULL;
  assert_int_equal(modal_select_modes(&m, 100, 1, &modes, &error), SHB_ERR_INPUT);
  assert_has(shb_message(), "does not hold what estimates its error");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(band_limits_the_number),
                                     cmocka_unit_test(tolerance_is_kept),
                                     cmocka_unit_test(terms_are_needed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
