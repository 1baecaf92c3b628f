/* The motion that lasts on whole curves: which points, file, resumption, threads, interruption, and
 * what is said where nothing is computed. */
#include <omp.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/lasting_motion.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "tests/support/check.h"
#include "tests/support/files.h"
#include "tests/support/random_model.h"

static const shb_provenance from = {"case.yaml", "name: x\n", "mu = 0.4\n", "shroudhb-mhb"};

static void model_of(modal_model *model) {
  random_model(1, WITH_LEFT, 1, model);
  for (int i = 0; i < 6; i++) model->damping_ratio[i] = .003;
}

/* Six blades; at n0 = 0.15 the wave is modulated, at 3 it sticks. */
static mhb_settings settings_of(void) {
  mhb_settings s = random_settings(5);
  s.tolerance    = 1e-8;
  s.n_preloads   = 2;
  s.n0[0]        = .15;
  s.n0[1]        = 3;
  s.frequency[0] = .915 / SHB_TWO_PI;
  s.frequency[1] = .94 / SHB_TWO_PI;
  s.stability    = MHB_STABILITY_ALWAYS;
  s.lasting      = MHB_LASTING_AUTO;
  return s;
}

static mhb_response *run(const mhb_settings *s, const char *path) {
  modal_model   model;
  mhb_response *r;
  model_of(&model);
  assert_ok(mhb_forced_response(&model, s, path, &from, NULL, &r));
  modal_model_free(&model);
  return r;
}

static int n_computed(const mhb_branch *b) {
  int n = 0;
  for (int i = 0; i < b->n_points; i++) n += b->lasting_kind[i] != MHB_LASTING_UNKNOWN;
  return n;
}

static bool is_modulated(const mhb_branch *b, int i) {
  return b->stable[i] == 0 && b->loss[i] > MHB_LOSS_FOLD && b->state[3 * i] < 1;
}

#define assert_same(a, b, member, n) \
  assert_memory_equal((a)->member, (b)->member, (size_t)(n) * sizeof *(a)->member)

static void assert_same_lasting(const mhb_branch *a, const mhb_branch *b) {
  int n = a->n_points, windows = a->lasting_curve.n;
  assert_int_equal(n, b->n_points);
  assert_string_equal(a->lasting, b->lasting);
  assert_same(a, b, lasting_mean, n);
  assert_same(a, b, lasting_worst, n);
  assert_same(a, b, lasting_error, n);
  assert_same(a, b, lasting_side, n);
  assert_same(a, b, lasting_offset, n);
  assert_same(a, b, lasting_periods, n);
  assert_same(a, b, lasting_kind, n);
  assert_same(a, b, lasting_starts, n);
  assert_same(a, b, lasting_reached, n);
  assert_same(a, b, lasting_least, n);
  assert_same(a, b, lasting_least_worst, n);
  assert_int_equal(windows, b->lasting_curve.n);
  if (windows == 0) return;
  assert_same(&a->lasting_curve, &b->lasting_curve, frequency, windows);
  assert_same(&a->lasting_curve, &b->lasting_curve, mean, windows);
  assert_same(&a->lasting_curve, &b->lasting_curve, worst, windows);
}

/* Few points, at modulated ones only; the sweep; the file has all of it. */
static void auto_computes_few_points_and_a_sweep(void **state) {
  (void)state;
  mhb_settings      s = settings_of();
  mhb_response     *r = run(&s, scratch("auto.h5")), *read;
  const mhb_branch *b = &r->branch[2], *stuck = &r->branch[3];
  int               n = 0;
  print_message("\"%s\", \"%s\"\n", b->lasting, stuck->lasting);
  for (int i = 0; i < b->n_points; i++) {
    n += is_modulated(b, i);
    if (!b->lasting_kind[i]) continue;
    assert_true(is_modulated(b, i));
    assert_true(b->lasting_worst[i] >= b->lasting_mean[i] && b->lasting_mean[i] > .3);
    assert_true(b->lasting_periods[i] >= 600 && b->lasting_side[i] < 6);
  }
  assert_true(n > 4);
  assert_in_range(n_computed(b), 2, 4);
  assert_true(b->lasting_curve.n >= 2);
  assert_has(b->lasting, "and a sweep");
  assert_int_equal(n_computed(stuck), 0);
  assert_has(stuck->lasting, "no point is modulated");
  assert_ok(mhb_response_read(scratch("auto.h5"), &read));
  for (int i = 2; i < 4; i++) assert_same_lasting(&r->branch[i], &read->branch[i]);
  mhb_response_destroy(read);
  mhb_response_destroy(r);
}

static void always_computes_every_modulated_point(void **state) {
  (void)state;
  mhb_settings s      = settings_of();
  s.lasting           = MHB_LASTING_ALWAYS;
  s.n_preloads        = 1;
  s.frequency[0]      = .915 / SHB_TWO_PI;
  s.frequency[1]      = .925 / SHB_TWO_PI;
  mhb_response     *r = run(&s, NULL);
  const mhb_branch *b = &r->branch[2];
  int               n = 0;
  for (int i = 0; i < b->n_points; i++) {
    n += is_modulated(b, i);
    assert_int_equal(b->lasting_kind[i] != 0, is_modulated(b, i));
  }
  print_message("%d of %d points\n", n, b->n_points);
  assert_true(n > 0);
  mhb_response_destroy(r);
}

static void nothing_else_is_computed_and_the_file_says_so(void **state) {
  (void)state;
  mhb_settings s  = settings_of();
  s.n_preloads    = 1;
  s.lasting       = MHB_LASTING_NEVER;
  mhb_response *r = run(&s, NULL);
  assert_has(r->branch[2].lasting, "mhb.lasting is never");
  assert_int_equal(n_computed(&r->branch[2]), 0);
  mhb_response_destroy(r);
  s.lasting   = MHB_LASTING_AUTO;
  s.stability = MHB_STABILITY_NEVER;
  r           = run(&s, NULL);
  assert_has(r->branch[2].lasting, "stability was not judged");
  mhb_response_destroy(r);
  s              = settings_of();
  s.parameter    = MHB_IN_SCALE;
  s.n_preloads   = 1;
  s.range[0]     = .8;
  s.range[1]     = 1;
  s.frequency[1] = s.frequency[0];
  r              = run(&s, NULL);
  assert_has(r->branch[2].lasting, "not over the frequency");
  mhb_response_destroy(r);
}

static void threads_do_not_change_the_result(void **state) {
  (void)state;
  mhb_settings s       = settings_of();
  int          threads = omp_get_max_threads();
  omp_set_num_threads(1);
  mhb_response *one = run(&s, NULL);
  omp_set_num_threads(3);
  mhb_response *three = run(&s, NULL);
  omp_set_num_threads(threads);
  for (int i = 2; i < 4; i++) assert_same_lasting(&one->branch[i], &three->branch[i]);
  mhb_response_destroy(one);
  mhb_response_destroy(three);
}

/* ---- a host that stops ---- */

typedef struct {
  int calls, most, n_stored;
} counter;

static bool goes_on(void *context) {
  counter *c = context;
  int      calls;
#pragma omp atomic capture
  calls = ++c->calls;
  return calls < c->most;
}

static void lock(void *context, bool locked) {
  (void)context;
  (void)locked;
}

static shb_status stored(void *context, double share, double n0, double frequency) {
  counter *c = context;
  c->n_stored++;
  assert_true(share > 0 && share <= 1 && n0 == .15 && frequency > 0);
  return SHB_OK;
}

/* The main curve of a response, alone, with no lasting motion. */
static mhb_response *main_curve_of(const mhb_response *r) {
  mhb_response *own = mhb_response_like(r);
  mhb_response_branch(own, MHB_BRANCH_NONLINEAR);
  mhb_branch *b  = &own->branch[0];
  b->n_harmonics = r->branch[2].n_harmonics;
  mhb_response_copy_points(own, 0, r, 2, 0, r->branch[2].n_points - 1);
  memset(b->lasting_kind, 0, sizeof(int) * (size_t)b->n_points);
  return own;
}

/* An interrupted branch has no text, and a second call completes it as if nothing had been. */
static void an_interrupted_branch_is_completed(void **state) {
  (void)state;
  mhb_settings s = settings_of();
  modal_model  model;
  s.n_preloads             = 1;
  mhb_response          *r = run(&s, NULL), *own = main_curve_of(r);
  mhb_branch            *b   = &own->branch[0];
  counter                few = {.most = 3500}, all = {.most = 1 << 30};
  const mhb_lasting_host stop = {&few, goes_on, lock, stored, 2},
                         go   = {&all, goes_on, lock, stored, 2};
  int threads                 = omp_get_max_threads();
  omp_set_num_threads(1);
  model_of(&model);
  assert_ok(mhb_lasting_motion(&model, &s, 1, &own, &stop));
  assert_null(b->lasting);
  print_message("stopped after %d of the results\n", few.n_stored);
  assert_ok(mhb_lasting_motion(&model, &s, 1, &own, &go));
  assert_same_lasting(&r->branch[2], b);
  int calls = all.calls;
  assert_ok(mhb_lasting_motion(&model, &s, 1, &own, &go)); /* done: nothing happens */
  assert_true(all.calls - calls < 10);
  omp_set_num_threads(threads);
  modal_model_free(&model);
  mhb_response_destroy(own);
  mhb_response_destroy(r);
}

/* Points that were not judged may be modulated: the sweep covers them as if they were. */
static void the_sweep_covers_points_that_were_not_judged(void **state) {
  (void)state;
  mhb_settings s = settings_of();
  modal_model  model;
  s.n_preloads    = 1;
  mhb_response *r = run(&s, NULL), *own = main_curve_of(r);
  mhb_branch   *b  = &own->branch[0];
  counter       c  = {.most = 1 << 30};
  double        at = r->branch[2].lasting_curve.frequency[0];
  int           n  = 0;
  for (int i = 0; i < b->n_points; i++) {
    if (b->frequency[i] > 1.01 * at || !is_modulated(b, i)) continue;
    b->stable[i] = -1;
    n++;
  }
  model_of(&model);
  assert_ok(
      mhb_lasting_motion(&model, &s, 1, &own, &(mhb_lasting_host){&c, goes_on, lock, stored, 2}));
  print_message("%d not judged\n", n);
  assert_true(n > 3);
  assert_float_equal(b->lasting_curve.frequency[0], at, 1e-12);
  for (int i = 0; i < b->n_points; i++)
    if (b->stable[i] < 0) assert_int_equal(b->lasting_kind[i], MHB_LASTING_UNKNOWN);
  modal_model_free(&model);
  mhb_response_destroy(own);
  mhb_response_destroy(r);
}

/* A file of an earlier version, or of a killed run: curves are complete, without lasting motion. */
static void a_resumed_run_completes_it(void **state) {
  (void)state;
  mhb_settings  s    = settings_of();
  const char   *path = scratch("resume.h5");
  mhb_response *r    = run(&s, path), *read;
  assert_ok(mhb_response_read(path, &read));
  mhb_branch *b = &read->branch[2];
  free(b->lasting);
  b->lasting = NULL;
  memset(b->lasting_kind, 0, sizeof(int) * (size_t)b->n_points);
  memset(b->lasting_mean, 0, sizeof(double) * (size_t)b->n_points);
  mhb_response_lasting_curve(b, 0);
  assert_ok(mhb_response_write(read, path, &from));
  mhb_response_destroy(read);
  s.resume             = true;
  mhb_response *second = run(&s, path);
  for (int i = 2; i < 4; i++) assert_same_lasting(&r->branch[i], &second->branch[i]);
  mhb_response_destroy(second);
  mhb_response_destroy(r);
}

/* A ring of different blades: judged, and what takes over where its motion is unstable. */
static void different_blades_have_it_too(void **state) {
  static const double delta[6] = {0.003, -0.002, 0.001, 0, -0.004, 0.002};
  (void)state;
  modal_model        model;
  mhb_mistuned_ring *ring;
  mhb_response      *r, *read;
  mhb_settings       s    = settings_of();
  int                n    = 0;
  const char        *path = scratch("different.h5");
  model_of(&model);
  s.n_preloads = 1;
  assert_ok(mhb_mistuned_ring_create(&model, &s, delta, 1, &ring));
  s.ring = ring;
  assert_ok(mhb_forced_response(&ring->whole, &s, path, &from, NULL, &r));
  const mhb_branch *b = &r->branch[2];
  print_message("\"%s\"\n", b->lasting);
  for (int i = 0; i < b->n_points; i++) {
    n += is_modulated(b, i);
    if (!b->lasting_kind[i]) continue;
    assert_true(is_modulated(b, i));
    assert_true(b->lasting_worst[i] > .5 && b->lasting_mean[i] > .5);
    print_message("%.4f rad/s: kind %d, mean %.4f, worst %.4f\n", SHB_TWO_PI * b->frequency[i],
                  b->lasting_kind[i], b->lasting_mean[i], b->lasting_worst[i]);
  }
  assert_true(n > 2);
  assert_in_range(n_computed(b), 1, 4);
  assert_true(b->lasting_curve.n >= 2);
  assert_ok(mhb_response_read(path, &read));
  assert_same_lasting(b, &read->branch[2]);
  mhb_response_destroy(read);
  mhb_response_destroy(r);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(auto_computes_few_points_and_a_sweep),
      cmocka_unit_test(always_computes_every_modulated_point),
      cmocka_unit_test(nothing_else_is_computed_and_the_file_says_so),
      cmocka_unit_test(threads_do_not_change_the_result),
      cmocka_unit_test(an_interrupted_branch_is_completed),
      cmocka_unit_test(the_sweep_covers_points_that_were_not_judged),
      cmocka_unit_test(a_resumed_run_completes_it),
      cmocka_unit_test(different_blades_have_it_too),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
