/* Assembled matrices: patch test, rigid motions, mass, clamp, preallocation; partition and floating
 * parts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/assemble.h"
#include "fem/body/clamp_check.h"
#include "fem/body/partition.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

static const double size[3]  = {.21, .13, .08};
static const int    cells[3] = {4, 3, 2};

/* Forces K u (or M u) of the field u = offset + gradient x on a body without a clamp. */
static void apply(const fem_system *system, Mat A, const mesh_fe *mesh, const double offset[3],
                  const double gradient[3][3], Vec u, Vec f) {
  PetscScalar *value;
  assert_int_equal(VecGetArray(u, &value), 0);
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int a = 0; a < 3; a++) {
      const double *x = mesh->coordinates + 3 * i, *g = gradient[a];
      value[3 * system->row[i] + a] = offset[a] + g[0] * x[0] + g[1] * x[1] + g[2] * x[2];
    }
  assert_int_equal(VecRestoreArray(u, &value), 0);
  assert_int_equal(MatMult(A, u, f), 0);
}

static mesh_fe free_body(void) {
  mesh_fe mesh          = make_box(size, cells);
  mesh.set[MESH_ROOT].n = 0;
  shake_inside(&mesh, size, .004); /* distorted, curved elements inside; flat surface */
  return mesh;
}

/* Constant stress: the largest force on an inner node divided by the largest on the surface. */
static double force_inside(const mesh_fe *mesh, fem_rules rules) {
  fem_system system;
  Vec        u, f;
  double     inner = 0, outer = 0;
  int        n_inner = 0;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, &steel, rules, &system), 0);
  assert_int_equal(MatCreateVecs(system.K, &u, &f), 0);
  const double offset[3] = {.01, -.02, .03};
  const double g[3][3]   = {{1e-3, 2e-4, -5e-4}, {7e-4, -2e-3, 3e-4}, {1e-4, 9e-4, 1.4e-3}};
  apply(&system, system.K, mesh, offset, g, u, f);
  const PetscScalar *force;
  assert_int_equal(VecGetArrayRead(f, &force), 0);
  for (int i = 0; i < mesh->n_nodes; i++) {
    const double *x      = mesh->coordinates + 3 * i;
    bool          inside = true;
    for (int d = 0; d < 3; d++) inside = inside && x[d] > 1e-12 && x[d] < size[d] - 1e-12;
    n_inner += inside;
    for (int a = 0; a < 3; a++) {
      double value = fabs(force[3 * system.row[i] + a]);
      if (inside)
        inner = fmax(inner, value);
      else
        outer = fmax(outer, value);
    }
  }
  assert_int_equal(VecRestoreArrayRead(f, &force), 0);
  assert_true(n_inner > 30 && outer > 1e3);
  VecDestroy(&u);
  VecDestroy(&f);
  fem_system_destroy(&system);
  return inner / outer;
}

/* Constant stress: no force on any inner node, tractions on the surface only. */
static void patch_test(void **state) {
  (void)state;
  mesh_fe mesh = free_body();
  check_below(force_inside(&mesh, FEM_FULL), 1e-9, "force inside, all points");
  straighten(&mesh);
  check_below(force_inside(&mesh, FEM_STANDARD), 1e-9, "force inside, straight edges");
  mesh_fe_free(&mesh);
}

/* A box whose inner nodes are moved by a smooth field: all elements are curved. */
static mesh_fe smooth_body(int finer) {
  const int n[3]        = {cells[0] * finer, cells[1] * finer, cells[2] * finer};
  mesh_fe   mesh        = make_box(size, n);
  mesh.set[MESH_ROOT].n = 0;
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, y[3] = {x[0], x[1], x[2]}, bubble = .01;
    for (int d = 0; d < 3; d++) bubble *= 4 * y[d] * (size[d] - y[d]) / (size[d] * size[d]);
    for (int d = 0; d < 3; d++) x[d] += bubble * sin(40 * y[(d + 1) % 3] + d);
  }
  return mesh;
}

/* Four points leave forces inside a body of curved elements. The forces fall as the mesh is
 * refined. */
static void patch_test_of_curved_elements(void **state) {
  (void)state;
  double inside[2];
  for (int level = 0; level < 2; level++) {
    mesh_fe mesh  = smooth_body(2 << level);
    inside[level] = force_inside(&mesh, FEM_STANDARD);
    check_below(force_inside(&mesh, FEM_FULL), 1e-9, "force inside, all points");
    mesh_fe_free(&mesh);
  }
  print_message("force inside: %.1e, half as fine %.1e\n", inside[1], inside[0]);
  assert_true(inside[0] > 1e-9 && inside[0] < 1e-2 && inside[1] < .3 * inside[0]);
}

static void mass_and_inertia_are_exact(void **state) {
  (void)state;
  mesh_fe    mesh = free_body();
  fem_system system;
  Vec        u, f;
  double     twice;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(MatCreateVecs(system.M, &u, &f), 0);
  const double mass = 7850 * size[0] * size[1] * size[2], none[3][3] = {{0}}, zero[3] = {0};
  for (int a = 0; a < 3; a++) {
    double unit[3] = {a == 0, a == 1, a == 2};
    apply(&system, system.M, &mesh, unit, none, u, f);
    assert_int_equal(VecDot(u, f, &twice), 0);
    check_close(twice, mass, 1e-12, "mass");
    apply(&system, system.K, &mesh, unit, none, u, f);
    assert_int_equal(VecNorm(f, NORM_INFINITY, &twice), 0);
    check_below(twice, 1e-2, "force of a translation"); /* entries of K are of order 1e10 */
  }
  const double spin[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 0}}; /* about z: I = m (a2 + b2)/3 */
  apply(&system, system.M, &mesh, zero, spin, u, f);
  assert_int_equal(VecDot(u, f, &twice), 0);
  check_close(twice, mass * (size[0] * size[0] + size[1] * size[1]) / 3, 1e-12, "inertia");
  apply(&system, system.K, &mesh, zero, spin, u, f);
  assert_int_equal(VecNorm(f, NORM_INFINITY, &twice), 0);
  check_below(twice, 1e-2, "force of a rotation");
  VecDestroy(&u);
  VecDestroy(&f);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

/* The energy from the strains is u^T K u. For a rigid motion it vanishes, where u^T K u is
 * rounding. */
static void strain_energy_is_the_quadratic_form(void **state) {
  (void)state;
  mesh_fe      mesh    = free_body();
  fem_element *element = malloc(sizeof *element);
  double      *u       = malloc(3 * (size_t)mesh.n_nodes * sizeof *u), product;
  fem_system   system;
  Vec          x, f;
  assert_int_equal(fem_element_create(mesh.kind, FEM_STANDARD, element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(MatCreateVecs(system.K, &x, &f), 0);
  for (int i = 0; i < mesh.n_nodes; i++)
    for (int d = 0; d < 3; d++) {
      u[3 * i + d] = sin(2.7 * i + 1.3 * d);
      assert_int_equal(VecSetValue(x, 3 * system.row[i] + d, u[3 * i + d], INSERT_VALUES), 0);
    }
  assert_int_equal(VecAssemblyBegin(x), 0);
  assert_int_equal(VecAssemblyEnd(x), 0);
  assert_int_equal(MatMult(system.K, x, f), 0);
  assert_int_equal(VecDot(x, f, &product), 0);
  check_close(strain_energy(&mesh, &steel, element, u), product, 1e-12, "energy");
  for (int i = 0; i < mesh.n_nodes; i++) {
    const double *at = mesh.coordinates + 3 * i;
    u[3 * i]         = 1 - 3 * at[1];
    u[3 * i + 1]     = 2 + 3 * at[0];
    u[3 * i + 2]     = 3;
  }
  check_below(strain_energy(&mesh, &steel, element, u), 1e-25 * product, "rigid energy");
  VecDestroy(&x);
  VecDestroy(&f);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
  free(element);
  free(u);
}

static void clamped_nodes_are_left_out_and_storage_is_exact(void **state) {
  (void)state;
  mesh_fe    mesh = make_box(size, cells);
  fem_system system;
  MatInfo    info;
  int        clamped = 0;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  for (int i = 0; i < mesh.n_nodes; i++) {
    bool on_root = mesh.coordinates[3 * i] == 0;
    assert_true((system.row[i] < 0) == on_root);
    clamped += on_root;
  }
  /* hexahedra have no node in the middle of a face */
  assert_int_equal(clamped, mesh.kind == MESH_HEX20 ? 7 * 5 - 3 * 2 : 7 * 5);
  assert_int_equal(system.n_free, mesh.n_nodes - clamped);
  Mat both[2] = {system.K, NULL};
  assert_int_equal(MatMAIJGetAIJ(system.M, &both[1]), 0);
  for (int i = 0; i < 2; i++) {
    assert_int_equal(MatGetInfo(both[i], MAT_LOCAL, &info), 0);
    assert_true(info.mallocs == 0 && info.nz_unneeded == 0);
  }
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static void partition_is_balanced(void **state) {
  (void)state;
  mesh_fe mesh    = make_box(size, cells);
  bool   *is_free = malloc((size_t)mesh.n_nodes);
  int    *rank    = malloc((size_t)mesh.n_nodes * sizeof *rank);
  for (int i = 0; i < mesh.n_nodes; i++) is_free[i] = i % 7 != 0;
  for (int n = 1; n <= 5; n++) {
    int count[5] = {0}, least = mesh.n_nodes, most = 0;
    assert_int_equal(fem_partition(&mesh, is_free, n, rank), 0);
    for (int i = 0; i < mesh.n_nodes; i++) {
      assert_true(is_free[i] ? rank[i] >= 0 && rank[i] < n : rank[i] == -1);
      if (rank[i] >= 0) count[rank[i]]++;
    }
    for (int r = 0; r < n; r++) {
      least = count[r] < least ? count[r] : least;
      most  = count[r] > most ? count[r] : most;
    }
    assert_true(most - least <= 2);
  }
  free(is_free);
  free(rank);
  mesh_fe_free(&mesh);
}

/* Two bodies side by side in one mesh, one of them clamped. */
static void floating_part_is_named(void **state) {
  (void)state;
  mesh_fe one = make_box(size, cells), two = make_box(size, cells);
  int     bodies;
  assert_int_equal(fem_clamp_check(&one, &bodies), SHB_OK);
  assert_int_equal(bodies, 1);
  mesh_fe both  = one;
  int     nodes = one.n_nodes, elements = one.n_elements;
  both.n_nodes      = 2 * nodes;
  both.n_elements   = 2 * elements;
  const int each    = mesh_topology_of(one.kind)->nodes * elements;
  both.connectivity = malloc(2 * (size_t)each * sizeof(int));
  both.element_tag  = malloc(2 * (size_t)elements * sizeof(long));
  for (int i = 0; i < each; i++) {
    both.connectivity[i]        = one.connectivity[i];
    both.connectivity[each + i] = two.connectivity[i] + nodes;
  }
  for (int e = 0; e < 2 * elements; e++) both.element_tag[e] = 1000 + e;
  assert_int_equal(fem_clamp_check(&both, &bodies), SHB_ERR_INPUT);
  assert_int_equal(bodies, 2);
  assert_non_null(strstr(shb_message(), one.kind == MESH_HEX20
                                            ? "24 elements (the first has tag 1024)"
                                            : "144 elements (the first has tag 1144)"));
  free(both.connectivity);
  free(both.element_tag);
  mesh_fe_free(&one);
  mesh_fe_free(&two);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(patch_test),
      cmocka_unit_test(patch_test_of_curved_elements),
      cmocka_unit_test(mass_and_inertia_are_exact),
      cmocka_unit_test(strain_energy_is_the_quadratic_form),
      cmocka_unit_test(clamped_nodes_are_left_out_and_storage_is_exact),
      cmocka_unit_test(partition_is_balanced),
      cmocka_unit_test(floating_part_is_named),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL) != 0) return 1;
  int failures = run_with_both_elements(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
