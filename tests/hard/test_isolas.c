/* Hard case 11: subharmonic branches of order 2 and 3 that nothing connects to the main one, found by the sweep's search. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/hard/verdict.h"
#include "tests/mhb/periodic.h"
#include "tests/mhb/three_degree.h"

static const double PI = 3.14159265358979323846;

/* Time integration; amplitudes of harmonic 1 of W/order, the stable and the unstable one at w. */
typedef struct {
  int    order, harmonics; /* of the main branch: times order in all */
  double w, ends[2], amplitude[2];
} isola;

/* Point i of the curve and its share of the next, solved for: its amplitude and whether its multipliers say stable. */
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
  for (int i = 0; i < n; i++) {
    double here = 2 * PI * b->frequency[i], next = 2 * PI * b->frequency[(i + 1) % n];
    lo = fmin(lo, here);
    hi = fmax(hi, here);
    changes += i > 0 && b->stable[i] != b->stable[i - 1];
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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(isolas)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
