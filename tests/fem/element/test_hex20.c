/* The 20-node hexahedron: topology, rules, mass, rank and zero-energy modes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/assemble.h"
#include "fem/element/hourglass.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

#include <petscblaslapack.h>

/* N_i is 1 at node i and 0 at the others; they add up to 1; gradients against differences. */
static void shape_functions_belong_to_the_nodes(void **state) {
  (void)state;
  const mesh_kind both[2] = {MESH_TET10, MESH_HEX20};
  for (int k = 0; k < 2; k++) {
    const mesh_topology *t     = mesh_topology_of(both[k]);
    const double         at[3] = {.23, .31, .17}, h = 1e-5;
    double               N[2][MESH_NODES], dN[MESH_NODES][3], unused[MESH_NODES][3];
    for (int j = 0; j < t->nodes; j++) {
      mesh_shape(both[k], t->place[j], N[0], dN);
      for (int i = 0; i < t->nodes; i++) check_below(N[0][i] - (i == j), 1e-15, "N at a node");
    }
    mesh_shape(both[k], at, N[0], dN);
    double sum = 0;
    for (int i = 0; i < t->nodes; i++) sum += N[0][i];
    check_close(sum, 1, 1e-15, "sum of N");
    for (int d = 0; d < 3; d++) {
      for (int s = 0; s < 2; s++) {
        double shifted[3] = {at[0], at[1], at[2]};
        shifted[d] += s ? h : -h;
        mesh_shape(both[k], shifted, N[s], unused);
      }
      for (int i = 0; i < t->nodes; i++)
        check_below((N[1][i] - N[0][i]) / (2 * h) - dN[i][d], 1e-8, "gradient of N");
    }
  }
}

/* Middles lie between their ends. Faces hold the middles of their sides and are ordered outward. */
static void edges_and_faces_fit_the_places(void **state) {
  (void)state;
  const mesh_kind both[2] = {MESH_TET10, MESH_HEX20};
  for (int k = 0; k < 2; k++) {
    const mesh_topology *t      = mesh_topology_of(both[k]);
    const double         inside = both[k] == MESH_HEX20 ? .5 : .25;
    for (int e = 0; e < t->edges; e++)
      for (int d = 0; d < 3; d++)
        check_below(t->place[t->corners + e][d] -
                        (t->place[t->edge[e][0]][d] + t->place[t->edge[e][1]][d]) / 2,
                    0, "middle of an edge");
    for (int f = 0; f < t->faces; f++) {
      const int *face = t->face[f], c = t->face_corners;
      double     a[3], b[3], out = 0;
      for (int d = 0; d < 3; d++) {
        a[d] = t->place[face[1]][d] - t->place[face[0]][d];
        b[d] = t->place[face[c - 1]][d] - t->place[face[0]][d];
      }
      for (int d = 0; d < 3; d++)
        out += (a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]) *
               (t->place[face[0]][d] - inside);
      assert_true(out > 0);
      for (int i = 0; i < c; i++)
        for (int d = 0; d < 3; d++)
          check_below(t->place[face[c + i]][d] -
                          (t->place[face[i]][d] + t->place[face[(i + 1) % c]][d]) / 2,
                      0, "middle of a face's side");
    }
  }
}

static void rules_have_their_degree(void **state) {
  (void)state;
  for (int n = 1; n <= 4; n++) {
    fem_rule rule;
    double   above = 0;
    assert_int_equal(fem_hex_rule(n, &rule), 0);
    assert_int_equal(rule.n, n * n * n);
    for (int power = 0; power <= 2 * n; power++) {
      double sum = 0, exact = 1. / (power + 1) / (2 * n) / 2;
      for (int p = 0; p < rule.n; p++) {
        double x[3] = {0};
        for (int i = 0; i < 20; i++)
          for (int d = 0; d < 3; d++)
            x[d] += rule.shape[p][i] * mesh_topology_of(MESH_HEX20)->place[i][d];
        sum += rule.weight[p] * pow(x[0], power) * pow(x[1], 2 * n - 1) * x[2];
      }
      if (power < 2 * n)
        check_close(sum, exact, 1e-13, "monomial");
      else
        above = fabs(sum / exact - 1);
    }
    assert_true(above > 1e-6);
  }
}

/* Rows of the mass of an affine element add up to its nodal volumes: -1/8 at corners, 1/6 at
 * middles. */
static void mass_rows_are_the_nodal_volumes(void **state) {
  (void)state;
  fem_element *element     = malloc(sizeof *element);
  const double place[3][3] = {{.21, .02, -.01}, {.03, .13, .02}, {-.02, .01, .17}};
  double       x[20][3], m[400], volume = 0;
  for (int a = 0; a < 3; a++)
    volume += place[0][a] * (place[1][(a + 1) % 3] * place[2][(a + 2) % 3] -
                             place[1][(a + 2) % 3] * place[2][(a + 1) % 3]);
  for (int i = 0; i < 20; i++)
    for (int d = 0; d < 3; d++) {
      const double *r = mesh_topology_of(MESH_HEX20)->place[i];
      x[i][d]         = .3 + r[0] * place[0][d] + r[1] * place[1][d] + r[2] * place[2][d];
    }
  assert_int_equal(fem_element_create(MESH_HEX20, FEM_STANDARD, element), 0);
  assert_true(fem_element_is_straight(element, (const double(*)[3])x));
  for (int bent = 0; bent < 2; bent++) {
    if (bent) x[13][1] += 1e-6; /* no longer affine: the rule is summed anew */
    fem_element_mass(element, 7850, (const double(*)[3])x, m);
    for (int i = 0; i < 20; i++) {
      double sum = 0;
      for (int j = 0; j < 20; j++) sum += m[20 * i + j];
      check_close(sum, 7850 * volume * (i < 8 ? -1. / 8 : 1. / 6), bent ? 1e-4 : 1e-13, "row");
    }
  }
  free(element);
}

/* Number of zero eigenvalues of the assembled stiffness. */
static int motions_without_energy(const mesh_fe *mesh, fem_rules rules) {
  fem_system   system;
  Vec          u, f;
  PetscBLASInt info, n, size;
  int          zeros = 0;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, &steel, rules, &system), 0);
  assert_int_equal(MatCreateVecs(system.K, &u, &f), 0);
  n             = (PetscBLASInt)(3 * system.n_free);
  size          = 64 * n;
  double *K     = malloc((size_t)n * (size_t)n * sizeof *K);
  double *value = malloc((size_t)n * sizeof *value);
  double *work  = malloc((size_t)size * sizeof *work);
  for (PetscBLASInt j = 0; j < n; j++) {
    const PetscScalar *column;
    assert_int_equal(VecSet(u, 0), 0);
    assert_int_equal(VecSetValue(u, j, 1, INSERT_VALUES), 0);
    assert_int_equal(VecAssemblyBegin(u), 0);
    assert_int_equal(VecAssemblyEnd(u), 0);
    assert_int_equal(MatMult(system.K, u, f), 0);
    assert_int_equal(VecGetArrayRead(f, &column), 0);
    memcpy(K + (size_t)j * (size_t)n, column, (size_t)n * sizeof *K);
    assert_int_equal(VecRestoreArrayRead(f, &column), 0);
  }
  LAPACKsyev_("N", "U", &n, K, &n, value, work, &size, &info);
  assert_int_equal(info, 0);
  while (zeros < n && value[zeros] < 1e-9 * value[n - 1]) zeros++;
  VecDestroy(&u);
  VecDestroy(&f);
  fem_system_destroy(&system);
  free(K), free(value), free(work);
  return zeros;
}

/* The count stated in fem/element/hourglass.h. Its check refuses exactly the meshes with such
 * modes. */
static void columns_of_single_elements_are_refused(void **state) {
  (void)state;
  const int cells[][3] = {{1, 1, 1}, {2, 1, 1}, {4, 1, 1}, {1, 2, 1}, {1, 1, 2},
                          {3, 2, 1}, {2, 1, 2}, {2, 2, 2}, {2, 3, 1}};
  use_elements(MESH_HEX20);
  for (size_t c = 0; c < sizeof cells / sizeof *cells; c++) {
    const int   *n       = cells[c];
    const double size[3] = {.1 * n[0], .08 * n[1], .07 * n[2]};
    const bool   column  = n[1] == 1 && n[2] == 1;
    mesh_fe      mesh    = make_box(size, n);
    assert_int_equal(motions_without_energy(&mesh, FEM_STANDARD), column ? n[0] : 0);
    assert_int_equal(motions_without_energy(&mesh, FEM_FULL), 0);
    assert_int_equal(fem_hourglass_check(&mesh), column ? SHB_ERR_INPUT : SHB_OK);
    if (column) assert_non_null(strstr(shb_message(), "modal.integration: full"));
    mesh.set[MESH_ROOT].n = 0;
    assert_int_equal(motions_without_energy(&mesh, FEM_FULL), 6);
    if (n[0] > 1 && !column) assert_int_equal(motions_without_energy(&mesh, FEM_STANDARD), 6);
    mesh_fe_free(&mesh);
  }
}

/* Unbalanced force divided by the largest nodal force, for curved elements under constant strain.
 * It vanishes at inner nodes with 3x3x3 points, but not with 2x2x2. */
static double out_of_balance(fem_rules rules, double curve) {
  const double size[3] = {.21, .13, .08}, g[3][3] = {{1, .2, -.5}, {.7, -2, .3}, {.1, .9, 1.4}};
  const int    cells[3] = {3, 3, 2};
  double       inner = 0, outer = 0;
  use_elements(MESH_HEX20);
  mesh_fe            mesh = make_box(size, cells);
  fem_system         system;
  Vec                u, f;
  const PetscScalar *force;
  mesh.set[MESH_ROOT].n = 0;
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, y[3] = {x[0], x[1], x[2]}, bubble = curve;
    for (int d = 0; d < 3; d++) bubble *= 4 * y[d] * (size[d] - y[d]) / (size[d] * size[d]);
    for (int d = 0; d < 3; d++) x[d] += bubble * sin(40 * y[(d + 1) % 3] + d);
  }
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, rules, &system), 0);
  assert_int_equal(MatCreateVecs(system.K, &u, &f), 0);
  for (int i = 0; i < mesh.n_nodes; i++)
    for (int a = 0; a < 3; a++) {
      const double *x = mesh.coordinates + 3 * i;
      VecSetValue(u, 3 * system.row[i] + a, g[a][0] * x[0] + g[a][1] * x[1] + g[a][2] * x[2],
                  INSERT_VALUES);
    }
  assert_int_equal(VecAssemblyBegin(u), 0);
  assert_int_equal(VecAssemblyEnd(u), 0);
  assert_int_equal(MatMult(system.K, u, f), 0);
  assert_int_equal(VecGetArrayRead(f, &force), 0);
  for (int i = 0; i < mesh.n_nodes; i++) {
    const double *x      = mesh.coordinates + 3 * i;
    bool          inside = true;
    for (int d = 0; d < 3; d++) inside = inside && x[d] > 1e-9 && x[d] < size[d] - 1e-9;
    double *most = inside ? &inner : &outer;
    for (int a = 0; a < 3; a++) *most = fmax(*most, fabs(force[3 * system.row[i] + a]));
  }
  assert_int_equal(VecRestoreArrayRead(f, &force), 0);
  VecDestroy(&u);
  VecDestroy(&f);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
  return inner / outer;
}

static void patch_test_of_curved_elements(void **state) {
  (void)state;
  double reduced = out_of_balance(FEM_STANDARD, .01), full = out_of_balance(FEM_FULL, .01);
  print_message("force out of balance: 2x2x2 %.1e, 3x3x3 %.1e\n", reduced, full);
  check_below(full, 1e-12, "3x3x3 points");
  assert_true(reduced > 1e-9 && reduced < 1e-2);
  check_below(out_of_balance(FEM_STANDARD, 0), 1e-12, "2x2x2 points, bricks");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shape_functions_belong_to_the_nodes),
      cmocka_unit_test(edges_and_faces_fit_the_places),
      cmocka_unit_test(rules_have_their_degree),
      cmocka_unit_test(mass_rows_are_the_nodal_volumes),
      cmocka_unit_test(columns_of_single_elements_are_refused),
      cmocka_unit_test(patch_test_of_curved_elements),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL) != 0) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
