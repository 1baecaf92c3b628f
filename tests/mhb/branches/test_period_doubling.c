/* The direction of a doubled branch: the least singular vector of the Jacobian's odd harmonics. */
#include "mhb/branches/period_doubling.h"

#include "mhb/balance/newton.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { PAIRS = 2, H = 4, NB = 2 * H + 1, N = PAIRS * 3 * NB };

typedef struct {
  modal_model  model;
  mhb_settings settings;
  mhb_balance *balance;
} fixture;

static void set_up(fixture *f, double n0) {
  random_model(PAIRS, WITH_LEFT | WITH_RESIDUAL, 4, &f->model);
  f->settings              = random_settings(H);
  f->settings.subharmonics = 2;
  f->settings.blades       = 7;
  assert_ok(mhb_balance_create(&f->model, &f->settings, &f->balance));
  mhb_balance_set_preload(f->balance, n0);
  assert_int_equal(f->balance->n, N);
}

static void tear_down(fixture *f) {
  mhb_balance_destroy(f->balance);
  modal_model_free(&f->model);
}

static bool is_odd(int i) {
  return (i % NB + 1) / 2 % 2 == 1;
}

/* A motion of the period of the excitation: even harmonics alone. */
static void set_even(double size, double *x) {
  unsigned long long seed = 6;
  for (int i = 0; i < N; i++) {
    double random = random_unit(&seed);
    x[i]          = is_odd(i) ? 0 : size * random;
  }
}

/* |J v| over the odd harmonics, and over the even ones. */
static void image(fixture *f, const double *x, const double *v, double *odd, double *even) {
  static double jacobian[N * N];
  double        r[N], square[2] = {0};
  mhb_balance_evaluate(f->balance, x, 1.3, r, jacobian, NULL);
  for (int i = 0; i < N; i++) {
    double sum = 0;
    for (int j = 0; j < N; j++) sum += jacobian[j * N + i] * v[j];
    square[is_odd(i)] += sum * sum;
  }
  *odd  = sqrt(square[1]);
  *even = sqrt(square[0]);
}

/* J maps the direction to a vector of the length of its singular value, the least one, and no odd
 * vector to a shorter one. By symmetry odd and even harmonics do not couple. */
static void it_is_the_least_singular_vector(void **state) {
  (void)state;
  static const double size[] = {1e-3, 0.2, 0.5, 1};
  for (int i = 0; i < 4; i++) {
    fixture            f;
    double             x[N], along[N], least, odd, even;
    unsigned long long seed = 8;
    set_up(&f, 0.3);
    set_even(size[i], x);
    mhb_period_doubling_direction(f.balance, x, 1.3, along, &least);
    assert_near(mhb_norm(along, N), 1, 1e-13);
    for (int k = 0; k < N; k++) assert_true(is_odd(k) || along[k] == 0);
    image(&f, x, along, &odd, &even);
    print_message("|x| %.0e: singular value %.4f, even part of J along %.1e\n", size[i], least,
                  even);
    assert_near(odd, least, 1e-11);
    assert_below(even, 1e-6 * odd); /* to the tolerance of the contact law */
    for (int trial = 0; trial < 20; trial++) {
      double v[N];
      for (int k = 0; k < N; k++) v[k] = along[k] + 0.3 * is_odd(k) * random_unit(&seed);
      image(&f, x, v, &odd, &even);
      assert_true(odd >= least * mhb_norm(v, N) * (1 - 1e-12));
    }
    tear_down(&f);
  }
}

/* Without contact the Jacobian is I. */
static void without_contact_it_is_one(void **state) {
  (void)state;
  fixture f;
  double  x[N], along[N], least;
  set_up(&f, -100);
  set_even(0.3, x);
  mhb_period_doubling_direction(f.balance, x, 1.3, along, &least);
  assert_near(least, 1, 1e-13);
  tear_down(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_the_least_singular_vector),
                                     cmocka_unit_test(without_contact_it_is_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
