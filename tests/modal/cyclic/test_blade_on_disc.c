/* The parametric blade on a disc, of hexahedra and of tetrahedra: the same mass, and frequencies at
 * a nodal diameter that converge to the same. */
#include <math.h>
#include <stdlib.h>

#include "fem/body/sector.h"
#include "mesh/base/constants.h"
#include "mesh/blade/blade.h"
#include "mesh/core/cyclic_sides.h"
#include "modal/common/session.h"
#include "modal/cyclic/wave_modes.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"
#include "tests/support/odd_blade.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scratch_folder.h"

enum { MODES = 4, DIAMETER = 2 };

static mesh_blade on_a_disc(mesh_kind kind, double size) {
  mesh_blade blade = odd_blade();
  blade.elements   = kind;
  blade.root_width = 0.0315;
  blade.disc_bore  = 0.143;
  blade.disc_web   = 0.0117;
  blade.disc_rim   = 0.0213;
  blade.disc_taper = 0.0171;
  blade.size       = size;
  return blade;
}

static void find_modes(const mesh_fe *mesh, int blades, fem_system *system,
                       double frequency[MODES]) {
  const wave_settings  wanted  = {.modes = MODES};
  fem_element         *element = make_element_tables(FEM_STANDARD);
  const fem_body       body    = {mesh, &steel, element, {MESH_AXIS_X, 0}, 0};
  fem_sector           sector;
  fem_hermitian_order *order;
  wave_operator        op;
  wave_modes           modes;
  assert_int_equal(fem_sector_create(&body, NULL, system, &sector), 0);
  assert_ok(fem_sector_analyse(&sector, &order));
  assert_ok(wave_operator_create(&sector, order, DIAMETER, blades, &op));
  assert_ok(wave_modes_solve(&op, &wanted, &body, NULL, &modes));
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(modes.lambda[i]) / SHB_TWO_PI;
  wave_modes_free(&modes);
  wave_operator_free(&op);
  fem_hermitian_order_free(order);
  fem_sector_free(&sector);
  free(element);
}

static void solve(mesh_kind kind, double size, double frequency[MODES]) {
  static const shb_provenance origin = {"case.yaml", "", "", "test"};
  const mesh_blade            blade  = on_a_disc(kind, size);
  mesh_cyclic_sides           sides;
  mesh_fe                     mesh;
  fem_system                  system;
  use_elements(kind);
  assert_ok(mesh_blade_write(&blade, scratch("blade.msh"), &origin, NULL));
  assert_ok(read_mesh(scratch("blade.msh"), &mesh));
  assert_ok(mesh_cyclic_pair(&mesh, blade.axis, blade.blades, &sides));
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  find_modes(&mesh, blade.blades, &system, frequency);
  print_message("%s, %g mm, %d nodes:", kind == MESH_HEX20 ? "hex20" : "tet10", 1e3 * size,
                mesh.n_nodes);
  for (int i = 0; i < MODES; i++) print_message(" %.6g", frequency[i]);
  print_message(" Hz\n");
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static double worst(const double a[MODES], const double b[MODES]) {
  double most = 0;
  for (int i = 0; i < MODES; i++) most = fmax(most, fabs(a[i] / b[i] - 1));
  return most;
}

/* Re-entrant edges make the error of tetrahedra one of first order; hexahedra are thin there. */
static void both_kinds_converge_to_the_same(void **state) {
  (void)state;
  double hex[2][MODES], tet[2][MODES], limit[MODES], apart[2];
  for (int i = 0; i < 2; i++) {
    solve(MESH_HEX20, i ? 0.008 : 0.016, hex[i]);
    solve(MESH_TET10, i ? 0.007 : 0.014, tet[i]);
    apart[i] = worst(tet[i], hex[i]);
  }
  for (int i = 0; i < MODES; i++) limit[i] = 2 * tet[1][i] - tet[0][i];
  print_message("hexahedra change by %.1e; tetrahedra off by %.1e, %.1e, in the limit %.1e\n",
                worst(hex[0], hex[1]), apart[0], apart[1], worst(limit, hex[1]));
  assert_below(worst(hex[0], hex[1]), 5e-4);
  assert_below(apart[1], 0.65 * apart[0]);
  assert_below(worst(limit, hex[1]), 4e-3);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(both_kinds_converge_to_the_same)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failed;
}
