/* Modal amplitudes of points: the motion of probes and contact follows from them; which points are
 * kept. */
#include "mhb/response/modal_motion.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "tests/support/check.h"
#include "tests/support/files.h"
#include "tests/support/random_model.h"

static mhb_settings narrow(void) {
  mhb_settings s = random_settings(3);
  s.frequency[0] = 0.75 / SHB_TWO_PI;
  s.frequency[1] = 1.25 / SHB_TWO_PI;
  s.n_preloads   = 1;
  s.n0[0]        = 0.3;
  s.stability    = MHB_STABILITY_NEVER;
  return s;
}

static mhb_response *solve(const modal_model *model, const mhb_settings *s, const char *path) {
  static const shb_provenance from = {"case.yaml", "name: x\n", "mu = 0.4\n", "shroudhb-mhb"};
  mhb_response               *response;
  shb_status                  status = mhb_forced_response(model, s, path, &from, NULL, &response);
  if (status != SHB_OK) fail_msg("%s", shb_message());
  return response;
}

/* Largest difference of the probes' motion from the sum over the modes, relative to the largest
 * motion. The model has no residual terms, so nothing is left out. */
static double probe_error(const modal_model *model, const mhb_response *r) {
  const size_t m = (size_t)model->n_modes, rows = 3 * (size_t)model->n_probes;
  double       error = 0, most = 0;
  for (int i = 0; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    const size_t      K = (size_t)b->n_harmonics + 1;
    for (int a = 0; a < b->modal.n; a++)
      for (size_t row = 0; row < rows; row++)
        for (size_t k = 0; k < K; k++) {
          double complex sum = 0, x = b->probe[((size_t)b->modal.point[a] * rows + row) * K + k];
          for (size_t j = 0; j < m; j++)
            sum += model->probe[row * m + j] * b->modal.amplitude[((size_t)a * K + k) * m + j];
          error = fmax(error, cabs(sum - x));
          most  = fmax(most, cabs(x));
        }
  }
  return error / most;
}

static int points_kept(const mhb_response *r) {
  int n = 0;
  for (int i = 0; i < r->n_branches; i++) n += r->branch[i].modal.n;
  return n;
}

static void amplitudes_give_the_motion_of_the_probes(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = narrow();
  random_model(2, WITH_LEFT, 5, &model);
  s.save.what = MHB_SAVE_ALL;
  for (s.subharmonics = 1; s.subharmonics <= 2; s.subharmonics++) {
    s.harmonics     = 3 * s.subharmonics;
    s.engine_order  = s.subharmonics; /* a wave of two periods closes around six blades */
    mhb_response *r = solve(&model, &s, NULL);
    int           n = 0;
    for (int i = 0; i < r->n_branches; i++) n += r->branch[i].n_points;
    assert_int_equal(points_kept(r), n);
    print_message("%d points: probes off by %.1e\n", n, probe_error(&model, r));
    assert_true(probe_error(&model, r) < 1e-12);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
}

/* The scale of the excitation is that of the point. */
static void scale_is_that_of_the_point(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = narrow();
  random_model(1, WITH_LEFT, 5, &model);
  s.save.what     = MHB_SAVE_ALL;
  s.frequency[1]  = s.frequency[0];
  s.parameter     = MHB_IN_SCALE;
  s.range[0]      = 0.5;
  s.range[1]      = 2.5;
  mhb_response *r = solve(&model, &s, NULL);
  assert_true(probe_error(&model, r) < 1e-12);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static bool is_kept(const mhb_branch *b, int point) {
  for (int a = 0; a < b->modal.n; a++)
    if (b->modal.point[a] == point) return true;
  return false;
}

/* By default: every peak, and the highest point. The file gives back what was written. */
static void peaks_are_kept(void **state) {
  (void)state;
  modal_model   model;
  mhb_settings  s = narrow();
  mhb_response *read;
  int           peaks = 0;
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 5, &model);
  mhb_response *r = solve(&model, &s, scratch("peaks.h5"));
  assert_ok(mhb_response_read(scratch("peaks.h5"), &read));
  for (int i = 0; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i], *c = &read->branch[i];
    int               highest = 0;
    for (int p = 0; p < b->n_points; p++) {
      if (b->special[p] == MHB_PEAK) assert_true(is_kept(b, p));
      peaks += b->special[p] == MHB_PEAK;
      if (mhb_response_output(r, b, p) > mhb_response_output(r, b, highest)) highest = p;
    }
    assert_true(is_kept(b, highest));
    assert_true(b->modal.n < b->n_points / 4);
    assert_int_equal(b->modal.n, c->modal.n);
    assert_memory_equal(b->modal.point, c->modal.point, (size_t)c->modal.n * sizeof(int));
    assert_memory_equal(b->modal.amplitude, c->modal.amplitude,
                        (size_t)c->modal.n * (size_t)(b->n_harmonics + 1) * (size_t)model.n_modes *
                            sizeof(double complex));
    const size_t rows = (size_t)c->modal.n * (size_t)(b->n_harmonics + 1);
    assert_int_equal(c->modal.n_contact, 6);
    assert_memory_equal(b->modal.force, c->modal.force, 6 * rows * sizeof(double complex));
    assert_memory_equal(b->modal.scale, c->modal.scale, (size_t)c->modal.n * sizeof(double));
  }
  assert_true(peaks >= 2);
  mhb_response_destroy(r);
  mhb_response_destroy(read);
  modal_model_free(&model);
}

/* At a frequency of the list the nearer point of each passage is kept, and no other. */
static void listed_frequencies_are_kept(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = narrow();
  random_model(1, WITH_LEFT, 5, &model);
  s.save          = (mhb_save_settings){MHB_SAVE_LISTED, 2, {0.93 / SHB_TWO_PI, s.frequency[1]}};
  mhb_response *r = solve(&model, &s, NULL);
  for (int i = 0; i < r->n_branches; i++) {
    const mhb_branch *b = &r->branch[i];
    assert_true(b->modal.n >= 2 && is_kept(b, b->n_points - 1));
    for (int a = 0; a < b->modal.n; a++) {
      double f   = b->frequency[b->modal.point[a]];
      double off = fmin(fabs(f - s.save.frequency[0]), fabs(f - s.save.frequency[1]));
      assert_true(off < 0.02 / SHB_TWO_PI);
    }
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(amplitudes_give_the_motion_of_the_probes),
                                     cmocka_unit_test(scale_is_that_of_the_point),
                                     cmocka_unit_test(peaks_are_kept),
                                     cmocka_unit_test(listed_frequencies_are_kept)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
