/* Questions and answers: the optimum of known functions; the order of answers does not matter. */
#include "cases/study/optimiser.h"

#include <math.h>
#include <string.h>

#include "tests/support/check.h"

enum { STARTS = 3, MOST = 400 };

/* A kink along a line, least at (0.3, 0.6). */
static double kinked(const double *u) {
  return 1 + fmax(2 * (u[0] - 0.3) + (u[1] - 0.6), -(u[0] - 0.3) - (u[1] - 0.6)) +
         pow(u[1] - 0.6, 2) + 0.5 * fabs(u[0] - 0.3);
}

static const double first[STARTS * 2] = {0.5, 0.5, 0.1, 0.9, 0.8, 0.2};

typedef struct {
  int    n[STARTS];
  double point[STARTS][MOST][2];
  double best;
  bool   used_up;
} trace;

/* Run; answers come at once, or in the reverse order of their questions. */
static void run(study_algorithm algorithm, int evaluations, bool reversed, trace *t) {
  const study_optimise settings = {
      .evaluations = evaluations, .starts = STARTS, .seed = 5, .algorithm = algorithm};
  optimiser    *o;
  const double *u;
  int           asked[STARTS], n;
  double        value[STARTS];
  *t = (trace){.best = INFINITY};
  assert_ok(optimiser_create(&settings, 2, first, &o));
  do {
    for (n = 0; n < (reversed ? STARTS : 1) && (asked[n] = optimiser_ask(o, &u)) >= 0; n++) {
      int *at = &t->n[asked[n]];
      assert_true(*at < MOST && u[0] >= 0 && u[0] <= 1 && u[1] >= 0 && u[1] <= 1);
      memcpy(t->point[asked[n]][(*at)++], u, 2 * sizeof *u);
      value[n] = kinked(u);
      t->best  = fmin(t->best, value[n]);
    }
    for (int i = n - 1; i >= 0; i--) optimiser_tell(o, asked[i], value[i], NAN);
  } while (n > 0);
  t->used_up = optimiser_used_up(o, 0);
  optimiser_destroy(o);
}

static void the_kinked_optimum_is_found(void **state) {
  (void)state;
  trace t;
  run(STUDY_SBPLX, 600, false, &t);
  print_message("SBPLX: %d, %d, %d evaluations, %.2e above the optimum\n", t.n[0], t.n[1], t.n[2],
                t.best - 1);
  assert_below(t.best - 1, 1e-4);
}

static void the_order_of_answers_does_not_matter(void **state) {
  (void)state;
  static trace a, b;
  for (int i = 0; i < STUDY_SLOPE; i++) {
    run((study_algorithm)i, 120, false, &a);
    run((study_algorithm)i, 120, true, &b);
    for (int s = 0; s < STARTS; s++) {
      assert_int_equal(a.n[s], b.n[s]);
      assert_true(a.n[s] <= 120 / STARTS);
      assert_memory_equal(a.point[s], b.point[s], sizeof a.point[s]);
    }
  }
}

static void evaluations_that_are_used_up_are_told(void **state) {
  (void)state;
  trace t;
  run(STUDY_SBPLX, 30, false, &t);
  assert_true(t.used_up);
}

static void a_search_can_be_ended_early(void **state) {
  (void)state;
  const study_optimise settings = {.evaluations = 90, .starts = STARTS, .seed = 1};
  optimiser           *o;
  const double        *u;
  assert_ok(optimiser_create(&settings, 2, first, &o));
  assert_int_equal(optimiser_ask(o, &u), 0);
  optimiser_destroy(o);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_kinked_optimum_is_found),
                                     cmocka_unit_test(the_order_of_answers_does_not_matter),
                                     cmocka_unit_test(evaluations_that_are_used_up_are_told),
                                     cmocka_unit_test(a_search_can_be_ended_early)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
