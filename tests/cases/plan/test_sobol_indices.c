#include "cases/plan/sobol_indices.h"
#include "tests/support/check.h"

typedef double function(const double *u);

/* Ishigami, Homma 1990: sin a + 7 sin^2 b + 0.1 c^4 sin a on [-pi, pi]^3. */
static double ishigami(const double *u) {
  double a = M_PI * (2 * u[0] - 1), b = M_PI * (2 * u[1] - 1), c = M_PI * (2 * u[2] - 1);
  return sin(a) + 7 * sin(b) * sin(b) + 0.1 * pow(c, 4) * sin(a);
}

static void ishigami_indices(double *first, double *total) {
  double pi4 = pow(M_PI, 4), alone = pow(1 + 0.1 * pi4 / 5, 2) / 2, second = 49.0 / 8;
  double mixed = 0.01 * pi4 * pi4 * 8 / 225, all = alone + second + mixed;
  first[0] = alone / all;
  first[1] = second / all;
  first[2] = 0;
  total[0] = (alone + mixed) / all;
  total[1] = second / all;
  total[2] = mixed / all;
}

/* The G function of Sobol': kinked, each factor (|4 u - 2| + a) / (1 + a). */
static const double A[4] = {0, 1, 4.5, 9};

static double g_function(const double *u) {
  double product = 1;
  for (int i = 0; i < 4; i++) product *= (fabs(4 * u[i] - 2) + A[i]) / (1 + A[i]);
  return product;
}

static void g_indices(double *first, double *total) {
  double all = 1;
  for (int i = 0; i < 4; i++) all *= 1 + 1 / (3 * pow(1 + A[i], 2));
  for (int i = 0; i < 4; i++) {
    double alone = 1 / (3 * pow(1 + A[i], 2));
    first[i]     = alone / (all - 1);
    total[i]     = alone * all / (1 + alone) / (all - 1);
  }
}

static double *outputs(function *f, int n, int d, unsigned long seed) {
  double *u = malloc((size_t)n * (size_t)(d + 2) * (size_t)d * sizeof *u);
  double *y = malloc((size_t)n * (size_t)(d + 2) * sizeof *y);
  assert_ok(plan_saltelli(n, d, seed, u));
  for (int j = 0; j < n * (d + 2); j++) y[j] = f(u + (size_t)j * (size_t)d);
  free(u);
  return y;
}

/* Largest error of all indices; count of bounds that do not hold the index is added to missed. */
static double error_of(function *f, void exact(double *, double *), int n, int d,
                       unsigned long seed, int *missed) {
  double       first[PLAN_INDEX_INPUTS], total[PLAN_INDEX_INPUTS], error = 0;
  plan_indices found;
  exact(first, total);
  double *y = outputs(f, n, d, seed);
  assert_ok(plan_indices_of(n, d, y, 0.95, seed, &found));
  free(y);
  for (int i = 0; i < d; i++) {
    const plan_estimate *s = &found.first[i], *t = &found.total[i];
    error = fmax(error, fmax(fabs(s->value - first[i]), fabs(t->value - total[i])));
    *missed += !(s->low <= first[i] && first[i] <= s->high);
    *missed += !(t->low <= total[i] && total[i] <= t->high);
  }
  return error;
}

static void converges(const char *name, function *f, void exact(double *, double *), int d) {
  const int sizes[] = {128, 512, 2048};
  double    error[3];
  int       missed = 0;
  for (int k = 0; k < 3; k++) {
    double square = 0;
    for (unsigned long seed = 0; seed < 6; seed++)
      square += pow(error_of(f, exact, sizes[k], d, seed, &missed), 2) / 6;
    error[k] = sqrt(square);
  }
  double order = log2(error[0] / error[2]) / 4, share = missed / (3.0 * 6 * 2 * d);
  printf("%s: errors %.1e %.1e %.1e, order %.2f; 95 %% bounds missed %.1f %%\n", name, error[0],
         error[1], error[2], order, 100 * share);
  assert_true(order > 0.65); /* independent points: 0.5 */
  assert_below(error[2], 0.01);
  assert_below(share, 0.05);
}

static void ishigami_converges(void **state) {
  (void)state;
  converges("Ishigami", ishigami, ishigami_indices, 3);
}

static void the_g_function_converges(void **state) {
  (void)state;
  converges("G function", g_function, g_indices, 4);
}

static void failed_designs_cost_their_block(void **state) {
  (void)state;
  enum { BLOCKS = 512 };
  plan_indices all, left;
  double      *y = outputs(ishigami, BLOCKS, 3, 1);
  assert_ok(plan_indices_of(BLOCKS, 3, y, 0.95, 1, &all));
  y[5 * 7 + 3] = NAN;
  y[5 * 7 + 1] = NAN;
  y[5 * 90]    = INFINITY;
  assert_ok(plan_indices_of(BLOCKS, 3, y, 0.95, 1, &left));
  free(y);
  assert_int_equal(left.n_failed, 2);
  assert_int_equal(left.n_blocks, BLOCKS - 2);
  for (int i = 0; i < 3; i++) assert_near(left.total[i].value, all.total[i].value, 0.02);
  assert_true(left.total[0].value != all.total[0].value);
}

static void what_has_no_indices_is_refused(void **state) {
  (void)state;
  const double y[10] = {2, 2, 2, 2, 2, 2, 2, 2, 2, 2};
  plan_indices found;
  double       u[1];
  assert_refused(plan_indices_of(2, 3, y, 0.95, 1, &found), SHB_ERR_INPUT, "output that varies");
  assert_refused(plan_indices_of(1, 3, y, 0.95, 1, &found), SHB_ERR_INPUT, "2 blocks");
  assert_refused(plan_saltelli(1, 21, 1, u), SHB_ERR_INPUT, "1 to 20 inputs, not of 21");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ishigami_converges),
      cmocka_unit_test(the_g_function_converges),
      cmocka_unit_test(failed_designs_cost_their_block),
      cmocka_unit_test(what_has_no_indices_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
