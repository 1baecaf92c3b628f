/* Corners of several contact pairs. A smooth peak goes over into the corner of one pair, and that
 * into a peak with one slipping pair less. Every peak is that of a sweep. */
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/contact/law.h"
#include "mhb/tracking/tracked_response.h"
#include "tests/support/check.h"
#include "tests/support/main_curve.h"
#include "tests/support/random_model.h"

enum { H = 5 };

static const double STICKS = 0.998;

typedef struct {
  modal_model   model;
  mhb_settings  settings;
  mhb_response *tracked;
} fixture;

static void follow(fixture *f, int n_pairs, unsigned long long seed, double low, double high) {
  shb_progress quiet = shb_progress_start("mhb", true, false);
  random_model(n_pairs, WITH_LEFT, seed, &f->model);
  f->settings              = random_settings(H);
  f->settings.frequency[0] = 0.85 / SHB_TWO_PI;
  f->settings.frequency[1] = 1.6 / SHB_TWO_PI;
  f->settings.tolerance    = 1e-10;
  f->settings.stability    = MHB_STABILITY_NEVER;
  f->settings.track        = MHB_TRACK_PEAKS;
  f->settings.parameter    = MHB_IN_N0;
  f->settings.range[0]     = low;
  f->settings.range[1]     = high;
  assert_ok(mhb_tracked_response(&f->model, &f->settings, NULL, NULL, &quiet, &f->tracked));
}

static void tear_down(fixture *f) {
  mhb_response_destroy(f->tracked);
  modal_model_free(&f->model);
}

static mhb_response *sweep_at(const fixture *f, double n0) {
  mhb_response *r;
  mhb_settings  s = f->settings;
  s.n0[0]         = n0;
  s.parameter     = MHB_IN_FREQUENCY;
  s.track         = MHB_TRACK_NOTHING;
  assert_ok(main_curve(&f->model, &s, H, NULL, &r));
  return r;
}

/* Relative differences of a tracked point from the nearest marked peak of a sweep. */
static void compare(const fixture *f, const mhb_branch *t, int point, double *amplitude,
                    double *frequency) {
  mhb_response     *r = sweep_at(f, t->value[point]);
  const mhb_branch *b = &r->branch[0];
  *frequency          = INFINITY;
  for (int i = 0; i < b->n_points; i++) {
    const double away = fabs(b->frequency[i] / t->frequency[point] - 1);
    if (b->special[i] != MHB_PEAK || away >= *frequency) continue;
    *frequency = away;
    *amplitude = fabs(mhb_response_output(f->tracked, t, point) / mhb_response_output(r, b, i) - 1);
  }
  mhb_response_destroy(r);
}

/* How many pairs stick at a point. */
static int stuck_at(const mhb_branch *t, int n_pairs, int point) {
  int n = 0;
  for (int a = 0; a < n_pairs; a++) n += t->state[3 * (point * n_pairs + a) + MHB_STICK] >= STICKS;
  return n;
}

/* Whether two peaks meet near a point: an end of the branch is near. */
static bool is_near_end(const mhb_branch *t, int point) {
  const double value = t->value[point], ends[2] = {t->value[0], t->value[t->n_points - 1]};
  return fmin(fabs(value - ends[0]), fabs(value - ends[1])) < 1e-3 * value;
}

/* Four points of every branch against sweeps. */
static void the_chain_of_two_pairs_is_that_of_sweeps(void **state) {
  (void)state;
  enum { PAIRS = 2 };
  fixture f;
  double  worst = 0, worst_f = 0;
  int     points = 0, least = PAIRS, most = 0;
  follow(&f, PAIRS, 2, 0.3, 1.2);
  for (int b = 0; b < f.tracked->n_branches; b++) {
    const mhb_branch *t    = &f.tracked->branch[b];
    const int         step = t->n_points > 8 ? t->n_points / 4 : 2;
    for (int i = step / 2; i < t->n_points; i += step) {
      if (is_near_end(t, i)) continue;
      double    a = INFINITY, away;
      const int n = stuck_at(t, PAIRS, i);
      compare(&f, t, i, &a, &away);
      print_message("n0 %.6f, %.6f Hz, %d stick: amplitude %.1e, frequency %.1e\n", t->value[i],
                    t->frequency[i], n, a, away);
      points++;
      worst   = fmax(worst, a);
      worst_f = fmax(worst_f, away);
      least   = n < least ? n : least;
      most    = n > most ? n : most;
    }
    print_message("%d points, n0 %.6f to %.6f: %s\n", t->n_points, t->value[0],
                  t->value[t->n_points - 1], t->reason);
  }
  print_message("%d points: amplitude %.1e, frequency %.1e\n", points, worst, worst_f);
  assert_true(f.tracked->n_branches >= 3 && points >= 8);
  assert_true(least == 1 && most == PAIRS);
  assert_below(worst, 1e-6);
  assert_below(worst_f, 1e-6);
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_chain_of_two_pairs_is_that_of_sweeps)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
