/* Sets of solutions, and Newton's method from random starts. */
#include "mhb/search/multistart.h"

#include "mhb/balance/subharmonics.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

/* ---- sets ---- */

static void a_set_has_what_was_added(void **state) {
  (void)state;
  enum { N = 7, COUNT = 50 };
  mhb_solution_set   set = {0};
  double             x[COUNT][N];
  unsigned long long seed = 3;
  for (int i = 0; i < COUNT; i++) {
    for (int k = 0; k < N; k++) x[i][k] = random_unit(&seed);
    assert_false(i > 0 && mhb_solution_set_has(&set, x[i]));
    mhb_solution_set_add(&set, N, x[i]);
    for (int k = 0; k <= i; k++) assert_true(mhb_solution_set_has(&set, x[k]));
  }
  assert_int_equal(set.n_solutions, COUNT);
  assert_memory_equal(set.x, x, sizeof x);
  mhb_solution_set_free(&set);
  assert_null(set.x);
  assert_int_equal(set.n_solutions, 0);
}

/* To 1e-5 of the larger of both. */
static void near_solutions_are_the_same(void **state) {
  (void)state;
  mhb_solution_set set = {0};
  double           x[] = {3, 4}, zero[] = {0, 0};
  double           size[] = {0.9e-5, 1.1e-5};
  mhb_solution_set_add(&set, 2, x);
  for (int i = 0; i < 2; i++) {
    double y[] = {3 * (1 + size[i]), 4 * (1 + size[i])};
    assert_true(mhb_solution_set_has(&set, y) == (i == 0));
  }
  assert_false(mhb_solution_set_has(&set, zero));
  mhb_solution_set_free(&set);
}

/* A motion of order 3 comes three times, one of order 1 once. */
static void a_motion_is_added_with_its_copies(void **state) {
  (void)state;
  modal_model        model;
  mhb_settings       settings = random_settings(3);
  mhb_balance       *b;
  mhb_solution_set   set  = {0};
  unsigned long long seed = 2;
  random_model(1, WITH_LEFT, 4, &model);
  model.n_load          = 1;
  settings.subharmonics = 3;
  settings.blades       = 8;
  assert_ok(mhb_balance_create(&model, &settings, &b));
  double x[b->n], later[b->n];
  for (int i = 0; i < b->n; i++) x[i] = random_unit(&seed);
  for (int again = 0; again < 2; again++) {
    mhb_solution_set_add_copies(&set, b, x);
    assert_int_equal(set.n_solutions, 3);
  }
  mhb_subharmonic_shift(b, x, 2, later);
  assert_true(mhb_solution_set_has(&set, later));
  mhb_solution_set_add_copies(&set, b, later);
  assert_int_equal(set.n_solutions, 3);
  for (int i = 0; i < b->n; i++)
    if (i % b->nb == 1 || i % b->nb == 2 || i % b->nb == 3 || i % b->nb == 4) x[i] = 0;
  mhb_solution_set_add_copies(&set, b, x); /* harmonics 0 and 3 alone */
  assert_int_equal(set.n_solutions, 4);
  mhb_solution_set_free(&set);
  mhb_balance_destroy(b);
  modal_model_free(&model);
}

/* ---- random starts ---- */

typedef struct {
  modal_model  model;
  mhb_settings settings;
  mhb_balance *balance;
  mhb_newton  *newton;
} fixture;

static void set_up(fixture *f, double n0) {
  one_degree_model(0.02, 0, 0.1, &f->model);
  f->settings = ground_settings(0.3, 5, 1, n0, 3);
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  f->newton = mhb_newton_create(f->balance->n);
  mhb_balance_set_preload(f->balance, n0);
}

static void tear_down(fixture *f) {
  mhb_newton_destroy(f->newton);
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

/* A contact that opens has several solutions beside the resonance. Each is a solution, and no two
 * are the same. The same seed gives the same. */
static void starts_lead_to_different_solutions(void **state) {
  (void)state;
  int n[2];
  for (int again = 0; again < 2; again++) {
    fixture f;
    set_up(&f, -2.5); /* a gap of 0.5 m */
    mhb_solution_set   set = {0};
    double             x[f.balance->n], r[f.balance->n];
    unsigned long long seed  = 1;
    int                n_new = 0;
    for (int i = 0; i < 60; i++) {
      bool               is_new;
      unsigned long long before = seed;
      mhb_multistart_once(f.newton, f.balance, 1.15, 0.5 * (1 + i % 4), &seed, &set, x, &is_new);
      assert_true(seed != before);
      if (!is_new) continue;
      n_new++;
      assert_true(mhb_solution_set_has(&set, x));
      mhb_balance_evaluate(f.balance, x, 1.15, r, NULL, NULL);
      assert_below(mhb_norm(r, f.balance->n), 1e-9 * mhb_norm(x, f.balance->n));
    }
    n[again] = set.n_solutions;
    assert_int_equal(set.n_solutions, n_new);
    mhb_solution_set_free(&set);
    tear_down(&f);
  }
  print_message("%d solutions\n", n[0]);
  assert_true(n[0] >= 2);
  assert_int_equal(n[0], n[1]);
}

/* An open contact that nothing reaches: the system is linear, and one start is enough. */
static void a_linear_problem_has_one_solution(void **state) {
  (void)state;
  fixture f;
  set_up(&f, -50);
  mhb_solution_set   set = {0};
  double             x[f.balance->n];
  unsigned long long seed = 1;
  for (int i = 0; i < 5; i++) {
    bool is_new;
    mhb_multistart_once(f.newton, f.balance, 1.15, 1, &seed, &set, x, &is_new);
    assert_true(is_new == (i == 0));
  }
  assert_int_equal(set.n_solutions, 1);
  mhb_solution_set_free(&set);
  tear_down(&f);
}

/* A start whose residual is no number leads nowhere. */
static void a_start_may_lead_nowhere(void **state) {
  (void)state;
  fixture f;
  set_up(&f, -2.5); /* a gap of 0.5 m */
  mhb_solution_set   set = {0};
  double             x[f.balance->n];
  unsigned long long seed = 1;
  bool               is_new;
  mhb_multistart_once(f.newton, f.balance, 1.15, INFINITY, &seed, &set, x, &is_new);
  assert_false(is_new);
  assert_int_equal(set.n_solutions, 0);
  mhb_solution_set_free(&set);
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_set_has_what_was_added),
                                     cmocka_unit_test(near_solutions_are_the_same),
                                     cmocka_unit_test(a_motion_is_added_with_its_copies),
                                     cmocka_unit_test(starts_lead_to_different_solutions),
                                     cmocka_unit_test(a_linear_problem_has_one_solution),
                                     cmocka_unit_test(a_start_may_lead_nowhere)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
