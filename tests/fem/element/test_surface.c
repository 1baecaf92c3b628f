/* Surface loads: resultants that are exact on any mesh. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element/surface.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"

static const double size[3]  = {.21, .13, .08};
static const int    cells[3] = {4, 3, 2};

/* Resultant and moment about the origin. */
static void resultant(const mesh_fe *mesh, const double *force, double sum[3], double moment[3]) {
  for (int d = 0; d < 3; d++) sum[d] = moment[d] = 0;
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int d = 0; d < 3; d++) {
      int a = (d + 1) % 3, b = (d + 2) % 3;
      sum[d] += force[3 * i + d];
      moment[d] += mesh->coordinates[3 * i + a] * force[3 * i + b] -
                   mesh->coordinates[3 * i + b] * force[3 * i + a];
    }
}

static void pressure_pushes_into_a_flat_face(void **state) {
  (void)state;
  mesh_fe  mesh  = make_box(size, cells);
  double  *force = malloc(3 * (size_t)mesh.n_nodes * sizeof *force), sum[3], moment[3];
  fem_load load  = {.kind = FEM_LOAD_PRESSURE, .pressure = 2385};
  assert_int_equal(fem_load_pattern(&mesh, &load, NULL, force), SHB_OK);
  resultant(&mesh, force, sum, moment);
  double F = 2385 * size[0] * size[1]; /* on z = size[2], outward +z */
  check_close(sum[2], -F, 1e-12, "pressure resultant");
  check_below(sum[0], 1e-12 * F, "sideways");
  check_below(sum[1], 1e-12 * F, "sideways");
  check_close(moment[0], -F * size[1] / 2, 1e-12, "moment");
  check_close(moment[1], F * size[0] / 2, 1e-12, "moment");
  load = (fem_load){.kind = FEM_LOAD_TRACTION, .traction = {17, -23, 41}};
  assert_int_equal(fem_load_pattern(&mesh, &load, NULL, force), SHB_OK);
  resultant(&mesh, force, sum, moment);
  for (int d = 0; d < 3; d++)
    check_close(sum[d], load.traction[d] * size[0] * size[1], 1e-12, "traction resultant");
  free(force);
  mesh_fe_free(&mesh);
}

/* All six sides of a body with curved sides as the loaded group. */
static mesh_fe closed_curved_body(void) {
  mesh_fe        mesh  = make_box(size, cells);
  const int      width = mesh_topology_of(mesh.kind)->face_nodes;
  mesh_face_set *load = &mesh.set[MESH_LOAD], all = {0, malloc(96 * 6 * sizeof(int) * 24)};
  for (int side = 0; side < 6; side++) {
    assert_int_equal(box_set(&mesh, MESH_LOAD, side / 2, side % 2 ? size[side / 2] : 0), SHB_OK);
    memcpy(all.nodes + width * all.n, load->nodes, (size_t)(width * load->n) * sizeof(int));
    all.n += load->n;
  }
  free(load->nodes);
  *load = all;
  for (int i = 0; i < 3 * mesh.n_nodes; i += 3) {
    double *x = mesh.coordinates + i, y[3] = {x[0], x[1], x[2]};
    for (int d = 0; d < 3; d++)
      x[d] = y[d] + .01 * sin(31 * y[(d + 1) % 3] + d) * cos(17 * y[(d + 2) % 3]);
  }
  return mesh;
}

/* int n dA = 0, int x cross n dA = 0, int x . n dA = 3 V over a closed surface. */
static void pressure_on_a_closed_curved_surface(void **state) {
  (void)state;
  mesh_fe  mesh   = closed_curved_body();
  double  *force  = malloc(3 * (size_t)mesh.n_nodes * sizeof *force), sum[3], moment[3];
  double   volume = 0, virial = 0, scale = 0;
  fem_load load = {.kind = FEM_LOAD_PRESSURE, .pressure = 1e5};
  fem_rule rule;
  assert_int_equal(fem_load_pattern(&mesh, &load, NULL, force), SHB_OK);
  resultant(&mesh, force, sum, moment);
  for (int i = 0; i < 3 * mesh.n_nodes; i++) {
    scale += fabs(force[i]);
    virial += force[i] * mesh.coordinates[i];
  }
  for (int d = 0; d < 3; d++) {
    check_below(sum[d], 1e-13 * scale, "resultant");
    check_below(moment[d], 1e-13 * scale, "moment");
  }
  assert_int_equal(
      mesh.kind == MESH_HEX20 ? fem_hex_rule(3, &rule) : fem_tet_rule_conical(3, &rule), 0);
  const int nodes = mesh_topology_of(mesh.kind)->nodes;
  for (int e = 0; e < mesh.n_elements; e++)
    for (int p = 0; p < rule.n; p++) {
      double J[3][3] = {{0}};
      for (int i = 0; i < nodes; i++)
        for (int a = 0; a < 3; a++)
          for (int d = 0; d < 3; d++)
            J[a][d] +=
                rule.gradient[p][i][a] * mesh.coordinates[3 * mesh.connectivity[nodes * e + i] + d];
      volume += rule.weight[p] * (J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
                                  J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                                  J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]));
    }
  check_close(virial, -3e5 * volume, 1e-12, "virial of the pressure");
  free(force);
  mesh_fe_free(&mesh);
}

static void point_force_and_its_place(void **state) {
  (void)state;
  mesh_fe      mesh     = make_box(size, cells);
  double      *force    = malloc(3 * (size_t)mesh.n_nodes * sizeof *force), sum[3], moment[3];
  fem_load     load     = {.kind = FEM_LOAD_FORCE, .force = {5, -7, 11}};
  const double probe[3] = {.2, .001, .079}, at[3] = {.001, .131, .001};
  assert_int_equal(fem_load_pattern(&mesh, &load, NULL, force), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "excitation.force"));
  assert_int_equal(fem_load_pattern(&mesh, &load, probe, force), SHB_OK);
  resultant(&mesh, force, sum, moment);
  const double corner[3] = {size[0], 0, size[2]};
  check_close(moment[0], corner[1] * 11 - corner[2] * -7, 1e-12, "moment");
  check_close(moment[1], corner[2] * 5 - corner[0] * 11, 1e-12, "moment");
  load.has_at = true;
  memcpy(load.at, at, sizeof at);
  assert_int_equal(fem_load_pattern(&mesh, &load, probe, force), SHB_OK);
  resultant(&mesh, force, sum, moment);
  check_close(sum[1], -7, 1e-15, "force");
  check_close(moment[2], -size[1] * 5, 1e-12, "moment at (0, b, 0)");
  load.kind             = FEM_LOAD_PRESSURE;
  mesh.set[MESH_LOAD].n = 0;
  assert_int_equal(fem_load_pattern(&mesh, &load, probe, force), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "no group \"load\""));
  free(force);
  mesh_fe_free(&mesh);
}

/* Shares of the nodes of a flat parallelogram: -1/12 at the corners, 1/3 at the mid-sides. */
static void quadrangle_has_its_known_weights(void **state) {
  (void)state;
  static const double place[8][2] = {{0, 0},  {1, 0},  {1, 1},  {0, 1},
                                     {.5, 0}, {1, .5}, {.5, 1}, {0, .5}};
  fem_face_rule       rule;
  double              x[8][3], area[8], normal[8][3];
  for (int i = 0; i < 8; i++) {
    x[i][0] = .3 + .21 * place[i][0] + .04 * place[i][1];
    x[i][1] = .1 + .13 * place[i][1];
    x[i][2] = 0;
  }
  assert_int_equal(fem_face_rule_create(MESH_HEX20, &rule), 0);
  fem_face_integrate(&rule, (const double(*)[3])x, area, normal);
  for (int i = 0; i < 8; i++) {
    check_close(area[i], (i < 4 ? -1. / 12 : 1. / 3) * .21 * .13, 1e-13, "share of a node");
    check_close(normal[i][2], area[i], 1e-13, "normal of a node");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_pushes_into_a_flat_face),
      cmocka_unit_test(pressure_on_a_closed_curved_surface),
      cmocka_unit_test(point_force_and_its_place),
      cmocka_unit_test(quadrangle_has_its_known_weights),
  };
  if (PetscInitialize(NULL, NULL, NULL, NULL) != 0) return 1;
  int failures = run_with_both_elements(tests, NULL, NULL);
  PetscFinalize();
  return failures;
}
