/* Hard case 14: twenty contact pairs, some stuck, some slipping, some opening. Accuracy of the
 * truncation estimate for 1 to 200 pairs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/numerics/fourier.h"
#include "tests/hard/power.h"
#include "tests/hard/verdict.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/shroud_face.h"

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

static void states(const mhb_balance *b, int count[3]) {
  count[0] = count[1] = count[2] = 0;
  for (int a = 0; a < b->n_pairs; a++) {
    const double *share = b->eval->info[a].share;
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

/* Shroud faces of 20 modes near the peak of their resonance: the motion with 3 harmonics against
 * the one with `fine`. */
typedef struct {
  int    pairs, fine;
  double force, frequency; /* N, Hz */
  int    few, many;        /* pairs that move: at least, at most */
} face;

/* |x - y|/|y|, x of nb coefficients a row, y of wide ones. */
static double distance(int rows, const double *x, int nb, const double *y, int wide) {
  double sum = 0;
  for (int row = 0; row < rows; row++)
    for (int i = 0; i < wide; i++)
      sum += pow((i < nb ? x[row * nb + i] : 0) - y[row * wide + i], 2);
  return sqrt(sum) / mhb_norm(y, rows * wide);
}

/* The same point with more harmonics; the error of p's. */
static double true_error(const modal_model *model, const face *row, const periodic *p) {
  mhb_settings s    = shroud_face_settings(row->fine);
  int          rows = 3 * row->pairs, nb = p->residual->nb, wide = mhb_real_size(row->fine);
  periodic     q;
  double      *guess = calloc((size_t)(rows * wide), sizeof(double));
  for (int i = 0; i < rows; i++)
    memcpy(guess + i * wide, p->x + i * nb, sizeof(double) * (size_t)nb);
  periodic_create(model, &s, p->omega, guess, &q);
  double error = distance(rows, p->x, nb, q.x, wide);
  periodic_destroy(&q);
  free(guess);
  return error;
}

static void estimates(void **state) {
  (void)state;
  static const face rows[] = {{1, 13, 150, 212, 1, 1},      {10, 13, 8, 232, 1, 3},
                              {10, 13, 150, 216.7, 10, 10}, {50, 13, 8, 221.1, 5, 12},
                              {50, 9, 20, 219, 50, 50},     {200, 9, 8, 220, 20, 40},
                              {200, 9, 12, 219.5, 45, 60}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const face     *row = &rows[i];
    modal_model     model;
    mhb_settings    s = shroud_face_settings(3);
    mhb_truncation *t;
    periodic        p;
    int             moving = 0;
    shroud_face_model(row->pairs, row->force, &model);
    periodic_create(&model, &s, SHB_TWO_PI * row->frequency, NULL, &p);
    assert_int_equal(mhb_truncation_create(p.residual, &t), SHB_OK);
    double estimate = mhb_truncation_error(t, p.x);
    for (int a = 0; a < row->pairs; a++) moving += p.residual->eval->kind[a] == MHB_PAIR_NONLINEAR;
    assert_in_range(moving, row->few, row->many);
    assert_int_equal(t->kind, MHB_TRUNCATION_NEWTON);
    mhb_truncation_destroy(t);
    verdict(fabs(log(estimate / true_error(&model, row, &p))), log(1.5),
            "%d pairs, %d moving, estimate %.1e: off by", row->pairs, moving, estimate);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
  verdict_all();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(mixed_states), cmocka_unit_test(curve),
                                     cmocka_unit_test(estimates)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
