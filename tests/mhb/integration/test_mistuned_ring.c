/* A ring of different blades by time integration, from rest, ends on the solution of the balance.
 * The integration has the ring as one dense model and shares no block with the balance. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/balance/newton.h"
#include "mhb/integration/integration_sweep.h"
#include "mhb/mistuning/dense_ring.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = 6, M = 31, NB = 2 * M + 1, ALL = 3 * N * NB };

static const double DELTA[N] = {0.03, -0.02, 0.01, 0, -0.04, 0.02};

/* x[ALL] <- motion of a point. */
static void motion_of(const mhb_branch *b, int point, double *x) {
  const int K = b->n_harmonics + 1;
  for (int row = 0; row < 3 * N; row++)
    for (int k = 0; k < K && k <= M; k++) {
      const double complex a =
          b->motion[((size_t)point * 3 * N + (size_t)row) * (size_t)K + (size_t)k];
      x[row * NB + (k ? 2 * k - 1 : 0)] = creal(a);
      if (k) x[row * NB + 2 * k] = cimag(a);
    }
}

/* Distance of the vibrations, relative. The mean of a contact that sticks is not determined. */
static double distance(const double *a, const double *b) {
  double away = 0, size = 0;
  for (int i = 0; i < ALL; i++) {
    if (i % NB == 0) continue;
    away += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return sqrt(away / size);
}

static void ends_on_the_balance(void **state) {
  modal_model              blade, dense;
  mhb_settings             s = random_settings(M), of_dense;
  mhb_mistuned_ring       *ring;
  mhb_integration_settings asked = {.n_frequencies = 2,
                                    .listed        = true,
                                    .frequency     = {1.02 / SHB_TWO_PI, 1.31 / SHB_TWO_PI},
                                    .start         = MHB_START_FROM_REST,
                                    .steps         = 64,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 2000};
  mhb_response            *response;
  mhb_balance             *b;
  mhb_newton              *newton;
  static double            x[ALL], end[ALL];
  double                   worst = 0, slip = 0;
  (void)state;
  random_model(1, WITH_LEFT, 3, &blade);
  s.blades     = N;
  s.n_preloads = 1;
  s.scale      = 5;
  assert_ok(mhb_mistuned_ring_create(&blade, &s, DELTA, 1, &ring));
  s.ring = ring;
  mhb_dense_ring(ring, &dense);
  mhb_dense_ring_settings(&s, &of_dense);
  assert_ok(mhb_integration_sweep(&dense, &of_dense, &asked, NULL, NULL, NULL, NULL, &response));
  assert_ok(mhb_balance_create(&ring->whole, &s, &b));
  mhb_balance_set_preload(b, s.n0[0]);
  newton                   = mhb_newton_create(b->n);
  const mhb_branch *branch = &response->branch[0];
  assert_int_equal(branch->n_points, 2);
  for (int p = 0; p < branch->n_points; p++) {
    int iterations;
    assert_int_equal(branch->multiple[p], 1);
    motion_of(branch, p, end);
    memcpy(x, end, sizeof x);
    assert_int_equal(
        mhb_newton_solve(newton, b, SHB_TWO_PI * branch->frequency[p], 1e-10, x, &iterations),
        MHB_CONVERGED);
    worst = fmax(worst, distance(end, x));
    for (int a = 0; a < N; a++)
      slip = fmax(slip, 1 - branch->state[((size_t)p * N + (size_t)a) * 3]);
  }
  print_message("distance %.1e, slipping or open for %.2f of a period\n", worst, slip);
  assert_below(worst, 1e-5);
  assert_true(slip > 0.3); /* else it would be linear */
  mhb_newton_destroy(newton);
  mhb_balance_destroy(b);
  mhb_response_destroy(response);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&dense);
  modal_model_free(&blade);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(ends_on_the_balance)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
