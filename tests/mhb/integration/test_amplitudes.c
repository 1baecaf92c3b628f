/* Modes that Coriolis terms couple, over time: closed forms, and the steps of the integration. */
#include "mhb/integration/amplitudes.h"

#include <stdlib.h>

#include "mhb/integration/steady_state.h"
#include "modal/model/reduce.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"

/* int_0^1 e^((1 - tau) x) tau^(k - 1)/(k - 1)! by Simpson's rule. */
static double complex by_quadrature(double complex x, int k) {
  enum { N = 4000 };
  double complex sum = 0;
  for (int i = 0; i <= N; i++) {
    const double tau = (double)i / N;
    sum += (i == 0 || i == N ? 1 : i % 2 ? 4 : 2) * cexp((1 - tau) * x) * pow(tau, k - 1);
  }
  return sum / (3. * N * tgamma(k));
}

/* On both sides of the size from which the closed form is used, and far from it. */
static void responses_to_powers(void **state) {
  static const double complex x[] = {1e-7 * I, -0.01 + 0.7 * I, -0.2 + 2.9 * I, -0.2 + 3.1 * I,
                                     -0.5 + 11.385 * I};
  (void)state;
  for (int i = 0; i < 5; i++) {
    double complex response[MHB_POWERS];
    double         worst = 0;
    mhb_amplitudes_responses(x[i], response);
    assert_below(cabs(response[0] - cexp(x[i])), 1e-15);
    for (int k = 1; k < MHB_POWERS; k++) {
      const double complex wanted = by_quadrature(x[i], k);
      worst                       = fmax(worst, cabs(response[k] - wanted) / cabs(wanted));
    }
    print_message("x = %g + %gj: %.1e\n", creal(x[i]), cimag(x[i]), worst);
    assert_below(worst, 1e-10);
  }
}

/* Foucault's pendulum and an oscillator beside it, damped: x'' + d x' - g y' + w0^2 x = 0, y'' + d
 * y' + g x' + w0^2 y = 0. x + j y has the exponents of s^2 + (d + j g) s + w0^2. */
static void foucault_pendulum(void **state) {
  enum { M = 3 };
  const double        w0 = 1.7, w1 = 2.385, g = 0.6, zeta = 0.01, t = 4.31, d = 2 * zeta * w0;
  double              G[M * M] = {0, 0, -g, 0, 0, 0, g, 0, 0}, shape[3 * M] = {1, 2, 3};
  double              omega[M] = {w0, w1, w0}, zetas[M] = {zeta, 0, zeta};
  modal_model         model     = {.n_modes = M, .n_pairs = 1, .coriolis = G};
  mhb_modal_structure structure = {
      .blades = 1, .sides = 1, .modes = M, .pairs = 1, .omega = omega, .zeta = zetas};
  double               q[M] = {0.9, 0.31, -0.2}, v[M] = {0.4, -0.7, 1.1};
  const double complex z0 = CMPLX(q[0], q[2]), rate = CMPLX(v[0], v[2]), b = CMPLX(d, g);
  const double complex root = csqrt(b * b - 4 * w0 * w0), s[2] = {(root - b) / 2, (-root - b) / 2};
  const double complex first  = (rate - s[1] * z0) / (s[0] - s[1]);
  const double complex wanted = first * cexp(s[0] * t) + (z0 - first) * cexp(s[1] * t);
  const double         beside = q[1] * cos(w1 * t) + v[1] / w1 * sin(w1 * t);
  mhb_amplitudes      *a;
  (void)state;
  assert_ok(mhb_amplitudes_create(&model, &structure, shape, &a));
  assert_int_equal(a->n_groups, 2);
  mhb_amplitudes_take(a, q, v);
  double motion = 0, wanted_motion = creal(wanted) + 2 * beside + 3 * cimag(wanted);
  for (int i = 0; i < M; i++) {
    const double complex end = CMPLX(q[i], v[i]) * cexp(a->pole[i] * t);
    q[i]                     = creal(end);
    v[i]                     = cimag(end);
    motion += a->motion[i] * q[i] + a->motion[M + i] * v[i];
  }
  mhb_amplitudes_give(a, q, v);
  print_message("off by %.1e, %.1e, %.1e\n", fabs(q[0] - creal(wanted)), fabs(q[2] - cimag(wanted)),
                fabs(motion - wanted_motion));
  assert_near(q[0], creal(wanted), 1e-13);
  assert_near(q[2], cimag(wanted), 1e-13);
  assert_near(q[1], beside, 1e-13);
  assert_near(motion, wanted_motion, 1e-13);
  mhb_amplitudes_destroy(a);
}

/* What does not oscillate has no amplitudes. */
static void strong_damping_is_refused(void **state) {
  double              G[4] = {0, -0.1, 0.1, 0}, shape[6] = {1, 0}, omega[2] = {1, 2};
  double              zeta[2]   = {1.5, 1.5};
  modal_model         model     = {.n_modes = 2, .n_pairs = 1, .coriolis = G};
  mhb_modal_structure structure = {
      .blades = 1, .sides = 1, .modes = 2, .pairs = 1, .omega = omega, .zeta = zeta};
  mhb_amplitudes *a;
  (void)state;
  assert_refused(mhb_amplitudes_create(&model, &structure, shape, &a), SHB_ERR_INPUT,
                 "of 2 modes oscillate with Coriolis terms; the damping is too high");
}

/* A random model whose modes are coupled by up to 0.3 rad/s. */
static void coupled_model(int n_pairs, int parts, modal_model *model) {
  unsigned long long seed = 11;
  random_model(n_pairs, parts, 4, model);
  const int m     = model->n_modes;
  model->coriolis = calloc((size_t)(m * m), sizeof *model->coriolis);
  for (int i = 0; i < m; i++)
    for (int j = 0; j < i; j++)
      model->coriolis[j * m + i] = -(model->coriolis[i * m + j] = 0.3 * random_unit(&seed));
}

/* Difference of the harmonics from 1 on from the balance's, relative to the largest. */
static double apart(const mhb_steady_state_result *r, const periodic *p) {
  const int K = r->n_harmonics + 1, nb = p->residual->nb;
  double    worst = 0, size = 0;
  for (int row = 0; row < 3 * r->n_pairs; row++)
    for (int k = 1; k < K && k <= p->residual->m; k++) {
      const double complex b = CMPLX(p->x[row * nb + 2 * k - 1], p->x[row * nb + 2 * k]);
      worst                  = fmax(worst, cabs(r->motion[row * K + k] - b));
      size                   = fmax(size, cabs(b));
    }
  return worst / size;
}

/* Difference of the probes, likewise. */
static double probes_apart(const mhb_steady_state_result *r, const periodic *p) {
  const int       K = r->n_harmonics + 1, n = 3 * r->n_pairs, q = 3 * r->n_probes;
  mhb_receptance *of    = p->residual->receptance;
  double          worst = 0, size = 0;
  for (int k = 1; k < K && k <= p->residual->m; k++) {
    double complex force[n], wanted[q];
    mhb_balance_contact_force(p->residual, k, force);
    mhb_receptance_probe(of, k, force, wanted);
    for (int s = 0; s < q; s++) {
      worst = fmax(worst, cabs(r->probe[s * K + k] - wanted[s]));
      size  = fmax(size, cabs(wanted[s]));
    }
  }
  return worst / size;
}

typedef struct {
  double motion, probe, slipping;
} comparison;

/* Integration from the balance, compared with it. */
static comparison compare(const modal_model *model, const mhb_settings *s, double omega, int steps,
                          double tolerance) {
  const mhb_steady_state_settings settings = {tolerance, 400};
  mhb_integrator                 *g;
  mhb_steady_state               *orbit;
  periodic                        p;
  periodic_create(model, s, omega, NULL, &p);
  const int       n = 3 * p.residual->n_pairs, m = p.residual->m;
  double complex *force = calloc((size_t)(n * (m + 1)), sizeof *force);
  for (int k = 0; k <= m; k++) mhb_balance_contact_force(p.residual, k, force + k * n);
  assert_ok(mhb_integrator_create(model, s, m, &g));
  orbit = mhb_steady_state_create(g);
  mhb_integrator_set(g, omega, s->n0[0], steps);
  mhb_integrator_balance(g, m, force);
  const mhb_steady_state_result *r = mhb_steady_state_run(orbit, &settings, NULL, NULL);
  assert_false(r->failed);
  assert_int_equal(r->multiple, 1);
  const comparison found = {apart(r, &p), probes_apart(r, &p), r->state[1]};
  mhb_steady_state_destroy(orbit);
  mhb_integrator_destroy(g);
  periodic_destroy(&p);
  free(force);
  return found;
}

/* Stuck contacts are springs: the balance is exact, and the steps are of order five. With
 * OpenBLAS's kernels for AVX-512 a distance of 1e-12 is not reached within 400 periods. */
static void order_of_stuck_contacts(void **state) {
  modal_model  model;
  mhb_settings s    = random_settings(3);
  double       last = 0;
  (void)state;
  coupled_model(2, WITH_LEFT, &model);
  s.n0[0] = 500;
  for (int steps = 8; steps <= 32; steps *= 2) {
    const comparison c = compare(&model, &s, 1.13, steps, 1e-11);
    print_message("%d steps: %.2e, probes %.2e, order %.2f\n", steps, c.motion, c.probe,
                  last > 0 ? log2(last / c.motion) : 0);
    assert_true(last == 0 || log2(last / c.motion) > 4.7);
    assert_below(c.probe, 2 * c.motion);
    last = c.motion;
  }
  modal_model_free(&model);
}

/* Residual flexibility alone. */
static void keep_flexibility(modal_model *m) {
  double         **real[] = {&m->residual_inertia, &m->residual_fourth, &m->probe_contact_inertia,
                             &m->probe_contact_fourth};
  double complex **load[] = {&m->load_inertia, &m->load_fourth, &m->probe_load_inertia,
                             &m->probe_load_fourth};
  for (int i = 0; i < 4; i++) {
    free(*real[i]);
    free(*load[i]);
    *real[i] = NULL;
    *load[i] = NULL;
  }
}

/* Contacts that slip, to the ground and between all blades of a ring; residual terms too. */
static void slipping_contacts(void **state) {
  static const int    parts[] = {0, WITH_LEFT, WITH_LEFT | WITH_RESIDUAL};
  static const double scale[] = {40, 4, 4};
  (void)state;
  for (int i = 0; i < 3; i++) {
    modal_model  model;
    mhb_settings s = i == 0 ? ground_settings(0.4, 0.8, 0.5, 0.3, 31) : random_settings(31);
    coupled_model(1, parts[i], &model);
    keep_flexibility(&model);
    s.n0[0]            = 0.3;
    s.scale            = scale[i];
    const comparison c = compare(&model, &s, 0.62, 64, 1e-8);
    print_message("%s%s: %.1e, probes %.1e, slipping %.2f\n", i ? "ring" : "ground",
                  i == 2 ? " with residual flexibility" : "", c.motion, c.probe, c.slipping);
    assert_true(c.slipping > 0.05);
    assert_below(c.motion, 5e-5);
    assert_below(c.probe, 5e-5);
    modal_model_free(&model);
  }
}

/* Motion of an open contact at the start of a run from rest, and after a period.
 *   with  in  Coriolis terms */
static void open_motion(bool with, double scale, double start[3], double end[3]) {
  mhb_settings    s = ground_settings(0.4, 0.8, 0.5, 0.3, 4);
  modal_model     model;
  mhb_integrator *g;
  coupled_model(1, 0, &model);
  if (!with) {
    free(model.coriolis);
    model.coriolis = NULL;
  }
  s.n0[0] = -1000; /* a gap that never closes */
  s.scale = scale;
  assert_ok(mhb_integrator_create(&model, &s, 4, &g));
  mhb_integrator_set(g, 1.13, s.n0[0], 32);
  mhb_integrator_rest(g);
  for (int c = 0; c < 3; c++) start[c] = g->point[0].u[c];
  assert_true(mhb_integrator_period(g));
  for (int c = 0; c < 3; c++) end[c] = g->point[0].u[c];
  mhb_integrator_destroy(g);
  modal_model_free(&model);
}

/* A run from rest begins at rest whatever the scale of the excitation, and grows with it. */
static void rest_knows_the_scale(void **state) {
  (void)state;
  for (int with = 0; with < 2; with++) {
    double start[2][3], end[2][3], size = 0;
    open_motion(with, 1, start[0], end[0]);
    open_motion(with, 2.385, start[1], end[1]);
    for (int c = 0; c < 3; c++) size = fmax(size, fabs(end[0][c]));
    assert_true(size > 0.01);
    for (int c = 0; c < 3; c++) {
      print_message("%s %d: at rest %.1e, after a period %.6g, scaled %.6g\n",
                    with ? "Coriolis" : "plain", c, start[1][c], end[0][c], end[1][c]);
      assert_near(start[0][c], 0, 1e-14);
      assert_near(start[1][c], 0, 1e-14);
      assert_near(end[1][c], 2.385 * end[0][c], 1e-12 * size);
    }
  }
}

/* Modes in place of residual inertia are beside the Coriolis terms. */
static void residual_inertia_is_not_coupled(void **state) {
  modal_model model, wide;
  (void)state;
  coupled_model(1, WITH_LEFT, &model);
  assert_ok(modal_model_reduce(&model, 5, true));
  assert_ok(mhb_inertia_modes(&model, &wide));
  const int m = wide.n_modes;
  assert_true(m > 5);
  for (int i = 0; i < m * m; i++)
    assert_true(wide.coriolis[i] ==
                (i / m < 5 && i % m < 5 ? model.coriolis[i / m * 5 + i % m] : 0));
  mhb_inertia_free(&wide);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(responses_to_powers),
      cmocka_unit_test(foucault_pendulum),
      cmocka_unit_test(strong_damping_is_refused),
      cmocka_unit_test(order_of_stuck_contacts),
      cmocka_unit_test(slipping_contacts),
      cmocka_unit_test(rest_knows_the_scale),
      cmocka_unit_test(residual_inertia_is_not_coupled),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
