/* Hard cases 4, 5, 16: preload next to zero, a gap that is just touched, nothing to do. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/balance/newton.h"
#include "mhb/branches/main_branch.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { M = 7, N = 3 * (2 * M + 1) };

static void cold(const modal_model *model, const mhb_settings *s, double w, double *x) {
  periodic p;
  periodic_create(model, s, w, NULL, &p);
  memcpy(x, p.x, sizeof(double) * (size_t)p.residual->n);
  periodic_destroy(&p);
}

static double difference(const double *a, const double *b, int n) {
  double worst = 0;
  for (int i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst / mhb_norm(a, n);
}

static void preload_next_to_zero(void **state) {
  (void)state;
  static const double n0[] = {0, 1e-12, -1e-12};
  modal_model         model;
  double              worst[2] = {0, 0}, x[3][N];
  three_degree_model(&model);
  for (int w = 0; w < 19; w++) {
    for (int i = 0; i < 3; i++) {
      mhb_settings s = ground_settings(.4, .8, .5, n0[i], M);
      cold(&model, &s, .8 + .05 * w, x[i]);
    }
    for (int i = 0; i < 2; i++) worst[i] = fmax(worst[i], difference(x[0], x[i + 1], N));
  }
  verdict(worst[0], 1e-6, "4 preload 1e-12 against 0, 19 frequencies");
  verdict(worst[1], 1e-6, "4 preload -1e-12 against 0, 19 frequencies");
  mhb_settings s  = ground_settings(.4, .8, .5, n0[0], M);
  s.n_preloads    = 3;
  s.n0[1]         = n0[1];
  s.n0[2]         = n0[2];
  mhb_response *r = covered_sweep(&model, &s, .8, 1.7);
  for (int i = 0; i < 3; i++)
    verdict_count(r->branch[2 + i].complete, 1, "4 preload %.0e: curve covered", n0[i]);
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

/* One direction, open: amplitude F/|1 - W^2 + 2j zeta W|. The gap differs from it by a relative
 * 1e-9, in both directions. */
static void grazing_gap(void **state) {
  (void)state;
  static const double off[] = {1e-9, 0, -1e-9}, w[] = {.7, 1, 1.4};
  const double        zeta = .02, F = .1;
  modal_model         model;
  one_degree_model(zeta, 0, F, &model);
  for (int i = 0; i < 9; i++) {
    double       W = w[i / 3], open = F / hypot(1 - W * W, 2 * zeta * W);
    mhb_settings s = ground_settings(.3, 9, 1, -9 * open * (1 + off[i % 3]), 15);
    periodic     p;
    periodic_create(&model, &s, W, NULL, &p);
    verdict(fabs(hypot(p.x[1], p.x[2]) / open - 1), 1e-8, "5 W %.1f, gap %+.0e of the peak", W,
            off[i % 3]);
    verdict_count(p.residual->eval->info[0].lost, 0, "5 W %.1f, gap %+.0e: contact law lost", W,
                  off[i % 3]);
    periodic_destroy(&p);
  }
  double       W = sqrt(1 - 2 * zeta * zeta), open = F / hypot(1 - W * W, 2 * zeta * W);
  mhb_settings s = ground_settings(.3, 9, 1, 0, 15);
  s.n_preloads   = 3;
  for (int i = 0; i < 3; i++) s.n0[i] = -9 * open * (1 + off[i]);
  mhb_response *r = covered_sweep(&model, &s, .5, 1.6);
  for (int i = 0; i < 3; i++) {
    const mhb_branch *b   = &r->branch[2 + i];
    double            top = 0;
    for (int k = 0; k < b->n_points; k++) top = fmax(top, harmonic_of(r, b, k, 0, 1));
    verdict(fabs(top / open - 1), 1e-8, "5 curve, gap %+.0e of the peak: peak", off[i]);
    verdict_count(count_special(b, MHB_FOLD), 0, "5 curve, gap %+.0e: folds", off[i]);
  }
  mhb_response_destroy(r);
  modal_model_free(&model);
  verdict_all();
}

static void nothing_to_do(void **state) {
  (void)state;
  static const double n0[] = {.3, 0, -.3};
  modal_model         model;
  random_model(2, WITH_LEFT | WITH_RESIDUAL | WITH_NORMALS, 9, &model);
  mhb_settings s = random_settings(3);
  s.scale        = 0;
  s.tolerance    = 1e-8;
  s.n_preloads   = 3;
  memcpy(s.n0, n0, sizeof n0);
  mhb_response *r    = covered_sweep(&model, &s, .6, 2);
  double        most = 0;
  int           done = 0;
  for (int b = 2; b < 5; b++) {
    for (int i = 0; i < r->branch[b].n_points * 2 * 3 * 4; i++)
      most = fmax(most, cabs(r->branch[b].motion[i]));
    done += r->branch[b].complete;
  }
  verdict(most, 0, "16 no excitation: motion");
  verdict_count(done, 3, "16 no excitation: curves covered");
  mhb_response_destroy(r);
  modal_model_free(&model);

  three_degree_model(&model);
  for (int i = 0; i < 3; i++) model.damping_ratio[i] = 0;
  for (int i = 0; i < 3; i++) {
    s = ground_settings(.4, .8, .5, n0[i], M);
    r = covered_sweep(&model, &s, .2, .6);
    verdict_count(r->branch[2].complete, 1, "16 no damping, n0 %.1f: curve covered, %d points",
                  n0[i], r->branch[2].n_points);
    mhb_response_destroy(r);
  }
  modal_model_free(&model);

  for (int i = 0; i < 6; i++) {
    one_degree_model(.02, i % 2, .1, &model);
    s = ground_settings(.4, .8, .5, n0[i / 2], M);
    r = covered_sweep(&model, &s, .5, 2);
    verdict_count(r->branch[2].complete, 1, "16 one mode along %c, n0 %.1f: curve covered",
                  "vu"[i % 2], n0[i / 2]);
    mhb_response_destroy(r);
    modal_model_free(&model);
  }
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(preload_next_to_zero),
      cmocka_unit_test(grazing_gap),
      cmocka_unit_test(nothing_to_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
