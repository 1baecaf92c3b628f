/* Steps of the ring: waves of the balance stay, with an error of second order; linear rings; the
 * state as positions and velocities. */
#include "mesh/base/constants.h"
#include "mhb/integration/integrator.h"
#include "mhb/ring/lasting.h"
#include "mhb/ring/ring_output.h"
#include "tests/support/check.h"
#include "tests/support/periodic.h"
#include "tests/support/random_model.h"
#include "tests/support/three_degree.h"

enum { M = 31 };

/* Only the terms that are modes exactly: residual flexibility, without inertia. */
static void keep_flexibility(modal_model *model) {
  free(model->residual_inertia);
  free(model->residual_fourth);
  free(model->load_inertia);
  free(model->probe_contact_inertia);
  free(model->probe_load_inertia);
  model->residual_inertia = model->residual_fourth = NULL;
  model->load_inertia = model->probe_load_inertia = NULL;
  model->probe_contact_inertia                    = NULL;
  int dofs                                        = modal_model_contact_dofs(model);
  for (int i = 0; i < dofs * dofs; i++) model->residual_flexibility[i] *= .2;
}

/* First harmonic of probe 0 in a solution of the balance. */
static void probe_of(const periodic *p, double complex motion[3]) {
  mhb_receptance *r = p->residual->receptance;
  double complex  force[r->n], all[3 * r->model->n_probes];
  mhb_balance_contact_force(p->residual, 1, force);
  mhb_receptance_update(r, 1);
  mhb_receptance_probe(r, 1, force, all);
  memcpy(motion, all, 3 * sizeof *motion);
}

/* Forces of a solution as a start, [row][M + 1], harmonics of 1/nu of its frequency. */
static double complex *forces_of(const periodic *p, int nu) {
  int             n     = 3 * p->residual->n_pairs;
  double complex *force = calloc((size_t)(n * (M + 1)), sizeof *force), one[n];
  for (int k = 0; k * nu <= M; k++) {
    mhb_balance_contact_force(p->residual, k, one);
    for (int i = 0; i < n; i++) force[i * (M + 1) + k * nu] = one[i];
  }
  return force;
}

/* Error of the first harmonics of all blades, relative, after some periods from the wave. */
static double error_after(const modal_model *model, const mhb_settings *s, const periodic *p,
                          int steps, int periods) {
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  double complex  wanted[3], *force = forces_of(p, s->subharmonics);
  double          apart = 0, size = 0;
  assert_ok(mhb_ring_model_create(model, s, s->n0[0], p->omega, &m));
  mhb_ring_model_set(m, p->omega, steps);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  assert_true(mhb_ring_model_stiffness(m) < 1);
  mhb_ring_start(&ring, M, force);
  for (int i = 0; i < periods; i++) mhb_ring_period(&ring);
  mhb_ring_first_harmonics(&ring, &out);
  probe_of(p, wanted);
  for (int b = 0; b < m->blades; b++)
    for (int c = 0; c < 3; c++) {
      double complex a = out.first[c * m->blades + b] * cexp(I * mhb_ring_model_lag(m, 1, b));
      apart += pow(cabs(a - wanted[c]), 2);
      size += pow(cabs(wanted[c]), 2);
    }
  free(force);
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  return sqrt(apart / size);
}

typedef struct {
  const char *name;
  int         pairs, parts;
  double      omega, n0, most; /* most: error at 256 steps */
  bool        ground, interference, skew;
} scene;

static const scene scenes[] = {
    {"slip, skew stiffness", 1, WITH_LEFT, 1.05, .1, 2e-4, false, false, true},
    {"slip and opening", 1, WITH_LEFT, 1.05, .08, 2e-4, false, false, false},
    {"gap", 1, WITH_LEFT, .9, -.05, 2e-4, false, false, false},
    {"interference", 1, WITH_LEFT, 1.05, .1, 2e-4, false, true, false},
    {"two pairs", 2, WITH_LEFT | WITH_AREAS | WITH_NORMALS, 1.05, .06, 2e-4, false, false, true},
    {"residual flexibility", 1, WITH_LEFT | WITH_RESIDUAL, 1.05, .15, 4e-4, false, false, false},
    {"two pairs, flexibility", 2, WITH_LEFT | WITH_RESIDUAL, 1.05, .3, 2e-4, false, false, true},
    {"to ground", 1, WITH_RESIDUAL, 1.05, .15, 4e-4, true, false, false},
};

static void waves_stay_to_second_order(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    const scene *c = &scenes[i];
    modal_model  model;
    mhb_settings s = random_settings(M);
    periodic     p;
    double       error[4];
    random_model(c->pairs, c->parts, 5, &model);
    if (c->parts & WITH_RESIDUAL) keep_flexibility(&model);
    s.n0[0]     = c->n0;
    s.to_ground = c->ground;
    s.preload   = c->interference ? MHB_INTERFERENCE : MHB_EQUILIBRIUM;
    if (!c->skew) s.ku[1] = 0, s.ku[2] = s.ku[0];
    periodic_create(&model, &s, c->omega, NULL, &p);
    for (int k = 0; k < 4; k++) error[k] = error_after(&model, &s, &p, 64 << k, 1);
    const double *share = p.residual->eval->info[0].share;
    double        order = log2(error[0] / error[1]);
    print_message("%-24s slip %.2f open %.2f: errors %.1e %.1e %.1e %.1e, order %.2f\n", c->name,
                  share[1], share[2], error[0], error[1], error[2], error[3], order);
    assert_true(share[1] > 0);
    assert_true(order > 1.6);
    assert_below(error[2], c->most);
    assert_below(error[3], .75 * c->most);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

/* A ring of stuck contacts is linear: the steady motion is exact but for the damping, also after a
 * change of the frequency. */
static void a_stuck_ring_is_exact(void **state) {
  (void)state;
  modal_model     model;
  mhb_settings    s = random_settings(1);
  mhb_ring_model *m;
  mhb_ring        ring;
  mhb_ring_output out;
  double          omega[2] = {.93, 1.07};
  random_model(1, WITH_LEFT, 5, &model);
  for (int i = 0; i < 6; i++) model.damping_ratio[i] = .03;
  for (int i = 0; i < 6; i++) model.modal_force[12 + i] = 0;
  s.n0[0] = 500;
  assert_ok(mhb_ring_model_create(&model, &s, 500, omega[0], &m));
  mhb_ring_model_set(m, omega[0], 64);
  mhb_ring_create(m, &ring);
  mhb_ring_output_create(&ring, &out);
  double complex none[3] = {0};
  mhb_ring_start(&ring, 0, none);
  for (int k = 0; k < 2; k++) {
    periodic       p;
    double complex wanted[3];
    if (k > 0) mhb_ring_move(&ring, omega[k], out.space);
    periodic_create(&model, &s, omega[k], NULL, &p);
    probe_of(&p, wanted);
    for (int i = 0; i < 150; i++) mhb_ring_period(&ring);
    mhb_ring_first_harmonics(&ring, &out);
    double apart = 0, size = 0;
    for (int c = 0; c < 3; c++) {
      apart += pow(cabs(out.first[c * m->blades] - wanted[c]), 2);
      size += pow(cabs(wanted[c]), 2);
    }
    print_message("%.2f rad/s: first harmonic off by %.1e\n", omega[k], sqrt(apart / size));
    assert_below(sqrt(apart / size), 1e-4);
    periodic_destroy(&p);
  }
  mhb_ring_output_destroy(&out);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
  modal_model_free(&model);
}

/* Disturbance of a blade's mode. */
static double factor_of(int blade, int mode) {
  return 1 + .1 * sin(2.385 * blade + .7 * mode);
}

/* Positions of all modes after some periods from a disturbed wave, by the ring. */
static void follow(const modal_model *model, const mhb_settings *s, const periodic *p, int steps,
                   int periods, double *position) {
  mhb_ring_model *m;
  mhb_ring        ring;
  double complex *force = forces_of(p, s->subharmonics);
  assert_ok(mhb_ring_model_create(model, s, s->n0[0], p->omega, &m));
  mhb_ring_model_set(m, p->omega, steps);
  mhb_ring_create(m, &ring);
  mhb_ring_start(&ring, M, force);
  double q[m->modes * m->lanes], v[m->modes * m->lanes];
  mhb_ring_get(&ring, q, v);
  for (int k = 0; k < m->modes; k++)
    for (int b = 0; b < m->blades; b++) {
      q[k * m->lanes + b] *= factor_of(b, k);
      v[k * m->lanes + b] *= factor_of(b, k);
    }
  mhb_ring_put(&ring, q, v);
  for (int i = 0; i < periods; i++) mhb_ring_period(&ring);
  mhb_ring_get(&ring, q, v);
  for (int k = 0; k < m->modes; k++)
    for (int b = 0; b < m->blades; b++) position[b * m->modes + k] = q[k * m->lanes + b] / m->w[k];
  free(force);
  mhb_ring_destroy(&ring);
  mhb_ring_model_destroy(m);
}

/* The same by mhb/integration, of fifth order. */
static void follow_slowly(const modal_model *model, const mhb_settings *s, const periodic *p,
                          int periods, double *position) {
  mhb_integrator *g;
  int             n     = 3 * model->n_pairs;
  double complex *force = forces_of(p, s->subharmonics), turned[n * (M + 1)];
  assert_ok(mhb_integrator_create(model, s, M, &g));
  mhb_integrator_set(g, p->omega, s->n0[0], 96 * s->subharmonics);
  for (int k = 0; k <= M; k++)
    for (int i = 0; i < n; i++) turned[k * n + i] = force[i * (M + 1) + k];
  mhb_integrator_balance(g, M, turned);
  for (int i = 0; i < 2 * g->blades * g->modes; i++)
    g->z[i] *= factor_of(i / g->modes % g->blades, i % g->modes);
  for (int i = 0; i < periods; i++) assert_true(mhb_integrator_period(g));
  memcpy(position, g->z, sizeof(double) * (size_t)(g->blades * g->modes));
  free(force);
  mhb_integrator_destroy(g);
}

/* Two pairs of contacts as two interfaces, the second with friction and preload of its own. */
static void two_interfaces(modal_model *model, mhb_settings *s) {
  static const char *const name[] = {"shroud", "snubber"};
  model->n_interfaces             = 2;
  model->interface                = calloc(2, sizeof(int));
  model->interface[1]             = 1;
  model->interface_name           = malloc(2 * sizeof(char *));
  s->n_interfaces                 = 2;
  for (int i = 0; i < 2; i++) {
    mhb_interface *own       = &s->interface[i];
    model->interface_name[i] = strdup(name[i]);
    *own = (mhb_interface){.mu = s->mu, .kv = s->kv, .n_preloads = 1, .n0 = {s->n0[0]}};
    memcpy(own->ku, s->ku, sizeof own->ku);
    snprintf(own->name, sizeof own->name, "%s", name[i]);
  }
  s->interface[1].mu    = 0.2;
  s->interface[1].kv    = 0.3;
  s->interface[1].n0[0] = 0.05;
}

typedef struct {
  const char *name;
  int         pairs, interfaces, subharmonics;
  bool        ground;
} transient;

static const transient transients[] = {
    {"one pair", 1, 1, 1, false},         {"two pairs", 2, 1, 1, false},
    {"two interfaces", 2, 2, 1, false},   {"two interfaces, to ground", 2, 2, 1, true},
    {"twice the period", 1, 1, 2, false},
};

/* Far from any wave: blades that differ, in transient motion with slip and opening. */
static void disturbed_rings_move_as_in_the_slow_integrator(void **state) {
  (void)state;
  enum { BLADES = 4, N = BLADES * 6 };
  for (size_t i = 0; i < sizeof transients / sizeof *transients; i++) {
    const transient *c = &transients[i];
    modal_model      model;
    mhb_settings     s = random_settings(M);
    periodic         p;
    double           slow[N], fast[N], error[3];
    int              n = c->ground ? 6 : N;
    random_model(c->pairs, WITH_LEFT, 5, &model);
    s.blades       = BLADES;
    s.n0[0]        = .08;
    s.to_ground    = c->ground;
    s.engine_order = c->subharmonics; /* so that a wave of so many periods closes */
    if (c->interfaces > 1) two_interfaces(&model, &s);
    periodic_create(&model, &s, 1.05, NULL, &p);
    s.subharmonics = c->subharmonics;
    follow_slowly(&model, &s, &p, 5, slow);
    for (int k = 0; k < 3; k++) {
      double apart = 0, size = 0;
      follow(&model, &s, &p, c->subharmonics * 64 << (2 * k), 5, fast);
      for (int j = 0; j < n; j++) {
        apart += pow(fast[j] - slow[j], 2);
        size += pow(slow[j], 2);
      }
      error[k] = sqrt(apart / size);
    }
    print_message("%-26s after 5 periods, 64, 256, 1024 steps: %.1e %.1e %.1e\n", c->name, error[0],
                  error[1], error[2]);
    assert_below(error[1], 1e-3);
    assert_below(error[2], 1e-4);
    periodic_destroy(&p);
    modal_model_free(&model);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(waves_stay_to_second_order),
      cmocka_unit_test(a_stuck_ring_is_exact),
      cmocka_unit_test(disturbed_rings_move_as_in_the_slow_integrator),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
