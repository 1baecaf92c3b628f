/* Coriolis terms of a sector against the rotating ring of Bryan (1890).
 *
 * A thin ring of mean radius R bends in its plane without extension. A wave of nodal diameter n has
 * u_r = 1, u_t = -+ j/n, hence |phi^H G phi| = 4 n Omega/(n^2 + 1). Both waves of n lie apart by
 * that in the frame of the ring, whatever its stiffness. A ring of thickness h departs from it by
 * O(h^2/R^2). */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
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
  assert_ok(fem_hermitian_analyse(&r->sector.blocks, &r->order));
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
  assert_ok(wave_coriolis(modes, &r->body.rotation, turning, re, im));
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

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {cmocka_unit_test(waves_lie_apart_as_bryan_says)};
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed    = cmocka_run_group_tests(tests, NULL, NULL);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failed;
}
