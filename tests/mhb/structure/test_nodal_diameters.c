/* Receptances of a bladed disc by nodal diameters against the explicit ring of all sectors. */
#include "mesh/base/constants.h"
#include "mhb/numerics/lu.h"
#include "mhb/structure/receptance.h"
#include "modal/model/reduce.h"
#include "tests/support/check.h"
#include "tests/support/lumped_disc.h"

enum { N = DISC_SECTORS, D = DISC_DOFS, ALL = DISC_ALL, TOP = 9 };

/* K - w^2 M + j w (C + G) of all sectors, column-major, factored. */
static void ring_matrix(const lumped_disc *d, double w, double complex *A, int *pivot) {
  const double complex factor = 1 + I * w * d->damping;
  memset(A, 0, sizeof *A * ALL * ALL);
  for (int b = 0; b < N; b++)
    for (int i = 0; i < D; i++)
      for (int j = 0; j < D; j++) {
        const int here = b * D, next = (b + 1) % N * D;
        A[(here + j) * ALL + here + i] += factor * d->own[i][j];
        A[(next + j) * ALL + here + i] += factor * d->next[i][j];
        A[(here + i) * ALL + next + j] += factor * d->next[i][j];
      }
  for (int i = 0; i < ALL; i++) A[i * ALL + i] -= w * w * d->mass[i % D];
  for (int b = 0; b < N; b++)
    for (int i = 0; i < D; i++)
      for (int j = 0; j < D; j++)
        A[(b * D + j) * ALL + b * D + i] += I * w * lumped_disc_coriolis(d, i, j);
  assert_true(mhb_factor_complex(ALL, A, pivot));
}

/* Relative motion of the first contact, in its axes. */
static void contact_motion(const mhb_receptance *r, const double complex *x, double complex u[3]) {
  for (int c = 0; c < 3; c++) {
    u[c] = 0;
    for (int a = 0; a < 3; a++)
      u[c] += r->T0[3 * a + c] * (x[DISC_RIGHT + a] - x[D + DISC_LEFT + a]);
  }
}

/* Forces p of a wave on all contacts: -p on the right face, p on the next left one. */
static void contact_load(const mhb_receptance *r, const double complex p[3], double lag,
                         double complex *f) {
  memset(f, 0, sizeof *f * ALL);
  for (int b = 0; b < N; b++)
    for (int c = 0; c < 3; c++)
      for (int a = 0; a < 3; a++) {
        const double complex force = r->T0[3 * a + c] * p[c] * cexp(-I * lag * b);
        f[b * D + DISC_RIGHT + a] -= force;
        f[(b + 1) % N * D + DISC_LEFT + a] += force;
      }
}

typedef struct {
  double contact, free, probe;
} errors;

static double worse(double a, const double complex *x, const double complex *wanted, int n) {
  double size = 0, error = 0;
  for (int i = 0; i < n; i++) {
    size  = fmax(size, cabs(wanted[i]));
    error = fmax(error, cabs(x[i] - wanted[i]));
  }
  return size > 0 ? fmax(a, error / size) : fmax(a, error);
}

/* Largest relative errors of harmonic k at the excitation frequency omega. */
static errors compare(const lumped_disc *d, mhb_receptance *r, const mhb_settings *s, int k,
                      double omega) {
  static double complex A[ALL * ALL], f[ALL];
  static int            pivot[ALL];
  errors                e    = {0, 0, 0};
  const double          w    = k * omega / s->subharmonics;
  const double          lag  = -carg(r->phase[1]) * k;
  const int             h    = k % s->subharmonics ? DISC_LOADS : k / s->subharmonics;
  const double complex  p[3] = {0.3 - 0.2 * I, 0.7 + 0.1 * I, -0.4 * I};
  double complex        u[3], moved[3], probe[3];
  ring_matrix(d, w, A, pivot);
  mhb_receptance_update(r, k);
  for (int c = 0; c < 3; c++) {
    double complex unit[3] = {c == 0, c == 1, c == 2}, column[3];
    contact_load(r, unit, lag, f);
    assert_true(mhb_solve_complex(ALL, A, pivot, 1, f));
    contact_motion(r, f, u);
    for (int i = 0; i < 3; i++) column[i] = -r->R[9 * k + 3 * i + c];
    e.contact = worse(e.contact, column, u, 3);
  }
  contact_load(r, p, lag, f);
  for (int b = 0; b < N && h < DISC_LOADS; b++)
    for (int i = 0; i < D; i++) f[b * D + i] += s->scale * d->load[h][i] * cexp(-I * lag * b);
  assert_true(mhb_solve_complex(ALL, A, pivot, 1, f));
  contact_motion(r, f, u);
  mhb_receptance_motion(r, k, p, moved);
  e.free = worse(0, moved, u, 3);
  mhb_receptance_probe(r, k, p, probe);
  e.probe = worse(0, probe, f + DISC_BLADE, 3);
  return e;
}

/* Of harmonics 0 to top. */
static double largest(const lumped_disc *d, const modal_nodal_diameters *waves, mhb_settings s,
                      int top, double omega) {
  mhb_receptance *r;
  double          worst = 0;
  s.nodal_diameters     = waves;
  assert_ok(mhb_receptance_create(&waves->model[0], &s, TOP, &r));
  mhb_receptance_set_frequency(r, omega);
  for (int k = 0; k <= top; k++) {
    errors e = compare(d, r, &s, k, omega);
    worst    = fmax(worst, fmax(e.contact, fmax(e.free, e.probe)));
  }
  mhb_receptance_destroy(r);
  return worst;
}

/* All modes: every harmonic, forward and backward, also of subharmonics. spin: with Coriolis
 * terms. */
static void sum_of_modes(double spin) {
  lumped_disc           d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  d.spin = spin;
  lumped_disc_waves(&d, D, &waves);
  for (int E = 0; E <= 11; E++) {
    mhb_settings s = lumped_disc_settings(E, TOP);
    double       e = largest(&d, &waves, s, TOP, 0.93);
    print_message("E = %d: %.1e\n", E, e);
    assert_below(e, 1e-11);
  }
  mhb_settings s = lumped_disc_settings(5, TOP);
  s.subharmonics = 3;
  assert_below(largest(&d, &waves, s, TOP, 1.31), 1e-11);
  modal_nodal_diameters_free(&waves);
}

static void the_sum_of_modes_is_the_ring(void **state) {
  (void)state;
  sum_of_modes(0);
}

static void coriolis_terms_are_those_of_the_ring(void **state) {
  (void)state;
  sum_of_modes(0.4);
  sum_of_modes(-0.4);
}

/* The sense of rotation matters, and so do Coriolis terms at all. */
static void the_sense_of_rotation_is_seen(void **state) {
  (void)state;
  lumped_disc           d = lumped_disc_of(0.8, 1.7), other;
  modal_nodal_diameters waves;
  d.spin = 0.1;
  lumped_disc_waves(&d, D, &waves);
  for (int turn = -1; turn < 1; turn++) {
    other          = d;
    other.spin     = turn * d.spin;
    const double e = largest(&other, &waves, lumped_disc_settings(3, TOP), TOP, 0.93);
    print_message("spin %g in place of %g: %.1e\n", other.spin, d.spin, e);
    assert_true(e > 1e-2);
  }
  modal_nodal_diameters_free(&waves);
}

/* With the terms R, R2 and R3 the error is of sixth order in the frequency. Harmonic 8, again at
 * nodal diameter 0, hardly moves the probe: its relative error has another order. */
static void residual_terms_have_sixth_order(void **state) {
  (void)state;
  lumped_disc           d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  d.damping = 0; /* what is left out has none */
  lumped_disc_waves(&d, 4, &waves);
  const double omega = 0.06;
  double       e[2];
  for (int i = 0; i < 2; i++)
    e[i] = largest(&d, &waves, lumped_disc_settings(3, TOP), 7, omega / (1 + i));
  print_message("%.1e, %.1e: order %.2f\n", e[0], e[1], log2(e[0] / e[1]));
  assert_below(e[0], 1e-4);
  assert_near(log2(e[0] / e[1]), 6, 0.3);
  modal_nodal_diameters_free(&waves);
}

/* Modes that are left out afterwards move to the residual terms and residual modes, exactly but for
 * their damping. Without them their part is missing. */
static void fewer_modes_are_the_ring(void **state) {
  (void)state;
  lumped_disc           d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  d.damping = 0;
  for (int residuals = 0; residuals < 2; residuals++) {
    lumped_disc_waves(&d, D, &waves);
    assert_ok(modal_nodal_diameters_reduce(&waves, 4, residuals));
    double worst = 0;
    for (int E = 3; E <= 5; E += 2)
      worst = fmax(worst, largest(&d, &waves, lumped_disc_settings(E, TOP), 7, 0.06));
    print_message("4 of %d modes, residual terms %d: %.1e\n", D, residuals, worst);
    if (residuals) assert_below(worst, 1e-10);
    if (!residuals) assert_true(worst > 1e-2);
    modal_nodal_diameters_free(&waves);
  }
  lumped_disc_waves(&d, D, &waves);
  assert_refused(modal_nodal_diameters_reduce(&waves, D + 1, true), SHB_ERR_INPUT,
                 "13 modes are to be kept; there are 1 to 12");
  modal_nodal_diameters_free(&waves);
}

/* The other sign of the phase, the conjugate receptance, a load taken for a real one: errors. */
static void wrong_signs_are_seen(void **state) {
  (void)state;
  const lumped_disc     d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  mhb_settings          s = lumped_disc_settings(3, TOP);
  lumped_disc_waves(&d, D, &waves);
  for (int n = 1; 2 * n < N; n++) { /* conjugate shapes everywhere */
    modal_model *im = &waves.imaginary[n];
    for (int i = 0; i < 3 * D; i++) {
      im->right[i] = -im->right[i];
      im->left[i]  = -im->left[i];
      im->probe[i] = -im->probe[i];
    }
    double complex *swap          = waves.model[n].modal_force;
    waves.model[n].modal_force    = waves.backward[n].modal_force;
    waves.backward[n].modal_force = swap;
  }
  assert_true(largest(&d, &waves, s, TOP, 0.93) > 1e-3);
  modal_nodal_diameters_free(&waves);
  lumped_disc_waves(&d, D, &waves);
  for (int n = 1; 2 * n < N; n++)
    for (int i = 0; i < DISC_LOADS * D; i++)
      waves.backward[n].modal_force[i] = conj(waves.model[n].modal_force[i]);
  assert_true(largest(&d, &waves, s, TOP, 0.93) > 1e-3);
  modal_nodal_diameters_free(&waves);
}

static void scale_damping(modal_nodal_diameters *waves, double factor) {
  for (int n = 0; n < waves->n; n++)
    for (int i = 0; i < waves->model[n].n_modes; i++) waves->model[n].damping_ratio[i] *= factor;
}

/* Slopes by the frequency, and by the damping, against differences. */
static void compare_slopes(double spin) {
  lumped_disc           d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  mhb_settings          s = lumped_disc_settings(3, TOP);
  mhb_receptance       *r;
  const double complex  p[3] = {0.3 - 0.2 * I, 0.7 + 0.1 * I, -0.4 * I}, no[3] = {0};
  d.spin = spin;
  lumped_disc_waves(&d, 5, &waves);
  s.nodal_diameters = &waves;
  assert_ok(mhb_receptance_create(&waves.model[0], &s, TOP, &r));
  for (int k = 1; k <= TOP; k++) {
    double complex u[2][3], q[2][3], slope[3], change[3], wanted[3], probe[3];
    const double   h = 1e-6, omega = 0.31;
    for (int i = 0; i < 2; i++) {
      mhb_receptance_set_frequency(r, omega + (i ? h : -h));
      mhb_receptance_update(r, k);
      mhb_receptance_motion(r, k, p, u[i]);
      mhb_receptance_probe(r, k, p, q[i]);
    }
    mhb_receptance_set_frequency(r, omega);
    mhb_receptance_update(r, k);
    mhb_receptance_slope(r, k, p, slope);
    for (int i = 0; i < 3; i++) wanted[i] = (u[1][i] - u[0][i]) / (2 * h);
    assert_below(worse(0, slope, wanted, 3), 1e-7);
    mhb_receptance_probe_change(r, k, p, no, 1, 0, change);
    for (int i = 0; i < 3; i++) wanted[i] = (q[1][i] - q[0][i]) / (2 * h);
    assert_below(worse(0, change, wanted, 3), 1e-7);
    mhb_receptance_by_damping(r, k, p, slope, probe);
    for (int i = 0; i < 2; i++) {
      const double factor = i ? 1 + h : 1 - h;
      scale_damping(&waves, factor);
      mhb_receptance_set_frequency(r, omega + 1); /* anew */
      mhb_receptance_update(r, k);
      mhb_receptance_set_frequency(r, omega);
      mhb_receptance_update(r, k);
      mhb_receptance_motion(r, k, p, u[i]);
      mhb_receptance_probe(r, k, p, q[i]);
      scale_damping(&waves, 1 / factor);
    }
    for (int i = 0; i < 3; i++) wanted[i] = (u[1][i] - u[0][i]) / (2 * h);
    assert_below(worse(0, slope, wanted, 3), 1e-6);
    for (int i = 0; i < 3; i++) wanted[i] = (q[1][i] - q[0][i]) / (2 * h);
    assert_below(worse(0, probe, wanted, 3), 1e-6);
  }
  mhb_receptance_destroy(r);
  modal_nodal_diameters_free(&waves);
}

static void slopes_are_those_of_differences(void **state) {
  (void)state;
  compare_slopes(0);
  compare_slopes(0.4);
}

/* Uncoupled discs: the clamped blade. */
static void without_coupling_it_is_the_blade(void **state) {
  (void)state;
  const lumped_disc     d = lumped_disc_of(0, 1.7);
  modal_nodal_diameters waves;
  modal_model           blade;
  mhb_settings          s = lumped_disc_settings(3, TOP);
  mhb_receptance       *r[2];
  lumped_disc_waves(&d, 5, &waves);
  lumped_disc_blade(&d, 5, &blade);
  assert_ok(mhb_receptance_create(&blade, &s, TOP, &r[0]));
  s.nodal_diameters = &waves;
  assert_ok(mhb_receptance_create(&waves.model[0], &s, TOP, &r[1]));
  for (int i = 0; i < 2; i++) mhb_receptance_at(r[i], 0.71, TOP);
  assert_below(worse(0, r[1]->R, r[0]->R, 9 * (TOP + 1)), 1e-12);
  assert_below(worse(0, r[1]->free, r[0]->free, 3 * (TOP + 1)), 1e-12);
  for (int i = 0; i < 2; i++) mhb_receptance_destroy(r[i]);
  modal_model_free(&blade);
  modal_nodal_diameters_free(&waves);
}

/* Refusals. */
static void what_is_missing_is_told(void **state) {
  (void)state;
  const lumped_disc     d = lumped_disc_of(0.8, 1.7);
  modal_nodal_diameters waves;
  mhb_settings          s = lumped_disc_settings(3, TOP);
  mhb_receptance       *r;
  lumped_disc_waves(&d, 5, &waves);
  s.nodal_diameters = &waves;
  s.blades          = 9;
  assert_refused(mhb_receptance_create(&waves.model[0], &s, TOP, &r), SHB_ERR_INPUT,
                 "rotor.blades is 9, but the modal file holds one of 8 sectors");
  s.blades          = N;
  waves.diameter[2] = 99; /* harmonic 2 runs at 6, backwards at 2 */
  assert_refused(mhb_receptance_create(&waves.model[0], &s, TOP, &r), SHB_ERR_INPUT,
                 "harmonic 2 at engine order 3 meets the disc at nodal diameter 2, which the modal "
                 "file does not have; add it by `shroudhb modal --set modal.nodal_diameters=all");
  assert_ok(mhb_receptance_create(&waves.model[0], &s, 1, &r));
  mhb_receptance_destroy(r);
  modal_nodal_diameters_free(&waves);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_sum_of_modes_is_the_ring),
      cmocka_unit_test(coriolis_terms_are_those_of_the_ring),
      cmocka_unit_test(the_sense_of_rotation_is_seen),
      cmocka_unit_test(residual_terms_have_sixth_order),
      cmocka_unit_test(fewer_modes_are_the_ring),
      cmocka_unit_test(wrong_signs_are_seen),
      cmocka_unit_test(slopes_are_those_of_differences),
      cmocka_unit_test(without_coupling_it_is_the_blade),
      cmocka_unit_test(what_is_missing_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
