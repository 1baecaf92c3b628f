/* Direct time integration: published numbers, order, the balance on the same models, orbits that do
 * not last, rings. */
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
#include "mhb/integration/steady_state.h"
#include "modal/model/reduce.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

typedef struct {
  mhb_integrator                *g;
  mhb_steady_state              *orbit;
  const mhb_steady_state_result *r;
} run;

static run prepare(const modal_model *model, const mhb_settings *s, double w, int steps) {
  run a;
  assert_int_equal(mhb_integrator_create(model, s, s->harmonics, &a.g), SHB_OK);
  a.orbit = mhb_steady_state_create(a.g);
  mhb_integrator_set(a.g, w, s->n0[0], steps);
  mhb_integrator_rest(a.g);
  return a;
}

static void until_periodic(run *a, double tolerance, int max_periods) {
  mhb_steady_state_settings settings = {tolerance, max_periods};
  a->r                               = mhb_steady_state_run(a->orbit, &settings, NULL, NULL);
  assert_false(a->r->failed);
}

static void finish(run *a) {
  mhb_steady_state_destroy(a->orbit);
  mhb_integrator_destroy(a->g);
}

static double first_harmonic(const run *a, int component) {
  return cabs(a->r->motion[component * (a->r->n_harmonics + 1) + 1]);
}

/* Largest value of the harmonics' sum. */
static double largest(const run *a, int component) {
  int    K    = a->r->n_harmonics + 1;
  double best = 0;
  for (int i = 0; i < 20000; i++) {
    double sum = 0, t = SHB_TWO_PI * i / 20000;
    for (int k = 0; k < K; k++) sum += creal(a->r->motion[component * K + k] * cexp(I * k * t));
    best = fmax(best, fabs(sum));
  }
  return best;
}

/* One slider under a constant load, from rest. The amplitudes are those of an event-driven
 * integration, to 1e-8. */
static void friction_oscillator(void **state) {
  (void)state;
  static const double w[2] = {1.18, 1.30}, wanted[2] = {2.39365184, 2.02243853};
  modal_model         model;
  mhb_settings        s = ground_settings(1, 0, 1, 1, 63);
  one_degree_model(.01, 1, .8, &model);
  for (int i = 0; i < 2; i++) {
    run a = prepare(&model, &s, w[i], 96);
    until_periodic(&a, 1e-10, 2000);
    print_message("W %.2f: %.8f, %d periods\n", w[i], largest(&a, 1), a.r->periods);
    assert_near(largest(&a, 1), wanted[i], 1e-6);
    assert_int_equal(a.r->multiple, 1);
    finish(&a);
  }
  modal_model_free(&model);
}

static mhb_settings three_degree_settings(double n0, int harmonics) {
  return ground_settings(.4, .8, .5, n0, harmonics);
}

/* Harmonics 1..m of the motion at contact of both, relative to the largest. */
static double apart(const run *a, const periodic *p, int from) {
  int    K = a->r->n_harmonics + 1, nb = p->residual->nb;
  double worst = 0, size = 0;
  for (int row = 0; row < 3 * a->r->n_pairs; row++)
    for (int k = from; k < K && k <= p->residual->m; k++) {
      const double  *x = p->x + row * nb;
      double complex b = k ? CMPLX(x[2 * k - 1], x[2 * k]) : x[0];
      worst            = fmax(worst, cabs(a->r->motion[row * K + k] - b));
      size             = fmax(size, cabs(b));
    }
  return worst / size;
}

static void from_balance(run *a, const periodic *p) {
  int             n = 3 * p->residual->n_pairs, m = p->residual->m;
  double complex *force = calloc((size_t)(n * (m + 1)), sizeof *force);
  for (int k = 0; k <= m; k++) mhb_balance_contact_force(p->residual, k, force + k * n);
  mhb_integrator_balance(a->g, m, force);
  free(force);
}

/* All states, open, stuck, and in between, from rest. */
static void three_degrees(void **state) {
  (void)state;
  static const struct {
    double n0, w, a[3];
  } rows[] = {{1, 1.20, {.027944, .147642, .008139}},
              {-.2, 1.00, {.019624, .197890, .003763}},
              {0, 1.05, {.195617, .114818, .021163}},
              {.3, 1.42, {.492394, .396878, .471625}}};
  modal_model model;
  three_degree_model(&model);
  for (int i = 0; i < 4; i++) {
    mhb_settings s = three_degree_settings(rows[i].n0, 31);
    periodic     p;
    run          a = prepare(&model, &s, rows[i].w, 96);
    until_periodic(&a, 1e-9, 3000);
    periodic_create(&model, &s, rows[i].w, NULL, &p);
    print_message("n0 %4.1f W %.2f: stick %.3f slip %.3f open %.3f, from the balance %.1e\n",
                  rows[i].n0, rows[i].w, a.r->state[0], a.r->state[1], a.r->state[2],
                  apart(&a, &p, 0));
    for (int c = 0; c < 3; c++) assert_near(first_harmonic(&a, c), rows[i].a[c], 1e-6);
    assert_near(apart(&a, &p, 0), 0, 1e-5);
    for (int c = 0; c < 3; c++)
      assert_near(a.r->state[c], p.residual->eval->info[0].share[c], 1e-3);
    assert_near(a.r->dissipation[0], p.residual->eval->info[0].slip_work,
                1e-4 * p.residual->eval->info[0].slip_work + 1e-12);
    periodic_destroy(&p);
    finish(&a);
  }
  modal_model_free(&model);
}

/* With stick, slip and separation in every period: errors fall with the fifth power, while they are
 * above the events' floor. */
static void order(void **state) {
  (void)state;
  static const double n0[2] = {.3, 0}, w[2] = {1.42, 1.05};
  modal_model         model;
  three_degree_model(&model);
  for (int i = 0; i < 2; i++) {
    mhb_settings s    = three_degree_settings(n0[i], 7);
    run          fine = prepare(&model, &s, w[i], 768);
    double       error[3];
    until_periodic(&fine, 1e-12, 3000);
    for (int c = 0; c < 3; c++) assert_true(fine.r->state[c] > .1);
    for (int j = 0; j < 3; j++) {
      run a = prepare(&model, &s, w[i], 12 << j);
      until_periodic(&a, 1e-12, 3000);
      error[j] = 0;
      for (int c = 0; c < 3; c++)
        error[j] = fmax(error[j], fabs(first_harmonic(&a, c) - first_harmonic(&fine, c)));
      finish(&a);
    }
    print_message("n0 %.1f: errors %.2e %.2e %.2e at 12, 24, 48 steps, slopes %.2f %.2f\n", n0[i],
                  error[0], error[1], error[2], log2(error[0] / error[1]),
                  log2(error[1] / error[2]));
    assert_true(log2(error[0] / error[2]) / 2 > 3.5);
    assert_true(error[2] < 1e-6);
    finish(&fine);
  }
  modal_model_free(&model);
}

/* The solution of the balance is left, and what follows does not repeat itself. */
static void unstable_orbit(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = three_degree_settings(.1, 31);
  periodic     p;
  three_degree_model(&model);
  periodic_create(&model, &s, 1.25, NULL, &p);
  run a = prepare(&model, &s, 1.25, 48);
  from_balance(&a, &p);
  until_periodic(&a, 1e-9, 1);
  double at_first = apart(&a, &p, 0);
  until_periodic(&a, 1e-9, 2500);
  print_message("apart %.1e after a period, %.1e after 2500; return distance %.1e\n", at_first,
                apart(&a, &p, 0), a.r->distance);
  assert_near(at_first, 0, 1e-3);
  assert_true(apart(&a, &p, 0) > .05);
  assert_int_equal(a.r->multiple, 0);
  assert_true(a.r->distance > 1e-3);
  finish(&a);
  periodic_destroy(&p);
  modal_model_free(&model);
}

/* Twenty modes: slip in two directions, preload at equilibrium and as an interference. */
static void beam(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(.3, 2e5, 2e5, 100, 31);
  tip_contact_beam_model(8, &model);
  for (int i = 0; i < 2; i++) {
    s.preload  = i ? MHB_INTERFERENCE : MHB_EQUILIBRIUM;
    double   w = SHB_TWO_PI * (i ? 263.155 : 266);
    periodic p;
    periodic_create(&model, &s, w, NULL, &p);
    run a = prepare(&model, &s, w, 128);
    until_periodic(&a, 1e-9, 4000);
    print_message("%s: slips for %.2f, from the balance %.1e\n", i ? "interference" : "equilibrium",
                  a.r->state[1], apart(&a, &p, 0));
    assert_true(a.r->state[1] > .02);
    assert_near(apart(&a, &p, 0), 0, 1e-5);
    finish(&a);
    periodic_destroy(&p);
  }
  modal_model_free(&model);
}

/* Motion of the probes, harmonics 0 to 3, against the balance's. */
static void probes_agree(const run *a, const periodic *p) {
  int            q = 3 * p->residual->receptance->model->n_probes, K = p->residual->m + 1;
  double complex probe[q], force[6];
  for (int k = 0; k < 4; k++) {
    mhb_balance_contact_force(p->residual, k, force);
    mhb_receptance_probe(p->residual->receptance, k, force, probe);
    for (int i = 0; i < q; i++)
      assert_near(cabs(a->r->probe[i * K + k] - probe[i]), 0, 1e-5 * cabs(probe[0]) + 1e-5);
  }
}

/* Residual modes change neither the response to the load nor what the probes show of forces,
 * inertia included. */
static void free_and_probes_are_the_same(mhb_receptance *a, mhb_receptance *b) {
  double complex force[6] = {.3, -.2 * I, .1, .5 + .1 * I, 0, .4}, probe[2][6];
  for (int k = 0; k < 4; k++) {
    mhb_receptance_update(a, k);
    mhb_receptance_update(b, k);
    mhb_receptance_probe(a, k, force, probe[0]);
    mhb_receptance_probe(b, k, force, probe[1]);
    for (int i = 0; i < 6; i++) {
      assert_near(cabs(a->free[6 * k + i] - b->free[6 * k + i]), 0, 1e-14);
      assert_near(cabs(probe[0][i] - probe[1][i]), 0, 1e-14);
    }
  }
}

/* Two pairs with skew springs, residual flexibility and static response to the load; load harmonics
 * 0 to 2. */
static void residual_flexibility(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = random_settings(25);
  periodic     p;
  s.to_ground = true;
  random_model(2, WITH_RESIDUAL, 11, &model);
  free(model.residual_inertia);
  model.residual_inertia = NULL;
  periodic_create(&model, &s, 1.1, NULL, &p);
  run a = prepare(&model, &s, 1.1, 96);
  until_periodic(&a, 1e-9, 2000);
  print_message("slips for %.2f, %.2f, from the balance %.1e\n", a.r->state[1], a.r->state[4],
                apart(&a, &p, 0));
  assert_true(a.r->state[1] > .1);
  assert_near(apart(&a, &p, 0), 0, 1e-5);
  probes_agree(&a, &p);
  finish(&a);
  periodic_destroy(&p);
  modal_model_free(&model);
}

static void drop_fourth(modal_model *model) {
  free(model->residual_fourth);
  model->residual_fourth = NULL;
}

/* Residual modes have the flexibility and inertia of the file. Their integration agrees with the
 * balance of the same modes. Far below their frequencies it agrees with that of R + w^2 R2. */
static void residual_inertia(void **state) {
  (void)state;
  modal_model  model, with;
  mhb_settings s = random_settings(51);
  s.to_ground    = true;
  random_model(2, WITH_RESIDUAL, 11, &model);
  for (int k = 0; k < 36; k++) model.residual_inertia[k] *= .02; /* modes from 14 rad/s on */
  for (int k = 0; k < 36; k++) model.residual_fourth[k] *= 1e-6; /* no modes have so little of it */
  assert_int_equal(mhb_inertia_modes(&model, &with), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "/contact/residual_fourth does not fit"));
  drop_fourth(&model);
  assert_int_equal(mhb_inertia_modes(&model, &with), SHB_OK);
  assert_int_equal(with.n_modes, model.n_modes + 6);
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) {
      double soft = with.residual_flexibility[i * 6 + j], heavy = 0;
      for (int k = model.n_modes; k < with.n_modes; k++) {
        double w       = SHB_TWO_PI * with.frequency[k];
        double product = with.right[i * with.n_modes + k] * with.right[j * with.n_modes + k];
        soft += product / (w * w);
        heavy += product / (w * w * w * w);
      }
      assert_near(soft, model.residual_flexibility[i * 6 + j], 1e-12);
      assert_near(heavy, model.residual_inertia[i * 6 + j], 1e-12);
      assert_near(with.residual_flexibility[i * 6 + j], 0, 1e-12);
    }
  periodic same, series;
  periodic_create(&with, &s, 1.1, NULL, &same);
  periodic_create(&model, &s, 1.1, NULL, &series);
  free_and_probes_are_the_same(same.residual->receptance, series.residual->receptance);
  run a = prepare(&model, &s, 1.1, 192);
  until_periodic(&a, 1e-9, 2000);
  print_message("slips for %.2f; from the balance with residual modes %.1e, with R + w^2 R2 %.1e\n",
                a.r->state[1], apart(&a, &same, 0), apart(&a, &series, 0));
  probes_agree(&a, &same);
  assert_true(a.r->state[1] > .1);
  assert_near(apart(&a, &same, 0), 0, 1e-5);
  assert_near(apart(&a, &series, 0), 0, 2e-3);
  finish(&a);
  periodic_destroy(&same);
  periodic_destroy(&series);
  mhb_inertia_free(&with);
  free(model.residual_flexibility);
  model.residual_flexibility = NULL;
  assert_int_equal(mhb_inertia_modes(&model, &with), SHB_ERR_INPUT);
  modal_model_free(&model);
}

/* Six modes of which four, from 10 rad/s on and undamped, are left out. */
static void stiff_model(modal_model *model) {
  random_model(1, 0, 11, model);
  for (int i = 2; i < 6; i++) {
    model->frequency[i] *= 7;
    model->damping_ratio[i] = 0;
    for (int c = 0; c < 3; c++) model->right[c * 6 + i] *= 5;
  }
  assert_int_equal(modal_model_reduce(model, 2, true), SHB_OK);
}

/* Largest error of sum psi psi^T/nu^(2 power), from mode 2 on, against a matrix [3][3], relative to
 * its first entry. */
static double moment_error(const modal_model *with, int power, const double *left,
                           const double *wanted) {
  double worst = 0;
  for (int i = 0; i < 9; i++) {
    double sum = left ? left[i] : 0;
    for (int k = 2; k < with->n_modes; k++)
      sum += with->right[i / 3 * with->n_modes + k] * with->right[i % 3 * with->n_modes + k] /
             pow(SHB_TWO_PI * with->frequency[k], 2 * power);
    worst = fmax(worst, fabs(sum - wanted[i]));
  }
  return worst / fabs(wanted[0]);
}

/* Largest difference at harmonic 1 between what the balance and the integration see, residual modes
 * undamped. */
static double receptance_gap(const modal_model *model, double omega) {
  modal_model     with;
  mhb_receptance *r[2];
  mhb_settings    s     = random_settings(1);
  double          worst = 0;
  s.to_ground           = true;
  assert_int_equal(mhb_inertia_modes(model, &with), SHB_OK);
  for (int k = model->n_modes; k < with.n_modes; k++) with.damping_ratio[k] = 0;
  for (int i = 0; i < 2; i++) {
    assert_int_equal(mhb_receptance_create(i ? &with : model, &s, 1, &r[i]), SHB_OK);
    mhb_receptance_at(r[i], omega, 1);
  }
  for (int i = 0; i < 9; i++) worst = fmax(worst, cabs(r[0]->R[9 + i] - r[1]->R[9 + i]));
  for (int i = 0; i < 2; i++) mhb_receptance_destroy(r[i]);
  mhb_inertia_free(&with);
  return worst;
}

/* With the term of omega^4 residual modes have all three terms, and a part of the flexibility
 * stays. Integration and balance then differ by omega^6, with two terms by omega^4. */
static void fourth_term(void **state) {
  (void)state;
  modal_model  three, two, with;
  mhb_settings s = random_settings(31);
  s.to_ground    = true;
  s.scale        = 4;
  stiff_model(&three);
  stiff_model(&two);
  drop_fourth(&two);
  assert_int_equal(mhb_inertia_modes(&three, &with), SHB_OK);
  assert_int_equal(with.n_modes, 5);
  assert_near(moment_error(&with, 1, with.residual_flexibility, three.residual_flexibility), 0,
              1e-12);
  assert_near(moment_error(&with, 2, NULL, three.residual_inertia), 0, 1e-12);
  assert_near(moment_error(&with, 3, NULL, three.residual_fourth), 0, 1e-12);
  double trace[2] = {0, 0};
  for (int c = 0; c < 9; c += 4) {
    trace[0] += with.residual_flexibility[c];
    trace[1] += three.residual_flexibility[c];
  }
  assert_true(trace[0] > 1e-3 * trace[1] && trace[0] < .5 * trace[1]);
  double   order[2] = {log2(receptance_gap(&two, .2) / receptance_gap(&two, .1)),
                       log2(receptance_gap(&three, .2) / receptance_gap(&three, .1))};
  periodic same;
  periodic_create(&with, &s, 1.1, NULL, &same);
  run a = prepare(&three, &s, 1.1, 192);
  until_periodic(&a, 1e-9, 2000);
  print_message(
      "receptances differ with order %.3f, %.3f; slips for %.2f, from the balance of the same "
      "modes %.1e\n",
      order[0], order[1], a.r->state[1], apart(&a, &same, 0));
  assert_near(order[0], 4, .1);
  assert_near(order[1], 6, .1);
  assert_true(a.r->state[1] > .1);
  assert_near(apart(&a, &same, 0), 0, 1e-5);
  finish(&a);
  periodic_destroy(&same);
  mhb_inertia_free(&with);
  modal_model_free(&three);
  modal_model_free(&two);
}

/* Twelve pairs with the residual terms of 60 modes, R3 to 1e-9 only. Directions of little inertia
 * would turn that into modes that are not there, and into negative flexibility. */
static void many_directions(void **state) {
  (void)state;
  enum { N = 36, LEFT_OUT = 60 };
  modal_model model, with;
  random_model(12, WITH_RESIDUAL, 5, &model);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double *R = &model.residual_flexibility[i * N + j], *R2 = &model.residual_inertia[i * N + j],
             *R3 = &model.residual_fourth[i * N + j];
      *R = *R2 = *R3 = 0;
      for (int k = 0; k < LEFT_OUT; k++) {
        double w = 20 * pow(1.25, k), product = cos(k * (i + .5) * SHB_PI / N);
        product *= cos(k * (j + .5) * SHB_PI / N);
        *R += product * pow(w, -2);
        *R2 += product * pow(w, -4);
        *R3 += product * pow(w, -6);
      }
      *R3 *= 1 + 1e-9 * cos(3. * (i + j) + i * j);
    }
  assert_ok(mhb_inertia_modes(&model, &with));
  assert_true(with.n_modes >= model.n_modes + 6);
  assert_true(with.n_modes <= model.n_modes + MHB_INERTIA_MODES);
  double worst = 0, w = 4; /* a fifth of the first mode left out */
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      double gap = with.residual_flexibility[i * N + j] - model.residual_flexibility[i * N + j];
      gap -= w * w * (model.residual_inertia[i * N + j] + w * w * model.residual_fourth[i * N + j]);
      for (int k = model.n_modes; k < with.n_modes; k++)
        gap += with.right[i * with.n_modes + k] * with.right[j * with.n_modes + k] /
               (pow(SHB_TWO_PI * with.frequency[k], 2) - w * w);
      worst = fmax(worst, fabs(gap) / model.residual_flexibility[0]);
    }
  print_message("%d modes, receptance off by %.1e of the flexibility\n",
                with.n_modes - model.n_modes, worst);
  assert_true(worst < 1e-4);
  mhb_inertia_free(&with);
  modal_model_free(&model);
}

/* Rings of two, three and five blades, all blades of them in time, against the wave of the
 * balance. */
static void rings(void **state) {
  (void)state;
  static const int blades[3] = {2, 3, 5};
  for (int i = 0; i < 3; i++) {
    modal_model  model;
    mhb_settings s = random_settings(25);
    periodic     p;
    s.blades = blades[i];
    s.n0[0]  = .15;
    random_model(1, WITH_LEFT | (i == 1 ? WITH_RESIDUAL : 0), 11, &model);
    free(model.residual_inertia);
    model.residual_inertia = NULL;
    periodic_create(&model, &s, 1.1, NULL, &p);
    run a = prepare(&model, &s, 1.1, 48);
    from_balance(&a, &p);
    until_periodic(&a, 1e-9, 2000);
    print_message(
        "%d blades: order %d after %d periods, stick %.2f slip %.2f open %.2f, from the "
        "balance %.1e\n",
        blades[i], a.r->multiple, a.r->periods, a.r->state[0], a.r->state[1], a.r->state[2],
        apart(&a, &p, 1));
    assert_int_equal(a.r->multiple, 1);
    assert_near(apart(&a, &p, 1), 0, 1e-4);
    finish(&a);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* The state that mhb_integrator_get gave, disturbed. */
static void put_state(mhb_integrator *g, const double *state) {
  int n = 2 * g->blades * g->modes;
  memcpy(g->z, state, sizeof(double) * (size_t)n);
  for (int k = 0; k < 2 * g->contacts; k++) g->point[k / 2].p[1 + k % 2] = state[n + k];
  mhb_integrator_set(g, g->omega, g->n0, g->steps);
}

/* Mean growth a period of a small disturbance of a motion: integrated beside it, and scaled back
 * after every period. */
static double growth(run *a, const modal_model *model, const mhb_settings *s, int periods) {
  mhb_integrator    *g = a->g, *other;
  int                n = mhb_integrator_size(g), modal = 2 * g->blades * g->modes;
  double            *x = calloc(2 * (size_t)n, sizeof *x), *y = x + n, sum = 0;
  unsigned long long seed = 7;
  assert_int_equal(mhb_integrator_create(model, s, s->harmonics, &other), SHB_OK);
  mhb_integrator_set(other, g->omega, g->n0, g->steps);
  mhb_integrator_get(g, x);
  memcpy(y, x, sizeof(double) * (size_t)n);
  for (int i = 0; i < modal; i++) y[i] += 1e-7 * random_unit(&seed);
  for (int period = 0; period < 2 * periods; period++) {
    put_state(other, y);
    double before = mhb_steady_state_distance(g, y, x);
    assert_true(mhb_integrator_period(g) && mhb_integrator_period(other));
    mhb_integrator_get(g, x);
    mhb_integrator_get(other, y);
    double now = mhb_steady_state_distance(g, y, x);
    if (period >= periods) sum += log(now / before);
    for (int i = 0; i < n; i++) y[i] = x[i] + (y[i] - x[i]) * 1e-7 / now;
  }
  mhb_integrator_destroy(other);
  free(x);
  return exp(sum / periods);
}

/* The largest multiplier against the growth or decay of disturbances of the integrated motion.
 * Cases: a blade that leaves its orbit, and rings. */
static void disturbances(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    modal_model    model;
    mhb_settings   s = i ? random_settings(25) : three_degree_settings(.1, 31);
    periodic       p;
    double complex multiplier[200];
    if (i == 0) three_degree_model(&model);
    if (i > 0) {
      s.blades = i == 1 ? 3 : 5;
      s.n0[0]  = .15;
      random_model(1, WITH_LEFT, 11, &model);
    }
    periodic_create(&model, &s, i ? 1.1 : 1.25, NULL, &p);
    mhb_multipliers m = periodic_multipliers(&p, 512, multiplier);
    run             a = prepare(&model, &s, p.omega, 64);
    from_balance(&a, &p);
    if (i > 0) until_periodic(&a, 1e-10, 2000);
    double rate = growth(&a, &model, &s, i ? 300 : 150);
    print_message("%d blades, slip %.2f: growth %.5f, largest multiplier %.5f\n", a.g->blades,
                  p.residual->eval->info[0].share[1], rate, m.largest);
    assert_near(rate, m.largest, 3e-3 * m.largest);
    assert_true(i > 0 || rate > 1.005);
    finish(&a);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* Motion without load after a push: its energy never increases. The contact is ten thousand times
 * stiffer than the structure, and the steps are far too long for it. */
static void passive(void **state) {
  (void)state;
  modal_model  model;
  mhb_settings s = ground_settings(.4, 1e4, 7e3, .3, 3);
  three_degree_model(&model);
  memset(model.modal_force, 0, 6 * sizeof *model.modal_force);
  memset(model.damping_ratio, 0, 3 * sizeof(double));
  run    a = prepare(&model, &s, 1, 16);
  double x[8], before = INFINITY;
  mhb_integrator_get(a.g, x);
  for (int i = 0; i < 3; i++) x[3 + i] = .3 - .2 * i;
  put_state(a.g, x);
  for (int period = 0; period < 200; period++) {
    assert_true(mhb_integrator_period(a.g));
    mhb_integrator_get(a.g, x);
    const mhb_contact_point *point  = &a.g->point[0];
    double                   load   = point->p[0] + a.g->law[0].mean_offset;
    double                   energy = load * load / 2e4 +
                    (point->p[1] * point->p[1] + point->p[2] * point->p[2]) / 1.4e4 -
                    a.g->law[0].mean_offset * point->u[0];
    for (int i = 0; i < 3; i++) {
      double w = SHB_TWO_PI * model.frequency[i];
      energy += .5 * (x[3 + i] * x[3 + i] + w * w * x[i] * x[i]);
    }
    assert_true(energy <= before * (1 + 1e-9) + 1e-9);
    before = energy;
  }
  print_message("energy left %.3e\n", before);
  finish(&a);
  modal_model_free(&model);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(friction_oscillator),
                                     cmocka_unit_test(three_degrees),
                                     cmocka_unit_test(order),
                                     cmocka_unit_test(unstable_orbit),
                                     cmocka_unit_test(beam),
                                     cmocka_unit_test(residual_flexibility),
                                     cmocka_unit_test(residual_inertia),
                                     cmocka_unit_test(fourth_term),
                                     cmocka_unit_test(many_directions),
                                     cmocka_unit_test(rings),
                                     cmocka_unit_test(disturbances),
                                     cmocka_unit_test(passive)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
