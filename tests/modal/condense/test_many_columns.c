/* Residual terms of many contact dofs: by the condensed mass of subtrees against solutions of the
 * whole body, any number of threads, and their ends. */
#include "modal/condense/many_columns.h"

#include <math.h>
#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/mass_product.h"
#include "modal/common/session.h"
#include "modal/condense/condense.h"
#include "tests/support/fem.h"

/* LOADED: nodes with three dofs each. PATCH: nodes of the last dof. */
enum { MODES = 12, LOADED = 50, PATCH = 9 };

static const double size[3]  = {0.3, 0.06, 0.03};
static const int    cells[3] = {12, 5, 4};

typedef struct {
  mesh_fe            mesh;
  fem_system         system;
  modal_condensation to;
} body;

/* Nodes of the face z = 0 away from the root, then a mean over some of them along y, and a probe at
 * the tip. */
static void add_dofs(body *b) {
  static const double weight[PATCH] = {.1, .2, .05, .15, .1, .1, .1, .1, .1};
  int                 node[LOADED], n = 0;
  for (int i = b->mesh.n_nodes - 1; i >= 0 && n < LOADED; i--)
    if (b->mesh.coordinates[3 * i + 2] < 1e-9 && b->mesh.coordinates[3 * i] > 0.1) node[n++] = i;
  assert_int_equal(n, LOADED);
  for (int i = 0; i < LOADED; i++)
    for (int a = 0; a < 3; a++) {
      const double axis[3] = {a == 0, a == 1, a == 2}, one = 1;
      const bool   last = i == LOADED - 1 && a == 2;
      modal_dofs_add(&b->to.contact, last ? PATCH : 1, last ? node : &node[i], last ? weight : &one,
                     axis);
    }
  for (int a = 0; a < 3; a++) {
    const double axis[3] = {a == 0, a == 1, a == 2}, one = 1;
    const int    tip = b->mesh.n_nodes - 1;
    modal_dofs_add(&b->to.probe, 1, &tip, &one, axis);
  }
  b->to.n_pairs = LOADED;
  b->to.damping = (modal_damping){.ratio = 0.002};
  assert_ok(modal_load_create(&b->mesh, 0, NULL, NULL, &b->to.load));
}

static int create(void **state) {
  static body b;
  b.mesh = make_box(size, cells);
  *state = &b;
  add_dofs(&b);
  return fem_system_create(PETSC_COMM_SELF, &b.mesh, &steel, FEM_STANDARD, &b.system);
}

static int destroy(void **state) {
  body *b = *state;
  modal_load_free(&b->to.load);
  modal_dofs_free(&b->to.contact);
  modal_dofs_free(&b->to.probe);
  fem_system_destroy(&b->system);
  mesh_fe_free(&b->mesh);
  return 0;
}

static modal_model condense(const body *b) {
  const modal_eigen_settings settings = {.modes = MODES};
  modal_eigen                eigen;
  modal_model                model;
  assert_int_equal(modal_eigen_solve(&b->system, &settings, &eigen), 0);
  assert_ok(modal_condense(&b->system, &eigen, &b->to, NULL, &model));
  assert_int_equal(modal_eigen_destroy(&eigen), 0);
  return model;
}

/* Greatest difference over the greatest entry of the second. */
static double difference(const double *a, const double *b, size_t n) {
  double off = 0, most = 0;
  for (size_t i = 0; i < n; i++) {
    off  = fmax(off, fabs(a[i] - b[i]));
    most = fmax(most, fabs(b[i]));
  }
  return off / most;
}

/* MUMPS has no panels: every column is solved. */
static void agrees_with_solutions(void **state) {
  const char  *mumps = "-st_pc_factor_mat_solver_type";
  const body  *b     = *state;
  const size_t n     = 3 * LOADED;
  modal_model  tree  = condense(b);
  assert_int_equal(PetscOptionsSetValue(NULL, mumps, "mumps"), 0);
  modal_model solved = condense(b);
  assert_int_equal(PetscOptionsClearValue(NULL, mumps), 0);
  assert_int_equal(tree.n_residual, 0); /* it is the stage of many columns */
  check_below(difference(tree.residual_flexibility, solved.residual_flexibility, n * n), 1e-11,
              "R");
  check_below(difference(tree.residual_inertia, solved.residual_inertia, n * n), 1e-10, "R2");
  check_below(difference(tree.probe_contact_residual, solved.probe_contact_residual, n * 3), 1e-10,
              "R of the probe");
  check_below(difference(tree.probe_contact_inertia, solved.probe_contact_inertia, n * 3), 1e-9,
              "R2 of the probe");
  modal_model_free(&tree);
  modal_model_free(&solved);
}

static void threads_change_no_bit(void **state) {
  const body  *b            = *state;
  const int    most         = omp_get_max_threads();
  const size_t size_of_term = (size_t)(9 * LOADED * LOADED) * sizeof(double);
  omp_set_num_threads(1);
  modal_model one = condense(b);
  omp_set_num_threads(2);
  modal_model two = condense(b);
  omp_set_num_threads(most);
  assert_memory_equal(one.residual_flexibility, two.residual_flexibility, size_of_term);
  assert_memory_equal(one.residual_inertia, two.residual_inertia, size_of_term);
  modal_model_free(&one);
  modal_model_free(&two);
}

/* ------------------------------------------------------------------ ends */

typedef struct {
  int    left; /* answers yes */
  double share;
} patience;

static bool ask(void *context, double share) {
  patience *p = context;
  assert_true(share >= p->share && share < 1);
  p->share = share;
  return p->left-- > 0;
}

/* R[0][0] of a load on one dof, with neither modes nor M V_0 to check. */
static fem_loads_end solve_one(const body *b, double room, patience *p, double *R) {
  static const int    start[2] = {0, 1}, row[1] = {30};
  static const double one = 1;
  fem_factor         *factor;
  fem_mass_rows       mass;
  fem_tree            tree;
  bool                definite, by_nodes;
  double              R2;
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor), 0);
  assert_int_equal(fem_factor_update(factor, b->system.K, &definite), 0);
  assert_true(fem_factor_tree(factor, &tree));
  assert_int_equal(fem_mass_borrow(b->system.M, &by_nodes, &mass), 0);
  assert_true(by_nodes);
  const fem_unit_loads loads = {.tree        = tree,
                                .node_start  = mass.start,
                                .node_column = mass.column,
                                .node_mass   = mass.value,
                                .n_loads     = 1,
                                .start       = start,
                                .row         = row,
                                .weight      = &one,
                                .go_on       = ask,
                                .context     = p,
                                .room        = room};
  const fem_loads_end  end   = fem_unit_loads_solve(&loads, R, &R2);
  assert_int_equal(fem_mass_give_back(b->system.M, &mass), 0);
  assert_int_equal(fem_factor_destroy(&factor), 0);
  return end;
}

static void without_modes_it_is_a_solution(void **state) {
  const body *b = *state;
  patience    p = {.left = 1 << 30};
  double      R, solved;
  Vec         x;
  fem_factor *factor;
  bool        definite;
  PetscInt    row = 30;
  assert_int_equal(solve_one(b, INFINITY, &p, &R), FEM_LOADS_SOLVED);
  assert_int_equal(fem_factor_create(b->system.K, 0, &factor), 0);
  assert_int_equal(fem_factor_update(factor, b->system.K, &definite), 0);
  assert_int_equal(MatCreateVecs(b->system.K, NULL, &x), 0);
  assert_int_equal(VecSetValue(x, row, 1, INSERT_VALUES), 0);
  assert_int_equal(VecAssemblyBegin(x), 0);
  assert_int_equal(VecAssemblyEnd(x), 0);
  assert_int_equal(fem_factor_solve(factor, x, x), 0);
  assert_int_equal(VecGetValues(x, 1, &row, &solved), 0);
  check_close(R, solved, 1e-12, "R");
  assert_int_equal(VecDestroy(&x), 0);
  assert_int_equal(fem_factor_destroy(&factor), 0);
}

/* Among the subtrees, and above them. */
static void it_stops_when_asked(void **state) {
  patience all = {.left = 1 << 30};
  double   R;
  assert_int_equal(solve_one(*state, INFINITY, &all, &R), FEM_LOADS_SOLVED);
  const int asked = (1 << 30) - all.left;
  patience  soon = {.left = 5}, late = {.left = asked - 1};
  assert_true(asked > 10);
  assert_int_equal(solve_one(*state, INFINITY, &soon, &R), FEM_LOADS_STOPPED);
  assert_int_equal(solve_one(*state, INFINITY, &late, &R), FEM_LOADS_STOPPED);
  assert_true(late.share > 0.8);
}

static void little_room_is_told(void **state) {
  patience p = {.left = 1 << 30};
  double   R;
  assert_int_equal(solve_one(*state, 1e4, &p, &R), FEM_LOADS_NO_ROOM);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(agrees_with_solutions),
      cmocka_unit_test(threads_change_no_bit),
      cmocka_unit_test(without_modes_it_is_a_solution),
      cmocka_unit_test(it_stops_when_asked),
      cmocka_unit_test(little_room_is_told),
  };
  modal_session session;
  use_elements(MESH_HEX20);
  assert_ok(modal_session_start(&argc, &argv, &session));
  const int failed = cmocka_run_group_tests(tests, create, destroy);
  modal_session_end(&session, SHB_OK);
  return failed;
}
