/* Continuity along straight paths of motions and laws through every kind of switching. The change
 * of the force harmonics in a step is bounded, and the bound shrinks with the step.
 *
 * Away from the onset of slip the force is Lipschitz: steps eight times as short change it by an
 * eighth. Where slip just begins under a varying load, the mean friction goes like the square root
 * of the distance: the change falls by 1/sqrt(8). A jump would keep the largest change. Changes are
 * relative to the largest force harmonic on the path. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/motion_suite.h"

enum { M = SUITE_HARMONICS, H = 15, NB = SUITE_WIDTH, NF = 2 * H + 1, COARSE = 400, FINER = 8 };

/* Bounds relative to the largest force: change <= LIPSCHITZ step + FLOOR; where slip just begins
 * ONSET sqrt(step) + ONSET_FLOOR, for there 1 - (contraction of a lap) -> 0. */
static const double LIPSCHITZ = 4, FLOOR = 1e-8, ONSET = .5, ONSET_FLOOR = 1e-4;

typedef struct {
  const char  *name;
  suite_motion from, to;
  double       order; /* change ~ step^order */
} path;

typedef struct {
  double           force[3][NF];
  mhb_contact_info info;
} answer;

static mhb_contact_evaluator *contact;

static int make_workspace(void **state) {
  (void)state;
  return mhb_contact_evaluator_create(M, H, 1e-9, &contact) != SHB_OK;
}

static int free_workspace(void **state) {
  (void)state;
  mhb_contact_evaluator_destroy(contact);
  return 0;
}

static double mix(double a, double b, double p) {
  return a + (b - a) * p;
}

static void evaluate(const path *way, double p, answer *a) {
  suite_motion s = way->from;
  for (int i = 0; i < 3 * NB; i++)
    (&s.motion[0][0])[i] = mix((&way->from.motion[0][0])[i], (&way->to.motion[0][0])[i], p);
  s.law.mu = mix(way->from.law.mu, way->to.law.mu, p);
  s.law.n0 = mix(way->from.law.n0, way->to.law.n0, p);
  mhb_contact_force(contact, &s.law, &s.motion[0][0], &a->force[0][0], NULL, &a->info);
}

/* The signature of a solution, which changes at a switch. */
static int signature(const answer *a) {
  const double *share = a->info.share;
  return 8 * a->info.n_transitions + 4 * (share[0] > 0) + 2 * (share[1] > 0) + (share[2] > 0);
}

static double largest(const answer *a) {
  double top = 0;
  for (int j = 0; j < 3 * NF; j++) top = fmax(top, fabs((&a->force[0][0])[j]));
  return top;
}

static double change(const answer *a, const answer *b) {
  double worst = 0;
  for (int j = 0; j < 3 * NF; j++)
    worst = fmax(worst, fabs((&a->force[0][0])[j] - (&b->force[0][0])[j]));
  return worst;
}

/* ---- the paths ---- */

static suite_motion scaled(int i, double factor) {
  suite_motion s = suite_at(i);
  for (int j = 0; j < 3 * NB; j++) (&s.motion[0][0])[j] *= factor;
  return s;
}

static suite_motion with(int i, int axis, int k, double a, double phase) {
  suite_motion s = suite_at(i);
  suite_add(&s, axis, k, a, phase);
  return s;
}

static suite_motion pressed(int i, double mu, double n0) {
  suite_motion s = suite_at(i);
  s.law.mu       = mu;
  s.law.n0       = n0;
  return s;
}

static int suite_index(const char *name) {
  int i = 0;
  while (i < suite_size() && strcmp(suite_at(i).name, name) != 0) i++;
  assert_true(i < suite_size());
  return i;
}

enum { PATHS = 14 };

static void make_paths(path way[PATHS]) {
  int opening = suite_index("opening"), gap = suite_index("gap"), skew = suite_index("skew Ku");
  int three = suite_index("three harmonics"), seven = suite_index("seven harmonics");
  int begun = suite_index("slip just begun"), closed = suite_index("varying ellipse");
  int closing = suite_index("stick on closing"), line = suite_index("one direction");
  const path made[PATHS] = {
      {"stuck to slip", scaled(begun, .5), scaled(begun, 1), .5},
      {"stuck to slip, large turns", scaled(closed, .1), scaled(closed, .4), .5},
      {"stuck to slip, skew Ku", scaled(skew, .1), scaled(skew, .3), .5},
      {"stuck to slip in one direction", scaled(line, .1), scaled(line, .4), 1},
      {"closed to opening", with(opening, 0, 1, -1.3e-4, .9), with(opening, 0, 1, -.7e-4, .9), 1},
      {"gap to closing", with(gap, 0, 1, -2e-4, -.4), suite_at(gap), 1},
      {"second closing", suite_at(three), with(three, 0, 3, 2e-4, 1.2), 1},
      {"some stick to always slip", suite_at(line), with(line, 2, 1, 1.1e-4, -1), 1},
      {"number of slips", suite_at(closed), with(closed, 1, 3, 1.8e-4, .5), 1},
      {"number of slips, opening", suite_at(opening), with(opening, 1, 3, 1.8e-4, .5), 1},
      {"slip or stick on closing", suite_at(closing), pressed(closing, .3, 100), 1},
      {"deep gap to deep stuck", pressed(three, .4, -300), pressed(three, .4, 1200), .5},
      {"deep gap to deep stuck, skew Ku", pressed(seven, .4, -300), pressed(seven, .4, 1500), .5},
      {"friction from nothing", pressed(three, 0, 100), pressed(three, 4, 100), 1},
  };
  memcpy(way, made, sizeof made);
}

/* ---- tests ---- */

/* Largest change over equal steps. */
typedef struct {
  double change, top; /* top: the largest force */
  int    switches;    /* changes of signature */
} walk;

static walk along(const path *way, int steps) {
  static answer now, before;
  walk          w = {0, 0, 0};
  for (int i = 0; i <= steps; i++) {
    evaluate(way, (double)i / steps, &now);
    w.top = fmax(w.top, largest(&now));
    if (i > 0) {
      double step = change(&now, &before);
      if (!(step <= w.change)) w.change = step;
      w.switches += signature(&now) != signature(&before);
    }
    before = now;
  }
  return w;
}

static void changes_shrink_with_the_step(void **state) {
  (void)state;
  static path way[PATHS];
  int         failed = 0;
  make_paths(way);
  for (int i = 0; i < PATHS; i++) {
    walk   coarse = along(&way[i], COARSE), fine = along(&way[i], COARSE * FINER);
    double slope = log(coarse.change / fine.change) / log(FINER), order = way[i].order;
    double bound = order < 1 ? ONSET : LIPSCHITZ;
    int ok = coarse.switches > 0 && coarse.change <= bound * coarse.top * pow(1. / COARSE, order) &&
             fine.change <= bound * fine.top * pow(1. / COARSE / FINER, order);
    if (order == 1) ok &= slope > .95;
    if (ok) continue;
    print_message("%s: %d switches, largest change %.1e, then %.1e: order %.2f\n", way[i].name,
                  coarse.switches, coarse.change / coarse.top, fine.change / fine.top, slope);
    failed++;
  }
  assert_int_equal(failed, 0);
}

/* The signature changes between p and p + step: bisects to one of the changes. */
static double find_switch(const path *way, double p, double step) {
  static answer low, middle;
  double        q = p + step;
  evaluate(way, p, &low);
  while (q - p > 1e-13) {
    double mid = .5 * (p + q);
    evaluate(way, mid, &middle);
    if (signature(&middle) == signature(&low)) {
      p = mid;
    } else {
      q = mid;
    }
  }
  return .5 * (p + q);
}

/* Number of failures at one switch: the change across it, by ever shorter steps, must fall like
 * step^order. */
static int across(const path *way, double p, double top) {
  static answer low, high;
  int           failed = 0;
  for (double w = 1e-3; w > 1e-12; w *= .1) {
    evaluate(way, p - w, &low);
    evaluate(way, p + w, &high);
    int    onset = low.info.undetermined != high.info.undetermined;
    double jump  = change(&low, &high) / top;
    double bound = onset ? ONSET * sqrt(2 * w) + ONSET_FLOOR : LIPSCHITZ * 2 * w + FLOOR;
    if (way->order < 1 && !onset) bound += ONSET * sqrt(2 * w); /* an onset nearby */
    if (jump <= bound) continue;
    print_message("%s at %.13f: %.1e > %.1e across %.0e\n", way->name, p, jump, bound, 2 * w);
    failed++;
  }
  return failed;
}

static void no_jump_at_any_switch(void **state) {
  (void)state;
  static path   way[PATHS];
  static answer low, high;
  int           failed = 0, found = 0;
  make_paths(way);
  for (int i = 0; i < PATHS; i++) {
    double top = along(&way[i], COARSE).top;
    evaluate(&way[i], 0, &low);
    for (int j = 1; j <= COARSE; j++, low = high) {
      evaluate(&way[i], (double)j / COARSE, &high);
      if (signature(&low) == signature(&high)) continue;
      failed += across(&way[i], find_switch(&way[i], (j - 1.) / COARSE, 1. / COARSE), top);
      found++;
    }
  }
  assert_true(found > 40);
  assert_int_equal(failed, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(changes_shrink_with_the_step),
      cmocka_unit_test(no_jump_at_any_switch),
  };
  return cmocka_run_group_tests(tests, make_workspace, free_workspace);
}
