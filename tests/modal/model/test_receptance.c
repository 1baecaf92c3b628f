/* Receptance of two modes at one contact pair against its sum, written out. */
#include "mesh/base/constants.h"
#include "modal/model/receptance.h"

#include "tests/support/check.h"

enum { MODES = 2, SIDE = 3, N = 2 * SIDE };

static double frequency[MODES] = {31, 77}, damping[MODES] = {0.01, 0.003};
static double right[SIDE * MODES] = {0.3, -0.1, 0.2, 0.7, 0.11, 0.4};
static double left[SIDE * MODES]  = {-0.6, 0.13, 0.5, 0.2, -0.17, 0.9};
static double R[N * N], R2[N * N], R3[N * N], tail[2 * N];

static modal_model model_with(int terms) {
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      R[i * N + j]  = 1e-6 * (1 + (i == j)) / (1 + abs(i - j));
      R2[i * N + j] = 1e-12 * R[i * N + j] / 1e-6;
    }
  return (modal_model){.n_modes              = MODES,
                       .n_pairs              = 1,
                       .has_left             = true,
                       .frequency            = frequency,
                       .damping_ratio        = damping,
                       .right                = right,
                       .left                 = left,
                       .residual_flexibility = terms > 0 ? R : NULL,
                       .residual_inertia     = terms > 1 ? R2 : NULL};
}

static double shape(int dof, int mode) {
  return dof < SIDE ? right[dof * MODES + mode] : left[(dof - SIDE) * MODES + mode];
}

/* Every entry is the modal sum plus R + omega^2 R2; the matrix is symmetric. */
static void entries_are_the_modal_sum(void **state) {
  (void)state;
  for (int terms = 0; terms <= 2; terms++) {
    const modal_model m = model_with(terms);
    for (double omega = 0; omega < 600; omega += 97.3) {
      double complex value[N * N];
      modal_receptance(&m, omega, value);
      for (int p = 0; p < N; p++)
        for (int l = 0; l < N; l++) {
          double complex wanted = 0;
          for (int i = 0; i < MODES; i++) {
            const double w = SHB_TWO_PI * frequency[i];
            wanted += shape(p, i) * shape(l, i) /
                      (w * w - omega * omega + 2 * I * damping[i] * w * omega);
          }
          if (terms > 0) wanted += R[p * N + l];
          if (terms > 1) wanted += omega * omega * R2[p * N + l];
          assert_near(cabs(value[p * N + l] - wanted), 0, 1e-14 * cabs(wanted) + 1e-22);
          assert_true(value[p * N + l] == value[l * N + p]);
        }
    }
  }
}

/* Without the data for an estimate the error is -1; with an empty tail it is 0. */
static void error_needs_the_tail(void **state) {
  (void)state;
  double complex value[N * N];
  modal_model    m = model_with(2);
  modal_receptance(&m, 100, value);
  assert_true(modal_receptance_error(&m, 100, value) == -1);
  m.residual_fourth = R3;
  m.contact_tail    = tail;
  m.tail_order      = 3;
  modal_receptance(&m, 1e-3, value);
  assert_near(modal_receptance_error(&m, 1e-3, value), 0, 1e-12);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(entries_are_the_modal_sum),
                                     cmocka_unit_test(error_needs_the_tail)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
