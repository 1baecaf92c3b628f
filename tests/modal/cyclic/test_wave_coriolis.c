/* Coriolis terms of a sector against the rotating ring of Bryan (1890).
 *
 * A thin ring of mean radius R bends in its plane without extension. A wave of nodal diameter n has
 * u_r = 1, u_t = -+ j/n, hence |phi^H G phi| = 4 n Omega/(n^2 + 1). Both waves of n lie apart by
 * that in the frame of the ring, whatever its stiffness. A ring of thickness h departs from it by
 * O(h^2/R^2).
 *
 * Over time, z = a + j b being the amplitudes of both standing waves and K the stiffness with
 * isotropic springs at the contact:
 *   z'' + (d + j g) z' + K z = F cos(omega t),
 *   z = F/2 e^(j omega t)/(K - omega^2 - g omega + j omega d)
 *     + F/2 e^(-j omega t)/(K - omega^2 + g omega - j omega d),
 * so a forward and a backward wave that resonate apart. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mhb/integration/steady_state.h"
#include "mhb/structure/gyroscopic.h"
#include "modal/common/session.h"
#include "modal/cyclic/wave_coriolis.h"
#include "tests/support/fem.h"

enum { SECTORS = 36, MODES = 12 };

static const double    radius = 0.3, inner = 0.15, depth = 0.02;
static const mesh_axis axis = MESH_AXIS_X;

/* A ring of thickness h on a web without mass that hardly holds it. */
typedef struct {
  mesh_fe              mesh;
  fem_element         *element;
  fem_material         material[2];
  fem_body             body;
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
} ring;

static void ring_create(double h, double omega, ring *r) {
  const double      size[3]  = {depth, 1, 2};
  const int         cells[3] = {2, 2, 2};
  mesh_cyclic_sides sides;
  use_elements(MESH_HEX20);
  r->mesh = make_sector(size, 1, SECTORS, cells);
  for (int i = 0; i < r->mesh.n_nodes; i++) { /* layers of equal height become web and ring */
    double      *x = r->mesh.coordinates + 3 * i;
    const double z = hypot(x[1], x[2]) - 1, web = radius - h / 2 - inner;
    const double to = inner + (z < 1 ? z * web : web + (z - 1) * h);
    for (int d = 1; d < 3; d++) x[d] *= to / (1 + z);
  }
  for (int s = 0; s < 2; s++) {
    r->mesh.set[s ? MESH_CYCLIC_LEFT : MESH_CYCLIC_RIGHT] =
        r->mesh.set[s ? MESH_CONTACT_LEFT : MESH_CONTACT_RIGHT];
    r->mesh.set[s ? MESH_CONTACT_LEFT : MESH_CONTACT_RIGHT] = (mesh_face_set){0, NULL};
  }
  assert_ok(mesh_cyclic_pair(&r->mesh, axis, SECTORS, &sides));
  r->mesh.n_regions = 2;
  r->mesh.region    = calloc((size_t)r->mesh.n_elements, sizeof *r->mesh.region);
  assert_non_null(r->mesh.region);
  for (int e = 0; e < r->mesh.n_elements; e++) {
    double mean = 0;
    for (int i = 0; i < 20; i++) {
      const double *x = r->mesh.coordinates + 3 * r->mesh.connectivity[20 * e + i];
      mean += hypot(x[1], x[2]) / 20;
    }
    r->mesh.region[e] = mean < radius - h / 2;
  }
  r->material[0] = r->material[1] = steel;
  r->material[1].E *= 1e-9;
  r->material[1].rho *= 1e-9;
  r->element = make_element_tables(FEM_STANDARD);
  r->body    = (fem_body){&r->mesh, r->material, r->element, {axis, omega}, 0};
  assert_int_equal(
      fem_system_create(PETSC_COMM_SELF, &r->mesh, r->material, FEM_STANDARD, &r->system), 0);
  assert_int_equal(fem_sector_create(&r->body, NULL, &r->system, &r->sector), 0);
  assert_ok(fem_sector_analyse(&r->sector, &r->order));
}

static void ring_destroy(ring *r) {
  fem_hermitian_order_free(r->order);
  fem_sector_free(&r->sector);
  fem_system_destroy(&r->system);
  free(r->element);
  mesh_fe_free(&r->mesh);
}

/* Modes at rest of a nodal diameter and their Coriolis matrix, G[i][j]. */
static void solve(const ring *r, int n, fem_turning turning, wave_modes *modes, double complex *G) {
  static double       re[MODES * MODES], im[MODES * MODES];
  const wave_settings wanted = {.modes = MODES};
  wave_operator       op;
  assert_ok(wave_operator_create(&r->sector, r->order, n, SECTORS, &op));
  assert_ok(wave_modes_solve(&op, &wanted, &r->body, NULL, modes));
  wave_coriolis(modes, &r->body.rotation, turning, re, im);
  for (int i = 0; i < MODES * MODES; i++) G[i] = CMPLX(re[i], im[i]);
  wave_operator_free(&op);
}

/* The mode that bends in the plane without extension: that with the largest own Coriolis term
 * among the lowest. */
static int in_plane(const wave_modes *modes, const double complex *G) {
  int best = 0;
  for (int i = 0; i < 4 && i < modes->n; i++)
    if (cabs(G[i * MODES + i]) > cabs(G[best * MODES + best])) best = i;
  return best;
}

/* The distance of both waves falls to Bryan's with the square of the thickness. */
static void waves_lie_apart_as_bryan_says(void **state) {
  const double omega = 5;
  (void)state;
  for (int n = 2; n <= 4; n++) {
    const double bryan = 4 * n * omega / (n * n + 1.);
    double       off[3];
    for (int k = 0; k < 3; k++) {
      ring           r;
      wave_modes     modes;
      double complex G[MODES * MODES];
      double         loss[MODES]      = {0};
      double complex K[MODES * MODES] = {0};
      mhb_gyroscopic g;
      ring_create(radius * 0.1 / (1 << k), omega, &r);
      solve(&r, n, FEM_TURNS_LEFT, &modes, G);
      const int at = in_plane(&modes, G);
      for (int i = 0; i < MODES; i++) K[i * (MODES + 1)] = modes.lambda[i];
      assert_ok(mhb_gyroscopic_solve(MODES, K, G, loss, &g));
      const double apart = fabs(g.omega[MODES + at] + g.omega[MODES - 1 - at]);
      off[k]             = apart / bryan - 1;
      print_message(
          "n = %d, h/R = %.3f: %.6g Hz at rest, waves apart %.9g rad/s, Bryan's %.9g: off "
          "by %.2e\n",
          n, 0.1 / (1 << k), sqrt(modes.lambda[at]) / SHB_TWO_PI, apart, bryan, off[k]);
      mhb_gyroscopic_free(&g);
      wave_modes_free(&modes);
      ring_destroy(&r);
    }
    const double order = log2((off[0] - off[1]) / (off[1] - off[2]));
    print_message("n = %d: order %.3f\n", n, order);
    assert_near(order, 2, 0.1);
    check_below(off[2], 1e-2, "distance of the waves");
  }
}

/* Both standing waves of some modes, a_0, b_0, a_1, ..., on one contact to the ground and a probe,
 * which take those of mode `at` alone. So does the load.
 *   G  in  [MODES][MODES], multiplied by `times` */
static void standing_waves(int n, const int *mode, int at, const wave_modes *from,
                           const double complex *G, double times, modal_model *model) {
  const size_t m       = 2 * (size_t)n;
  *model               = (modal_model){.n_modes = (int)m, .n_pairs = 1, .n_probes = 1, .n_load = 1};
  model->frequency     = calloc(m, sizeof *model->frequency);
  model->damping_ratio = calloc(m, sizeof *model->damping_ratio);
  model->coriolis      = calloc(m * m, sizeof *model->coriolis);
  model->right         = calloc(3 * m, sizeof *model->right);
  model->probe         = calloc(3 * m, sizeof *model->probe);
  model->modal_force   = calloc(2 * m, sizeof *model->modal_force);
  for (size_t i = 0; i < m; i++) {
    model->frequency[i]     = sqrt(from->lambda[mode[i / 2]]) / SHB_TWO_PI;
    model->damping_ratio[i] = 0.01;
    for (size_t k = 0; k < m; k++) {
      const double complex g     = times * G[mode[i / 2] * MODES + mode[k / 2]];
      model->coriolis[i * m + k] = i % 2 == k % 2 ? creal(g) : i % 2 ? cimag(g) : -cimag(g);
    }
    if (mode[i / 2] != at) continue;
    model->right[(1 + i % 2) * m + i] = 1; /* both along the contact */
    model->probe[i % 2 * m + i]       = 1;
    if (i % 2 == 0) model->modal_force[m + i] = 1;
  }
}

/* Largest distance of the first harmonics of a and b from the closed form, relative to it. The
 * integration starts from rest. */
static double off_closed_form(const modal_model *model, double w0, double g, double omega) {
  const double                    d = 0.02 * w0, spring = 0.3 * w0 * w0, K = w0 * w0 + spring;
  const mhb_settings              settings = {.to_ground    = true,
                                              .engine_order = 1,
                                              .blades       = SECTORS,
                                              .has_psi      = true,
                                              .has_phi      = true,
                                              .mu           = 0.5,
                                              .kv           = spring,
                                              .ku           = {spring, 0, spring},
                                              .preload      = MHB_INTERFERENCE,
                                              .n_preloads   = 1,
                                              .n0           = {500}, /* stuck throughout */
                                              .harmonics    = 1,
                                              .subharmonics = 1,
                                              .scale        = 1,
                                              .tolerance    = 1e-12};
  const mhb_steady_state_settings until    = {1e-9, 2000};
  const double complex            forward  = 0.5 / CMPLX(K - omega * omega - g * omega, omega * d);
  const double complex            backward = 0.5 / CMPLX(K - omega * omega + g * omega, -omega * d);
  const double complex            a = forward + conj(backward), b = (forward - conj(backward)) / I;
  mhb_integrator                 *integrator;
  mhb_steady_state               *steady;
  assert_ok(mhb_integrator_create(model, &settings, 1, &integrator));
  steady = mhb_steady_state_create(integrator);
  mhb_integrator_set(integrator, omega, settings.n0[0], 64);
  mhb_integrator_rest(integrator);
  const mhb_steady_state_result *r = mhb_steady_state_run(steady, &until, NULL, NULL);
  assert_false(r->failed);
  assert_int_equal(r->multiple, 1);
  assert_near(r->state[0], 1, 1e-12);
  const double off = hypot(cabs(r->probe[1] - a), cabs(r->probe[3] - b)) / hypot(cabs(a), cabs(b));
  print_message("  %.6g rad/s: forward %.4g, backward %.4g m, off by %.2e after %d periods\n",
                omega, cabs(forward), cabs(backward), off, r->periods);
  mhb_steady_state_destroy(steady);
  mhb_integrator_destroy(integrator);
  return off;
}

/* At the resonances of both waves: the mode alone with its own g, then all modes with Bryan's. */
static void rotating_ring_over_time(void **state) {
  const int    n     = 2;
  const double share = 0.04; /* speed relative to the frequency at rest */
  double       off[3];
  (void)state;
  for (int k = 0; k < 3; k++) {
    int            all[MODES];
    ring           r;
    wave_modes     modes;
    modal_model    one, many;
    double complex G[MODES * MODES];
    ring_create(radius * 0.1 / (1 << k), 1, &r);
    solve(&r, n, FEM_TURNS_LEFT, &modes, G);
    const int    at = in_plane(&modes, G);
    const double w0 = sqrt(modes.lambda[at]), speed = share * w0;
    const double own   = speed * cimag(G[at * (MODES + 1)]);
    const double bryan = copysign(4 * n * speed / (n * n + 1.), own);
    for (int i = 0; i < MODES; i++) all[i] = i;
    standing_waves(1, &at, at, &modes, G, speed, &one);
    standing_waves(MODES, all, at, &modes, G, speed, &many);
    off[k] = 0;
    for (int wave = -1; wave <= 1; wave += 2) {
      const double half  = bryan / 2;
      const double omega = sqrt(1.3 * w0 * w0 + half * half) + wave * half;
      check_below(off_closed_form(&one, w0, own, omega), 1e-7, "one mode");
      off[k] = fmax(off[k], off_closed_form(&many, w0, bryan, omega));
    }
    modal_model_free(&one);
    modal_model_free(&many);
    wave_modes_free(&modes);
    ring_destroy(&r);
  }
  const double order = log2((off[0] - off[1]) / (off[1] - off[2]));
  print_message("order %.3f\n", order);
  assert_near(order, 2, 0.2);
  check_below(off[2], 1e-2, "the ring against Bryan's");
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {cmocka_unit_test(waves_lie_apart_as_bryan_says),
                                     cmocka_unit_test(rotating_ring_over_time)};
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed    = cmocka_run_group_tests(tests, NULL, NULL);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failed;
}
