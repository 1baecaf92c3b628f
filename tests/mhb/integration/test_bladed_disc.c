/* The balance of a bladed disc by nodal diameters against all its sectors at once.
 *
 * The ring of eight sectors is condensed to its eight contacts, each to the ground. Its balance
 * knows no nodal diameter. Time integration of the ring from rest ends on the same motion. */
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/integration/integration_sweep.h"
#include "mhb/structure/dense_disc.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"
#include "tests/support/periodic.h"

enum { N = DISC_SECTORS, FEW = 7, MANY = 31 };

typedef struct {
  lumped_disc           disc;
  modal_nodal_diameters waves;
  mhb_settings          settings; /* of one sector */
} sector;

static void sector_create_spinning(int engine_order, int harmonics, double load, double spin,
                                   sector *s) {
  s->disc      = lumped_disc_of(0.8, 1.7);
  s->disc.spin = spin;
  lumped_disc_waves(&s->disc, DISC_DOFS, &s->waves);
  s->settings                 = lumped_disc_settings(engine_order, harmonics);
  s->settings.n_preloads      = 1;
  s->settings.scale           = load;
  s->settings.nodal_diameters = &s->waves;
}

/* A sector that is integrated, on engine order 3 at *omega: with Coriolis terms more damped, where
 * the wave is stable. */
static void sector_create_stable(double spin, sector *s, double *omega) {
  *omega = spin > 0 ? 0.93 : 0.86;
  if (spin > 0) {
    s->disc         = lumped_disc_of(0.8, 1.7);
    s->disc.spin    = spin;
    s->disc.damping = 0.1;
    lumped_disc_waves(&s->disc, DISC_DOFS, &s->waves);
    s->settings                 = lumped_disc_settings(3, MANY);
    s->settings.n_preloads      = 1;
    s->settings.n0[0]           = 0.4;
    s->settings.scale           = 12;
    s->settings.nodal_diameters = &s->waves;
  } else {
    sector_create_spinning(3, MANY, 5, 0, s);
  }
}

static void sector_create(int engine_order, int harmonics, double load, sector *s) {
  sector_create_spinning(engine_order, harmonics, load, 0, s);
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

/* spin: with Coriolis terms. */
static void compare_solutions(double spin) {
  static const int order[] = {1, 4, 6, 11}; /* N/2; above it and above N the wave runs back */
  for (int i = 0; i < 4; i++) {
    const int     E = order[i];
    sector        s;
    modal_model   ring;
    periodic      one;
    static double x[3 * N * (2 * FEW + 1)];
    sector_create_spinning(E, FEW, 5, spin, &s);
    lumped_disc_ring(&s.disc, E, &ring);
    const mhb_settings of_ring = lumped_disc_ring_settings(&s.settings);
    periodic_create(&s.waves.model[0], &s.settings, 0.93, NULL, &one);
    expand(FEW, E, one.x, x);
    const double left = residual(&ring, &of_ring, x);
    expand(FEW, -E, one.x, x);
    const double turned = residual(&ring, &of_ring, x);
    print_message(
        "E = %d, spin %g: %.1e, slipping for %.2f of the period; turned the other way %.1e\n", E,
        spin, left, slipping(&one), turned);
    assert_below(left, 1e-8);
    assert_true(slipping(&one) > 0.1);
    if (E % (N / 2) != 0) assert_true(turned > 0.1);
    periodic_destroy(&one);
    modal_model_free(&ring);
    modal_nodal_diameters_free(&s.waves);
  }
}

static void the_ring_has_the_same_solution(void **state) {
  (void)state;
  compare_solutions(0);
}

static void with_coriolis_terms_too(void **state) {
  (void)state;
  compare_solutions(0.1);
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

static void ends_on_it(double spin) {
  sector                   s;
  modal_model              ring;
  mhb_response            *response;
  double                   omega;
  mhb_integration_settings asked = {.n_frequencies = 1,
                                    .listed        = true,
                                    .start         = MHB_START_FROM_REST,
                                    .steps         = 32,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 2000};
  static double            x[3 * N * (2 * MANY + 1)], end[3 * N * (2 * MANY + 1)];
  const int                n = 3 * N * (2 * MANY + 1);
  sector_create_stable(spin, &s, &omega);
  asked.frequency[0] = omega / SHB_TWO_PI;
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
    print_message("%.2f rad/s, spin %g: %.1e apart, slipping for %.2f of the period\n", one.omega,
                  spin, apart, slipping(&one));
    assert_below(apart, 5e-5);
    assert_true(slipping(&one) > 0.1);
    periodic_destroy(&one);
  }
  mhb_response_destroy(response);
  modal_model_free(&ring);
  modal_nodal_diameters_free(&s.waves);
}

static void time_integration_ends_on_it(void **state) {
  (void)state;
  ends_on_it(0);
}

static void with_coriolis_terms_it_ends_on_it_too(void **state) {
  (void)state;
  ends_on_it(0.1);
}

/* The ring made of nodal diameters is that of the sectors: all contacts, probe and load. */
static void sectors_in_one_are_the_ring(void **state) {
  static const int order[] = {1, 4, 6, 11};
  (void)state;
  for (int i = 0; i < 8; i++) {
    const int       E = order[i % 4];
    const double    w = 0.93;
    sector          s;
    modal_model     ring, dense;
    mhb_settings    of_dense;
    mhb_receptance *r[2];
    sector_create_spinning(E, 2, 5, i < 4 ? 0 : 0.1, &s);
    lumped_disc_ring(&s.disc, E, &ring);
    const mhb_settings of_ring = lumped_disc_ring_settings(&s.settings);
    assert_ok(mhb_dense_disc(&s.settings, &dense));
    mhb_dense_disc_settings(&s.settings, &of_dense);
    assert_ok(mhb_receptance_create(&ring, &of_ring, 2, &r[0]));
    assert_ok(mhb_receptance_create(&dense, &of_dense, 2, &r[1]));
    assert_int_equal(r[0]->n, r[1]->n);
    const int      n       = r[0]->n;
    double         away[3] = {0}, size[3] = {0};
    double complex p[3 * N], motion[2][3 * N], probe[2][3];
    for (int k = 0; k <= 2; k++) {
      for (int c = 0; c < n; c++) p[c] = k ? CMPLX(sin(c + k), cos(3 * c)) : sin(c);
      for (int j = 0; j < 2; j++) {
        mhb_receptance_at(r[j], w, 2);
        mhb_receptance_motion(r[j], k, p, motion[j]);
        mhb_receptance_probe(r[j], k, p, probe[j]);
      }
      for (int c = 0; c < n; c++) {
        away[0] = fmax(away[0], cabs(motion[1][c] - motion[0][c]));
        size[0] = fmax(size[0], cabs(motion[0][c]));
        away[1] = fmax(away[1], cabs(r[1]->free[k * n + c] - r[0]->free[k * n + c]));
        size[1] = fmax(size[1], cabs(r[0]->free[k * n + c]));
      }
      for (int c = 0; c < 3; c++) {
        away[2] = fmax(away[2], cabs(probe[1][c] - probe[0][c]));
        size[2] = fmax(size[2], cabs(probe[0][c]));
      }
    }
    print_message("E = %d, spin %g: contact %.1e, load %.1e, probe %.1e apart\n", E, s.disc.spin,
                  away[0] / size[0], away[1] / size[1], away[2] / size[2]);
    for (int j = 0; j < 3; j++) assert_below(away[j] / size[j], 1e-11);
    for (int j = 0; j < 2; j++) mhb_receptance_destroy(r[j]);
    modal_model_free(&ring);
    modal_model_free(&dense);
    modal_nodal_diameters_free(&s.waves);
  }
}

/* Distance of sector 0 between both, relative, under forces in the form of the wave. */
static double distance_of_receptances(mhb_receptance *one, mhb_receptance *all, int engine_order,
                                      double omega) {
  double away = 0, size = 0;
  mhb_receptance_at(one, omega, 2);
  mhb_receptance_at(all, omega, 2);
  for (int k = 0; k <= 2; k++) {
    double complex p[3] = {1, k ? CMPLX(0.3, 0.5) : 0.3, k ? I : -0.7}, of_all[3 * N];
    double complex motion[2][3 * N], probe[2][3];
    for (int c = 0; c < 3 * N; c++)
      of_all[c] = p[c % 3] * cexp(-I * SHB_TWO_PI * k * engine_order * (c / 3) / N);
    mhb_receptance_motion(one, k, p, motion[0]);
    mhb_receptance_motion(all, k, of_all, motion[1]);
    mhb_receptance_probe(one, k, p, probe[0]);
    mhb_receptance_probe(all, k, of_all, probe[1]);
    for (int c = 0; c < 3; c++) {
      away = fmax(away, fmax(cabs(motion[1][c] - motion[0][c]), cabs(probe[1][c] - probe[0][c])));
      size = fmax(size, cabs(motion[0][c]));
    }
  }
  return away / size;
}

/* Modes left out: the ring answers to a wave as one sector. The weights of the terms are bounded by
 * the last mode kept, which differs: of order w^6. */
static void terms_are_those_of_the_nodal_diameters(void **state) {
  static const int order[] = {1, 4, 6, 11};
  (void)state;
  for (int i = 0; i < 4; i++) {
    sector          s;
    modal_model     dense;
    mhb_settings    of_dense;
    mhb_receptance *one, *all;
    sector_create(order[i], 2, 5, &s);
    modal_nodal_diameters_free(&s.waves);
    lumped_disc_waves(&s.disc, 5, &s.waves);
    assert_ok(mhb_dense_disc(&s.settings, &dense));
    mhb_dense_disc_settings(&s.settings, &of_dense);
    assert_ok(mhb_receptance_create(&s.waves.model[0], &s.settings, 2, &one));
    assert_ok(mhb_receptance_create(&dense, &of_dense, 2, &all));
    const double fast = distance_of_receptances(one, all, order[i], 0.1);
    const double slow = distance_of_receptances(one, all, order[i], 0.05);
    print_message("E = %d, 5 of 12 modes: %.1e and %.1e apart\n", order[i], fast, slow);
    assert_below(slow, 1e-9);
    assert_true(slow < fast / 40);
    mhb_receptance_destroy(one);
    mhb_receptance_destroy(all);
    modal_model_free(&dense);
    modal_nodal_diameters_free(&s.waves);
  }
}

/* From the balance: its forces lag from sector to sector. */
static void stays_on_the_balance(double spin) {
  sector                   s;
  modal_model              dense;
  mhb_settings             of_dense;
  mhb_response            *balance, *response;
  double                   omega;
  mhb_integration_settings asked = {.n_frequencies = 1,
                                    .listed        = true,
                                    .start         = MHB_START_FROM_BALANCE,
                                    .steps         = 32,
                                    .tolerance     = 1e-7,
                                    .max_periods   = 500};
  sector_create_stable(spin, &s, &omega);
  asked.frequency[0]      = omega / SHB_TWO_PI;
  s.settings.frequency[0] = (omega - 0.01) / SHB_TWO_PI;
  s.settings.frequency[1] = (omega + 0.01) / SHB_TWO_PI;
  assert_ok(mhb_forced_response(&s.waves.model[0], &s.settings, NULL, NULL, NULL, &balance));
  assert_ok(mhb_dense_disc(&s.settings, &dense));
  mhb_dense_disc_settings(&s.settings, &of_dense);
  assert_ok(mhb_integration_sweep(&dense, &of_dense, &asked, balance, NULL, NULL, NULL, &response));
  const mhb_branch *b = &response->branch[0];
  assert_int_equal(b->n_points, 1);
  assert_int_equal(b->multiple[0], 1);
  periodic one;
  periodic_create(&s.waves.model[0], &s.settings, SHB_TWO_PI * b->frequency[0], NULL, &one);
  static double x[3 * N * (2 * MANY + 1)], end[3 * N * (2 * MANY + 1)];
  const int     n = 3 * N * (2 * MANY + 1);
  expand(MANY, 3, one.x, x);
  motion_of(b, 0, MANY, end);
  const double apart = distance(n, 2 * MANY + 1, x, end);
  print_message("spin %g, from the balance %d periods, %.1e apart, slipping for %.2f of it\n", spin,
                b->periods[0], apart, slipping(&one));
  assert_below(apart, 5e-5);
  assert_true(slipping(&one) > 0.1);
  periodic_destroy(&one);
  mhb_response_destroy(response);
  mhb_response_destroy(balance);
  modal_model_free(&dense);
  modal_nodal_diameters_free(&s.waves);
}

static void integration_by_nodal_diameters_stays_on_the_balance(void **state) {
  (void)state;
  stays_on_the_balance(0);
  stays_on_the_balance(0.1);
}

static void all_nodal_diameters_are_needed(void **state) {
  sector      s;
  modal_model dense;
  (void)state;
  sector_create(3, 2, 5, &s);
  s.waves.n--;
  assert_refused(mhb_dense_disc(&s.settings, &dense), SHB_ERR_INPUT,
                 "needs all nodal diameters, 0 to 4; the modal file has 4 of 5");
  s.waves.n++;
  modal_nodal_diameters_free(&s.waves);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_ring_has_the_same_solution),
      cmocka_unit_test(with_coriolis_terms_too),
      cmocka_unit_test(time_integration_ends_on_it),
      cmocka_unit_test(with_coriolis_terms_it_ends_on_it_too),
      cmocka_unit_test(sectors_in_one_are_the_ring),
      cmocka_unit_test(terms_are_those_of_the_nodal_diameters),
      cmocka_unit_test(integration_by_nodal_diameters_stays_on_the_balance),
      cmocka_unit_test(all_nodal_diameters_are_needed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
