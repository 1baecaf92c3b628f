/* Modes of a sector at its nodal diameters against CalculiX's cyclic symmetry, on the same mesh
 * with its integration rules. Argument: the program ccx. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "mesh/io/inp_write.h"
#include "modal/common/session.h"
#include "modal/cyclic/wave_modes.h"
#include "tests/support/fem.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sector.h"

enum { BLADES = 6, MODES = 6 };

static const char *program;

/* The clamp without nodes of cyclic_left: CalculiX ties those to the other side, which is clamped.
 * */
static void write_clamp(const mesh_fe *mesh, FILE *deck) {
  const int width = mesh_topology_of(mesh->kind)->face_nodes;
  char     *done  = calloc((size_t)mesh->n_nodes, 1);
  assert_non_null(done);
  for (int i = 0; i < width * mesh->set[MESH_CYCLIC_LEFT].n; i++)
    done[mesh->set[MESH_CYCLIC_LEFT].nodes[i]] = 1;
  fprintf(deck, "*BOUNDARY\n");
  for (int i = 0; i < width * mesh->set[MESH_ROOT].n; i++) {
    const int node = mesh->set[MESH_ROOT].nodes[i];
    if (!done[node]) fprintf(deck, "%ld, 1, 3\n", mesh->node_tag[node]);
    done[node] = 1;
  }
  free(done);
}

static void write_deck(const mesh_fe *mesh, int diameter) {
  assert_ok(mesh_inp_write(mesh, scratch("sector.inp")));
  FILE *deck = fopen(scratch("sector.inp"), "a");
  assert_non_null(deck);
  write_clamp(mesh, deck);
  fprintf(deck,
          "*MATERIAL, NAME=STEEL\n*ELASTIC\n%.13g, %.13g\n*DENSITY\n%.13g\n"
          "*SOLID SECTION, ELSET=body, MATERIAL=STEEL\n"
          "*SURFACE, NAME=SLAVE, TYPE=NODE\ncyclic_left,\n"
          "*SURFACE, NAME=MASTER, TYPE=NODE\ncyclic_right,\n"
          "*TIE, CYCLIC SYMMETRY, NAME=SIDES\nSLAVE, MASTER\n"
          "*CYCLIC SYMMETRY MODEL, N=%d, NGRAPH=1, TIE=SIDES\n0, 0, 0, 1, 0, 0\n"
          "*STEP\n*FREQUENCY, STORAGE=YES\n%d\n"
          "*SELECT CYCLIC SYMMETRY MODES, NMIN=%d, NMAX=%d\n*END STEP\n",
          steel.E, steel.nu, steel.rho, BLADES, 2 * MODES, diameter, diameter);
  fclose(deck);
}

/* sector.eig holds four integers, then the number of eigenvalues and these. CalculiX solves the
 * doubled real problem: each comes twice. */
static void run_calculix(const mesh_fe *mesh, int diameter, double frequency[MODES]) {
  char    command[1200];
  int32_t head[5];
  double  value[2 * MODES];
  write_deck(mesh, diameter);
  snprintf(command, sizeof command, "cd %s && OMP_NUM_THREADS=1 '%s' sector >sector.log 2>&1",
           scratch_folder, program);
  assert_int_equal(system(command), 0);
  FILE *file = fopen(scratch("sector.eig"), "rb");
  assert_non_null(file);
  assert_int_equal(fread(head, sizeof *head, 5, file), 5);
  assert_int_equal(head[3], diameter);
  assert_int_equal(head[4], 2 * MODES);
  assert_int_equal(fread(value, sizeof *value, 2 * MODES, file), 2 * MODES);
  fclose(file);
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(value[2 * i]) / SHB_TWO_PI;
}

static void run_own(const fem_sector *sector, const fem_body *body,
                    const fem_hermitian_order *order, int diameter, double frequency[MODES]) {
  const wave_settings wanted = {.modes = MODES};
  wave_operator       op;
  wave_modes          modes;
  assert_ok(wave_operator_create(sector, order, diameter, BLADES, &op));
  assert_ok(wave_modes_solve(&op, &wanted, body, NULL, &modes));
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(modes.lambda[i]) / SHB_TWO_PI;
  wave_modes_free(&modes);
  wave_operator_free(&op);
}

static void compare(mesh_kind kind, int n, const int *diameter) {
  use_elements(kind);
  mesh_fe              mesh    = make_bladed_sector(BLADES, 1);
  fem_element         *element = make_element_tables(FEM_CALCULIX);
  const fem_body       body    = {&mesh, &steel, element, {MESH_AXIS_X, 0}, 0};
  mesh_cyclic_sides    sides;
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
  if (kind == MESH_TET10) straighten(&mesh);
  assert_ok(mesh_cyclic_pair(&mesh, MESH_AXIS_X, BLADES, &sides));
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_CALCULIX, &system), 0);
  assert_int_equal(fem_sector_create(&body, NULL, &system, &sector), 0);
  assert_ok(fem_sector_analyse(&sector, &order));
  for (int k = 0; k < n; k++) {
    double own[MODES], other[MODES], worst = 0;
    run_calculix(&mesh, diameter[k], other);
    run_own(&sector, &body, order, diameter[k], own);
    for (int i = 0; i < MODES; i++) worst = fmax(worst, fabs(own[i] / other[i] - 1));
    print_message("%s, nodal diameter %d: first mode %.8g Hz, CalculiX %.8g; six modes to %.1e\n",
                  kind == MESH_TET10 ? "C3D10" : "C3D20R", diameter[k], own[0], other[0], worst);
    check_below(worst, 1e-8, "frequencies");
  }
  fem_hermitian_order_free(order);
  fem_sector_free(&sector);
  fem_system_destroy(&system);
  free(element);
  mesh_fe_free(&mesh);
}

static void tetrahedra_agree(void **state) {
  (void)state;
  compare(MESH_TET10, 2, (const int[]){1, 3});
}

static void hexahedra_agree(void **state) {
  (void)state;
  compare(MESH_HEX20, 2, (const int[]){0, 2});
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(tetrahedra_agree),
                                     cmocka_unit_test(hexahedra_agree)};
  modal_session           session;
  if (argc < 2) return 77; /* skipped: CalculiX is not installed */
  program = argv[1];
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failed;
}
