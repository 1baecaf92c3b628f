/* Hard case 1: three degrees of freedom that rub on the ground, against time integration. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/main_branch.h"
#include "tests/hard/floquet.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

static void amplitudes(void **state) {
  (void)state;
  static const struct {
    double n0, w, a[3], error;
  } rows[] = {{1, 1.20, {.027944, .147642, .008139}, 1e-6},
              {-.2, 1.00, {.019624, .197890, .003763}, 1e-6},
              {0, 1.05, {.195617, .114818, .021163}, 7.8e-6},
              {.3, 1.42, {.492394, .396878, .471625}, 2.3e-6}};
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    mhb_settings s = ground_settings(.4, .8, .5, rows[i].n0, 15);
    periodic     p;
    double       worst = 0, size = 0;
    periodic_create(&model, &s, rows[i].w, NULL, &p);
    for (int c = 0; c < 3; c++) {
      const double *u = p.x + c * p.residual->nb;
      worst           = fmax(worst, fabs(hypot(u[1], u[2]) - rows[i].a[c]));
      size            = fmax(size, rows[i].a[c]);
    }
    /* the reference is printed to six decimals */
    verdict(worst / size, rows[i].error + .6e-6 / size, "1 n0 %.1f W %.2f: amplitude", rows[i].n0,
            rows[i].w);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
  verdict_all();
}

typedef struct {
  double n0;
  int    H, tops, folds; /* tops: all maxima of u, the same at every accuracy */
  double peak[3][2], fold[4];
} curve;

static int top(const mhb_response *r, const mhb_branch *b, int i) {
  double here = harmonic_of(r, b, i, 1, 1);
  return here > harmonic_of(r, b, distinct(b, i, -1), 1, 1) &&
         here >= harmonic_of(r, b, distinct(b, i, 1), 1, 1);
}

/* Peaks of u: their number, and the largest distance from the peaks of the reference, which lists
 * the high ones. */
static void check_peaks(const mhb_response *r, const mhb_branch *b, const curve *c,
                        double accuracy) {
  int    n      = 0;
  double far[2] = {0, 0};
  for (int i = 1; i + 1 < b->n_points; i++) {
    if (!top(r, b, i)) continue;
    int again = i > 1 && top(r, b, i - 1) && fabs(b->frequency[i - 1] / b->frequency[i] - 1) < 1e-7;
    n += !again;
  }
  for (int p = 0; p < 3 && c->peak[p][1] > 0; p++) {
    double best[2] = {INFINITY, INFINITY};
    for (int i = 1; i + 1 < b->n_points; i++) {
      double off = fabs(SHB_TWO_PI * b->frequency[i] - c->peak[p][1]);
      if (!top(r, b, i) || off >= best[1]) continue;
      best[0] = fabs(harmonic_of(r, b, i, 1, 1) - c->peak[p][0]);
      best[1] = off;
    }
    for (int k = 0; k < 2; k++) far[k] = fmax(far[k], best[k]);
  }
  verdict_count(n, c->tops, "1 n0 %.1f accuracy %.0e: peaks of u", c->n0, accuracy);
  /* the reference's friction was sampled: 5e-5 and 2e-4 */
  verdict(far[0], fmax(5e-5, 2 * accuracy), "1 n0 %.1f accuracy %.0e: peak amplitude", c->n0,
          accuracy);
  verdict(far[1], fmax(2e-4, 2 * accuracy), "1 n0 %.1f accuracy %.0e: peak frequency", c->n0,
          accuracy);
}

static void peaks_and_folds(void **state) {
  (void)state;
  static const curve rows[] = {
      {-.2,
       11,
       4,
       4,
       {{.255795, .960521}, {.887011, 1.158727}, {.631926, 1.311043}},
       {.968825, .959129, 1.162961, 1.160645}},
      {0, 7, 3, 0, {{.270514, 1.030220}, {.532418, 1.190037}, {.566835, 1.329447}}, {0}},
      {.3, 11, 3, 2, {{.250643, 1.245374}, {.398957, 1.416445}}, {1.408680, 1.408382}},
      {.5, 7, 3, 0, {{.389205, 1.254187}}, {0}},
      {1, 7, 3, 0, {{.560424, 1.362896}}, {0}}};
  static const double accuracy[] = {1e-8, 1e-5, 1e-3};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 15; i++) {
    const curve *c        = &rows[i % 5];
    mhb_settings s        = ground_settings(.4, .8, .5, c->n0, c->H);
    s.tolerance           = accuracy[i / 5];
    mhb_response     *r   = covered_sweep(&model, &s, .8, 1.7);
    const mhb_branch *b   = &r->branch[2];
    double            far = 0;
    check_peaks(r, b, c, s.tolerance);
    verdict_count(count_special(b, MHB_FOLD), c->folds, "1 n0 %.1f accuracy %.0e: folds", c->n0,
                  s.tolerance);
    for (int k = 0; k < c->folds; k++) {
      int at = special_near(b, MHB_FOLD, c->fold[k]);
      far    = fmax(far, at < 0 ? INFINITY : fabs(SHB_TWO_PI * b->frequency[at] - c->fold[k]));
    }
    if (c->folds)
      verdict(far, fmax(2e-4, 2 * s.tolerance), "1 n0 %.1f accuracy %.0e: folds' frequency", c->n0,
              s.tolerance);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
  verdict_all();
}

/* Stability is lost and regained at Neimark-Sacker points; between them the solution still
 * exists. */
static void unstable_solution(void **state) {
  (void)state;
  modal_model model;
  three_degree_model(&model);
  mhb_settings   s = ground_settings(.4, .8, .5, .1, 11);
  periodic       p;
  double complex mu[16];
  periodic_create(&model, &s, 1.25, NULL, &p);
  const double   *u   = p.x + p.residual->nb;
  mhb_multipliers out = periodic_multipliers(&p, 256, mu);
  verdict(fabs(hypot(u[1], u[2]) - .079726), 1e-5, "1 n0 .1 W 1.25, cold: amplitude");
  verdict(fabs(out.largest - 1.021574), 1e-3, "1 n0 .1 W 1.25: largest multiplier");
  verdict_count(out.verdict == MHB_UNSTABLE && out.crossing == MHB_THROUGH_PAIR, 1,
                "1 n0 .1 W 1.25: unstable through a pair");
  periodic_destroy(&p);

  mhb_response     *r      = covered_sweep(&model, &s, 1.1, 1.3);
  const mhb_branch *b      = &r->branch[2];
  floquet          *f      = calloc((size_t)b->n_points, sizeof *f);
  int               n      = 0;
  double            want[] = {1.20060, 1.25635};
  floquet_branch(&model, &s, r, b, 256, f);
  for (int i = 0; i + 1 < b->n_points; i++) {
    const floquet *beyond = f[i].largest > 1 ? &f[i] : &f[i + 1];
    if ((f[i].largest > 1) == (f[i + 1].largest > 1) || beyond->crossing != MHB_THROUGH_PAIR)
      continue;
    double w = floquet_crossing(&model, &s, r, b, i, 256);
    if (n < 2) verdict(fabs(w - want[n]), 2e-4, "1 n0 .1: Neimark-Sacker point %.5f", w);
    n++;
  }
  verdict_count(n, 2, "1 n0 .1: Neimark-Sacker points");
  free(f);
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(amplitudes),
      cmocka_unit_test(peaks_and_folds),
      cmocka_unit_test(unstable_solution),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
