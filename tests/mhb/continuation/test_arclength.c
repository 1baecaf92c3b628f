/* Branches: folds from both sides, both ends, limits of the settings, and changes without effect.
 */
#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/branches/forced_response.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/balance_curve.h"
#include "mhb/continuation/event_location.h"
#include "mhb/continuation/first_solution.h"
#include "tests/support/check.h"
#include "tests/support/micrometres.h"
#include "tests/support/random_model.h"
#include "tests/support/solution.h"
#include "tests/support/three_degree.h"

static mhb_settings ground(double n0, int harmonics, double from, double to) {
  mhb_settings s = random_settings(harmonics);
  s.to_ground    = true;
  s.ku[0] = s.ku[2] = 0.5;
  s.ku[1]           = 0;
  s.n0[0]           = n0;
  s.frequency[0]    = from / SHB_TWO_PI;
  s.frequency[1]    = to / SHB_TWO_PI;
  return s;
}

static mhb_response *sweep(const modal_model *model, const mhb_settings *s, shb_status wanted) {
  mhb_response *r      = NULL;
  shb_status    status = mhb_forced_response(model, s, NULL, NULL, NULL, &r);
  if (status != wanted) fail_msg("%d instead of %d: %s", status, wanted, shb_message());
  return r;
}

/* ---- the curve ---- */

enum { MAX_FOLDS = 8 };

typedef struct {
  int    n_folds, n_points;
  double fold[MAX_FOLDS], end, worst;
} walked;

static double turning(mhb_arclength *path, const mhb_curve_point *point, void *context) {
  (void)context;
  return point->tangent[path->n];
}

/* From one end of the range to the other; folds in order of passing. */
static walked walk(mhb_balance *residual, double low, double high, int direction) {
  walked         w = {0};
  mhb_arclength *path;
  mhb_newton    *newton;
  int            iterations;
  double         x[residual->n], start = direction > 0 ? low : high, at;
  path   = mhb_balance_curve_create(residual, low, high);
  newton = mhb_newton_create(residual->n);
  assert_int_equal(mhb_first_solution(newton, residual, start, 1e-11, x, &iterations),
                   MHB_CONVERGED);
  assert_int_equal(mhb_arclength_start(path, x, start, direction), MHB_CONVERGED);
  mhb_arclength_outcome outcome = MHB_ARCLENGTH_ON;
  while (outcome == MHB_ARCLENGTH_ON && w.n_points++ < 2000) {
    outcome  = mhb_arclength_step(path);
    w.worst  = fmax(w.worst, path->next.residual);
    double a = path->current.tangent[path->n], b = path->next.tangent[path->n];
    if (a * b < 0 && w.n_folds < MAX_FOLDS) {
      assert_int_equal(mhb_arclength_locate(path, turning, NULL, a, b, 0, &at), 1);
      w.fold[w.n_folds++] = path->trial.value;
    }
    mhb_arclength_advance(path);
  }
  assert_int_equal(outcome, direction > 0 ? MHB_ARCLENGTH_AT_END : MHB_ARCLENGTH_AT_START);
  w.end = path->current.value;
  mhb_newton_destroy(newton);
  mhb_arclength_destroy(path);
  return w;
}

/* Both directions end exactly on the range and turn at the same places. */
static void both_directions_see_the_same_folds(void **state) {
  (void)state;
  static const struct {
    double n0, force;
    int    normal;
  } rows[] = {{-4.5, 0.1, 1}, {1, 0.06, 1}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(0.02, 0, rows[i].force, &model);
    mhb_settings s = ground(rows[i].n0, 15, 0.5, 3.6);
    mhb_balance *residual;
    s.kv = 9;
    assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
    mhb_balance_set_preload(residual, rows[i].n0);
    walked up = walk(residual, 0.5, 3.6, 1), down = walk(residual, 0.5, 3.6, -1);
    print_message("%d and %d points, folds %.9f %.9f and %.9f %.9f\n", up.n_points, down.n_points,
                  up.fold[0], up.fold[1], down.fold[1], down.fold[0]);
    assert_true(up.end == 3.6 && down.end == 0.5);
    assert_int_equal(up.n_folds, 2);
    assert_int_equal(down.n_folds, 2);
    for (int k = 0; k < 2; k++) assert_below(fabs(up.fold[k] - down.fold[1 - k]), 1e-7);
    assert_below(fmax(up.worst, down.worst), 1e-8);
    mhb_balance_destroy(residual);
    modal_model_free(&model);
  }
}

/* ---- limits of the settings ---- */

static void a_branch_cut_short_says_why(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s  = ground(0.3, 3, 0.8, 1.7);
  s.max_points    = 20;
  mhb_response *r = sweep(&model, &s, SHB_NOT_CONVERGED);
  mhb_branch   *b = &r->branch[2];
  assert_has(b->reason, "mhb.max_points reached: 2");
  assert_false(b->complete);
  assert_true(b->n_points >= 20 && b->n_points <= 20 + 16);
  assert_true(r->branch[0].complete && r->branch[1].complete);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

/* An undamped mode, driven exactly at its own frequency, meets the contact. The solution there is
 * that of a frequency next to it. */
static void at_a_resonance_is_as_beside(void **state) {
  (void)state;
  static const double aside[] = {0, -1e-7, 1e-7};
  modal_model         model;
  one_degree_model(0, 0, 0.1, &model);
  mhb_settings s     = ground(-1, 3, 1, 1.5);
  model.frequency[0] = s.frequency[0] = 0.25; /* the same in every rounding */
  mhb_balance *residual;
  mhb_newton  *newton;
  int          iterations;
  assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
  newton = mhb_newton_create(residual->n);
  mhb_balance_set_preload(residual, -1);
  double x[3][residual->n];
  for (int i = 0; i < 3; i++) {
    assert_int_equal(mhb_first_solution(newton, residual, SHB_TWO_PI * 0.25 * (1 + aside[i]), 1e-10,
                                        x[i], &iterations),
                     MHB_CONVERGED);
    for (int j = 0; j < residual->n; j++) assert_below(fabs(x[i][j] - x[0][j]), 1e-5);
  }
  print_message("at a resonance: %.6f\n", mhb_norm(x[0], residual->n));
  assert_true(mhb_norm(x[0], residual->n) > 0.1 && mhb_norm(x[0], residual->n) < 10);
  mhb_newton_destroy(newton);
  mhb_balance_destroy(residual);
  modal_model_free(&model);
}

/* Friction alone damps. Harmonic 2 is exactly at the resonance at the low end of the range, and
 * harmonic 1 in its middle. The stuck contact moves by F/(k + ku - w^2), and the open one by as
 * much as at a frequency next to it. The curve between is bounded. */
static void undamped_resonances_are_passed(void **state) {
  (void)state;
  modal_model model;
  one_degree_model(0, 1, 0.1, &model);
  mhb_settings s          = ground(0.3, 5, 1, 2);
  model.frequency[0]      = 0.25; /* the same in every rounding */
  s.frequency[0]          = 0.125;
  s.frequency[1]          = 0.375;
  mhb_response     *r     = sweep(&model, &s, SHB_OK);
  const mhb_branch *stuck = &r->branch[1], *open = &r->branch[0], *curve = &r->branch[2];
  double            top = 0, k = 0.25 * SHB_PI * SHB_PI;
  int               K = curve->n_harmonics + 1, seen = 0;
  for (int p = 0; p < open->n_points; p++) top = fmax(top, cabs(open->motion[(p * 3 + 1) * K + 1]));
  for (int p = 0; p < stuck->n_points; p++) {
    double w = SHB_TWO_PI * stuck->frequency[p], u = cabs(stuck->motion[(p * 3 + 1) * K + 1]);
    assert_below(fabs(u * fabs(k + 0.5 - w * w) / 0.1 - 1), 1e-6);
    seen += stuck->frequency[p] == 0.25;
  }
  assert_int_equal(seen, 1);
  assert_true(top > 1e6 * 0.1 / k && isfinite(top));
  top = 0;
  for (int p = 0; p < curve->n_points; p++)
    top = fmax(top, cabs(curve->motion[(p * 3 + 1) * K + 1]));
  print_message("undamped: %d points, largest motion %.3f\n", curve->n_points, top);
  assert_true(top > 0.12 / 0.5 && top < 10);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static void a_norm_tells_what_is_not_a_number(void **state) {
  (void)state;
  double x[2] = {NAN, NAN}, y[2] = {0, NAN}, big[2] = {3e200, 4e200};
  assert_true(isnan(mhb_norm(x, 2)));
  assert_true(isnan(mhb_norm(y, 2)));
  assert_below(fabs(mhb_norm(big, 2) / 5e200 - 1), 1e-15);
}

/* A motion that overflowed is returned as such, soon. */
static void a_motion_that_is_no_number_ends(void **state) {
  (void)state;
  static const double bad[] = {NAN, INFINITY, -INFINITY, 1e308};
  modal_model         model;
  three_degree_model(&model);
  mhb_settings s = ground(0.3, 3, 0.8, 1.7);
  mhb_balance *residual;
  assert_int_equal(mhb_balance_create(&model, &s, &residual), SHB_OK);
  mhb_balance_set_preload(residual, 0.3);
  double x[residual->n], r[residual->n];
  for (int i = 0; i < residual->n; i++)
    for (int k = 0; k < 4; k++) {
      for (int j = 0; j < residual->n; j++) x[j] = 0.3 / (1 + j % 7);
      x[i] = bad[k];
      mhb_balance_evaluate(residual, x, 1.1, r, NULL, NULL);
      assert_false(isfinite(mhb_norm(r, residual->n)) && k < 3);
    }
  mhb_balance_destroy(residual);
  modal_model_free(&model);
}

/* No excitation, no resonance, no damping: nothing special. */
static void dull_ranges_are_covered(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings  s = ground(0.02, 3, 0.2, 0.5);
  mhb_response *r = sweep(&model, &s, SHB_OK);
  print_message("no resonance: %d points\n", r->branch[2].n_points);
  assert_true(r->branch[2].complete && r->branch[2].n_points < 200);
  mhb_response_destroy(r);
  for (int i = 0; i < 3; i++) model.damping_ratio[i] = 0;
  r = sweep(&model, &s, SHB_OK);
  print_message("no damping: %d points\n", r->branch[2].n_points);
  assert_true(r->branch[2].complete && r->branch[2].n_points < 200);
  mhb_response_destroy(r);
  modal_model_free(&model);
}

static void without_excitation_all_is_still(void **state) {
  (void)state;
  static const double n0[] = {0.3, 0, -0.3};
  modal_model         model;
  random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 9, &model);
  for (int i = 0; i < 3; i++) {
    mhb_settings s  = random_settings(3);
    s.scale         = 0;
    s.n0[0]         = n0[i];
    s.frequency[0]  = 0.1;
    s.frequency[1]  = 0.3;
    mhb_response *r = sweep(&model, &s, SHB_OK);
    for (int b = 0; b < 3; b++)
      for (int p = 0; p < r->branch[b].n_points * 2 * 3 * 4; p++) {
        assert_true(cabs(r->branch[b].motion[p]) == 0);
        assert_true(cabs(r->branch[b].probe[p]) == 0);
      }
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
}

/* ---- changes without effect ---- */

enum { M = 5, UNKNOWNS = 3 * (2 * M + 1) };

static double difference(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(a, n);
}

static void preloads_about_zero_agree(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  for (int w = 0; w < 4; w++) {
    static const double n0[] = {0, 1e-12, -1e-12}, omega[] = {0.85, 0.95, 1.3, 1.6};
    double              x[3][UNKNOWNS];
    for (int i = 0; i < 3; i++) {
      mhb_settings s = ground(n0[i], M, 0.8, 1.7);
      cold_solution(&model, &s, omega[w], 1e-12, x[i]);
    }
    print_message("at %.2f: %.1e %.1e\n", omega[w], difference(x[0], x[1], UNKNOWNS),
                  difference(x[0], x[2], UNKNOWNS));
    assert_below(difference(x[0], x[1], UNKNOWNS), 1e-6);
    assert_below(difference(x[0], x[2], UNKNOWNS), 1e-6);
  }
  modal_model_free(&model);
}

/* mu = 0: the tangential stiffness has no effect. mu huge: friction never slips while closed. */
static void extreme_friction(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s = ground(0.2, M, 0.8, 1.7);
  double       x[2][UNKNOWNS];
  s.mu = 0;
  cold_solution(&model, &s, 1.1, 1e-12, x[0]);
  s.ku[0] = s.ku[2] = 7;
  cold_solution(&model, &s, 1.1, 1e-12, x[1]);
  assert_below(difference(x[0], x[1], UNKNOWNS), 1e-10);
  s    = ground(0.2, M, 0.8, 1.7);
  s.mu = 1e6;
  cold_solution(&model, &s, 1.1, 1e-12, x[0]);
  s.mu = 2e6;
  cold_solution(&model, &s, 1.1, 1e-12, x[1]);
  print_message("mu 1e6 and 2e6: %.1e\n", difference(x[0], x[1], UNKNOWNS));
  assert_below(difference(x[0], x[1], UNKNOWNS), 1e-4);
  for (int i = 0; i < 2; i++) {
    s               = ground(0.2, 3, 0.8, 1.7);
    s.mu            = i ? 1e6 : 0;
    mhb_response *r = sweep(&model, &s, SHB_OK);
    print_message("mu %g: %d points\n", s.mu, r->branch[2].n_points);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
}

/* In the frequency, and in the excitation from rest, where no motion gives a unit. */
static void units_do_not_matter(void **state) {
  (void)state;
  for (int from_rest = 0; from_rest < 2; from_rest++) {
    mhb_response *r[2];
    mhb_settings  s = random_settings(4);
    s.engine_order  = 2;
    s.n0[0]         = 0.1;
    s.frequency[0]  = 0.9 / SHB_TWO_PI;
    s.frequency[1]  = (from_rest ? 0.9 : 1.2) / SHB_TWO_PI;
    s.parameter     = from_rest ? MHB_IN_SCALE : MHB_IN_FREQUENCY;
    s.range[1]      = 3;
    modal_model model;
    random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS | WITH_AREAS, 55, &model);
    r[0] = sweep(&model, &s, SHB_OK);
    model_in_micrometres(&model, &s);
    r[1]                = sweep(&model, &s, SHB_OK);
    const mhb_branch *a = &r[0]->branch[2], *b = &r[1]->branch[2];
    print_message("m and um: %d and %d points", a->n_points, b->n_points);
    assert_int_equal(a->n_points, b->n_points);
    double worst = 0, size = 0;
    for (int p = 0; p < a->n_points; p++)
      worst = fmax(worst, fabs(a->value[p] - b->value[p]) / a->value[a->n_points - 1]);
    assert_below(worst, 1e-9);
    worst = 0;
    for (int p = 0; p < a->n_points * 6 * 5; p++) {
      size  = fmax(size, cabs(a->motion[p]));
      worst = fmax(worst, cabs(a->motion[p] - 1e-6 * b->motion[p]));
    }
    print_message(", %.1e\n", worst / size);
    assert_below(worst / size, 1e-9);
    mhb_response_destroy(r[0]);
    mhb_response_destroy(r[1]);
    modal_model_free(&model);
  }
}

/* ---- threads, signals, disks ---- */

static void assert_same_branch(const mhb_response *r, const mhb_branch *a, const mhb_branch *b) {
  size_t n = (size_t)a->n_points, K = (size_t)r->n_harmonics + 1, pairs = (size_t)r->n_pairs;
  size_t probes = (size_t)r->n_probes;
  assert_int_equal(a->n_points, b->n_points);
  assert_string_equal(a->reason, b->reason);
  assert_memory_equal(a->frequency, b->frequency, n * sizeof(double));
  assert_memory_equal(a->n0, b->n0, n * sizeof(double));
  assert_memory_equal(a->motion, b->motion, n * pairs * 3 * K * sizeof(double complex));
  assert_memory_equal(a->force, b->force, n * pairs * 3 * K * sizeof(double complex));
  assert_memory_equal(a->probe, b->probe, n * probes * 3 * K * sizeof(double complex));
  assert_memory_equal(a->special, b->special, n * sizeof(int));
  assert_memory_equal(a->dissipation, b->dissipation, n * pairs * sizeof(double));
  assert_memory_equal(a->error_truncation, b->error_truncation, n * sizeof(double));
}

static void threads_do_not_matter(void **state) {
  (void)state;
  modal_model   model;
  mhb_response *r[2];
  mhb_settings  s = ground(-0.2, 5, 0.8, 1.7);
  three_degree_model(&model);
  s.n_preloads = 6;
  for (int i = 0; i < 6; i++) s.n0[i] = -0.2 + 0.15 * i;
  int before = omp_get_max_threads();
  for (int i = 0; i < 2; i++) {
    omp_set_num_threads(i + 1);
    r[i] = sweep(&model, &s, SHB_OK);
  }
  omp_set_num_threads(before);
  for (int b = 0; b < 8; b++) assert_same_branch(r[0], &r[0]->branch[b], &r[1]->branch[b]);
  for (int i = 0; i < 6; i++) assert_true(r[0]->branch[2 + i].n0[0] == s.n0[i]);
  mhb_response_destroy(r[0]);
  mhb_response_destroy(r[1]);
  modal_model_free(&model);
}

/* Interrupted from the start: the file is complete, with the linear limits, and notes the
 * interruption. It runs in its own process, since the flag stays. */
static int interrupted_sweep(const char *path) {
  modal_model    model;
  mhb_response  *r = NULL, *back = NULL;
  mhb_settings   s          = ground(0.3, 3, 0.8, 1.7);
  shb_provenance provenance = {0};
  three_degree_model(&model);
  s.n_preloads = 3;
  s.n0[1]      = 0.1;
  s.n0[2]      = -0.1;
  shb_interrupt_catch();
  raise(SIGINT);
  if (mhb_forced_response(&model, &s, path, &provenance, NULL, &r) != SHB_INTERRUPTED) return 1;
  if (mhb_response_read(path, &back) != SHB_OK) return 2;
  if (back->n_branches != 5 || !back->branch[0].complete || back->branch[3].complete) return 3;
  mhb_response_destroy(r);
  mhb_response_destroy(back);
  modal_model_free(&model);
  return 0;
}

static void an_interrupt_saves(void **state) {
  (void)state;
  char  path[64];
  int   status;
  pid_t child;
  snprintf(path, sizeof path, "interrupted_%d.response.h5", (int)getpid());
  fflush(NULL);
  child = fork(); /* no OpenMP thread is there yet */
  if (child == 0) _exit(interrupted_sweep(path));
  assert_int_equal(waitpid(child, &status, 0), child);
  remove(path);
  assert_true(WIFEXITED(status));
  assert_int_equal(WEXITSTATUS(status), 0);
}

/* A folder that does not exist. The message comes from another thread than the one that fails. */
static void a_failed_write_is_told(void **state) {
  (void)state;
  modal_model    model;
  mhb_response  *r          = NULL;
  shb_provenance provenance = {0};
  mhb_settings   s          = ground(0.3, 15, 0.8, 1.7);
  three_degree_model(&model);
  s.n_preloads = 8;
  for (int i = 0; i < 8; i++) s.n0[i] = 0.05 * i;
  assert_int_equal(mhb_forced_response(&model, &s, "no/such/folder.h5", &provenance, NULL, &r),
                   SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "no/such/folder.h5"));
  assert_null(r);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_interrupt_saves), /* first: it forks */
      cmocka_unit_test(both_directions_see_the_same_folds),
      cmocka_unit_test(a_branch_cut_short_says_why),
      cmocka_unit_test(at_a_resonance_is_as_beside),
      cmocka_unit_test(undamped_resonances_are_passed),
      cmocka_unit_test(a_norm_tells_what_is_not_a_number),
      cmocka_unit_test(a_motion_that_is_no_number_ends),
      cmocka_unit_test(dull_ranges_are_covered),
      cmocka_unit_test(without_excitation_all_is_still),
      cmocka_unit_test(preloads_about_zero_agree),
      cmocka_unit_test(extreme_friction),
      cmocka_unit_test(units_do_not_matter),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(a_failed_write_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
