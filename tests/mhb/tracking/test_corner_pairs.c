/* Corners of contact pairs. A smooth peak goes over into the corner of one pair, and that into a
 * peak with one slipping pair less. Every peak is that of a sweep. */
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mhb/contact/law.h"
#include "tests/support/check.h"
#include "tests/support/peak_scan.h"
#include "tests/support/random_model.h"

enum { H = 5 };

static const double STICKS = 0.998;

static mhb_settings settings_of(double low, double high) {
  mhb_settings s = random_settings(H);
  s.frequency[0] = 0.85 / SHB_TWO_PI;
  s.frequency[1] = 1.6 / SHB_TWO_PI;
  s.tolerance    = 1e-10;
  s.stability    = MHB_STABILITY_NEVER;
  s.track        = MHB_TRACK_PEAKS;
  s.parameter    = MHB_IN_N0;
  s.range[0]     = low;
  s.range[1]     = high;
  return s;
}

/* The least and the largest number of pairs that stick at a point of a tracked run. */
static void stuck_pairs(const mhb_response *r, int n_pairs, int least_most[2]) {
  least_most[0] = n_pairs;
  least_most[1] = 0;
  for (int b = 0; b < r->n_branches; b++)
    for (int i = 0; i < r->branch[b].n_points; i++) {
      int n = 0;
      for (int a = 0; a < n_pairs; a++)
        n += r->branch[b].state[3 * (i * n_pairs + a) + MHB_STICK] >= STICKS;
      least_most[0] = n < least_most[0] ? n : least_most[0];
      least_most[1] = n > least_most[1] ? n : least_most[1];
    }
}

/* Pair a belongs to interface a % 2. */
static void share_out(modal_model *model) {
  model->n_interfaces   = 2;
  model->interface      = malloc((size_t)model->n_pairs * sizeof(int));
  model->interface_name = malloc(2 * sizeof(char *));
  for (int a = 0; a < model->n_pairs; a++) model->interface[a] = a % 2;
  model->interface_name[0] = strdup("shroud");
  model->interface_name[1] = strdup("snubber");
}

/* Follow the peaks of a random model with some pairs, and compare them with sweeps.
 *   least     in  branches, peaks, pairs that stick at one of them, at least
 *   on_curve  in  peaks that a sweep resolves by its curve alone, at most */
static void chain(int n_pairs, unsigned long long seed, const mhb_settings *s, const int least[3],
                  int on_curve) {
  modal_model model;
  int         stuck[2];
  random_model(n_pairs, WITH_LEFT, seed, &model);
  if (s->n_interfaces == 2) share_out(&model);
  const peak_scan scan   = {&model, s};
  mhb_response   *r      = peak_scan_follow(&scan);
  peak_agreement  agrees = peak_scan_compare(&scan, r);
  stuck_pairs(r, n_pairs, stuck);
  print_message("%d branches; %d to %d of %d pairs stick\n", r->n_branches, stuck[0], stuck[1],
                n_pairs);
  assert_true(r->n_branches >= least[0] && agrees.n >= least[1]);
  assert_true(agrees.n_on_curve <= on_curve);
  assert_true(stuck[0] < n_pairs && stuck[1] >= least[2]);
  assert_below(agrees.amplitude, 1e-6);
  assert_below(agrees.frequency, 1e-6);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static void the_chain_of_two_pairs_is_that_of_sweeps(void **state) {
  (void)state;
  const mhb_settings s = settings_of(0.3, 1.2);
  chain(2, 2, &s, (int[]){4, 40, 2}, 8);
}

static void the_chain_of_three_pairs_is_that_of_sweeps(void **state) {
  (void)state;
  const mhb_settings s = settings_of(0.3, 1.2);
  chain(3, 2, &s, (int[]){4, 30, 3}, 8);
}

/* By the rss this chain has more pieces than by the semi-major axis. */
static void the_chain_of_four_pairs_is_that_of_sweeps(void **state) {
  (void)state;
  mhb_settings s    = settings_of(0.3, 1.2);
  s.output_quantity = MHB_OUTPUT_RSS;
  chain(4, 1, &s, (int[]){5, 50, 4}, 10);
}

/* The peak to peak has corners at the same frequencies. */
static void corners_of_the_peak_to_peak_are_those_of_sweeps(void **state) {
  (void)state;
  mhb_settings s    = settings_of(0.3, 1.2);
  s.output_quantity = MHB_OUTPUT_PEAK_TO_PEAK;
  chain(2, 2, &s, (int[]){4, 40, 2}, 8);
}

static void corners_of_a_contact_are_those_of_sweeps(void **state) {
  (void)state;
  mhb_settings s    = settings_of(0.3, 1.2);
  s.output_quantity = MHB_OUTPUT_PEAK_TO_PEAK;
  snprintf(s.output, sizeof s.output, "contact");
  chain(2, 2, &s, (int[]){4, 40, 2}, 8);
}

/* Two interfaces; the second has other friction, stiffness and preload.
 *   together  in  its preload moves with that of the first */
static void chain_of_two_interfaces(bool together) {
  mhb_settings   s       = settings_of(0.3, 1.2);
  mhb_interface *snubber = &s.interface[1];
  for (int i = 0; i < 2; i++) {
    mhb_interface *own = &s.interface[i];
    *own = (mhb_interface){.mu = s.mu, .kv = s.kv, .n_preloads = 1, .psi = s.psi, .phi = s.phi};
    memcpy(own->ku, s.ku, sizeof s.ku);
    own->n0[0] = s.n0[0];
    snprintf(own->name, sizeof own->name, "%s", i ? "snubber" : "shroud");
  }
  snubber->mu    = 0.5;
  snubber->kv    = 0.9 * s.kv;
  snubber->n0[0] = 1.2 * s.n0[0];
  s.n_interfaces = 2;
  s.together     = together;
  chain(2, 2, &s, together ? (int[]){3, 40, 2} : (int[]){1, 10, 1}, 0);
}

static void peaks_of_two_interfaces_are_those_of_sweeps(void **state) {
  (void)state;
  chain_of_two_interfaces(false);
}

static void peaks_of_two_interfaces_together_are_those_of_sweeps(void **state) {
  (void)state;
  chain_of_two_interfaces(true);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_chain_of_two_pairs_is_that_of_sweeps),
      cmocka_unit_test(the_chain_of_three_pairs_is_that_of_sweeps),
      cmocka_unit_test(the_chain_of_four_pairs_is_that_of_sweeps),
      cmocka_unit_test(corners_of_the_peak_to_peak_are_those_of_sweeps),
      cmocka_unit_test(corners_of_a_contact_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_two_interfaces_are_those_of_sweeps),
      cmocka_unit_test(peaks_of_two_interfaces_together_are_those_of_sweeps)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
