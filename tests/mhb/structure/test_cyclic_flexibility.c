/* T M T^H for any inter-blade phase, against the product by hand. */
#include "mhb/structure/cyclic_flexibility.h"
#include "mhb/structure/relative_motion.h"
#include "tests/support/check.h"

enum { PAIRS = 3, N = 3 * PAIRS, MOST = 2 * N };

static unsigned long long seed = 3;

static double uniform(void) {
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(seed >> 11) / 4503599627370496. - 1;
}

typedef struct {
  int                     sides, nc;
  double                  M[MOST * MOST], T0[9 * PAIRS];
  mhb_cyclic_flexibility *f;
} fixture;

/* A symmetric matrix. */
static void set_matrix(fixture *x) {
  for (int i = 0; i < x->nc; i++)
    for (int j = 0; j <= i; j++) x->M[i * x->nc + j] = x->M[j * x->nc + i] = uniform();
}

/* Orthogonal axes, a symmetric matrix. */
static void start(fixture *x, int sides) {
  x->sides = sides;
  x->nc    = sides * N;
  x->f     = NULL;
  set_matrix(x);
  for (int a = 0; a < PAIRS; a++) {
    double p = uniform(), cp = cos(p), sp = sin(p), q = uniform(), cq = cos(q), sq = sin(q);
    double T[9] = {cp * cq, -sp, cp * sq, sp * cq, cp, sp * sq, -sq, 0, cq};
    memcpy(x->T0 + 9 * a, T, sizeof T);
  }
  x->f = mhb_cyclic_flexibility_create(x->M, x->nc, x->T0, PAIRS, sides);
}

/* Row i, column j of T M T^H. */
static double complex by_hand(const fixture *x, double complex e, int i, int j) {
  const mhb_relative t   = {N, x->sides, x->T0};
  double complex     sum = 0;
  for (int a = 0; a < 3 * x->sides; a++)
    for (int b = 0; b < 3 * x->sides; b++) {
      int row = a / 3 * N + i / 3 * 3 + a % 3, column = b / 3 * N + j / 3 * 3 + b % 3;
      sum += mhb_relative_weight(&t, i, a / 3, a % 3, e) * x->M[row * x->nc + column] *
             conj(mhb_relative_weight(&t, j, b / 3, b % 3, e));
    }
  return sum;
}

static void compare(const fixture *x, double complex e, double factor) {
  double complex R[N * N], block[3][3], p[N], product[N] = {0};
  for (int i = 0; i < N * N; i++) R[i] = i;
  for (int i = 0; i < N; i++) p[i] = uniform() + I * uniform();
  mhb_cyclic_flexibility_add(x->f, e, factor, R);
  mhb_cyclic_flexibility_add_product(x->f, e, factor, p, product);
  for (int i = 0; i < N; i++) {
    double complex sum = 0;
    for (int j = 0; j < N; j++) {
      assert_near(cabs(R[i * N + j] - (i * N + j) - factor * by_hand(x, e, i, j)), 0,
                  2e-14 * N * N);
      sum += by_hand(x, e, i, j) * p[j];
    }
    assert_near(cabs(product[i] - factor * sum), 0, 2e-13 * fabs(factor));
  }
  for (int a = 0; a < PAIRS; a++) {
    memset(block, 0, sizeof block);
    mhb_cyclic_flexibility_add_block(x->f, e, factor, a, block);
    for (int i = 0; i < 9; i++)
      assert_near(cabs(block[i / 3][i % 3] - factor * by_hand(x, e, 3 * a + i / 3, 3 * a + i % 3)),
                  0, 1e-13);
  }
}

static void any_phase(void **state) {
  (void)state;
  const double phase[] = {0, .7, 3.14159, -1.1};
  for (int sides = 1; sides <= 2; sides++) {
    fixture x;
    start(&x, sides);
    for (int i = 0; i < 4; i++) compare(&x, cexp(I * phase[i]), 1 + i);
    mhb_cyclic_flexibility_destroy(x.f);
  }
}

static void another_matrix(void **state) {
  (void)state;
  fixture x;
  start(&x, 2);
  set_matrix(&x);
  mhb_cyclic_flexibility_set(x.f, x.M, x.nc, x.T0);
  compare(&x, cexp(.3 * I), -2);
  mhb_cyclic_flexibility_destroy(x.f);
}

/* To ground the left side of a model that has one is not used. */
static void ground_is_the_right_side_alone(void **state) {
  (void)state;
  fixture x, right;
  start(&x, 2);
  right       = x;
  right.sides = 1;
  right.f     = mhb_cyclic_flexibility_create(x.M, x.nc, x.T0, PAIRS, 1);
  compare(&right, cexp(.9 * I), 1.5);
  mhb_cyclic_flexibility_destroy(right.f);
  mhb_cyclic_flexibility_destroy(x.f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_phase),
      cmocka_unit_test(another_matrix),
      cmocka_unit_test(ground_is_the_right_side_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
