/* Both norms of the truncation estimate against the errors that they estimate, on random contacts.
 * The error is the difference to 127 harmonics at the same frequency. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/truncation_error.h"
#include "mhb/continuation/first_solution.h"
#include "mhb/numerics/fourier.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"
#include "tests/support/settings.h"
#include "tests/support/three_degree.h"

enum { FINE = 127, TIMES = 1024, CONTACTS = 6 };

typedef enum { SOFT, RIGID, SEPARATING } kind;

/* A balance, its solution there and the estimate. */
typedef struct {
  mhb_settings    settings;
  mhb_balance    *b;
  mhb_newton     *newton;
  mhb_truncation *truncation;
  double         *x, omega;
} solution;

static double between(unsigned long long *seed, double low, double high) {
  return low + (high - low) * 0.5 * (1 + random_unit(seed));
}

/* Contact and frequency, rad/s. */
static mhb_settings random_contact(kind of, unsigned long long *seed, double *omega) {
  const double mu = between(seed, 0.2, 0.8), n0 = between(seed, 0.02, 0.09);
  *omega = between(seed, 0.85, 1.7);
  if (of == SOFT) return ground_settings(mu, 0.8, pow(10, between(seed, -0.5, 0.7)), n0, 1);
  if (of == RIGID) return ground_settings(mu, 0.8, pow(10, between(seed, 2, 3.5)), n0, 1);
  return ground_settings(mu, pow(10, between(seed, -0.3, 1)), pow(10, between(seed, -0.5, 0.7)),
                         between(seed, -0.1, 0.05), 1);
}

static void solution_create(const modal_model *model, const mhb_settings *s, double omega, int m,
                            solution *out) {
  *out                    = (solution){.settings = *s, .omega = omega};
  out->settings.harmonics = m;
  assert_ok(mhb_balance_create(model, &out->settings, &out->b));
  out->newton = mhb_newton_create(out->b->n);
  assert_ok(mhb_truncation_create(out->b, &out->truncation));
  out->x = calloc((size_t)out->b->n, sizeof(double));
  assert_non_null(out->x);
}

static void solution_destroy(solution *s) {
  mhb_truncation_destroy(s->truncation);
  mhb_newton_destroy(s->newton);
  mhb_balance_destroy(s->b);
  free(s->x);
}

/* Largest |e(t)| over the rows. */
static double largest_in_period(int rows, int m, const double *e) {
  const int nb  = mhb_real_size(m);
  double    top = 0, basis[nb];
  for (int i = 0; i < TIMES; i++) {
    double sum = 0;
    mhb_basis(m, SHB_TWO_PI * i / TIMES, basis, NULL);
    for (int row = 0; row < rows; row++) {
      double y = 0;
      for (int j = 0; j < nb; j++) y += e[row * nb + j] * basis[j];
      sum += y * y;
    }
    top = fmax(top, sum);
  }
  return sqrt(top);
}

/* Root-mean-square and largest error of the coarse solution, relative to the vibration. false: the
 * fine one is another, or was not found. */
static bool true_errors(const solution *coarse, solution *fine, double error[2]) {
  const int nb = coarse->b->nb, wide = fine->b->nb;
  double   *e = fine->x;
  int       iterations;
  memset(e, 0, sizeof *e * (size_t)fine->b->n);
  for (int row = 0; row < 3; row++)
    memcpy(e + row * wide, coarse->x + row * nb, sizeof *e * (size_t)nb);
  if (mhb_newton_solve(fine->newton, fine->b, fine->omega, 1e-11, e, &iterations) != MHB_CONVERGED)
    return false;
  const double size = mhb_balance_vibration(fine->b, e);
  for (int row = 0; row < 3; row++)
    for (int i = 0; i < nb; i++) e[row * wide + i] -= coarse->x[row * nb + i];
  error[0] = mhb_norm(e, fine->b->n) / size;
  error[1] = largest_in_period(3, FINE, e) / size;
  return error[0] < 0.1;
}

/* Ratios told/true of both norms at one contact with m harmonics; false: there are none. */
static bool ratios(const modal_model *model, const mhb_settings *s, double omega, int m,
                   double ratio[2]) {
  solution coarse, fine;
  int      iterations;
  double   told[2] = {0}, error[2] = {0};
  solution_create(model, s, omega, m, &coarse);
  solution_create(model, s, omega, FINE, &fine);
  bool ok = mhb_first_solution(coarse.newton, coarse.b, omega, 1e-11, coarse.x, &iterations) ==
            MHB_CONVERGED;
  if (ok) {
    mhb_balance_linearise(coarse.b, coarse.x, omega, coarse.newton->r, NULL);
    told[0] = mhb_truncation_error(coarse.truncation, coarse.x);
    told[1] = coarse.truncation->largest;
    ok      = told[0] > 0 && true_errors(&coarse, &fine, error);
  }
  for (int i = 0; i < 2; i++) ratio[i] = ok ? told[i] / error[i] : 0;
  if (ok)
    print_message("  m %2d ku %7.2f: rms %.1e told %.2f, largest %.1e told %.2f, order %.2f\n", m,
                  s->ku[0], error[0], ratio[0], error[1], ratio[1], coarse.truncation->order);
  solution_destroy(&coarse);
  solution_destroy(&fine);
  return ok;
}

/* Neither norm tells less than the error, nor three times as much. */
static void check(kind of) {
  unsigned long long seed   = 11 + (unsigned)of;
  double             low[2] = {INFINITY, INFINITY}, high[2] = {0, 0};
  int                n = 0;
  for (int i = 0; i < CONTACTS; i++) {
    double       omega;
    modal_model  model;
    mhb_settings s = random_contact(of, &seed, &omega);
    if (of == RIGID && i % 2)
      two_mode_model(3.7, 0.01, 1, 1, 0.02, &model);
    else
      three_degree_model(&model);
    for (int m = 7; m <= 31; m = 2 * m + 1) {
      double ratio[2];
      if (!ratios(&model, &s, omega, m, ratio)) continue;
      n++;
      for (int j = 0; j < 2; j++) {
        low[j]  = fmin(low[j], ratio[j]);
        high[j] = fmax(high[j], ratio[j]);
      }
    }
    modal_model_free(&model);
  }
  print_message(
      "%d solutions, told over true: root mean square %.2f to %.2f, largest %.2f to %.2f\n", n,
      low[0], high[0], low[1], high[1]);
  assert_true(n >= 6);
  for (int j = 0; j < 2; j++) assert_true(low[j] >= 0.98 && high[j] <= 3);
}

static void soft_friction(void **state) {
  (void)state;
  check(SOFT);
}

static void nearly_rigid_friction(void **state) {
  (void)state;
  check(RIGID);
}

static void separation(void **state) {
  (void)state;
  check(SEPARATING);
}

/* At a resonance without damping the step to the solution may be any number of times as long as the
 * vibration. What is told is a number, as a file needs it, and rises with that ratio. */
static void an_error_without_a_bound_is_a_number(void **state) {
  (void)state;
  enum { M = 3 };
  modal_model  model;
  mhb_settings s    = ground_settings(0, 0.8, 0.5, 0, 1);
  double       last = 0;
  three_degree_model(&model);
  memset(model.damping_ratio, 0, sizeof(double) * (size_t)model.n_modes);
  for (int power = 0; power <= 150; power += 15) {
    const double omega = SHB_TWO_PI * model.frequency[0] / (M + 1), size = pow(10, -power);
    solution     at;
    solution_create(&model, &s, omega, M, &at);
    at.x[1] = size; /* a contact without preload opens for half of the period */
    mhb_balance_linearise(at.b, at.x, omega, at.newton->r, NULL);
    const double told = mhb_truncation_error(at.truncation, at.x), most = at.truncation->largest;
    print_message("vibration %.0e: %.1e, largest %.1e\n", size, told, most);
    assert_true(isfinite(told) && isfinite(most) && told <= 1e30 && most <= 1e30);
    assert_true(told >= last);
    last = told;
    solution_destroy(&at);
  }
  assert_true(last == 1e30);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(soft_friction), cmocka_unit_test(nearly_rigid_friction),
      cmocka_unit_test(separation), cmocka_unit_test(an_error_without_a_bound_is_a_number)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
