/* The truncation estimate against the error it estimates: the difference to 31 harmonics at the
 * same frequency. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/branches/forced_response.h"
#include "mhb/continuation/first_solution.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { FINE = 31, MAX_RATIOS = 2000 };

/* Estimate over error at the points of a curve. */
typedef struct {
  double ratio[MAX_RATIOS], worst; /* worst true error */
  int    n, lost;
} comparison;

typedef struct {
  mhb_balance    *residual;
  mhb_newton     *newton;
  mhb_truncation *truncation;
} workspace;

static void workspace_create(const modal_model *model, const mhb_settings *s, workspace *out) {
  assert_int_equal(mhb_balance_create(model, s, &out->residual), SHB_OK);
  mhb_balance_set_preload(out->residual, s->n0[0]);
  out->newton = mhb_newton_create(out->residual->n);
  assert_int_equal(mhb_truncation_create(out->residual, &out->truncation), SHB_OK);
}

static void workspace_destroy(workspace *s) {
  mhb_truncation_destroy(s->truncation);
  mhb_newton_destroy(s->newton);
  mhb_balance_destroy(s->residual);
}

/* Motion of one pair at a point in real form, [3][2 FINE + 1]. */
static void fine_solution(const mhb_branch *b, int point, double *x) {
  for (int c = 0; c < 3; c++)
    mhb_to_real(FINE, b->motion + ((size_t)point * 3 + (size_t)c) * (FINE + 1),
                x + c * mhb_real_size(FINE));
}

/* |x - fine|/|fine|, x of nb coefficients a row. */
static double distance(const double *x, int nb, const double *fine) {
  int    wide = mhb_real_size(FINE);
  double sum  = 0;
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < wide; i++) sum += pow((i < nb ? x[c * nb + i] : 0) - fine[c * wide + i], 2);
  return sqrt(sum) / mhb_norm(fine, 3 * wide);
}

/* What the estimate says before it counts the tail of the spectrum (test_truncation_norms). */
static double distance_told(const mhb_truncation *t) {
  return hypot(mhb_norm(t->step, t->doubled->n), t->higher_size);
}

/* Near a fold the error at fixed frequency goes with the root of the shift of the curve. */
static int near_fold(const mhb_branch *b, int point) {
  for (int i = 0; i < b->n_points; i++)
    if (b->special[i] == MHB_FOLD &&
        fabs(b->frequency[i] - b->frequency[point]) < 2e-3 * b->frequency[point])
      return 1;
  return 0;
}

/* Points near folds, or all others. */
static void compare(workspace *s, const mhb_branch *b, int folds, comparison *out) {
  mhb_balance *r  = s->residual;
  int          nb = r->nb, iterations;
  double       x[3 * nb], fine[3 * mhb_real_size(FINE)];
  *out = (comparison){.n = 0};
  for (int p = 0; p < b->n_points && out->n < MAX_RATIOS; p++) {
    double omega = SHB_TWO_PI * b->frequency[p];
    if (near_fold(b, p) != folds) continue;
    fine_solution(b, p, fine);
    for (int c = 0; c < 3; c++)
      memcpy(x + c * nb, fine + c * mhb_real_size(FINE), sizeof(double) * (size_t)nb);
    double error = NAN;
    if (mhb_newton_solve(s->newton, r, omega, 1e-11, x, &iterations) == MHB_CONVERGED)
      error = distance(x, nb, fine);
    if (!(error < .2)) { /* another branch, or none at so few harmonics */
      out->lost++;
      continue;
    }
    mhb_balance_evaluate(r, x, omega, s->newton->r, NULL, NULL);
    mhb_truncation_error(s->truncation, x);
    double estimate = distance_told(s->truncation) / mhb_balance_vibration(r, x);
    out->worst      = fmax(out->worst, error);
    if (fmax(error, estimate) > 1e-7) out->ratio[out->n++] = estimate / error; /* else: noise */
  }
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* There the other solution may be met, or none. */
static void check_folds(comparison *seen) {
  if (seen->n == 0) return;
  qsort(seen->ratio, (size_t)seen->n, sizeof(double), ascending);
  double middle = seen->ratio[seen->n / 2];
  print_message(
      "near folds %3d points (%d lost), true error to %.1e, estimate/error %.2f to %.2f, median "
      "%.2f\n",
      seen->n, seen->lost, seen->worst, seen->ratio[0], seen->ratio[seen->n - 1], middle);
  assert_true(middle > .5 && middle < 1.3);
  assert_true(seen->ratio[0] > .08 && seen->ratio[seen->n - 1] < 15);
}

/* With 31 harmonics little is left out, at folds as elsewhere: there a Newton step alone would go
 * any distance. */
static void check_finest(const char *name, const mhb_branch *b) {
  double worst = 0, at_folds = 0;
  for (int i = 0; i < b->n_points; i++) {
    worst = fmax(worst, b->error_truncation[i]);
    if (b->special[i] == MHB_FOLD) at_folds = fmax(at_folds, b->error_truncation[i]);
  }
  print_message("%-12s H 31: estimates to %.1e, at folds %.1e\n", name, worst, at_folds);
  assert_true(worst < 1e-2);
}

static void check_curve(const char *name, const modal_model *model, mhb_settings s, double from,
                        double to) {
  static const int  H[] = {5, 7, 9, 13};
  static comparison seen, folds;
  mhb_response     *r;
  s.frequency[0] = from / SHB_TWO_PI;
  s.frequency[1] = to / SHB_TWO_PI;
  assert_int_equal(mhb_forced_response(model, &s, NULL, NULL, NULL, &r), SHB_OK);
  check_finest(name, &r->branch[2]);
  for (int h = 0; h < 4; h++) {
    workspace at;
    s.harmonics = H[h];
    workspace_create(model, &s, &at);
    compare(&at, &r->branch[2], 1, &folds);
    compare(&at, &r->branch[2], 0, &seen);
    workspace_destroy(&at);
    check_folds(&folds);
    qsort(seen.ratio, (size_t)seen.n, sizeof(double), ascending);
    assert_true(seen.n >= 20);
    double low = seen.ratio[0], middle = seen.ratio[seen.n / 2],
           high = seen.ratio[seen.n * 19 / 20];
    print_message(
        "%-12s H %2d: %3d points (%d lost), true error to %.1e, estimate/error %.2f to "
        "%.2f, median %.2f, at 95 %% %.2f\n",
        name, H[h], seen.n, seen.lost, seen.worst, low, seen.ratio[seen.n - 1], middle, high);
    assert_true(seen.lost <= seen.n / 50);
    /* never optimistic by more than two */
    assert_true(low > .5);
    assert_true(fabs(middle - 1) < .1);
    assert_true(high < 1.6);
  }
  mhb_response_destroy(r);
}

static void three_degrees(void **state) {
  (void)state;
  static const double n0[] = {-.2, 0, .1, .3};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    char name[32];
    snprintf(name, sizeof name, "n0 %.1f", n0[i]);
    check_curve(name, &model, ground_settings(.4, .8, .5, n0[i], FINE), .8, 1.7);
  }
  modal_model_free(&model);
}

/* Twenty modes: harmonics beyond 2m meet resonances. */
static void beam(void **state) {
  (void)state;
  static const double force[] = {8, 20};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    char        name[32];
    tip_contact_beam_model(force[i], &model);
    snprintf(name, sizeof name, "beam F %g", force[i]);
    check_curve(name, &model, ground_settings(.3, 2e5, 2e5, 100, FINE), SHB_TWO_PI * 215,
                SHB_TWO_PI * 320);
    modal_model_free(&model);
  }
}

static void jumps(void **state) {
  (void)state;
  static const double rows[2][2] = {{-4.5, .1}, {1, .06}};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(.02, 0, rows[i][1], &model);
    check_curve(i ? "jump B" : "jump A", &model, ground_settings(0, 9, 1, rows[i][0], FINE), .5,
                3.6);
    modal_model_free(&model);
  }
}

/* x + delta is a better start for twice the harmonics than x. */
static void step_leads_on(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings s = ground_settings(.4, .8, .5, .3, 5);
  workspace    narrow, wide;
  int          iterations;
  workspace_create(&model, &s, &narrow);
  mhb_balance *b = narrow.residual;
  double       x[b->n], omega = 1.42;
  assert_int_equal(mhb_first_solution(narrow.newton, b, omega, 1e-11, x, &iterations),
                   MHB_CONVERGED);
  mhb_balance_evaluate(b, x, omega, narrow.newton->r, NULL, NULL);
  mhb_truncation_error(narrow.truncation, x);
  s.harmonics = 10;
  workspace_create(&model, &s, &wide);
  int    n = wide.residual->n;
  double before[n], after[n];
  for (int i = 0; i < n; i++) narrow.truncation->step[i] += narrow.truncation->x[i];
  mhb_balance_evaluate(wide.residual, narrow.truncation->x, omega, before, NULL, NULL);
  mhb_balance_evaluate(wide.residual, narrow.truncation->step, omega, after, NULL, NULL);
  print_message("residual %.1e before the step, %.1e after\n", mhb_norm(before, n),
                mhb_norm(after, n));
  assert_true(mhb_norm(after, n) < .1 * mhb_norm(before, n));
  workspace_destroy(&narrow);
  workspace_destroy(&wide);
  modal_model_free(&model);
}

/* Which kind of estimate it was: none needed when stuck throughout, of first order for many moving
 * unknowns of few pairs. Many pairs have no such limit. */
static void kinds(void **state) {
  (void)state;
  static const struct {
    int                 pairs, harmonics;
    double              n0;
    mhb_truncation_kind kind;
  } rows[] = {{1, 5, 1e4, MHB_TRUNCATION_NONE},
              {1, 5, .3, MHB_TRUNCATION_NEWTON},
              {12, 5, .3, MHB_TRUNCATION_NEWTON},
              {12, 21, .3, MHB_TRUNCATION_NEWTON},
              {7, 41, .3, MHB_TRUNCATION_FIRST_ORDER}};
  for (int i = 0; i < 5; i++) {
    modal_model  model;
    mhb_settings s = ground_settings(.4, .8, .5, rows[i].n0, rows[i].harmonics);
    random_model(rows[i].pairs, 0, 5, &model);
    workspace at;
    workspace_create(&model, &s, &at);
    mhb_balance *b = at.residual;
    double       x[b->n], r[b->n];
    memset(x, 0, sizeof x);
    for (int row = 0; row < 3 * b->n_pairs; row++) x[row * b->nb + 1] = 1 + .1 * row;
    mhb_balance_evaluate(b, x, 1.23, r, NULL, NULL);
    double error = mhb_truncation_error(at.truncation, x);
    print_message("%2d pairs, n0 %g: kind %d, %.2e\n", rows[i].pairs, rows[i].n0,
                  at.truncation->kind, error);
    assert_int_equal(at.truncation->kind, rows[i].kind);
    assert_true(rows[i].kind == MHB_TRUNCATION_NONE ? error == 0 : error > 0);
    workspace_destroy(&at);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_degrees), cmocka_unit_test(beam),  cmocka_unit_test(jumps),
      cmocka_unit_test(step_leads_on), cmocka_unit_test(kinds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
