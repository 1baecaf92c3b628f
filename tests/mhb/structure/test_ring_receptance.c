/* The receptance of a ring by blocks against that of the same ring as one dense model. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mhb/mistuning/dense_ring.h"
#include "mhb/structure/receptance.h"
#include "tests/support/check.h"
#include "tests/support/random_model.h"

enum { N = 5, P = 2, M = 3, ROWS = 3 * N * P, PROBES = 6 * N };

typedef struct {
  modal_model        blade, dense;
  mhb_mistuned_ring *ring;
  mhb_settings       settings, of_dense;
  mhb_receptance    *blocks, *matrix;
} rings;

static const double delta[N] = {0.03, -0.02, 0.11, 0, -0.07};

static void make(rings *g, int parts, int by_mode) {
  double each[N * 6];
  for (int i = 0; i < N * 6; i++) each[i] = delta[i / 6] * (i % 6 == 2 ? 0.5 : 1);
  random_model(P, WITH_LEFT | parts, 11, &g->blade);
  g->settings              = random_settings(M);
  g->settings.blades       = N;
  g->settings.engine_order = 2;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->settings, by_mode ? each : delta,
                                     by_mode ? 6 : 1, &g->ring));
  mhb_dense_ring(g->ring, &g->dense);
  g->settings.ring = g->ring;
  mhb_dense_ring_settings(&g->settings, &g->of_dense);
  assert_ok(mhb_receptance_create(&g->blade, &g->settings, M, &g->blocks));
  assert_ok(mhb_receptance_create(&g->dense, &g->of_dense, M, &g->matrix));
}

static void drop(rings *g) {
  mhb_receptance_destroy(g->blocks);
  mhb_receptance_destroy(g->matrix);
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->dense);
  modal_model_free(&g->blade);
}

static double distance(int n, const double complex *a, const double complex *b) {
  double away = 0, size = 0;
  for (int i = 0; i < n; i++) {
    away += pow(cabs(a[i] - b[i]), 2);
    size += pow(cabs(b[i]), 2);
  }
  return sqrt(away / size);
}

static void compare_blocks(const rings *g, int k, double tolerance) {
  const double complex *R = g->matrix->R + (size_t)k * ROWS * ROWS;
  for (int row = 0; row < ROWS; row++)
    for (int pair = 0; pair < N * P; pair++) {
      double complex own[3];
      mhb_ring_receptance_row(g->blocks->ring, k, row, pair, own);
      for (int c = 0; c < 3; c++)
        assert_small(cabs(own[c] - R[row * ROWS + 3 * pair + c]), tolerance);
    }
  assert_small(cabs(mhb_receptance_diagonal(g->blocks, k, 7) - R[7 * ROWS + 7]), tolerance);
}

/* Product, motion and probes; their changes with the frequency and the damping. */
static void compare_motions(const rings *g, int k, const double complex *p, double tolerance) {
  double complex a[ROWS] = {0}, b[ROWS] = {0}, x[PROBES], y[PROBES];
  mhb_receptance_product_of(g->blocks, k, p, a);
  mhb_receptance_product_of(g->matrix, k, p, b);
  assert_below(distance(ROWS, a, b), tolerance);
  mhb_receptance_motion(g->blocks, k, p, a);
  mhb_receptance_motion(g->matrix, k, p, b);
  assert_below(distance(ROWS, a, b), tolerance);
  mhb_receptance_probe(g->blocks, k, p, x);
  mhb_receptance_probe(g->matrix, k, p, y);
  assert_below(distance(PROBES, x, y), tolerance);
  if (k == 0) return;
  mhb_receptance_slope(g->blocks, k, p, a);
  mhb_receptance_slope(g->matrix, k, p, b);
  assert_below(distance(ROWS, a, b), tolerance);
  mhb_receptance_by_damping(g->blocks, k, p, a, x);
  mhb_receptance_by_damping(g->matrix, k, p, b, y);
  assert_below(distance(ROWS, a, b), tolerance);
  assert_below(distance(PROBES, x, y), tolerance);
}

static void compare(rings *g, double tolerance) {
  unsigned long long seed = 5;
  double complex     p[ROWS];
  for (int i = 0; i < ROWS; i++) p[i] = CMPLX(random_unit(&seed), random_unit(&seed));
  mhb_receptance_at(g->blocks, 1.3, M);
  mhb_receptance_at(g->matrix, 1.3, M);
  for (int k = 0; k <= M; k++) {
    compare_blocks(g, k, tolerance);
    compare_motions(g, k, p, tolerance);
  }
  for (int k = 0; k <= 2; k++)
    assert_below(distance(ROWS, g->blocks->free + k * ROWS, g->matrix->free + k * ROWS), tolerance);
}

static void is_that_of_the_dense_ring(void **state) {
  rings g = {0};
  (void)state;
  make(&g, WITH_NORMALS | WITH_AREAS, 1);
  compare(&g, 1e-12);
  mhb_receptance_scale(g.blocks, 1.7);
  mhb_receptance_scale(g.matrix, 1.7);
  compare(&g, 1e-12);
  drop(&g);
}

/* Blade by blade the terms scale as the stiffness. The dense model has one series for all blades,
 * which is theirs only where no blade deviates. */
static void has_the_residual_terms(void **state) {
  rings g = {0};
  (void)state;
  make(&g, WITH_RESIDUAL, 0);
  for (int b = 0; b < N; b++) { /* static flexibility by (1 + delta)^-2 */
    const double factor = 1 / pow(1 + delta[b], 2);
    for (int i = 0; i < 36 * P * P; i++)
      assert_near(fabs(g.ring->blade[b].residual_flexibility[i]),
                  fabs(factor * g.blade.residual_flexibility[i]), 1e-14);
  }
  mhb_receptance_at(g.blocks, 1e-6, M);
  mhb_receptance_at(g.matrix, 1e-6, M);
  for (int k = 0; k <= M; k++)
    for (int i = 0; i < ROWS; i++)
      assert_within(creal(mhb_receptance_diagonal(g.blocks, k, i)),
                    creal(mhb_receptance_diagonal(g.matrix, k, i)), 1e-9);
  drop(&g);
}

/* now: all blades with (1 + d)^2 times the stiffness, at (1 + d) times the frequency of then. */
static void compare_scaled(const mhb_receptance *then, const mhb_receptance *now, double d) {
  for (int k = 0; k <= M; k++)
    for (int row = 0; row < ROWS; row++) {
      const double complex wanted = mhb_receptance_diagonal(then, k, row);
      const double complex found  = mhb_receptance_diagonal(now, k, row) * pow(1 + d, 2);
      assert_small(cabs(found - wanted), 1e-12 * cabs(wanted));
    }
  for (int i = 0; i < 3 * ROWS; i++)
    assert_small(cabs(now->free[i] * pow(1 + d, 2) - then->free[i]), 1e-12);
}

static void of_stiffer_blades(int parts, double d) {
  double             equal[2][N] = {{0}, {0}};
  mhb_mistuned_ring *ring[2];
  mhb_receptance    *at[2];
  mhb_settings       s = random_settings(M);
  modal_model        blade;
  s.blades = N;
  for (int b = 0; b < N; b++) equal[1][b] = d;
  random_model(P, WITH_LEFT | parts, 23, &blade);
  for (int j = 0; j < 2; j++) {
    assert_ok(mhb_mistuned_ring_create(&blade, &s, equal[j], 1, &ring[j]));
    s.ring = ring[j];
    assert_ok(mhb_receptance_create(&blade, &s, M, &at[j]));
    mhb_receptance_at(at[j], j ? 1.1 * (1 + d) : 1.1, M);
  }
  compare_scaled(at[0], at[1], d);
  for (int j = 0; j < 2; j++) {
    mhb_receptance_destroy(at[j]);
    mhb_mistuned_ring_destroy(ring[j]);
  }
  modal_model_free(&blade);
}

/* A blade with (1 + delta)^2 times the stiffness, at (1 + delta) times the frequency, has (1 +
 * delta)^-2 times the receptance. */
static void scales_as_a_stiffer_blade(void **state) {
  (void)state;
  of_stiffer_blades(WITH_RESIDUAL, 0.13);
  of_stiffer_blades(WITH_RESIDUAL | WITH_RESIDUAL_MODES, -0.07);
}

/* all[ROWS] += motions own[2n] of blade b, n of a contact. */
static void add_blade(int b, const double complex *own, double complex *all) {
  const int n = 3 * P, before = (b + N - 1) % N;
  for (int i = 0; i < n; i++) {
    all[b * n + i] += own[i];
    all[before * n + i] += own[n + i];
  }
}

/* free - R p by the blocks is that of the blades one by one, which sum over modes and terms. So is
 * the slope. */
static void is_that_of_its_blades(int parts, double omega) {
  rings              g    = {0};
  unsigned long long seed = 6;
  double complex     p[ROWS], own[6 * P], part[6 * P];
  make(&g, parts, 0);
  for (int i = 0; i < ROWS; i++) p[i] = CMPLX(random_unit(&seed), random_unit(&seed));
  mhb_receptance_at(g.blocks, omega, M);
  for (int k = 0; k <= M; k++) {
    double complex by_blocks[ROWS] = {0}, by_blades[ROWS], slope[ROWS], slopes[ROWS] = {0};
    mhb_receptance_product_of(g.blocks, k, p, by_blocks);
    for (int i = 0; i < ROWS; i++) by_blocks[i] = g.blocks->free[k * ROWS + i] - by_blocks[i];
    mhb_receptance_motion(g.blocks, k, p, by_blades);
    assert_below(distance(ROWS, by_blocks, by_blades), 1e-13);
    mhb_receptance_slope(g.blocks, k, p, slope);
    for (int b = 0; b < N; b++) {
      memcpy(own, p + 3 * P * b, sizeof(double complex) * 3 * P);
      memcpy(own + 3 * P, p + 3 * P * ((b + N - 1) % N), sizeof(double complex) * 3 * P);
      mhb_receptance_slope(g.blocks->ring->blade[b], k, own, part);
      add_blade(b, part, slopes);
    }
    if (k > 0) assert_below(distance(ROWS, slope, slopes), 1e-13);
  }
  drop(&g);
}

/* Harmonics below and above the first mode left out, where its series is bounded. */
static void has_the_residual_modes(void **state) {
  (void)state;
  is_that_of_its_blades(WITH_RESIDUAL, 1.3);
  is_that_of_its_blades(WITH_RESIDUAL | WITH_RESIDUAL_MODES, 1.3);
  is_that_of_its_blades(WITH_RESIDUAL | WITH_RESIDUAL_MODES, 0.5);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(is_that_of_the_dense_ring), cmocka_unit_test(has_the_residual_terms),
      cmocka_unit_test(scales_as_a_stiffer_blade), cmocka_unit_test(has_the_residual_modes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
