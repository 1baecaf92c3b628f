/* The fast integrator of a ring of different blades. References are the wave where they are equal,
 * the integrator of fifth order where they are not, and the decision beside a wave. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mhb/integration/steady_state.h"
#include "mhb/mistuning/dense_ring.h"
#include "mhb/ring/lasting.h"
#include "mhb/ring/ring_output.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

enum { N = 6, H = 31, K = H + 1, STATES = 400 };

static const double DELTA[N] = {0.03, -0.02, 0.01, 0, -0.04, 0.02}, ZERO[N] = {0};

static mhb_settings settings_of_ring(void) {
  mhb_settings s = ground_settings(0.4, 0.8, 0.5, 0.1, H);
  s.to_ground    = false;
  s.blades       = N;
  s.engine_order = 1;
  return s;
}

static void lightly_damped(int pairs, int parts, modal_model *model) {
  random_model(pairs, WITH_LEFT | parts, 2, model);
  for (int i = 0; i < model->n_modes; i++) model->damping_ratio[i] = 0.003;
}

/* force[rows][K] <- of the balance's solution. */
static void forces(const periodic *p, double complex *force) {
  for (int row = 0; row < 3 * p->residual->n_pairs; row++)
    for (int k = 0; k < K; k++) {
      const double *a    = p->solution.p + row * (2 * H + 1);
      force[row * K + k] = k ? CMPLX(a[2 * k - 1], a[2 * k]) : a[0];
    }
}

/* all[N][rows][K] <- those of a wave, in every contact. */
static void spread(int rows, const double complex *force, double complex *all) {
  for (int i = 0; i < N * rows * K; i++) {
    const int b = i / (rows * K), k = i % K;
    all[i] = force[i % (rows * K)] * cexp(-I * SHB_TWO_PI * k * b / N);
  }
}

/* ---- equal blades ---- */

/* Positions of the model's own modes after some periods, disturbed at the start. Merged modes may
 * change their signs. Returns their number. */
static int march(const modal_model *model, const mhb_settings *s, double omega,
                 const double complex *force, double *q) {
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  mhb_noise       noise = {7};
  double          v[STATES];
  assert_ok(mhb_ring_model_create(model, s, s->n0[0], omega, &m));
  mhb_ring_model_set(m, omega, 256);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  const int n = m->kept * m->lanes;
  assert_true(m->modes * m->lanes <= STATES);
  mhb_ring_start(&ring, H, force);
  mhb_ring_disturb(&ring, &out, 0.05, &noise);
  for (int i = 0; i < 20; i++) mhb_ring_period(&ring);
  mhb_ring_get(&ring, q, v);
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  return n;
}

/* Every blade has the same deviation: the wave's path with a model of other frequencies. Residual
 * terms and merged modes follow. */
static void alike_blades_are_the_wave(void **state) {
  static const struct {
    int    pairs, parts;
    double deviation;
  } rows[] = {{1, 0, 0}, {2, WITH_RESIDUAL, 0}, {1, 0, 0.03}, {2, WITH_RESIDUAL, 0.03}};
  (void)state;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    modal_model        model, other;
    mhb_mistuned_ring *ring;
    periodic           wave;
    mhb_settings       s = settings_of_ring(), of_ring = s;
    static double      q[2][STATES];
    double             each[N], away = 0, size = 0;
    const double       f = 1 + rows[i].deviation;
    for (int b = 0; b < N; b++) each[b] = rows[i].deviation;
    lightly_damped(rows[i].pairs, rows[i].parts, &model);
    lightly_damped(rows[i].pairs, rows[i].parts, &other);
    const int nc = 6 * rows[i].pairs, q3 = 3 * model.n_probes;
    for (int k = 0; k < model.n_modes; k++) other.frequency[k] *= f;
    for (int k = 0; other.residual_flexibility && k < nc * nc; k++) {
      other.residual_flexibility[k] *= pow(f, -2);
      other.residual_inertia[k] *= pow(f, -4);
      other.residual_fourth[k] *= pow(f, -6);
    }
    for (int k = 0; other.load_residual && k < nc * (other.n_load + 1); k++) {
      other.load_residual[k] *= pow(f, -2);
      other.load_inertia[k] *= pow(f, -4);
    }
    for (int k = 0; other.probe_contact_residual && k < nc * q3; k++)
      other.probe_contact_residual[k] *= pow(f, -2);
    periodic_create(&other, &s, 0.95, NULL, &wave);
    assert_ok(mhb_mistuned_ring_create(&model, &s, each, 1, &ring));
    of_ring.ring      = ring;
    const int      n3 = 3 * rows[i].pairs;
    double complex own[n3 * K], all[N * n3 * K];
    forces(&wave, own);
    spread(n3, own, all);
    const int n = march(&other, &s, 0.95, own, q[0]);
    assert_int_equal(march(&ring->whole, &of_ring, 0.95, all, q[1]), n);
    for (int k = 0; k < n; k++) { /* times w of the model, which is the tuned one there */
      away = fmax(away, fabs(q[0][k] - q[1][k] * f));
      size = fmax(size, fabs(q[0][k]));
    }
    print_message("%d pairs, deviation %.2f: apart %.1e\n", rows[i].pairs, rows[i].deviation,
                  away / size);
    assert_below(away / size, 1e-11);
    periodic_destroy(&wave);
    mhb_mistuned_ring_destroy(ring);
    modal_model_free(&model);
    modal_model_free(&other);
  }
}

static void settled(const modal_model *model, const mhb_settings *s, const double complex *force,
                    double omega, mhb_lasting *found) {
  const mhb_wave wave = {omega, s->n0[0], H, force, 0};
  assert_ok(mhb_lasting_settle(model, s, &wave, NULL, found));
}

/* Beside a wave that is unstable, and beside a stable one. */
static void equal_blades_last_as_the_wave(void **state) {
  (void)state;
  for (int i = 0; i < 2; i++) {
    const double       omega = i ? 0.93 : 0.89;
    modal_model        model;
    mhb_mistuned_ring *ring;
    periodic           wave;
    mhb_settings       s = settings_of_ring(), of_ring = s;
    mhb_lasting        a, b;
    double complex     own[3 * K], all[N * 3 * K];
    lightly_damped(1, 0, &model);
    periodic_create(&model, &s, omega, NULL, &wave);
    assert_ok(mhb_mistuned_ring_create(&model, &s, ZERO, 1, &ring));
    of_ring.ring = ring;
    forces(&wave, own);
    spread(3, own, all);
    settled(&model, &s, own, omega, &a);
    settled(&ring->whole, &of_ring, all, omega, &b);
    print_message(
        "%.2f rad/s: kind %d, %d, mean %.6f, %.6f, worst %.6f, %.6f, %d periods, side %d "
        "%.5f, %d %.5f\n",
        omega, a.kind, b.kind, a.mean, b.mean, a.worst, b.worst, a.periods, a.diameter, a.offset,
        b.diameter, b.offset);
    assert_int_equal(a.kind, b.kind);
    assert_int_equal(a.periods, b.periods);
    assert_near(a.mean, b.mean, 1e-9);
    assert_near(a.worst, b.worst, 1e-9);
    periodic_destroy(&wave);
    mhb_mistuned_ring_destroy(ring);
    modal_model_free(&model);
  }
}

/* ---- different blades ---- */

/* Modes of the dense ring, which are by frequency: which[i] of the ring [blade][mode]. */
static void sorted(const mhb_mistuned_ring *ring, int *which) {
  const double *f = ring->whole.frequency;
  for (int i = 0; i < ring->whole.n_modes; i++) {
    int at = i;
    for (; at > 0 && f[which[at - 1]] > f[i]; at--) which[at] = which[at - 1];
    which[at] = i;
  }
}

/* Both from one disturbed state: after some periods they are apart by the second order of the
 * steps. */
static void order_against_the_integrator(void **state) {
  enum { PERIODS = 10, MODES = 6, ALL = N * MODES };
  const double       omega = 0.95;
  modal_model        model, dense;
  mhb_mistuned_ring *ring;
  periodic           motion;
  mhb_settings       s = settings_of_ring(), of_dense;
  mhb_integrator    *g;
  double complex     force[N * 3 * K], by_k[K * N * 3];
  int                which[ALL];
  double             apart[3];
  (void)state;
  lightly_damped(1, 0, &model);
  assert_ok(mhb_mistuned_ring_create(&model, &s, DELTA, 1, &ring));
  s.ring = ring;
  periodic_create(&ring->whole, &s, omega, NULL, &motion);
  forces(&motion, force);
  mhb_dense_ring(ring, &dense);
  mhb_dense_ring_settings(&s, &of_dense);
  sorted(ring, which);
  for (int i = 0; i < N * 3 * K; i++) by_k[i % K * N * 3 + i / K] = force[i];
  assert_ok(mhb_integrator_create(&dense, &of_dense, H, &g));
  for (int step = 0; step < 3; step++) {
    mhb_ring_model *m;
    mhb_ring        fast;
    double          q[STATES], v[STATES], size = 0;
    assert_ok(mhb_ring_model_create(&ring->whole, &s, s.n0[0], omega, &m));
    mhb_ring_model_set(m, omega, 256 << step);
    mhb_ring_create(m, &fast);
    assert_int_equal(m->modes, MODES);
    mhb_ring_start(&fast, H, force);
    mhb_integrator_set(g, omega, s.n0[0], 64);
    mhb_integrator_balance(g, H, by_k);
    mhb_ring_get(&fast, q, v);
    for (int i = 0; i < ALL; i++) { /* the same disturbed state in both */
      const int    b = which[i] / MODES, k = which[i] % MODES;
      const double much = 1 + 0.05 * cos(3 * b + k), w = m->w[k];
      g->z[ALL + i] *= much; /* a velocity: contacts are where they were */
      q[k * m->lanes + b] = w * g->z[i];
      v[k * m->lanes + b] = w * g->z[ALL + i];
    }
    mhb_ring_put(&fast, q, v);
    mhb_integrator_set(g, omega, s.n0[0], 64);
    for (int t = 0; t < PERIODS; t++) {
      mhb_ring_period(&fast);
      assert_true(mhb_integrator_period(g));
    }
    mhb_ring_get(&fast, q, v);
    apart[step] = 0;
    for (int i = 0; i < ALL; i++) {
      const int b = which[i] / MODES, k = which[i] % MODES;
      apart[step] = fmax(apart[step], fabs(q[k * m->lanes + b] / m->w[k] - g->z[i]));
      size        = fmax(size, fabs(g->z[i]));
    }
    apart[step] /= size;
    mhb_ring_destroy(&fast);
    mhb_ring_model_destroy(m);
  }
  print_message("apart %.1e, %.1e, %.1e with 256, 512, 1024 steps\n", apart[0], apart[1], apart[2]);
  assert_below(apart[0], 1e-2);
  assert_true(apart[1] < apart[0] / 2.8);
  assert_true(apart[2] < apart[1] / 2.8);
  mhb_integrator_destroy(g);
  periodic_destroy(&motion);
  modal_model_free(&dense);
  mhb_mistuned_ring_destroy(ring);
  modal_model_free(&model);
}

/* What lasts beside a stable motion of different blades is that motion; beside an unstable one it
 * is another. */
static void different_blades(void **state) {
  static const double omega[2] = {0.93, 0.89}, small[N] = {0.003, -0.002, 0.001, 0, -0.004, 0.002};
  (void)state;
  for (int i = 0; i < 2; i++) {
    modal_model        model;
    mhb_mistuned_ring *ring;
    periodic           motion;
    mhb_settings       s = settings_of_ring();
    mhb_lasting        found;
    double complex     force[N * 3 * K];
    lightly_damped(1, 0, &model);
    assert_ok(mhb_mistuned_ring_create(&model, &s, small, 1, &ring));
    s.ring = ring;
    periodic_create(&ring->whole, &s, omega[i], NULL, &motion);
    forces(&motion, force);
    settled(&ring->whole, &s, force, omega[i], &found);
    print_message("%.2f rad/s: kind %d, mean %.4f, worst %.4f, error %.4f, side %d %.5f\n",
                  omega[i], found.kind, found.mean, found.worst, found.error, found.diameter,
                  found.offset);
    assert_true((found.kind == MHB_LASTING_WAVE) == (i == 0));
    assert_true(found.kind != MHB_LASTING_UNKNOWN);
    if (i == 0) {
      assert_near(found.mean, 1, 1e-3);
    } else {
      assert_true(found.diameter >= 0 && fabs(found.offset) > 1e-3);
    }
    periodic_destroy(&motion);
    mhb_mistuned_ring_destroy(ring);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(alike_blades_are_the_wave), cmocka_unit_test(equal_blades_last_as_the_wave),
      cmocka_unit_test(order_against_the_integrator), cmocka_unit_test(different_blades)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
