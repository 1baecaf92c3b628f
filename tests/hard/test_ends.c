/* A range that ends within a jump. The curve leaves the range and comes back. Every solution in the
 * range is found, with its stability, as on the curve of a wide range. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

enum { MOST = 8, PLACES = 9 };

typedef struct {
  int    n;
  double amplitude[MOST]; /* ascending */
  int    stable[MOST];
} answers;

static void add(answers *a, double amplitude, int stable) {
  int i = a->n;
  if (a->n == MOST) fail_msg("more than %d solutions", MOST);
  for (; i > 0 && a->amplitude[i - 1] > amplitude; i--) {
    a->amplitude[i] = a->amplitude[i - 1];
    a->stable[i]    = a->stable[i - 1];
  }
  a->amplitude[i] = amplitude;
  a->stable[i]    = stable;
  a->n++;
}

/* Where the curve crosses w, between points. */
static answers crossings(const mhb_response *r, const mhb_branch *b, double w) {
  answers a = {0};
  for (int i = 0; i + 1 < b->n_points; i++) {
    double here = SHB_TWO_PI * b->frequency[i], next = SHB_TWO_PI * b->frequency[i + 1];
    if ((here < w) == (next < w)) continue;
    double share = (w - here) / (next - here), one = harmonic_of(r, b, i, 0, 1),
           two = harmonic_of(r, b, i + 1, 0, 1);
    add(&a, (1 - share) * one + share * two, b->stable[b->special[i] == MHB_FOLD ? i + 1 : i]);
  }
  return a;
}

/* Points on an end of the range. */
static answers at_end(const mhb_response *r, const mhb_branch *b, double w) {
  answers a = {0};
  for (int i = 0; i < b->n_points; i++)
    if (fabs(SHB_TWO_PI * b->frequency[i] - w) < 1e-12 * w)
      add(&a, harmonic_of(r, b, i, 0, 1), b->stable[i]);
  return a;
}

typedef struct {
  const char *name;
  double      F, n0, from, to, end,
      known[3]; /* amplitudes at an end by time integration; 0: not known */
} range;

/* Folds alone prove that a motion is unstable, and never that it is stable. */
static int expected(int stable, int stability) {
  return stable && stability == MHB_STABILITY_NEVER ? -1 : stable;
}

static void check(const range *c, int stability) {
  modal_model model;
  one_degree_model(.02, 0, c->F, &model);
  mhb_settings  s        = ground_settings(0, 9, 1, c->n0, 15);
  mhb_response *wide     = covered_sweep(&model, &s, .5, 3.6);
  s.stability            = stability;
  mhb_response     *r    = covered_sweep(&model, &s, c->from, c->to);
  const mhb_branch *b    = &r->branch[2];
  int               lost = 0, wrong = 0;
  double            away = 0;
  for (int k = 0; k < PLACES; k++) {
    double  w   = c->from + (k + .5) / PLACES * (c->to - c->from);
    answers all = crossings(wide, &wide->branch[2], w), here = crossings(r, b, w);
    lost += abs(all.n - here.n);
    for (int i = 0; i < all.n && all.n == here.n; i++) {
      wrong += here.stable[i] != expected(all.stable[i], stability);
      away = fmax(away, fabs(all.amplitude[i] - here.amplitude[i]));
    }
  }
  const char *by = stability == MHB_STABILITY_NEVER ? "by folds" : "by multipliers";
  verdict_count(lost, 0, "%s %.2f to %.2f: solutions lost or too many", c->name, c->from, c->to);
  verdict_count(wrong, 0, "%s %.2f to %.2f, %s: wrong stability", c->name, c->from, c->to, by);
  verdict(away, 1e-2, "%s %.2f to %.2f: amplitudes, interpolated", c->name, c->from, c->to);
  if (c->known[0] > 0) {
    answers ends = at_end(r, b, c->end);
    verdict_count(ends.n, 3, "%s %.2f to %.2f: solutions at %.2f", c->name, c->from, c->to, c->end);
    for (int i = 0; i < 3 && ends.n == 3; i++) {
      verdict(fabs(ends.amplitude[i] - c->known[i]), 1e-4, "  amplitude");
      verdict_count(ends.stable[i], expected(i != 1, stability), "  stable, %s", by);
    }
  }
  mhb_response_destroy(r);
  mhb_response_destroy(wide);
  modal_model_free(&model);
}

static void inside_a_jump(void **state) {
  (void)state;
  static const range ranges[] = {
      {"A", .1, -4.5, .9, 1.6, 0, {0}},
      {"A", .1, -4.5, .9, 1.3, 1.3, {.144518, .908380, 1.141048}},
      {"A", .1, -4.5, 1.15, 1.6, 0, {0}},
      {"A", .1, -4.5, 1.15, 1.35, 0, {0}},
      {"B", .06, 1, 1.5, 2.9, 0, {0}},
      {"B", .06, 1, 2.3, 3.5, 2.3, {.012736, .432375, .461382}},
      {"B", .06, 1, 2.3, 2.9, 2.3, {.012736, .432375, .461382}},
  };
  for (int i = 0; i < 7; i++) {
    check(&ranges[i], MHB_STABILITY_NEVER);
    check(&ranges[i], MHB_STABILITY_AUTO);
  }
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(inside_a_jump)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
