/* Missed modes are noticed and found: repeated ones, one hidden from the solver on purpose; the count is the inertia's. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "modal/common/session.h"
#include "modal/eigen/block_lanczos.h"
#include "modal/eigen/eigen.h"
#include "modal/eigen/inertia_count.h"
#include "modal/eigen/missed_modes.h"
#include "tests/support/fem.h"

static void assemble(const mesh_fe *mesh, fem_system *system) {
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, &steel, FEM_STANDARD, system), 0);
}

static void solve(const fem_system *system, const modal_eigen_settings *settings,
                  modal_eigen *eigen) {
  if (modal_eigen_solve(system, settings, eigen) != 0) fail_msg("%s", shb_message());
  assert_int_equal(eigen->n, settings->modes);
}

static PetscInt block_size(const modal_eigen *eigen) {
  PetscInt size = 0;
  modal_block_lanczos_get_size(eigen->eps, &size);
  return size;
}

/* The body side by side with itself, copies of it that touch nowhere. */
static mesh_fe repeat(const mesh_fe *one, int copies, double pitch) {
  const int nodes = mesh_topology_of(one->kind)->nodes;
  const int face  = mesh_topology_of(one->kind)->face_nodes;
  const int root  = one->set[MESH_ROOT].n;
  mesh_fe   all   = {
          .kind = one->kind, .n_nodes = copies * one->n_nodes, .n_elements = copies * one->n_elements};
  all.coordinates          = malloc(3 * (size_t)all.n_nodes * sizeof *all.coordinates);
  all.node_tag             = calloc((size_t)all.n_nodes, sizeof *all.node_tag);
  all.connectivity         = malloc((size_t)(nodes * all.n_elements) * sizeof *all.connectivity);
  all.element_tag          = calloc((size_t)all.n_elements, sizeof *all.element_tag);
  all.set[MESH_ROOT].n     = copies * root;
  all.set[MESH_ROOT].nodes = malloc((size_t)(copies * root * face) * sizeof(int));
  for (int c = 0; c < copies; c++) {
    const int first = c * one->n_nodes;
    for (int i = 0; i < 3 * one->n_nodes; i++)
      all.coordinates[3 * first + i] = one->coordinates[i] + (i % 3 == 1 ? c * pitch : 0);
    for (int i = 0; i < nodes * one->n_elements; i++)
      all.connectivity[c * nodes * one->n_elements + i] = one->connectivity[i] + first;
    for (int i = 0; i < root * face; i++)
      all.set[MESH_ROOT].nodes[c * root * face + i] = one->set[MESH_ROOT].nodes[i] + first;
  }
  return all;
}

/* Bars that know nothing of each other have every frequency as often as there are bars; a block of four sees four of them, unless it
 * goes on until rounding brings the others. */
static void copies_are_found(void **state) {
  (void)state;
  enum { MODES = 12 };
  const double size[3]  = {0.2, 0.031, 0.011};
  const int    cells[3] = {7, 2, 1}, copies[2] = {6, 9};
  mesh_fe      bar = make_box(size, cells);
  for (int k = 0; k < 2; k++) {
    modal_eigen_settings settings = {.modes = MODES, .tolerance = 1e-6};
    mesh_fe              row      = repeat(&bar, copies[k], 1.5 * size[1]);
    fem_system           one, all;
    modal_eigen          single, eigen;
    assemble(&bar, &one);
    assemble(&row, &all);
    solve(&one, &settings, &single);
    solve(&all, &settings, &eigen);
    for (int i = 0; i < MODES; i++)
      check_close(eigen.lambda[i], single.lambda[i / copies[k]], 1e-6, "one of many");
    print_message("%d copies: blocks of %d, checked by %s\n", copies[k], (int)block_size(&eigen),
                  eigen.check.method);
    assert_int_equal(eigen.check.count,
                     (MODES - 1) / copies[k] * copies[k]); /* equals are not below */
    modal_eigen_destroy(&eigen);
    modal_eigen_destroy(&single);
    fem_system_destroy(&all);
    fem_system_destroy(&one);
    mesh_fe_free(&row);
  }
  mesh_fe_free(&bar);
}

/* A square bar's pairs, for a solver that sees one of each. */
static void pairs_are_found(void **state) {
  (void)state;
  const double               size[3]  = {0.2, 0.02, 0.02};
  const int                  cells[3] = {12, 3, 3};
  const modal_check_kind     kind[2]  = {MODAL_CHECK_AUTO, MODAL_CHECK_INERTIA};
  const modal_eigen_settings usual    = {.modes = 4};
  fem_system                 system;
  modal_eigen                good, eigen;
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_box(size, cells);
  use_elements(MESH_TET10);
  assemble(&mesh, &system);
  solve(&system, &usual, &good);
  assert_int_equal(block_size(&good), 4);
  for (int k = 0; k < 2; k++) {
    modal_eigen_settings settings = {.modes = 4, .tolerance = 1e-6, .check = kind[k]};
    PetscOptionsSetValue(NULL, "-eps_block_size", "1");
    solve(&system, &settings, &eigen);
    PetscOptionsClearValue(NULL, "-eps_block_size");
    assert_int_equal(block_size(&eigen), 2);
    assert_string_equal(eigen.check.method, k == 0 ? "restart" : "inertia");
    for (int i = 0; i < 4; i++) check_close(eigen.lambda[i], good.lambda[i], 1e-6, "eigenvalue");
    modal_eigen_destroy(&eigen);
  }
  modal_eigen_destroy(&good);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* ------------------------------------------------------------------ a set with one mode taken out */

enum { WHOLE = 9, KEPT = 8, COLUMNS = 4 };

/* A basis of the reference's modes without one, as if a run had converged to it. */
static void make_basis(const fem_system *system, const modal_eigen *reference, int hidden,
                       modal_block_basis *b) {
  const double *phi;
  int           columns = 0;
  ST            st;
  KSP           ksp;
  EPSGetST(reference->eps, &st);
  STGetKSP(st, &ksp);
  assert_int_equal(modal_block_basis_create(system->M, ksp, COLUMNS, KEPT / COLUMNS + 1, b), 0);
  MatDenseGetArrayRead(reference->phi, &phi);
  for (int i = 0; i < WHOLE && columns < KEPT; i++) {
    if (i == hidden) continue;
    const int to = KEPT - 1 - columns; /* theta ascending */
    if (!b->Q[to / COLUMNS]) b->Q[to / COLUMNS] = malloc((size_t)(b->rows * COLUMNS) * sizeof *phi);
    memcpy(b->Q[to / COLUMNS] + (size_t)(to % COLUMNS) * (size_t)b->rows,
           phi + (size_t)i * (size_t)b->rows, (size_t)b->rows * sizeof *phi);
    b->theta[to]         = 1 / reference->lambda[i];
    b->H[to * KEPT + to] = 1;
    columns++;
  }
  b->n = KEPT / COLUMNS;
  MatDenseRestoreArrayRead(reference->phi, &phi);
}

/* Each of nine modes in turn: missing below the last kept one, which is noticed, but for that last one itself. */
static void hidden_mode_is_noticed(void **state) {
  (void)state;
  const double               size[3]  = {0.2, 0.031, 0.011};
  const int                  cells[3] = {14, 4, 2};
  const modal_eigen_settings settings = {.modes = WHOLE};
  mesh_fe                    mesh     = make_box(size, cells);
  fem_system                 system;
  modal_eigen                reference;
  assemble(&mesh, &system);
  solve(&system, &settings, &reference);
  for (int hidden = 0; hidden < WHOLE; hidden++) {
    const double       last = reference.lambda[hidden == WHOLE - 1 ? WHOLE - 2 : WHOLE - 1];
    modal_block_basis  basis;
    modal_missed_modes rest;
    make_basis(&system, &reference, hidden, &basis);
    assert_int_equal(modal_missed_modes_search(&basis, 1 / (last * (1 - 1e-6)), &rest), 0);
    print_message("mode %d hidden: ratio %.6f after %d solves, chance %.1e\n", hidden + 1,
                  rest.ratio, rest.steps, rest.probability);
    assert_int_equal(rest.count, KEPT - 1);
    if (hidden < WHOLE - 1) {
      assert_int_equal(rest.verdict, MODAL_VERDICT_MISSING);
      assert_true(rest.ratio <= last / reference.lambda[hidden] * (1 + 1e-9)); /* a lower bound */
    } else {
      assert_int_equal(rest.verdict, MODAL_VERDICT_COMPLETE);
      assert_true(rest.probability <= 1e-9);
      check_close(rest.ratio, last / reference.lambda[WHOLE - 1], 0.05, "the next mode");
    }
    modal_block_basis_destroy(&basis);
  }
  modal_eigen_destroy(&reference);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* ------------------------------------------------------------------ the count */

/* Between any two modes the negative pivots are as many as the modes below, of a clamped body and of a free one. */
static void inertia_counts(void **state) {
  (void)state;
  const double size[3]  = {0.11, 0.07, 0.05};
  const int    cells[3] = {4, 3, 2};
  for (int clamped = 0; clamped < 2; clamped++) {
    modal_eigen_settings settings = {.modes = 9, .shift = clamped ? 0 : -1e8};
    mesh_fe              mesh     = make_box(size, cells);
    fem_system           system;
    modal_eigen          eigen;
    if (!clamped) mesh.set[MESH_ROOT].n = 0;
    assemble(&mesh, &system);
    solve(&system, &settings, &eigen);
    assert_string_equal(eigen.check.method, "restart");
    for (int i = clamped ? 0 : 6; i < 8; i++) {
      int count;
      assert_int_equal(
          modal_inertia_count(&system, (eigen.lambda[i] + eigen.lambda[i + 1]) / 2, &count), 0);
      assert_int_equal(count, i + 1);
    }
    modal_eigen_destroy(&eigen);
    fem_system_destroy(&system);
    mesh_fe_free(&mesh);
  }
}

/* Krylov-Schur keeps no basis to go by, and its modes are counted. */
static void others_are_counted(void **state) {
  (void)state;
  const double         size[3]  = {0.2, 0.031, 0.011};
  const int            cells[3] = {12, 3, 2};
  modal_eigen_settings settings = {.modes = 10};
  mesh_fe              mesh     = make_box(size, cells);
  fem_system           system;
  modal_eigen          eigen;
  assemble(&mesh, &system);
  PetscOptionsSetValue(NULL, "-eps_type", EPSKRYLOVSCHUR);
  solve(&system, &settings, &eigen);
  PetscOptionsClearValue(NULL, "-eps_type");
  assert_string_equal(eigen.check.method, "inertia");
  assert_int_equal(eigen.check.count, 9);
  assert_true(eigen.check.probability == 0);
  check_close(eigen.check.limit, eigen.lambda[9] * (1 - 1e-6), 1e-9, "limit");
  modal_eigen_destroy(&eigen);
  settings.check = MODAL_CHECK_NEVER;
  solve(&system, &settings, &eigen);
  assert_string_equal(eigen.check.method, "no");
  assert_true(eigen.check.probability == 1);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* ------------------------------------------------------------------ the chance */

/* Greatest Ritz value of so many Krylov vectors of diag(value) from a random one, n <= 64: Lanczos with full orthogonalisation. */
static double ritz(int n, const double *value, int steps, uint64_t *random) {
  double Q[8][64], T[64] = {0}, w[8], work[64];
  for (int i = 0; i < n; i++) { /* normal: twelve uniform ones */
    Q[0][i] = -6;
    for (int k = 0; k < 12; k++) {
      *random = *random * 6364136223846793005u + 1442695040888963407u;
      Q[0][i] += (double)(*random >> 11) * 0x1p-53;
    }
  }
  for (int k = 0; k < steps; k++) {
    for (int pass = 0; pass < 2; pass++)
      for (int j = 0; j < k; j++) {
        double dot = 0;
        for (int i = 0; i < n; i++) dot += Q[j][i] * Q[k][i];
        for (int i = 0; i < n; i++) Q[k][i] -= dot * Q[j][i];
      }
    double norm = 0;
    for (int i = 0; i < n; i++) norm += Q[k][i] * Q[k][i];
    for (int i = 0; i < n; i++) Q[k][i] /= sqrt(norm);
    for (int j = 0; j <= k; j++)
      for (int i = 0; i < n; i++) T[k * steps + j] += Q[j][i] * value[i] * Q[k][i];
    for (int i = 0; i < n && k + 1 < steps; i++) Q[k + 1][i] = value[i] * Q[k][i];
  }
  PetscBLASInt m = steps, size = 64, info;
  LAPACKsyev_("N", "U", &m, T, &m, w, work, &size, &info);
  assert_int_equal(info, 0);
  return w[steps - 1];
}

/* The bound against 100,000 draws, one column: how often no Ritz value tells of an eigenvalue at 1 when the others reach 0.3. The bound holds,
 * and is not empty: within two orders of what is drawn (one is the share a). */
static void chance_holds(void **state) {
  (void)state;
  enum { N = 40, DRAWS = 100000 };
  double   value[N] = {1};
  uint64_t random   = 5;
  for (int i = 1; i < N; i++) value[i] = 0.3 * i / (N - 1);
  for (int steps = 2; steps <= 4; steps++) {
    const double ratio = 0.3;
    int          blind = 0;
    for (int d = 0; d < DRAWS; d++) blind += ritz(N, value, steps, &random) <= ratio;
    const double drawn = (double)blind / DRAWS,
                 bound = modal_missed_modes_probability(ratio, steps, 1, N);
    print_message("%d steps: blind in %.1e of the draws, bound %.1e\n", steps, drawn, bound);
    assert_true(drawn <= bound);
    assert_true(blind == 0 || bound < 1000 * drawn);
    assert_true(steps > 2 || blind > 0);
  }
  assert_true(modal_missed_modes_probability(1, 9, 4, 1e5) == 1);
  assert_true(modal_missed_modes_probability(0.5, 9, 4, 1e5) <
              modal_missed_modes_probability(0.5, 8, 4, 1e5));
  assert_true(modal_missed_modes_probability(0.5, 9, 4, 1e5) >
              modal_missed_modes_probability(0.4, 9, 4, 1e5));
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(copies_are_found),       cmocka_unit_test(pairs_are_found),
      cmocka_unit_test(hidden_mode_is_noticed), cmocka_unit_test(inertia_counts),
      cmocka_unit_test(others_are_counted),     cmocka_unit_test(chance_holds)};
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
