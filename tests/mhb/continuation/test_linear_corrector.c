/* The linear regime: harmonics one by one, and means by a Newton step of their own. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/balance/newton.h"
#include "mhb/continuation/linear_corrector.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { PAIRS = 3, H = 5 };

static int count(const mhb_balance *b, mhb_pair_kind kind) {
  int n = 0;
  for (int a = 0; a < b->n_pairs; a++) n += b->eval->kind[a] == kind;
  return n;
}

static void solve(const modal_model *model, const mhb_settings *s, double omega, periodic *p) {
  periodic_create(model, s, omega, NULL, p);
  double r[p->residual->n];
  mhb_balance_linearise(p->residual, p->x, omega, r, NULL);
}

/* A solution at which no pair slips or opens, and the mean friction of some pairs is at the limit.
 * The preload is in the middle of those with such a solution. */
static void held_solution(const modal_model *model, mhb_settings *s, double omega, periodic *p) {
  double most = 0, least = 0;
  int    moving = 0;
  for (s->n0[0] = 40; !moving && s->n0[0] > 0.01; s->n0[0] *= 0.98) {
    solve(model, s, omega, p);
    moving = count(p->residual, MHB_PAIR_NONLINEAR);
    if (!moving && count(p->residual, MHB_PAIR_AT_LIMIT) > 0) {
      least = s->n0[0];
      if (most == 0) most = least;
    }
    periodic_destroy(p);
  }
  assert_true(least < most);
  s->n0[0] = 0.5 * (least + most);
  solve(model, s, omega, p);
}

/* Largest residual of the means, and of the rest. */
static void largest(const mhb_balance *b, const double *r, double *means, double *rest) {
  *means = *rest = 0;
  for (int i = 0; i < b->n; i++) {
    double *to = i % b->nb ? rest : means;
    *to        = fmax(*to, fabs(r[i]));
  }
}

/* From a solution to another frequency: move along the plane, then correct the means with a new
 * derivative each time. */
static void means_converge(const modal_model *model, mhb_settings *s, double omega) {
  periodic              p;
  mhb_linear_corrector *linear;
  int                   steps;
  held_solution(model, s, omega, &p);
  mhb_balance *b = p.residual;
  double       x[b->n], r[b->n], normal[b->n + 1], there = 1.0005 * omega, means[5], rest;
  linear = mhb_linear_corrector_create(b);
  mhb_linear_set_states(linear, b->eval, b->n_pairs);
  memcpy(x, p.x, sizeof x);
  memset(normal, 0, sizeof normal);
  normal[b->n] = 1; /* the plane of one frequency */
  assert_true(mhb_linear_correct(linear, b, normal, 1, 1, x, &there, &steps));
  double size = mhb_norm(x, b->n);
  for (int i = 0; i < 5; i++) {
    mhb_balance_linearise(b, x, there, r, NULL);
    assert_true(mhb_linear_states_hold(linear, b->eval, b->n_pairs));
    largest(b, r, &means[i], &rest);
    assert_true(rest < 1e-12 * size);
    assert_true(mhb_linear_correct_means(linear, b, r, 0, x));
  }
  print_message("n0 %.3g, %d held: residual of the means %.1e %.1e %.1e %.1e of the motion\n",
                s->n0[0], count(b, MHB_PAIR_AT_LIMIT), means[0] / size, means[1] / size,
                means[2] / size, means[3] / size);
  assert_true(means[0] > 1e-8 * size); /* they had to move */
  assert_true(means[1] < 1e-2 * means[0]);
  assert_true(means[2] < fmax(1e-2 * means[1], 1e-13 * size));
  assert_true(means[4] < 1e-12 * size);
  mhb_linear_corrector_destroy(linear);
  periodic_destroy(&p);
}

static void one_pair(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(H);
  random_model(1, WITH_LEFT | WITH_RESIDUAL, 3, &model);
  model.n_load = 1;
  means_converge(&model, &s, 1.3);
  modal_model_free(&model);
}

static void some_pairs(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(H);
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL | WITH_AREAS, 1, &model);
  model.n_load = 1;
  means_converge(&model, &s, 1.3);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_pair), cmocka_unit_test(some_pairs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
