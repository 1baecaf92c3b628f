/* Damping ratios from every kind of law. */
#include "modal/model/damping.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"

static double ratio(const modal_damping *damping, int i, double omega) {
  double zeta = NAN;
  assert_int_equal(modal_damping_ratio(damping, i, omega, &zeta), SHB_OK);
  return zeta;
}

static void assert_same(double a, double b) {
  if (!(fabs(a - b) <= 1e-15 * fabs(b))) fail_msg("%.17g is not %.17g", a, b);
}

static void ratios(void **state) {
  (void)state;
  const modal_damping all  = {.ratio = 0.0023};
  const modal_damping each = {.kind = MODAL_DAMPING_EACH, .n = 3, .each = {0.001, 0.004, 0.0025}};
  assert_same(ratio(&all, 0, 700), 0.0023);
  assert_same(ratio(&all, 9, 7000), 0.0023);
  assert_same(ratio(&each, 0, 700), 0.001);
  assert_same(ratio(&each, 1, 700), 0.004);
  assert_same(ratio(&each, 2, 700), 0.0025);
  assert_same(ratio(&each, 17, 700), 0.0025); /* further modes take the last ratio */
}

/* At resonance K (1 + j eta) dissipates pi eta K |q|^2 per cycle, a viscous damper 2 pi zeta K
 * |q|^2. */
static void loss_factor(void **state) {
  (void)state;
  const modal_damping loss = {.kind = MODAL_DAMPING_LOSS, .loss = 0.006};
  double              K = 3.7, q = 0.9;
  assert_same(SHB_TWO_PI * ratio(&loss, 4, 1234) * K * q * q, SHB_PI * 0.006 * K * q * q);
}

/* phi^T (alpha M + beta K) phi = alpha + beta omega^2 = 2 zeta omega. */
static void rayleigh(void **state) {
  (void)state;
  const modal_damping law = {.kind = MODAL_DAMPING_RAYLEIGH, .alpha = 12.5, .beta = 1.7e-6};
  for (double omega = 300; omega < 3e4; omega *= 1.7)
    assert_same(2 * ratio(&law, 0, omega) * omega, 12.5 + 1.7e-6 * omega * omega);
  double zeta;
  assert_int_equal(modal_damping_ratio(&law, 6, 2e6, &zeta), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "modal.damping: mode 7 at 318310 Hz would have"));
  assert_null(strchr(shb_message(), '\n'));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ratios),
      cmocka_unit_test(loss_factor),
      cmocka_unit_test(rayleigh),
  };
  return cmocka_run_group_tests_name("modal.damping", tests, NULL, NULL);
}
