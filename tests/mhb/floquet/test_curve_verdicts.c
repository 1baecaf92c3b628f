/* Which points of a curve are judged, and what follows for the others. Functions f in closed form
 * stand in place of multipliers. */
#include "mhb/floquet/curve_verdicts.h"

#include <math.h>

#include "tests/support/check.h"

enum { N = 201 };

static double crosses_often(double s) {
  return 0.1 * sin(s / 13) + 0.02;
}

static double stays_inside(double s) {
  return -0.05 - 0.02 * cos(s / 20);
}

/* Touches the circle from inside and stays there. */
static double touches(double s) {
  return -0.001 * fabs(s - 100) - 1e-4;
}

/* Judge as the choice asks until it is done. Returns the number of points judged. */
static int judge(double (*f)(double), mhb_curve_verdict *v, int *decided) {
  int judged = 0, next;
  while (judged < 2 * N && (next = mhb_curve_verdicts_next(N, v)) >= 0) {
    assert_false(v[next].judged || v[next].divides);
    v[next].judged = true;
    v[next].excess = f(next);
    v[next].kind   = f(next) > 0 ? MHB_KIND_MODULATED : MHB_KIND_STABLE;
    judged++;
  }
  mhb_curve_verdicts_decided(N, v, decided);
  return judged;
}

/* Every point ends with its true kind; crossings lie between adjacent judged points. */
static void kinds_are_true(void **state) {
  (void)state;
  static double (*const of[])(double) = {crosses_often, stays_inside, touches};
  for (int k = 0; k < 3; k++) {
    mhb_curve_verdict v[N] = {0};
    int               decided[N], judged = judge(of[k], v, decided);
    for (int i = 0; i < N; i++) {
      mhb_stability_kind wanted = of[k](i) > 0 ? MHB_KIND_MODULATED : MHB_KIND_STABLE;
      assert_true(v[i].judged != (decided[i] >= 0));
      assert_int_equal(v[v[i].judged ? i : decided[i]].kind, wanted);
      if (i > 0 && (of[k](i) > 0) != (of[k](i - 1) > 0))
        assert_true(v[i].judged && v[i - 1].judged);
    }
    print_message("%d of %d judged\n", judged, N);
    assert_true(judged < N / 2);
  }
}

/* Nothing is concluded across a fold, a linear point or a gap, nor beside an undecided point. */
static void divisions_are_kept(void **state) {
  (void)state;
  mhb_curve_verdict v[N] = {0};
  int               decided[N];
  v[50].divides    = true;
  v[90].begins     = true;
  v[120].undecided = true;
  v[133].wanted    = true;
  assert_int_equal(mhb_curve_verdicts_next(N, v), 133);
  judge(stays_inside, v, decided);
  static const int ends[] = {0, 49, 51, 89, 90, 119, 121, 133, N - 1};
  for (int i = 0; i < 9; i++) assert_true(v[ends[i]].judged);
  assert_false(v[50].judged || v[120].judged);
  assert_true(decided[50] < 0 && decided[120] < 0);
  for (int i = 51; i < 90; i++) assert_true(v[i].judged || decided[i] >= 51);
}

/* Two judged points alone: near and well inside decide, far apart or in doubt do not. */
static void doubt_decides_nothing(void **state) {
  (void)state;
  static const struct {
    int    gap;
    double f[2];
    int    decides;
  } rows[] = {{8, {-0.05, -0.05}, 1}, {9, {-0.05, -0.05}, 0}, {4, {-0.05, -0.04}, 1},
              {4, {-0.05, -0.01}, 0}, {4, {0.05, 0.045}, 1},  {4, {-0.05, 0.05}, 0}};
  for (int k = 0; k < 6; k++) {
    mhb_curve_verdict v[N] = {0};
    int               decided[N];
    for (int side = 0; side < 2; side++) {
      mhb_curve_verdict *at = &v[20 + side * rows[k].gap];
      at->judged            = true;
      at->excess            = rows[k].f[side];
      at->kind              = rows[k].f[side] > 0 ? MHB_KIND_MODULATED : MHB_KIND_STABLE;
    }
    mhb_curve_verdicts_decided(N, v, decided);
    for (int i = 0; i < N; i++)
      assert_int_equal(decided[i], rows[k].decides && i > 20 && i < 20 + rows[k].gap ? 20 : -1);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(kinds_are_true),
                                     cmocka_unit_test(divisions_are_kept),
                                     cmocka_unit_test(doubt_decides_nothing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
