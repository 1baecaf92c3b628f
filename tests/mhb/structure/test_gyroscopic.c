/* Modes coupled by Coriolis terms, in closed form; the Coriolis matrix of a modal file. */
#include <math.h>

#include "mesh/base/constants.h"
#include "mhb/structure/gyroscopic.h"
#include "tests/support/files.h"

#include <hdf5_hl.h>

/* Foucault's two degrees of freedom: w^4 - (a^2 + b^2 + g^2) w^2 + a^2 b^2 = 0. */
static void two_degrees_of_freedom(void **state) {
  (void)state;
  const double         a = 2.385, b = 3.11, g = 0.77, half = (a * a + b * b + g * g) / 2;
  const double complex K[] = {a * a, 0, 0, b * b}, G[] = {0, -g, g, 0};
  const double         loss[2] = {0, 0};
  mhb_gyroscopic       of;
  assert_ok(mhb_gyroscopic_solve(2, K, G, loss, &of));
  for (int i = 0; i < 2; i++) {
    const double wanted = sqrt(half + (i ? 1 : -1) * sqrt(half * half - a * a * b * b));
    assert_near(of.omega[2 + i], wanted, 1e-14);
    assert_near(of.omega[1 - i], -wanted, 1e-14);
    assert_near(of.decay[2 + i], 0, 0);
  }
  mhb_gyroscopic_free(&of);
}

/* The shapes solve K x + j w G x = w^2 x and are scaled. Decay rates are the slope of the damped
 * roots: of equal circular motions c w^2/(w0^2 + w^2). */
static void shapes_and_decay(void **state) {
  (void)state;
  const double         w0 = 1.7, g = 0.9, c = 0.03, loss[2] = {c, c};
  const double complex K[] = {w0 * w0, 0, 0, w0 * w0}, G[] = {0, -g, g, 0};
  mhb_gyroscopic       of;
  assert_ok(mhb_gyroscopic_solve(2, K, G, loss, &of));
  for (int i = 0; i < 4; i++) {
    const double          w    = of.omega[i];
    const double complex *x    = of.shape + 2 * i;
    double                size = 0;
    for (int r = 0; r < 2; r++) {
      const double complex left = w0 * w0 * x[r] + I * w * (G[2 * r] * x[0] + G[2 * r + 1] * x[1]);
      assert_below(cabs(left - w * w * x[r]), 1e-14);
      size += (w0 * w0 + w * w) * cabs(x[r]) * cabs(x[r]);
    }
    assert_near(size, 1, 1e-14);
    assert_near(of.decay[i], c * w * w / (w0 * w0 + w * w), 1e-15);
  }
  mhb_gyroscopic_free(&of);
}

/* One complex mode of a wave: w^2 - g w - w0^2 = 0. Both roots are those of a wave and of the
 * opposite one. */
static void one_mode_of_a_wave(void **state) {
  (void)state;
  double                re = 0, im = 0.6, frequency = 2.385 / SHB_TWO_PI, zeta = 0;
  const double          w0 = 2.385, root = sqrt(w0 * w0 + 0.09);
  modal_model           model[2] = {{.n_modes = 1}, {.n_modes = 1}}, imaginary[2] = {{0}, {0}};
  int                   diameter[2] = {0, 1};
  modal_nodal_diameters d = {4, 2, diameter, model, imaginary, (modal_model[2]){{0}, {0}}};
  model[1].frequency      = &frequency;
  model[1].damping_ratio  = &zeta;
  model[1].coriolis       = &re;
  imaginary[1].coriolis   = &im;
  double shape            = 1;
  imaginary[1].right      = &shape;
  for (int wave = 1; wave <= 3; wave += 2) {
    modal_wave     w;
    mhb_gyroscopic of;
    int            missing;
    assert_true(modal_nodal_diameters_wave(&d, wave, &w, &missing));
    assert_ok(mhb_gyroscopic_of_wave(&w, &of));
    const double shift = wave == 1 ? -0.3 : 0.3; /* j G = -+ 0.6 */
    print_message("wave %d: %.6f, %.6f\n", wave, of.omega[0], of.omega[1]);
    assert_near(of.omega[1], root + shift, 1e-14);
    assert_near(of.omega[0], -root + shift, 1e-14);
    mhb_gyroscopic_free(&of);
  }
}

static void a_stiffness_that_is_not_positive(void **state) {
  (void)state;
  const double complex K[] = {-1}, G[] = {0};
  const double         loss[1] = {0};
  mhb_gyroscopic       of;
  assert_refused(mhb_gyroscopic_solve(1, K, G, loss, &of), SHB_NOT_CONVERGED, "not positive");
  mhb_gyroscopic_free(&of);
}

/* A Coriolis matrix comes back from the file. One that does work is refused. */
static void the_matrix_in_the_file(void **state) {
  (void)state;
  double         frequency[2] = {31, 77}, zeta[2] = {0.01, 0.003}, G[4] = {0, 2.5, -2.5, 0};
  double         right[6] = {0.3, -0.1, 0.2, 0.7, 0.11, 0.4};
  double complex force[4] = {1, 2, 3 + I, 4};
  modal_model    model    = {.n_modes       = 2,
                             .n_pairs       = 1,
                             .n_load        = 1,
                             .frequency     = frequency,
                             .damping_ratio = zeta,
                             .right         = right,
                             .modal_force   = force,
                             .coriolis      = G},
              back;
  const shb_provenance from = {"case.yaml", "name: case\n", "", "shroudhb-modal"};
  for (int wrong = 0; wrong < 2; wrong++) {
    hid_t file;
    G[1] = wrong ? -2.5 : 2.5;
    assert_ok(h5_create(scratch("coriolis.h5"), &file));
    assert_ok(modal_model_write(file, &model, &from));
    assert_ok(h5_close(file));
    if (wrong) {
      assert_refused(modal_model_read(scratch("coriolis.h5"), &back), SHB_ERR_INPUT,
                     "/modes/coriolis is not skew-symmetric: [0, 1] and [1, 0] add up to 2 of the "
                     "largest value");
      continue;
    }
    assert_ok(modal_model_read(scratch("coriolis.h5"), &back));
    for (int i = 0; i < 4; i++) assert_near(back.coriolis[i], G[i], 0);
    modal_model_free(&back);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_degrees_of_freedom), cmocka_unit_test(shapes_and_decay),
      cmocka_unit_test(one_mode_of_a_wave), cmocka_unit_test(a_stiffness_that_is_not_positive),
      cmocka_unit_test(the_matrix_in_the_file)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
