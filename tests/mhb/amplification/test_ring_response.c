/* The response of a mistuned ring: factors of its peaks, samples, an interrupted run taken up. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/amplification/ring_response.h"
#include "mhb/branches/forced_response.h"
#include "mhb/mistuning/deviations.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/scratch_folder.h"

enum { N = 4, SAMPLES = 3 };

static const mhb_sampling   SAMPLING = {.n = SAMPLES, .deviation = 0.01, .seed = 7};
static const shb_provenance NONE     = {
        .case_path = "test.yaml", .case_text = "test", .settings = "test = 1\n", .command = "test"};

/* A ring that sticks and slips, with its peak inside the range. */
static mhb_settings ring_settings(void) {
  mhb_settings s = random_settings(3);
  s.blades       = N;
  s.n_preloads   = 1;
  s.scale        = 2;
  s.frequency[0] = 1.25 / SHB_TWO_PI;
  s.frequency[1] = 1.55 / SHB_TWO_PI;
  s.stability    = MHB_STABILITY_NEVER;
  s.max_points   = 3000;
  s.resume       = true;
  return s;
}

static mhb_response *solve(const modal_model *blade, const double *deviation,
                           const mhb_sampling *sampling, const char *path) {
  mhb_settings       s = ring_settings();
  mhb_mistuned_ring *ring;
  mhb_response      *response;
  shb_progress       quiet = shb_progress_start("test", true, false);
  assert_ok(mhb_mistuned_ring_create(blade, &s, deviation, 1, &ring));
  s.ring = ring;
  assert_ok(mhb_ring_response(&s, sampling, path, path ? &NONE : NULL, &quiet, &response));
  mhb_mistuned_ring_destroy(ring);
  return response;
}

static void equal_blades_have_the_factor_one(void **state) {
  const double zero[N] = {0};
  modal_model  blade;
  (void)state;
  random_model(1, WITH_LEFT, 3, &blade);
  mhb_response            *r = solve(&blade, zero, NULL, NULL);
  const mhb_amplification *a = &r->branch[2].amplification;
  assert_int_equal(r->ring, N);
  assert_near(a->factor, 1, 1e-6); /* both peaks are located to 1e-6 */
  assert_within(a->mean, a->tuned, 1e-6);
  assert_true(a->worst_at > 1.25 / SHB_TWO_PI && a->worst_at < 1.55 / SHB_TWO_PI);
  mhb_response_destroy(r);
  modal_model_free(&blade);
}

/* Sample 0 is the ring itself. Samples of the file are not made again. */
static void samples_are_taken_up(void **state) {
  double        deviation[N];
  modal_model   blade;
  mhb_response *all, *again;
  (void)state;
  random_model(1, WITH_LEFT, 3, &blade);
  assert_ok(mhb_deviations_random(SAMPLING.deviation, SAMPLING.seed, 0, N, deviation));
  all = solve(&blade, deviation, &SAMPLING, scratch("r.h5"));
  assert_int_equal(mhb_samples_done(all->samples, 0), SAMPLES);
  assert_within(all->samples->factor[0], all->branch[2].amplification.factor, 1e-9);
  assert_true(fabs(all->samples->factor[1] - all->samples->factor[0]) > 1e-4);
  assert_int_equal(all->unfinished, 0);
  /* the file of an interrupted run, with a mark on a sample that is done */
  const double kept       = all->samples->factor[2];
  all->samples->factor[1] = 7;
  all->samples->factor[2] = 0;
  all->unfinished         = true;
  assert_ok(mhb_response_write(all, scratch("r.h5"), &NONE));
  again = solve(&blade, deviation, &SAMPLING, scratch("r.h5"));
  assert_near(again->samples->factor[1], 7, 0);
  assert_near(again->samples->factor[2], kept, 0);
  mhb_response_destroy(again);
  assert_ok(mhb_response_read(scratch("r.h5"), &again));
  assert_near(again->samples->factor[2], kept, 0);
  assert_within(again->branch[2].amplification.worst, all->branch[2].amplification.worst, 1e-12);
  assert_int_equal(again->branch[2].amplification.blade, all->branch[2].amplification.blade);
  mhb_response_destroy(again);
  mhb_response_destroy(all);
  modal_model_free(&blade);
}

/* The blade, deviations and settings of a ring whose blades differ; its owner destroys it. */
static mhb_mistuned_ring *drawn_ring(modal_model *blade, double deviation[N], mhb_settings *s) {
  mhb_mistuned_ring *ring;
  random_model(1, WITH_LEFT, 3, blade);
  *s = ring_settings();
  assert_ok(mhb_deviations_random(SAMPLING.deviation, SAMPLING.seed, 0, N, deviation));
  assert_ok(mhb_mistuned_ring_create(blade, s, deviation, 1, &ring));
  s->ring = ring;
  return ring;
}

/* A run that is killed before it adds its peaks has more to do. */
static void a_sweep_without_its_peaks_is_unfinished(void **state) {
  double             deviation[N];
  modal_model        blade;
  mhb_settings       s;
  mhb_response      *r;
  mhb_mistuned_ring *ring  = drawn_ring(&blade, deviation, &s);
  shb_progress       quiet = shb_progress_start("test", true, false);
  (void)state;
  assert_ok(mhb_forced_response(&ring->whole, &s, scratch("sweep.h5"), &NONE, &quiet, &r));
  mhb_response_destroy(r);
  assert_ok(mhb_response_read(scratch("sweep.h5"), &r));
  assert_int_equal(r->unfinished, 1);
  mhb_response_destroy(r);
  mhb_mistuned_ring_destroy(ring);
  mhb_response_destroy(solve(&blade, deviation, NULL, scratch("sweep.h5")));
  assert_ok(mhb_response_read(scratch("sweep.h5"), &r));
  assert_int_equal(r->unfinished, 0);
  assert_true(r->branch[2].amplification.factor > 1);
  mhb_response_destroy(r);
  modal_model_free(&blade);
}

/* No number of harmonics keeps the tolerance: samples are marked, not silent results. */
static void samples_above_the_tolerance_are_marked(void **state) {
  double             deviation[N];
  modal_model        blade;
  mhb_settings       s;
  mhb_response      *r;
  mhb_mistuned_ring *ring  = drawn_ring(&blade, deviation, &s);
  shb_progress       quiet = shb_progress_start("test", true, false);
  (void)state;
  r               = solve(&blade, deviation, NULL, NULL);
  const double at = r->branch[2].amplification.worst_at;
  mhb_response_destroy(r);
  s.frequency[0] = 0.99 * at;
  s.frequency[1] = 1.01 * at;
  for (int i = 0; i < 2; i++) {
    s.motion_tolerance = i ? 1e-2 : 1e-9;
    assert_ok(mhb_ring_response(&s, &SAMPLING, NULL, &NONE, &quiet, &r));
    const mhb_marks marks = mhb_response_marks(r);
    print_message("tolerance %.0e: %d of %d samples marked\n", s.motion_tolerance,
                  marks.marked_samples, marks.samples);
    assert_int_equal(r->branch[2].amplification.factor > 0, i); /* that of the ring itself */
    assert_int_equal(marks.samples, SAMPLES);
    assert_int_equal(marks.marked_samples, i ? 0 : SAMPLES);
    assert_int_equal(mhb_samples_worst(r->samples, 0) < 0, !i);
    mhb_response_destroy(r);
  }
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

/* Interrupted before its samples, a run keeps those of the file. The last test: the mark of the
 * interruption stays. */
static void samples_outlive_an_interruption(void **state) {
  double             deviation[N];
  modal_model        blade;
  mhb_settings       s;
  mhb_response      *r;
  mhb_mistuned_ring *ring  = drawn_ring(&blade, deviation, &s);
  shb_progress       quiet = shb_progress_start("test", true, false);
  (void)state;
  mhb_response_destroy(solve(&blade, deviation, &SAMPLING, scratch("kept.h5")));
  shb_interrupt_catch();
  raise(SIGINT);
  assert_int_equal(mhb_ring_response(&s, &SAMPLING, scratch("kept.h5"), &NONE, &quiet, &r),
                   SHB_INTERRUPTED);
  mhb_response_destroy(r);
  assert_ok(mhb_response_read(scratch("kept.h5"), &r));
  assert_int_equal(r->unfinished, 1);
  assert_int_equal(mhb_samples_done(r->samples, 0), SAMPLES);
  mhb_response_destroy(r);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&blade);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(equal_blades_have_the_factor_one),
                                     cmocka_unit_test(samples_are_taken_up),
                                     cmocka_unit_test(a_sweep_without_its_peaks_is_unfinished),
                                     cmocka_unit_test(samples_above_the_tolerance_are_marked),
                                     cmocka_unit_test(samples_outlive_an_interruption)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
