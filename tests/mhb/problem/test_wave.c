/* The wave of equal blades: lag and number for both senses of the rotor. */
#include "mhb/problem/wave.h"

#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/check.h"

static double complex turn(double angle) {
  return cexp(I * angle);
}

static void neighbours_lead_where_the_rotor_turns_right(void **state) {
  (void)state;
  for (int N = 2; N <= 7; N++)
    for (int E = 0; E <= 2 * N; E++) {
      const mhb_driven_wave left  = mhb_driven_wave_of(E, false, N, 1);
      const mhb_driven_wave right = mhb_driven_wave_of(E, true, N, 1);
      assert_near(cabs(turn(mhb_driven_wave_lag(left)) - turn(SHB_TWO_PI * E / N)), 0, 1e-13);
      assert_near(cabs(turn(mhb_driven_wave_lag(right)) - turn(-SHB_TWO_PI * E / N)), 0, 1e-13);
      assert_in_range(mhb_driven_wave_order(right), 0, N - 1);
    }
}

/* Over nu periods of the fundamental a blade repeats what its neighbour did nu lags before. */
static void closed_waves_of_several_periods_go_round_the_ring(void **state) {
  (void)state;
  int closed = 0;
  for (int N = 2; N <= 7; N++)
    for (int E = 0; E <= N; E++)
      for (int nu = 1; nu <= 4; nu++)
        for (int right = 0; right < 2; right++) {
          const mhb_driven_wave w    = mhb_driven_wave_of(E, right, N, nu);
          const double          sign = right ? -1 : 1;
          if (mhb_driven_wave_shift(w) < 0) {
            assert_int_equal(mhb_driven_wave_number(w), -1);
            continue;
          }
          const double lag = mhb_driven_wave_lag(w);
          closed++;
          assert_near(cabs(turn(N * lag) - 1), 0, 1e-12);
          assert_near(cabs(turn(nu * lag) - turn(sign * SHB_TWO_PI * E / N)), 0, 1e-12);
          const long   number = mhb_driven_wave_number(w);
          const double whole  = N * lag / SHB_TWO_PI - (double)number;
          assert_near(whole / N, round(whole / N), 1e-12);
          const mhb_driven_wave other = mhb_driven_wave_of(E, !right, N, nu); /* its mirror image */
          assert_int_equal((number + mhb_driven_wave_number(other)) % N, 0);
        }
  assert_true(closed > 100);
}

/* Contact to ground needs no blades. */
static void without_blades_there_is_no_sense(void **state) {
  (void)state;
  assert_int_equal(mhb_driven_wave_order(mhb_driven_wave_of(4, true, 0, 1)), 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(neighbours_lead_where_the_rotor_turns_right),
      cmocka_unit_test(closed_waves_of_several_periods_go_round_the_ring),
      cmocka_unit_test(without_blades_there_is_no_sense),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
