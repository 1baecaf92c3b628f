/* The maximum of every resonance is located to 1e-6 of its frequency, not only at the points of the
 * curve. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "mhb/continuation/balance_curve.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

static double amplitude(mhb_arclength *path, const mhb_curve_point *point, int c) {
  int nb = mhb_curve_balance(path)->nb;
  return hypot(point->x[c * nb + 1], point->x[c * nb + 2]);
}

/* Relative distance in w of the top of a parabola through a point and its neighbours on the path. A
 * step is 1e-4 of |x| and of the contribution of w. INFINITY: a neighbour is higher or cannot be
 * reached. */
static double off_parabola(mhb_balance *b, const double *x, double w, int c, double part) {
  double a[3], at[3];
  for (int k = 0; k < 2; k++) {
    mhb_arclength *path;
    path       = mhb_balance_curve_create(b, (1 - part) * w, (1 + part) * w);
    int ok     = mhb_arclength_start(path, x, w, k ? 1 : -1) == MHB_CONVERGED;
    a[1]       = amplitude(path, &path->current, c);
    path->step = 1e-4;
    ok         = ok && mhb_arclength_step(path) != MHB_ARCLENGTH_STALLED;
    a[2 * k]   = ok ? amplitude(path, &path->next, c) : INFINITY;
    at[2 * k]  = path->next.value;
    mhb_arclength_destroy(path);
  }
  double bend = a[0] - 2 * a[1] + a[2], tiny = 1e-13 * a[1];
  if (a[0] > a[1] + tiny || a[2] > a[1] + tiny || !(bend < 0)) return INFINITY;
  return fabs(.25 * (at[2] - at[0]) * (a[0] - a[2]) / bend) / w;
}

/* Relative distance in w of the highest of the points within a few tiny steps. INFINITY: it is the
 * last one. For kinks. */
static double off_highest(mhb_balance *b, const double *x, double w, int c) {
  enum { STEPS = 6 };
  double top = -INFINITY, at = INFINITY;
  for (int k = 0; k < 2; k++) {
    mhb_arclength *path;
    path   = mhb_balance_curve_create(b, .999 * w, 1.001 * w);
    int ok = mhb_arclength_start(path, x, w, k ? 1 : -1) == MHB_CONVERGED;
    for (int i = 0; i <= STEPS && ok; i++) {
      if (amplitude(path, &path->current, c) > top) {
        top = amplitude(path, &path->current, c);
        at  = i == STEPS ? INFINITY : path->current.value;
      }
      path->step = 1e-4;
      ok         = mhb_arclength_step(path) != MHB_ARCLENGTH_STALLED;
      mhb_arclength_advance(path);
    }
    mhb_arclength_destroy(path);
  }
  return fabs(at / w - 1);
}

/* The smaller of the narrow estimate, which holds at kinks, and the wide one, where round-off is
 * harmless. */
static double off_top(mhb_balance *b, const double *x, double w, int c) {
  double best = off_highest(b, x, w, c);
  for (double part = .001; part < .5; part *= 4) best = fmin(best, off_parabola(b, x, w, c, part));
  return best;
}

static void check(const modal_model *model, mhb_settings *s, double from, double to,
                  const char *name) {
  mhb_balance  *b;
  mhb_response *r        = covered_sweep(model, s, from, to);
  int           unmarked = 0, tops = 0;
  double        worst = 0;
  assert_int_equal(mhb_balance_create(model, s, &b), SHB_OK);
  mhb_balance_set_preload(b, s->n0[0]);
  const mhb_branch *branch = &r->branch[2];
  double            x[b->n];
  for (int c = 0; c < 3; c++)
    for (int i = 1; i + 1 < branch->n_points; i++) {
      double here = harmonic_of(r, branch, i, c, 1);
      if (here < 1e-9 || here <= harmonic_of(r, branch, distinct(branch, i, -1), c, 1) ||
          here <= harmonic_of(r, branch, distinct(branch, i, 1), c, 1))
        continue;
      tops++;
      unmarked += branch->special[i] != MHB_PEAK;
      double off = INFINITY, w = SHB_TWO_PI * branch->frequency[i];
      for (int k = i - 2; k <= i + 2;
           k++) { /* at a kink Newton may not start from the point itself */
        if (k < 0 || k >= branch->n_points) continue;
        double shift = fabs(branch->frequency[k] / branch->frequency[i] - 1);
        if (shift > 1e-7) continue;
        point_of(r, branch, k, 0, x);
        off = fmin(off, shift + off_top(b, x, w * branch->frequency[k] / branch->frequency[i], c));
      }
      if (off > 1e-6)
        print_message("  %s: %c at %.7f is %.1e off, special %d, stuck %.4f\n", name, "vuw"[c],
                      SHB_TWO_PI * branch -> frequency[i], off, branch -> special[i],
                      branch -> state[3 * i]);
      worst = fmax(worst, off);
    }
  verdict_count(unmarked, 0, "peaks of %s: %d of v, u, w; not located", name, tops);
  verdict(worst, 1e-6, "peaks of %s: distance from the top", name);
  mhb_balance_destroy(b);
  mhb_response_destroy(r);
}

static void peaks(void **state) {
  (void)state;
  static const double n0[] = {-.2, 0, .1, .3, .5, .8, 1};
  modal_model         model;
  char                name[40];
  three_degree_model(&model);
  for (int i = 0; i < 7; i++) {
    mhb_settings s = ground_settings(.4, .8, .5, n0[i], 7);
    snprintf(name, sizeof name, "three degrees, n0 %.1f", n0[i]);
    check(&model, &s, .8, 1.7, name);
  }
  modal_model_free(&model);
  for (int i = 0; i < 2; i++) {
    one_degree_model(.02, 0, i ? .06 : .1, &model);
    mhb_settings s = ground_settings(0, 9, 1, i ? 1 : -4.5, 31);
    check(&model, &s, .5, 3.6, i ? "B" : "A");
    modal_model_free(&model);
  }
  for (int i = 0; i < 2; i++) {
    tip_contact_beam_model(i ? 20 : 8, &model);
    mhb_settings s = ground_settings(.3, 2e5, 2e5, 100, 7);
    check(&model, &s, SHB_TWO_PI * 215, SHB_TWO_PI * 320, i ? "beam, F 20" : "beam, F 8");
    modal_model_free(&model);
  }
  one_degree_model(.01, 1, .8, &model);
  mhb_settings s = ground_settings(1, 1, 1, 1, 15);
  check(&model, &s, .6, 2, "friction oscillator");
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(peaks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
