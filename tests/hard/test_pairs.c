/* Hard case 14: twenty contact pairs, some stuck, some slipping, some opening. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/newton.h"
#include "tests/hard/power.h"
#include "tests/hard/verdict.h"
#include "tests/mhb/periodic.h"
#include "tests/mhb/random_model.h"

enum { PAIRS = 20, M = 3 };

/* Pair a becomes pair PAIRS - 1 - a. */
static void reverse(double *x, int width) {
  double kept[width];
  for (int a = 0; a < PAIRS / 2; a++) {
    double *one = x + a * width, *other = x + (PAIRS - 1 - a) * width;
    memcpy(kept, one, sizeof kept);
    memcpy(one, other, sizeof kept);
    memcpy(other, kept, sizeof kept);
  }
}

static void states(const mhb_residual *b, int count[3]) {
  count[0] = count[1] = count[2] = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    const double *share = b->info[a].share;
    count[share[MHB_SEPARATE] > 0 ? 2 : share[MHB_SLIDE] > 0]++;
  }
}

static void mixed_states(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(M);
  periodic     p, q;
  random_model(PAIRS, WITH_LEFT | WITH_AREAS | WITH_NORMALS, 3, &model);
  s.tolerance = 1e-10;
  s.kv *= 10;
  for (int i = 0; i < 3; i++) s.ku[i] *= 4;
  s.n0[0] = .5;
  for (int i = 0; i < 5; i++) {
    double w = .8 + .2 * i;
    int    count[3];
    periodic_create(&model, &s, w, NULL, &p);
    states(p.residual, count);
    power e = power_of(p.residual, w);
    verdict(fabs(e.input - e.damping - e.friction) / e.input, 1e-8,
            "14 W %.1f: stuck %d, slipping %d, opening %d: power", w, count[0], count[1], count[2]);
    if (i == 2)
      verdict_count((count[0] > 0) + (count[1] > 0) + (count[2] > 0), 3,
                    "14 W %.1f: states among the pairs", w);
    periodic_destroy(&p);
  }
  periodic_create(&model, &s, 1.2, NULL, &p);
  reverse(model.right, 3 * model.n_modes);
  reverse(model.left, 3 * model.n_modes);
  reverse(model.normal, 3);
  reverse(model.area, 1);
  periodic_create(&model, &s, 1.2, NULL, &q);
  reverse(q.x, 3 * p.residual->nb);
  double worst = 0;
  for (int i = 0; i < p.residual->n; i++) worst = fmax(worst, fabs(p.x[i] - q.x[i]));
  verdict(worst / mhb_norm(p.x, p.residual->n), 1e-8, "14 pairs in the other order: motion");
  periodic_destroy(&p);
  periodic_destroy(&q);
  modal_model_free(&model);
  verdict_all();
}

static void curve(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(1);
  random_model(PAIRS, WITH_LEFT | WITH_AREAS | WITH_NORMALS, 3, &model);
  s.tolerance = 1e-8;
  s.kv *= 10;
  for (int i = 0; i < 3; i++) s.ku[i] *= 4;
  s.n0[0]         = .5;
  model.n_load    = 1;
  mhb_response *r = covered_sweep(&model, &s, .7, 1.6);
  verdict_count(r->branch[2].complete, 1, "14 curve covered, %d points", r->branch[2].n_points);
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(mixed_states), cmocka_unit_test(curve)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
