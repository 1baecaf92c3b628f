/* Stability of a ring of different blades. References are the wave of equal blades, the ring as one
 * dense model, and the growth of disturbances in time integration. */
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/branches/forced_response.h"
#include "mhb/integration/steady_state.h"
#include "mhb/mistuning/dense_ring.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { MOST = 200, SUBSTEPS = 256 };

/* A ring of blades, and its periodic motion. */
typedef struct {
  modal_model        blade;
  mhb_settings       of_blade, settings;
  mhb_mistuned_ring *ring;
  periodic           motion;
} mistuned;

typedef struct {
  int    blades, engine_order, pairs, parts, harmonics;
  double n0, w; /* N, rad/s */
} place;

/* The modes keep their dynamics and the flexibility; what no integration has is taken off. */
static void integrable(modal_model *model) {
  free(model->residual_inertia);
  free(model->load_residual);
  free(model->load_inertia);
  model->residual_inertia = NULL;
  model->load_residual    = NULL;
  model->load_inertia     = NULL;
}

static void make(const place *at, const double *deviation, mistuned *g) {
  random_model(at->pairs, at->parts | WITH_LEFT, 11, &g->blade);
  integrable(&g->blade);
  g->of_blade              = random_settings(at->harmonics);
  g->of_blade.blades       = at->blades;
  g->of_blade.engine_order = at->engine_order;
  g->of_blade.n0[0]        = at->n0;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->of_blade, deviation, 1, &g->ring));
  g->settings      = g->of_blade;
  g->settings.ring = g->ring;
}

static void solve(const place *at, const double *deviation, const double *guess, mistuned *g) {
  make(at, deviation, g);
  periodic_create(&g->ring->whole, &g->settings, at->w, guess, &g->motion);
}

static void drop(mistuned *g) {
  periodic_destroy(&g->motion);
  mhb_mistuned_ring_destroy(g->ring);
  modal_model_free(&g->blade);
}

static double slip_of(const mistuned *g) {
  double most = 0;
  for (int a = 0; a < g->ring->whole.n_pairs; a++)
    most = fmax(most, 1 - g->motion.residual->eval->info[a].share[MHB_STICK]);
  return most;
}

/* ---- equal blades ---- */

/* The sets of a wave and of the ring of blades without deviations. */
static double apart_from_wave(const place *at, int substeps, mhb_multipliers *out, double *slip) {
  const double   zero[8] = {0};
  double complex one[MOST], all[MOST];
  mistuned       g;
  periodic       wave;
  solve(at, zero, NULL, &g);
  periodic_create(&g.blade, &g.of_blade, at->w, NULL, &wave);
  mhb_multipliers wanted = periodic_multipliers(&wave, substeps, one);
  *out                   = periodic_multipliers(&g.motion, substeps, all);
  *slip                  = slip_of(&g);
  assert_int_equal(out->n, wanted.n);
  assert_int_equal(out->n_stuck, wanted.n_stuck);
  assert_int_equal(out->verdict, wanted.verdict);
  double apart = distance_to(one, wanted.n, all, out->n);
  periodic_destroy(&wave);
  drop(&g);
  return apart;
}

/* In phase both integrate the whole period; of a linear motion there are no sub-steps. */
static void equal_blades_have_those_of_the_wave(void **state) {
  static const place places[] = {{4, 4, 1, 0, 15, 0.05, 1.1},         /* in phase */
                                 {3, 0, 2, 0, 15, 0.05, 1.1},         /* two pairs */
                                 {5, 1, 1, 0, 7, 3, 1.1},             /* stuck */
                                 {5, 2, 2, WITH_RESIDUAL, 7, 3, 1.1}, /* stuck */
                                 {4, 1, 1, 0, 7, -3, 1.1}};           /* open */
  (void)state;
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    mhb_multipliers out;
    double          slip, apart = apart_from_wave(&places[i], SUBSTEPS, &out, &slip);
    print_message("N = %d, E = %d, slip %.2f: %d multipliers, largest %.6f, apart %.1e\n",
                  places[i].blades, places[i].engine_order, slip, out.n, out.largest, apart);
    assert_below(apart, 1e-10);
    assert_int_equal(slip > 0.1, i < 2 || i == 4);
  }
}

/* The wave's sub-steps are extrapolated over a segment, those of the ring over the period: what is
 * between them is of fourth order. */
static void the_rest_is_of_fourth_order(void **state) {
  static const place places[] = {{5, 1, 1, 0, 15, 0.05, 1.1}, {4, 2, 2, WITH_AREAS, 15, 0.05, 1.1}};
  (void)state;
  for (int k = 0; k < 2; k++) {
    double          apart[3], slip;
    mhb_multipliers out;
    for (int i = 0; i < 3; i++) apart[i] = apart_from_wave(&places[k], 128 << 2 * i, &out, &slip);
    print_message("slip %.2f, apart %.1e, %.1e, %.1e by 128, 512, 2048 sub-steps\n", slip, apart[0],
                  apart[1], apart[2]);
    assert_true(slip > 0.1);
    assert_true(apart[1] < apart[0] / 100);
    assert_below(apart[2], 1e-8);
  }
}

/* ---- different blades ---- */

static const double DELTA[] = {0.03, -0.02, 0.01, 0, -0.04, 0.02};

static void one_dense_structure_has_the_same(void **state) {
  static const place places[] = {{4, 1, 1, 0, 15, 0.05, 1.1},
                                 {6, 1, 1, 0, 15, 0.1, 1.4},
                                 {3, 1, 2, WITH_RESIDUAL, 15, 0.05, 1.1},
                                 {4, 1, 1, 0, 7, 3, 1.1}};
  (void)state;
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    double complex mine[MOST], wanted[MOST];
    modal_model    dense;
    mhb_settings   of_dense;
    mistuned       g;
    periodic       whole;
    solve(&places[i], DELTA, NULL, &g);
    mhb_dense_ring(g.ring, &dense);
    mhb_dense_ring_settings(&g.settings, &of_dense);
    periodic_create(&dense, &of_dense, places[i].w, g.motion.x, &whole);
    mhb_multipliers out = periodic_multipliers(&g.motion, SUBSTEPS, mine);
    mhb_multipliers all = periodic_multipliers(&whole, SUBSTEPS, wanted);
    double          off = distance_to(mine, out.n, wanted, all.n);
    print_message("N = %d, slip %.2f: %d multipliers, largest %.8f, %.8f, apart %.1e\n",
                  places[i].blades, slip_of(&g), out.n, out.largest, all.largest, off);
    assert_int_equal(out.n, all.n);
    assert_int_equal(out.n_stuck, all.n_stuck);
    assert_int_equal(out.n_zero, all.n_zero);
    assert_below(off, 1e-8);
    periodic_destroy(&whole);
    modal_model_free(&dense);
    drop(&g);
  }
}

/* ---- time integration ---- */

/* A ring in which a Neimark-Sacker point was found, lightly damped. */
enum { BLADES = 6, FINE = 31, STEPS = 64, STATES = 2 * BLADES * 6 + 2 * BLADES };

static const double SMALL[BLADES] = {0.003, -0.002, 0.001, 0, -0.004, 0.002};

static void lightly_damped(double w, const double *guess, mistuned *g) {
  random_model(1, WITH_LEFT, 2, &g->blade);
  for (int i = 0; i < g->blade.n_modes; i++) g->blade.damping_ratio[i] = 0.003;
  g->of_blade              = ground_settings(0.4, 0.8, 0.5, 0.1, FINE);
  g->of_blade.to_ground    = false;
  g->of_blade.blades       = BLADES;
  g->of_blade.engine_order = 1;
  assert_ok(mhb_mistuned_ring_create(&g->blade, &g->of_blade, SMALL, 1, &g->ring));
  g->settings      = g->of_blade;
  g->settings.ring = g->ring;
  periodic_create(&g->ring->whole, &g->settings, w, guess, &g->motion);
}

/* The dense ring in time, at the motion of the balance. */
typedef struct {
  modal_model     model;
  mhb_settings    settings;
  mhb_integrator *g;
  double x[STATES], M[STATES * STATES]; /* state at phase 0; derivative of the period map */
} marched;

static void march_from(const mistuned *of, marched *a) {
  const int      n = 3 * BLADES, nb = 2 * FINE + 1;
  double complex force[(FINE + 1) * 3 * BLADES];
  mhb_dense_ring(of->ring, &a->model);
  mhb_dense_ring_settings(&of->settings, &a->settings);
  for (int k = 0; k <= FINE; k++)
    for (int r = 0; r < n; r++) {
      const double *p  = of->motion.solution.p + r * nb;
      force[k * n + r] = k ? CMPLX(p[2 * k - 1], p[2 * k]) : p[0];
    }
  assert_ok(mhb_integrator_create(&a->model, &a->settings, FINE, &a->g));
  assert_int_equal(mhb_integrator_size(a->g), STATES);
  mhb_integrator_set(a->g, of->motion.omega, a->settings.n0[0], STEPS);
  mhb_integrator_balance(a->g, FINE, force);
  mhb_integrator_get(a->g, a->x);
}

static void march_end(marched *a) {
  mhb_integrator_destroy(a->g);
  modal_model_free(&a->model);
}

static void period(marched *a, const double *x, double *y) {
  mhb_integrator *g = a->g;
  const int       n = 2 * g->blades * g->modes;
  memcpy(g->z, x, sizeof(double) * (size_t)n);
  for (int k = 0; k < 2 * g->contacts; k++) g->point[k / 2].p[1 + k % 2] = x[n + k];
  mhb_integrator_set(g, g->omega, g->n0, g->steps);
  assert_true(mhb_integrator_period(g));
  mhb_integrator_get(g, y);
}

/* M by central differences, column by column. */
static void differentiate(marched *a) {
  double near[STATES], up[STATES], down[STATES];
  for (int i = 0; i < STATES; i++) {
    const double h = 1e-6; /* m, m/s, N; the motion is of order 1 */
    memcpy(near, a->x, sizeof near);
    near[i] = a->x[i] + h;
    period(a, near, up);
    near[i] = a->x[i] - h;
    period(a, near, down);
    for (int k = 0; k < STATES; k++) a->M[i * STATES + k] = (up[k] - down[k]) / (2 * h);
  }
}

/* Newton's method for the periodic motion; the distance that is left. */
static double close_orbit(marched *a) {
  double     away = 0, end[STATES], J[STATES * STATES];
  lapack_int pivot[STATES];
  for (int step = 0; step < 2; step++) {
    differentiate(a);
    period(a, a->x, end);
    for (int i = 0; i < STATES * STATES; i++) J[i] = (i % (STATES + 1) == 0) - a->M[i];
    for (int i = 0; i < STATES; i++) end[i] -= a->x[i];
    away = 0;
    for (int i = 0; i < STATES; i++) away = fmax(away, fabs(end[i]));
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, STATES, 1, J, STATES, pivot, end, STATES), 0);
    for (int i = 0; i < STATES; i++) a->x[i] += end[i];
  }
  return away;
}

/* Modulus of the largest eigenvalue of M. */
static double largest_of(marched *a) {
  double re[STATES], im[STATES], largest = 0;
  assert_int_equal(
      LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', STATES, a->M, STATES, re, im, NULL, 1, NULL, 1), 0);
  for (int i = 0; i < STATES; i++) largest = fmax(largest, hypot(re[i], im[i]));
  return largest;
}

/* Mean growth a period of a disturbance that is left to itself. */
static double growth(marched *a) {
  enum { SETTLE = 50, WATCH = 200 };
  double             x[STATES], sum[4] = {0};
  unsigned long long seed = 5;
  for (int i = 0; i < STATES; i++) x[i] = a->x[i] + 1e-7 * random_unit(&seed);
  for (int k = 0; k < SETTLE + WATCH; k++) {
    double away = 0, t = k - SETTLE - 0.5 * (WATCH - 1);
    period(a, x, x);
    for (int i = 0; i < STATES; i++) away += pow(x[i] - a->x[i], 2);
    if (k < SETTLE) continue;
    sum[0] += t * 0.5 * log(away);
    sum[1] += t * t;
  }
  return exp(sum[0] / sum[1]);
}

/* The curve of the ring with the same harmonics: where it says that it loses stability, rad/s. */
static double neimark_sacker_point(void) {
  mistuned      g;
  mhb_response *r;
  double        found = 0;
  int           n     = 0;
  lightly_damped(0.89, NULL, &g);
  g.settings.frequency[0] = 0.88 / SHB_TWO_PI;
  g.settings.frequency[1] = 0.91 / SHB_TWO_PI;
  g.settings.harmonics    = 15;
  g.settings.stability    = MHB_STABILITY_ALWAYS;
  const shb_status status = mhb_forced_response(&g.ring->whole, &g.settings, NULL, NULL, NULL, &r);
  assert_true(status == SHB_OK || status == SHB_NOT_CONVERGED);
  const mhb_branch *b = &r->branch[2];
  for (int i = 0; i < b->n_points; i++) {
    assert_true(b->stable[i] >= 0);
    if (b->special[i] != MHB_NEIMARK_SACKER) continue;
    found = SHB_TWO_PI * b->frequency[i];
    n++;
    assert_int_equal(b->stable[i - 1] + b->stable[i + 1], 1);
    assert_int_equal(b->stable[i - 1] ? b->loss[i + 1] : b->loss[i - 1], MHB_LOSS_NEIMARK_SACKER);
    assert_near(cabs(b->multipliers[(size_t)i * (size_t)r->n_multipliers]), 1, 1e-5);
  }
  assert_int_equal(n, 1);
  mhb_response_destroy(r);
  drop(&g);
  return found;
}

/* Where the largest pair of multipliers passes 1 disturbances turn from growth to decay. */
static void a_neimark_sacker_point_is_confirmed(void **state) {
  const double at = neimark_sacker_point();
  (void)state;
  print_message("Neimark-Sacker point at %.5f rad/s\n", at);
  for (int side = -1; side <= 1; side += 2) {
    static marched a;
    double complex multiplier[MOST];
    mistuned       g;
    lightly_damped(at + side * 0.005, NULL, &g);
    mhb_multipliers out = periodic_multipliers(&g.motion, SUBSTEPS, multiplier);
    march_from(&g, &a);
    const double away = close_orbit(&a), growing = growth(&a), brute = largest_of(&a);
    print_message(
        "%.5f rad/s, slip %.2f: largest %.6f, of the period map %.6f, growth %.5f; "
        "orbit %.1e\n",
        g.motion.omega, slip_of(&g), out.largest, brute, growing, away);
    assert_true(slip_of(&g) > 0.2);
    assert_below(away, 1e-6); /* before the last step of Newton */
    assert_near(brute, out.largest, 1e-4);
    assert_near(growing, out.largest, 2e-3);
    assert_int_equal(out.verdict, side < 0 ? MHB_UNSTABLE : MHB_STABLE);
    assert_true((growing > 1) == (side < 0));
    march_end(&a);
    drop(&g);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(equal_blades_have_those_of_the_wave),
                                     cmocka_unit_test(the_rest_is_of_fourth_order),
                                     cmocka_unit_test(one_dense_structure_has_the_same),
                                     cmocka_unit_test(a_neimark_sacker_point_is_confirmed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
