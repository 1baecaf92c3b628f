/* Peaks of a ring of different blades, followed along the preload, against those of sweeps. */
#include "mesh/base/constants.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/peak_scan.h"
#include "tests/support/random_model.h"

static void tracked_peaks_are_those_of_sweeps(void **state) {
  enum { N = 4 };
  const double       deviation[N] = {0.02, -0.01, 0.015, -0.03};
  modal_model        blade;
  mhb_mistuned_ring *ring;
  mhb_settings       s = random_settings(3);
  (void)state;
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 3, &blade);
  s.blades       = N;
  s.scale        = 2;
  s.frequency[0] = 1.2 / SHB_TWO_PI;
  s.frequency[1] = 1.6 / SHB_TWO_PI;
  s.tolerance    = 1e-10;
  s.stability    = MHB_STABILITY_NEVER;
  s.track        = MHB_TRACK_PEAKS;
  s.parameter    = MHB_IN_N0;
  s.range[0]     = 0.2;
  s.range[1]     = 0.42;
  assert_ok(mhb_mistuned_ring_create(&blade, &s, deviation, 1, &ring));
  s.ring                = ring;
  const peak_scan scan  = {&ring->whole, &s};
  mhb_response   *r     = peak_scan_follow(&scan);
  peak_agreement  found = peak_scan_compare(&scan, r);
  print_message("%d peaks, %d of them on a curve: amplitude to %.1e, frequency to %.1e\n", found.n,
                found.n_on_curve, found.amplitude, found.frequency);
  assert_true(found.n >= 8 && found.n_on_curve == 0);
  assert_below(found.amplitude, 1e-6);
  assert_below(found.frequency, 1e-6);
  mhb_response_destroy(r);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(tracked_peaks_are_those_of_sweeps)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
