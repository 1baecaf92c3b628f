/* Hard case 11: detached branches, subharmonic of order 2 and 3, and one with friction. The search
 * of the sweep finds them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/subharmonics.h"
#include "tests/hard/verdict.h"
#include "tests/support/disturbed.h"
#include "tests/support/periodic.h"
#include "tests/support/three_degree.h"

/* Time integration; amplitudes of harmonic 1 of W/order, the stable and the unstable one at w. */
typedef struct {
  int    order, harmonics; /* of the main branch: times order in all */
  double w, ends[2], amplitude[2];
} isola;

/* Solves at point i of the curve plus a share of the step to the next. Returns the amplitude, and
 * whether the multipliers say stable. */
static double solved(const modal_model *model, const mhb_settings *s, const isola *row,
                     const mhb_branch *b, int i, double share, int *stable) {
  int            K = b->n_harmonics + 1, nb = 2 * K - 1;
  double         x[3 * nb];
  double complex mu[16];
  mhb_settings   own = *s;
  periodic       p;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < K; k++) {
      const double complex *a  = b->motion + (size_t)((3 * i + c) * K + k);
      double complex        at = (1 - share) * a[0] + share * a[3 * K];
      if (k > 0) x[c * nb + 2 * k] = cimag(at);
      x[c * nb + (k ? 2 * k - 1 : 0)] = creal(at);
    }
  own.subharmonics = b->order;
  own.harmonics    = b->n_harmonics;
  periodic_create(model, &own, row->w, x, &p);
  double a = hypot(p.x[1], p.x[2]);
  *stable  = periodic_multipliers(&p, 1024, mu).verdict == MHB_STABLE;
  periodic_destroy(&p);
  return a;
}

static void check_isola(const modal_model *model, const mhb_settings *s, const isola *row,
                        const mhb_branch *b) {
  double lo = INFINITY, hi = 0, far[2] = {INFINITY, INFINITY};
  int    judged = 0, n = b->n_points, folds = count_special(b, MHB_FOLD), changes = 0;
  int    before = -1; /* the last verdict */
  for (int i = 0; i < n; i++) {
    double here = SHB_TWO_PI * b->frequency[i], next = SHB_TWO_PI * b->frequency[(i + 1) % n];
    lo = fmin(lo, here);
    hi = fmax(hi, here);
    if (b->stable[i] >= 0) { /* beside a fold the verdict may lie within its error */
      changes += before >= 0 && b->stable[i] != before;
      before = b->stable[i];
    }
    if (i + 1 == n || (here < row->w) == (next < row->w)) continue;
    int    stable;
    double a = solved(model, s, row, b, i, (row->w - here) / (next - here), &stable);
    for (int k = 0; k < 2; k++) {
      if (fabs(a - row->amplitude[k]) > 1e-3) continue;
      far[k] = fabs(a - row->amplitude[k]);
      if (stable == (k == 0)) judged |= 1 << k;
    }
  }
  verdict_count(changes, 2, "11 order %d: changes of stability along the curve", row->order);
  verdict(far[0], 1e-5, "11 order %d: stable one, amplitude", row->order);
  verdict(far[1], 1e-5, "11 order %d: unstable one, amplitude", row->order);
  verdict_count(judged, 3, "11 order %d: stable, unstable (bits)", row->order);
  verdict(fabs(lo / row->ends[0] - 1), 1e-5, "11 order %d: lower end", row->order);
  verdict(fabs(hi / row->ends[1] - 1), 1e-5, "11 order %d: upper end", row->order);
  verdict_count(folds, 2, "11 order %d: folds", row->order);
  verdict_count(strcmp(b->reason, "closed curve"), 0, "11 order %d: closed", row->order);
}

static void isolas(void **state) {
  (void)state;
  static const isola rows[] = {{2, 8, 2.5, {2.071793, 2.825990}, {.984855, .734821}},
                               {3, 7, 3.6, {3.274102, 3.864229}, {.770513, .719994}}};
  modal_model        model;
  one_degree_model(.02, 0, .5, &model);
  for (int i = 0; i < 2; i++) {
    mhb_settings s    = ground_settings(0, 9, 1, -4.5, rows[i].harmonics);
    s.search          = (mhb_search_settings){.starts = 40, .n_orders = 3, .order = {1, 2, 3}};
    mhb_response *r   = covered_sweep(&model, &s, 2, 4);
    int           one = 0;
    verdict_count(r->n_branches, 5, "11: branches, the linear limits among them");
    for (int b = 3; b < r->n_branches; b++) {
      if (r->branch[b].order != rows[i].order) continue;
      one++;
      check_isola(&model, &s, &rows[i], &r->branch[b]);
    }
    verdict_count(one, 1, "11 order %d: found", rows[i].order);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);
  verdict_all();
}

/* Largest |v| in a period of time integration that began near the solution, after many. */
static double marched(const modal_model *model, const periodic *p) {
  enum { STEPS = 2000, PERIODS = 150 };
  disturbed d;
  double    y[16], top = 0;
  disturbed_create(model, &p->settings, p->residual, p->x, p->omega, STEPS, &d);
  assert_true(d.n <= 16);
  disturbed_start(&d, y);
  for (int i = 0; i < d.n; i++) y[i] *= 1.01;
  for (int i = 0; i < PERIODS; i++) disturbed_period(&d, y);
  for (int i = 0; i < STEPS; i++) {
    disturbed_step(&d, y, i);
    top = fmax(top, fabs(d.u[0]));
  }
  disturbed_destroy(&d);
  return top;
}

/* The same of the balance. */
static double largest(const periodic *p) {
  double top = 0;
  int    m   = p->residual->m;
  for (int i = 0; i < 2000; i++) {
    double v = p->x[0];
    for (int k = 1; k <= m; k++) {
      double t = SHB_TWO_PI * k * i / 2000;
      v += p->x[2 * k - 1] * cos(t) - p->x[2 * k] * sin(t);
    }
    top = fmax(top, fabs(v));
  }
  return top;
}

/* Point i of the curve as a solution of 21 harmonics. */
static void fine_point(const modal_model *model, const mhb_settings *s, const mhb_response *r,
                       const mhb_branch *b, int i, periodic *p) {
  mhb_settings fine = *s;
  double       own[3 * (2 * s->harmonics + 1)], x[3 * 43];
  fine.harmonics = 21;
  point_of(r, b, i, 0, own);
  mhb_subharmonic_embed(3, own, s->harmonics, 1, x, 21);
  periodic_create(model, &fine, SHB_TWO_PI * b->frequency[i], x, p);
}

static int nearest_stable(const mhb_branch *b, double w) {
  int best = -1;
  for (int i = 0; i < b->n_points; i++)
    if (b->stable[i] == 1 && (best < 0 || fabs(SHB_TWO_PI * b->frequency[i] - w) <
                                              fabs(SHB_TWO_PI * b->frequency[best] - w)))
      best = i;
  return best;
}

/* Little friction and a small gap: a detached curve of the excitation's own period. */
static void with_friction(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(.05, .8, .5, -.05, 9);
  three_degree_model(&model);
  s.search = (mhb_search_settings){
      .starts = 40, .n_at = 1, .at = {1.025 / SHB_TWO_PI}, .n_orders = 1, .order = {1}};
  mhb_response *r = covered_sweep(&model, &s, .8, 1.7);
  verdict_count(r->n_branches, 4, "11 friction: branches, the linear limits among them");
  if (r->n_branches == 4) {
    double top[2][2];
    verdict_count(strcmp(r->branch[3].reason, "closed curve"), 0, "11 friction: closed");
    verdict_count(count_special(&r->branch[3], MHB_FOLD), 2, "11 friction: folds");
    for (int k = 0; k < 2; k++) {
      const mhb_branch *b = &r->branch[2 + k];
      periodic          p;
      fine_point(&model, &s, r, b, nearest_stable(b, 1.03), &p);
      top[k][0] = largest(&p);
      top[k][1] = marched(&model, &p);
      print_message("  %s at W %.4f: %.5f, time integration %.5f\n", k ? "isola" : "main", p.omega,
                    top[k][0], top[k][1]);
      periodic_destroy(&p);
      verdict(fabs(top[k][1] / top[k][0] - 1), 2e-3, "11 friction: %s against time integration",
              k ? "isola" : "main curve");
    }
    verdict_count(top[1][1] > 1.5 * top[0][1], 1, "11 friction: the isola's motion is the larger");
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(isolas), cmocka_unit_test(with_friction)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
