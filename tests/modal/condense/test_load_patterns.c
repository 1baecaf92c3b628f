/* Loads from field files: equal to those of a case where both can describe them, else exact. */
#include "modal/condense/load_patterns.h"

#include <complex.h>
#include <math.h>

#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/stage/stage.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/files.h"
#include "tests/support/one_of_each.h"

enum { BLADES = 23 };

static const double size[3] = {0.04, 1, 0.12}, inner = 0.1;
static const int    cells[3] = {2, 2, 3};

static modal_settings default_settings(void) {
  const modal_settings own = {
      .axis = MESH_AXIS_X, .blades = BLADES, .modes = 6, .damping = {.ratio = 0.002}};
  return one_of_each(own, 1, false, (fem_load){0});
}

/* A field of complex values [m][n][width], width 0: [m][n]. */
static const char *write_field(const char *name, int n, const int *node, int m, const int *harmonic,
                               int width, const double complex *value) {
  const char *path = scratch(name);
  hid_t       file;
  assert_ok(h5_create(path, &file));
  assert_ok(h5_write_int(file, "node", H5_SHAPE((hsize_t)n), node, "-", "nodes"));
  assert_ok(h5_write_int(file, "harmonic", H5_SHAPE((hsize_t)m), harmonic, "-", "harmonics"));
  if (width)
    assert_ok(h5_write_complex(file, "force", H5_SHAPE((hsize_t)m, (hsize_t)n, (hsize_t)width),
                               value, "N", "forces"));
  else
    assert_ok(h5_write_complex(file, "pressure", H5_SHAPE((hsize_t)m, (hsize_t)n), value, "Pa",
                               "pressure"));
  assert_ok(h5_close(file));
  return path;
}

static void solve(const mesh_fe *mesh, const fem_load *load, modal_model *model) {
  modal_settings settings = default_settings();
  modal_result   result;
  settings.loads = load;
  assert_ok(modal_solve(PETSC_COMM_WORLD, mesh, &settings, NULL, &result));
  *model = result.model;
  memset(&result.model, 0, sizeof result.model);
  modal_result_free(&result);
}

static void check_same(int n, const double complex *a, const double complex *b, const char *what) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, cabs(b[i]));
  assert_true(most > 0);
  for (int i = 0; i < n; i++) check_below(cabs(a[i] - b[i]), 1e-9 * most, what);
}

static void check_equal(const modal_model *a, const modal_model *b) {
  const int k = b->n_load + 1, nc = 6 * b->n_pairs;
  assert_int_equal(a->n_load, b->n_load);
  check_same(k * b->n_modes, a->modal_force, b->modal_force, "modal force");
  check_same(k * nc, a->load_residual, b->load_residual, "residual response");
  check_same(k * nc, a->load_inertia, b->load_inertia, "its inertia");
}

/* Equal pressure at every node, with a factor and a phase for each harmonic. */
static void even_pressure_is_the_case_s(void **state) {
  (void)state;
  const int            harmonic[2] = {3, 1}; /* in any order */
  const double complex factor[2]   = {0.3 * cexp(I * 1.1), -0.7};
  mesh_fe              mesh        = make_sector(size, inner, BLADES, cells);
  int                 *node        = malloc((size_t)mesh.n_nodes * sizeof *node);
  double complex      *value       = malloc(2 * (size_t)mesh.n_nodes * sizeof *value);
  assert_true(node && value);
  for (int i = 0; i < mesh.n_nodes; i++) node[i] = (int)mesh.node_tag[mesh.n_nodes - 1 - i];
  for (int i = 0; i < 2 * mesh.n_nodes; i++) value[i] = 200 * factor[i / mesh.n_nodes];
  fem_load own   = {.kind = FEM_LOAD_PRESSURE, .pressure = 200, .n_harmonics = 3};
  fem_load field = {.kind = FEM_LOAD_FIELD};
  own.factor[3]  = factor[0];
  own.factor[1]  = factor[1];
  field.field    = write_field("even.h5", mesh.n_nodes, node, 2, harmonic, 0, value);
  modal_model a, b;
  solve(&mesh, &field, &a);
  solve(&mesh, &own, &b);
  check_equal(&a, &b);
  modal_model_free(&a);
  modal_model_free(&b);
  free(node), free(value);
  mesh_fe_free(&mesh);
}

static void force_at_a_node_is_the_case_s(void **state) {
  (void)state;
  const int      harmonic = 2;
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  fem_load       own      = {.kind        = FEM_LOAD_FORCE,
                             .force       = {3, -4, 5},
                             .has_at      = true,
                             .at          = {0.02, 0, 0.2},
                             .n_harmonics = 2,
                             .factor      = {0, 0, I - 0.5}};
  fem_load       field    = {.kind = FEM_LOAD_FIELD};
  int            node     = (int)mesh.node_tag[mesh_fe_nearest(&mesh, own.at)];
  double complex value[3];
  for (int d = 0; d < 3; d++) value[d] = own.force[d] * own.factor[2];
  field.field = write_field("point.h5", 1, &node, 1, &harmonic, 3, value);
  modal_model a, b;
  solve(&mesh, &field, &a);
  solve(&mesh, &own, &b);
  check_equal(&a, &b);
  modal_model_free(&a);
  modal_model_free(&b);
  mesh_fe_free(&mesh);
}

/* p = 2 + 30 x - 7 y on the flat face z = c of a box: force and moments in closed form. */
static void linear_pressure_is_exact(void **state) {
  (void)state;
  const double flat[3] = {0.3, 0.2, 0.1}, a = flat[0], b = flat[1];
  const int    few[3] = {3, 2, 1}, harmonic = 0;
  for (int kind = MESH_TET10; kind <= MESH_HEX20; kind++) {
    use_elements((mesh_kind)kind);
    mesh_fe         mesh  = make_box(flat, few);
    int            *node  = malloc((size_t)mesh.n_nodes * sizeof *node);
    double complex *value = malloc((size_t)mesh.n_nodes * sizeof *value);
    assert_true(node && value);
    for (int i = 0; i < mesh.n_nodes; i++) {
      node[i]  = (int)mesh.node_tag[i];
      value[i] = 2 + 30 * mesh.coordinates[3 * i] - 7 * mesh.coordinates[3 * i + 1];
    }
    fem_load   field = {.kind = FEM_LOAD_FIELD};
    modal_load load;
    field.field = write_field("linear.h5", mesh.n_nodes, node, 1, &harmonic, 0, value);
    assert_ok(modal_load_create(&mesh, 1, &field, NULL, &load));
    assert_int_equal(load.dofs.n, 1); /* the imaginary part is 0 */
    double sum = 0, moment[2] = {0, 0};
    for (int e = 0; e < load.dofs.n_entries; e++) {
      const double *x = mesh.coordinates + 3 * load.dofs.node[e], *f = load.dofs.weight + 3 * e;
      check_below(fabs(f[0]) + fabs(f[1]), 1e-15, "along the face");
      sum += f[2];
      for (int d = 0; d < 2; d++) moment[d] += f[2] * x[d];
    }
    double mean = 2 + 15 * a - 3.5 * b;
    check_close(sum, -a * b * mean, 1e-12, "force");
    check_close(moment[0], -a * b * (a + 10 * a * a - 1.75 * a * b), 1e-12, "moment");
    check_close(moment[1], -a * b * (b + 7.5 * a * b - 7 * b * b / 3), 1e-12, "moment");
    modal_load_free(&load);
    free(node), free(value);
    mesh_fe_free(&mesh);
  }
  use_elements(MESH_TET10);
}

static void refused(const mesh_fe *mesh, const char *path, const char *words) {
  fem_load   field = {.kind = FEM_LOAD_FIELD, .field = path};
  modal_load load;
  assert_int_equal(modal_load_create(mesh, 1, &field, NULL, &load), SHB_ERR_INPUT);
  if (!strstr(shb_message(), words)) fail_msg("'%s', wanted '%s'", shb_message(), words);
  assert_null(strchr(shb_message(), '\n'));
}

static void faults_are_one_line(void **state) {
  (void)state;
  const int            node[2] = {1, 2}, twice[2] = {2, 2}, none[2] = {1, 999999};
  const int            harmonic[2] = {1, 2}, again[2] = {1, 1}, far[2] = {1, 65};
  const double complex value[12] = {1, 2, 3, 4, 5, 6}, zero[12] = {0};
  mesh_fe              mesh = make_sector(size, inner, BLADES, cells);
  fem_load             lost = {.kind = FEM_LOAD_FIELD};
  modal_load           load;
  refused(&mesh, write_field("a.h5", 2, twice, 2, harmonic, 3, value), "node 2 is given twice");
  refused(&mesh, write_field("a.h5", 2, none, 2, harmonic, 3, value), "has no node 999999");
  refused(&mesh, write_field("a.h5", 2, node, 2, again, 3, value), "value 1 (from 0) is 1; exp");
  refused(&mesh, write_field("a.h5", 2, node, 2, far, 3, value), "is 65; expected whole numbers");
  refused(&mesh, write_field("a.h5", 2, node, 2, harmonic, 3, zero), "all loads are 0");
  refused(&mesh, write_field("a.h5", 2, node, 2, harmonic, 2, value), "/force");
  refused(&mesh, write_field("a.h5", 2, node, 2, harmonic, 0, value), "has no pressure");
  mesh.set[MESH_LOAD].n = 0;
  refused(&mesh, write_field("a.h5", 2, node, 2, harmonic, 0, value), "no group \"load\"");
  lost.field = scratch("none.h5");
  assert_int_equal(modal_load_create(&mesh, 1, &lost, NULL, &load), SHB_ERR_IO);
  mesh_fe_free(&mesh);
}

/* Loads with moduli and phases for each harmonic: together they give the sum of their separate
 * effects. */
static void loads_add_up(void **state) {
  (void)state;
  const double complex turn    = cexp(0.9 * I);
  mesh_fe              mesh    = make_sector(size, inner, BLADES, cells);
  fem_load             load[3] = {
                  {.kind = FEM_LOAD_PRESSURE, .pressure = 210, .n_harmonics = 1, .factor = {0, 1}},
                  {.kind        = FEM_LOAD_TRACTION,
                   .traction    = {3, -70, 20},
                   .n_harmonics = 3,
                   .factor      = {0.2, -0.4 * I, 0, cexp(2 * I)}},
                  {.kind        = FEM_LOAD_FORCE,
                   .force       = {0.1, 0, 0.3},
                   .has_at      = true,
                   .at          = {0, 0, 0.22},
                   .n_harmonics = 2,
                   .factor      = {0, 0.3, turn}}};
  modal_model    one[3], all;
  modal_settings settings = default_settings();
  modal_result   result;
  for (int i = 0; i < 3; i++) solve(&mesh, &load[i], &one[i]);
  settings.n_loads = 3;
  settings.loads   = load;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &result));
  all = result.model;
  assert_int_equal(all.n_load, 3);
  const int nc = 6 * all.n_pairs, width[3] = {all.n_modes, nc, nc};
  for (int part = 0; part < 3; part++) {
    const int       n   = width[part];
    double complex *sum = calloc((size_t)(4 * n), sizeof *sum);
    for (int i = 0; i < 3; i++) {
      const double complex *own[] = {one[i].modal_force, one[i].load_residual, one[i].load_inertia};
      for (int k = 0; k < (one[i].n_load + 1) * n; k++) sum[k] += own[part][k];
    }
    const double complex *both[] = {all.modal_force, all.load_residual, all.load_inertia};
    double                most   = 0;
    for (int k = 0; k < 4 * n; k++) most = fmax(most, cabs(sum[k]));
    for (int k = 0; k < 4 * n; k++) check_below(cabs(both[part][k] - sum[k]), 1e-11 * most, "sum");
    free(sum);
  }
  modal_result_free(&result);

  /* a phase shift of both shifts the sum; opposite loads cancel to rounding */
  load[1].n_harmonics = 1, load[1].factor[0] = 0, load[1].factor[1] = I;
  load[0].factor[1] = I;
  settings.n_loads  = 2;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &result));
  all               = result.model;
  load[0].factor[1] = 1, load[1].factor[1] = 1;
  modal_result still;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &still));
  double most = 0;
  for (int i = 0; i < all.n_modes; i++)
    most = fmax(most, cabs(still.model.modal_force[all.n_modes + i]));
  for (int i = 0; i < all.n_modes; i++)
    check_below(
        cabs(all.modal_force[all.n_modes + i] - I * still.model.modal_force[all.n_modes + i]),
        1e-13 * most, "a quarter turn");
  modal_result_free(&still);
  modal_result_free(&result);
  load[1]           = load[0];
  load[1].factor[1] = -1;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &result));
  for (int i = 0; i < all.n_modes; i++)
    check_below(cabs(result.model.modal_force[result.model.n_modes + i]), 1e-13 * most,
                "what is left");
  modal_result_free(&result);
  for (int i = 0; i < 3; i++) modal_model_free(&one[i]);
  mesh_fe_free(&mesh);
}

/* Loads on groups of their own. */
static void loads_have_groups(void **state) {
  (void)state;
  mesh_fe    mesh    = make_sector(size, inner, BLADES, cells);
  fem_load   load[2] = {{.kind        = FEM_LOAD_PRESSURE,
                         .pressure    = 210,
                         .n_harmonics = 1,
                         .factor      = {0, 1},
                         .group       = "side"},
                        {.kind        = FEM_LOAD_PRESSURE,
                         .pressure    = 210,
                         .n_harmonics = 1,
                         .factor      = {0, 1},
                         .group       = "load"}};
  modal_load made[2];
  strcpy(mesh.more[0], "side");
  mesh.n_more = 1;
  assert_int_equal(modal_load_create(&mesh, 1, load, NULL, &made[0]), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "no group \"side\""));
  mesh.set[MESH_N_SETS] = mesh.set[MESH_CONTACT_RIGHT];
  for (int i = 0; i < 2; i++) assert_ok(modal_load_create(&mesh, 1, &load[i], NULL, &made[i]));
  double sum[2][3] = {{0}};
  for (int i = 0; i < 2; i++) {
    assert_int_equal(made[i].dofs.n, 1);
    for (int e = 0; e < 3 * made[i].dofs.n_entries; e++) sum[i][e % 3] += made[i].dofs.weight[e];
    modal_load_free(&made[i]);
  }
  /* resultant of a pressure: radial on the outer face, tangential on the flat side */
  double half = SHB_PI / BLADES, outer = inner + size[2];
  check_close(sum[1][2], -210 * size[0] * 2 * outer * sin(half), 1e-6,
              "resultant on the outer face");
  check_close(hypot(sum[0][1], sum[0][2]), 210 * size[0] * size[2], 1e-9, "resultant on the side");
  mesh.set[MESH_N_SETS] = (mesh_face_set){0, NULL};
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loads_add_up),
      cmocka_unit_test(loads_have_groups),

      cmocka_unit_test(even_pressure_is_the_case_s),
      cmocka_unit_test(force_at_a_node_is_the_case_s),
      cmocka_unit_test(linear_pressure_is_exact),
      cmocka_unit_test(faults_are_one_line),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests_name("modal.field", tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failures;
}
