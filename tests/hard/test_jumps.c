/* Hard cases 2 and 15: one degree of freedom with jumps, hardening by a gap, softening by a
 * preload. */
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
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

/* m = k = 1, c = .04, kv = 9; amplitudes low, middle, high at w. Time integration. */
typedef struct {
  const char *name;
  double      n0, F, peak, at, upper, lower, w, amplitude[3], largest[3];
} jump;

static const jump A = {"A",
                       -4.5,
                       .1,
                       1.669613,
                       1.388351,
                       1.389887,
                       1.093215,
                       1.30,
                       {.144518, .908380, 1.141048},
                       {.907861, 1.389312, .907861}};
static const jump B = {"B",
                       1,
                       .06,
                       .668464,
                       2.086578,
                       2.086215,
                       3.078167,
                       2.30,
                       {.012736, .432375, .461382},
                       {.946829, 1.295319, .946829}};

/* Amplitudes are in units of `size`: the law is homogeneous in force and preload together. */
static void check_curve(const jump *j, double size, const mhb_response *r, const mhb_branch *b,
                        const char *number) {
  double best = 0, at = 0;
  for (int i = 0; i < b->n_points; i++) {
    if (harmonic_of(r, b, i, 0, 1) <= best) continue;
    best = harmonic_of(r, b, i, 0, 1);
    at   = SHB_TWO_PI * b->frequency[i];
  }
  verdict_count(count_special(b, MHB_FOLD), 2, "%s %s: folds", number, j->name);
  verdict(fabs(best / size - j->peak), 1e-4, "%s %s: peak", number, j->name);
  verdict(fabs(at - j->at), 2e-4, "%s %s: peak frequency", number, j->name);
  int up = special_near(b, MHB_FOLD, j->upper), low = special_near(b, MHB_FOLD, j->lower);
  verdict(up < 0 ? INFINITY : fabs(SHB_TWO_PI * b->frequency[up] - j->upper), 2e-4,
          "%s %s: upper fold", number, j->name);
  verdict(low < 0 ? INFINITY : fabs(SHB_TWO_PI * b->frequency[low] - j->lower), 2e-3,
          "%s %s: lower fold", number, j->name);
}

/* The three solutions at w, and their multipliers. */
static void check_branches(const jump *j, double size, const modal_model *model,
                           const mhb_settings *s, const mhb_response *r, const mhb_branch *b,
                           const char *number) {
  int            seen = 0;
  double         amp = 0, mul = 0, x[3 * (2 * s->harmonics + 1)];
  double complex mu[16];
  for (int i = 0; i + 1 < b->n_points; i++) {
    double   here = SHB_TWO_PI * b->frequency[i], next = SHB_TWO_PI * b->frequency[i + 1];
    periodic p;
    if ((here < j->w) == (next < j->w)) continue;
    point_of(r, b, i, (j->w - here) / (next - here), x);
    periodic_create(model, s, j->w, x, &p);
    mhb_multipliers out = periodic_multipliers(&p, 256, mu);
    double          a   = hypot(p.x[1], p.x[2]) / size;
    for (int k = 0; k < 3; k++) {
      if (fabs(a - j->amplitude[k]) > 1e-2) continue;
      amp = fmax(amp, fabs(a - j->amplitude[k]));
      mul = fmax(mul, fabs(out.largest - j->largest[k]));
      if (out.verdict == (k == 1 ? MHB_UNSTABLE : MHB_STABLE)) seen |= 1 << k;
    }
    periodic_destroy(&p);
  }
  verdict_count(seen, 7, "%s %s at %.2f: low, high stable, middle unstable (bits)", number, j->name,
                j->w);
  verdict(amp, 1e-4, "%s %s at %.2f: amplitudes", number, j->name, j->w);
  verdict(mul, 1e-3, "%s %s at %.2f: largest multipliers", number, j->name, j->w);
}

/* Every point between the folds unstable, every other stable. */
static void check_stability(const jump *j, const modal_model *model, const mhb_settings *s,
                            const mhb_response *r, const mhb_branch *b) {
  floquet *f     = calloc((size_t)b->n_points, sizeof *f);
  int      folds = 0, wrong = 0;
  floquet_branch(model, s, r, b, 256, f);
  for (int i = 0; i < b->n_points; i++) {
    if (b->special[i] == MHB_FOLD) {
      folds++;
      continue;
    }
    int near = (i > 0 && b->special[i - 1] == MHB_FOLD) ||
               (i + 1 < b->n_points && b->special[i + 1] == MHB_FOLD);
    if (near && fabs(f[i].largest - 1) < 2e-2) continue; /* marginal by nature */
    wrong += (f[i].verdict == MHB_UNSTABLE) != (folds == 1);
  }
  verdict_count(wrong, 0, "2 %s: wrong stability at %d points", j->name, b->n_points);
  free(f);
}

static void jumps(void **state) {
  (void)state;
  static const double accuracy[] = {1e-8, 1e-5, 1e-3};
  const jump         *rows[]     = {&A, &B};
  for (int i = 0; i < 2; i++) {
    modal_model model;
    one_degree_model(.02, 0, rows[i]->F, &model);
    for (int k = 0; k < 3; k++) {
      mhb_settings s      = ground_settings(0, 9, 1, rows[i]->n0, 31);
      s.tolerance         = accuracy[k];
      mhb_response     *r = covered_sweep(&model, &s, .5, 3.6);
      const mhb_branch *b = &r->branch[2];
      print_message("  accuracy %.0e\n", accuracy[k]);
      check_curve(rows[i], 1, r, b, "2");
      if (k == 0) check_branches(rows[i], 1, &model, &s, r, b, "2");
      if (k == 0) check_stability(rows[i], &model, &s, r, b);
      mhb_response_destroy(r);
    }
    modal_model_free(&model);
  }
  verdict_all();
}

/* The gap hardens and the preload softens, each with a jump, in one sweep. The preload and
 * amplitudes of B are scaled to the force of A. */
static void gap_and_preload_in_one_sweep(void **state) {
  (void)state;
  double      size = A.F / B.F;
  modal_model model;
  one_degree_model(.02, 0, A.F, &model);
  mhb_settings s  = ground_settings(0, 9, 1, A.n0, 31);
  s.n0[1]         = B.n0 * size;
  s.n_preloads    = 2;
  mhb_response *r = covered_sweep(&model, &s, .5, 3.6);
  for (int i = 0; i < 2; i++) {
    mhb_settings one = s;
    one.n0[0]        = s.n0[i];
    check_curve(i ? &B : &A, i ? size : 1, r, &r->branch[2 + i], "15");
    check_branches(i ? &B : &A, i ? size : 1, &model, &one, r, &r->branch[2 + i], "15");
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

/* Largest reversal of the frequency between two points neither of which is a fold. */
static double largest_reversal(const mhb_branch *b) {
  double worst = 0;
  for (int i = 1; i + 1 < b->n_points; i++) {
    const int    *special = b->special + i;
    const double *w       = b->frequency + i;
    if (special[-1] == MHB_FOLD || special[0] == MHB_FOLD || special[1] == MHB_FOLD) continue;
    if ((w[0] - w[-1]) * (w[1] - w[0]) < 0)
      worst = fmax(worst, fmin(fabs(w[0] - w[-1]), fabs(w[1] - w[0])) / w[0]);
  }
  return worst;
}

/* Several peaks and folds within one step are recorded in their order along the curve, each once.
 * No step misses a pair of folds. */
static void in_order_along_the_curve(void **state) {
  (void)state;
  static const int    seed[] = {1, 12, 22, 27, 32, 38, 57};
  static const double n0[]   = {-.2, 0, .1, .3, .6};
  for (int i = 0; i < 7; i++) {
    modal_model model;
    random_model(1, 0, (unsigned long long)seed[i], &model);
    mhb_settings  s = ground_settings(.4, .8, .5, n0[seed[i] % 5], 5);
    mhb_response *r = covered_sweep(&model, &s, .7, 2.2);
    verdict(largest_reversal(&r->branch[2]), 1e-12, "model %d: largest reversal", seed[i]);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(jumps),
      cmocka_unit_test(gap_and_preload_in_one_sweep),
      cmocka_unit_test(in_order_along_the_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
