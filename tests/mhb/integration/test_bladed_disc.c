/* The balance of a bladed disc by nodal diameters against all its sectors at once.
 *
 * The ring of eight sectors is condensed to its eight contacts, each to the ground. Its balance
 * knows no nodal diameter. Time integration of the ring from rest ends on the same motion. */
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/integration/integration_sweep.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/periodic.h"

enum { N = DISC_SECTORS, FEW = 7, MANY = 31 };

typedef struct {
  lumped_disc           disc;
  modal_nodal_diameters waves;
  mhb_settings          settings; /* of one sector */
} sector;

static void sector_create(int engine_order, int harmonics, double load, sector *s) {
  s->disc = lumped_disc_of(0.8, 1.7);
  lumped_disc_waves(&s->disc, DISC_DOFS, &s->waves);
  s->settings                 = lumped_disc_settings(engine_order, harmonics);
  s->settings.n_preloads      = 1;
  s->settings.scale           = load;
  s->settings.nodal_diameters = &s->waves;
}

/* all[pair][3][2 m + 1] <- the motion x[3][2 m + 1] of one contact in every sector. Sector b lags
 * by b E k/N of a turn. */
static void expand(int m, int engine_order, const double *x, double *all) {
  const int nb = 2 * m + 1;
  for (int b = 0; b < N; b++)
    for (int d = 0; d < 3; d++)
      for (int k = 0; k <= m; k++) {
        const double *from = x + d * nb;
        double       *to   = all + (3 * b + d) * nb;
        if (k == 0) {
          to[0] = from[0];
          continue;
        }
        const double complex turn = cexp(-I * SHB_TWO_PI * k * engine_order * b / N);
        const double complex a    = CMPLX(from[2 * k - 1], from[2 * k]) * turn;
        to[2 * k - 1]             = creal(a);
        to[2 * k]                 = cimag(a);
      }
}

/* Distance of the vibrations, relative to b. The mean of a stuck contact is not determined. */
static double distance(int n, int nb, const double *a, const double *b) {
  double away = 0, size = 0;
  for (int i = 0; i < n; i++) {
    if (i % nb == 0) continue;
    away += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return sqrt(away / size);
}

static double slipping(const periodic *p) {
  return p->residual->eval->info[0].share[1];
}

/* Residual of the ring's balance at x, relative to x. */
static double residual(const modal_model *ring, const mhb_settings *settings, double *x) {
  static double r[3 * N * (2 * FEW + 1)];
  const int     n    = 3 * N * (2 * FEW + 1);
  double        left = 0, size = 0;
  mhb_balance  *b;
  assert_ok(mhb_balance_create(ring, settings, &b));
  assert_int_equal(b->n, n);
  mhb_balance_set_preload(b, settings->n0[0]);
  mhb_balance_evaluate(b, x, 0.93, r, NULL, NULL);
  for (int i = 0; i < n; i++) {
    left += r[i] * r[i];
    size += x[i] * x[i];
  }
  mhb_balance_destroy(b);
  return sqrt(left / size);
}

static void the_ring_has_the_same_solution(void **state) {
  (void)state;
  static const int order[] = {1, 4, 6, 11}; /* N/2; above it and above N the wave runs back */
  for (int i = 0; i < 4; i++) {
    const int     E = order[i];
    sector        s;
    modal_model   ring;
    periodic      one;
    static double x[3 * N * (2 * FEW + 1)];
    sector_create(E, FEW, 5, &s);
    lumped_disc_ring(&s.disc, E, &ring);
    const mhb_settings of_ring = lumped_disc_ring_settings(&s.settings);
    periodic_create(&s.waves.model[0], &s.settings, 0.93, NULL, &one);
    expand(FEW, E, one.x, x);
    const double left = residual(&ring, &of_ring, x);
    expand(FEW, -E, one.x, x);
    const double turned = residual(&ring, &of_ring, x);
    print_message("E = %d: %.1e, slipping for %.2f of the period; turned the other way %.1e\n", E,
                  left, slipping(&one), turned);
    assert_below(left, 1e-8);
    assert_true(slipping(&one) > 0.1);
    if (E % (N / 2) != 0) assert_true(turned > 0.1);
    periodic_destroy(&one);
    modal_model_free(&ring);
    modal_nodal_diameters_free(&s.waves);
  }
}

/* x[3 N][2 m + 1] <- the motion of all contacts at a point. */
static void motion_of(const mhb_branch *b, int point, int m, double *x) {
  const int K = b->n_harmonics + 1;
  for (int row = 0; row < 3 * N; row++)
    for (int k = 0; k < K && k <= m; k++) {
      const double complex a =
          b->motion[((size_t)point * 3 * N + (size_t)row) * (size_t)K + (size_t)k];
      x[row * (2 * m + 1) + (k ? 2 * k - 1 : 0)] = creal(a);
      if (k) x[row * (2 * m + 1) + 2 * k] = cimag(a);
    }
}

static void time_integration_ends_on_it(void **state) {
  sector                   s;
  modal_model              ring;
  mhb_response            *response;
  mhb_integration_settings asked = {.n_frequencies = 1,
                                    .listed        = true,
                                    .frequency     = {0.86 / SHB_TWO_PI},
                                    .start         = MHB_START_FROM_REST,
                                    .steps         = 32,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 2000};
  static double            x[3 * N * (2 * MANY + 1)], end[3 * N * (2 * MANY + 1)];
  const int                n = 3 * N * (2 * MANY + 1);
  (void)state;
  sector_create(3, MANY, 5, &s);
  lumped_disc_ring(&s.disc, 3, &ring);
  const mhb_settings of_ring = lumped_disc_ring_settings(&s.settings);
  assert_ok(mhb_integration_sweep(&ring, &of_ring, &asked, NULL, NULL, NULL, NULL, &response));
  const mhb_branch *b = &response->branch[0];
  assert_int_equal(b->n_points, 1);
  for (int i = 0; i < b->n_points; i++) {
    periodic one;
    assert_int_equal(b->multiple[i], 1);
    periodic_create(&s.waves.model[0], &s.settings, SHB_TWO_PI * b->frequency[i], NULL, &one);
    expand(MANY, 3, one.x, x);
    motion_of(b, i, MANY, end);
    const double apart = distance(n, 2 * MANY + 1, x, end);
    print_message("%.2f rad/s: %.1e apart, slipping for %.2f of the period\n", one.omega, apart,
                  slipping(&one));
    assert_below(apart, 5e-5);
    assert_true(slipping(&one) > 0.1);
    periodic_destroy(&one);
  }
  mhb_response_destroy(response);
  modal_model_free(&ring);
  modal_nodal_diameters_free(&s.waves);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_ring_has_the_same_solution),
      cmocka_unit_test(time_integration_ends_on_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
