/* The VTKHDF group: header, cells in VTK's node order, modes as views of /modes/shape. */
#include <hdf5.h>

#include "modal/common/session.h"
#include "modal/stage/model_export.h"
#include "tests/support/check.h"
#include "tests/support/fem.h"

enum { MODES = 2 };

static char path[64];

/* A modal file with mesh and shapes only; shape of mode i at node k: i + 1, k, i k. */
static void write(const mesh_fe *mesh) {
  const double frequency[MODES] = {10, 20};
  double      *shape            = malloc(3 * MODES * (size_t)mesh->n_nodes * sizeof *shape);
  hid_t        file;
  assert_non_null(shape);
  for (int i = 0; i < MODES; i++)
    for (int k = 0; k < mesh->n_nodes; k++) {
      double *u = shape + 3 * (i * mesh->n_nodes + k);
      u[0] = i + 1, u[1] = k, u[2] = i * k;
    }
  strcpy(path, "/tmp/shroudhb-vtk-XXXXXX");
  assert_true(mkstemp(path) >= 0);
  assert_ok(h5_create(path, &file));
  assert_ok(
      h5_write_double(file, "modes/frequency", H5_SHAPE(MODES), frequency, "Hz", "frequency"));
  assert_ok(modal_export_mesh(file, mesh));
  assert_ok(modal_export_shapes(file, MODES, mesh->n_nodes, shape));
  assert_ok(modal_export_vtk(file, mesh, MODES, frequency));
  assert_ok(h5_close(file));
  free(shape);
}

static void check_header(hid_t file, const mesh_fe *mesh) {
  char     *type = NULL;
  h5_shape  one  = H5_SHAPE(1);
  int      *count;
  long long version[2];
  hid_t     attribute = H5Aopen_by_name(file, "VTKHDF", "Version", H5P_DEFAULT, H5P_DEFAULT);
  assert_true(attribute >= 0 && H5Aread(attribute, H5T_NATIVE_LLONG, version) >= 0);
  H5Aclose(attribute);
  assert_true(version[0] == 1 && version[1] == 0);
  assert_ok(h5_read_attribute_text(file, "VTKHDF", "Type", &type));
  assert_string_equal(type, "UnstructuredGrid");
  free(type);
  assert_ok(h5_read_int(file, "VTKHDF/NumberOfPoints", &one, &count));
  assert_int_equal(count[0], mesh->n_nodes);
  free(count);
  assert_ok(h5_read_int(file, "VTKHDF/NumberOfCells", &one, &count));
  assert_int_equal(count[0], mesh->n_elements);
  free(count);
}

/* In VTK's order a mid-side node lies in the middle of its edge. */
static void check_cells(hid_t file, const mesh_fe *mesh) {
  static const int tet[6][2]  = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  static const int hex[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                 {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const bool       is_tet     = mesh->kind == MESH_TET10;
  const int        nodes = is_tet ? 10 : 20, corners = is_tet ? 4 : 8;
  int             *connectivity, *offset, *type;
  h5_shape         all = {1, {0}}, starts = {1, {0}}, types = {1, {0}};
  assert_ok(h5_read_int(file, "VTKHDF/Connectivity", &all, &connectivity));
  assert_ok(h5_read_int(file, "VTKHDF/Offsets", &starts, &offset));
  assert_ok(h5_read_int(file, "VTKHDF/Types", &types, &type));
  assert_int_equal(all.dim[0], nodes * mesh->n_elements);
  assert_int_equal(starts.dim[0], mesh->n_elements + 1);
  assert_int_equal(types.dim[0], mesh->n_elements);
  for (int e = 0; e < mesh->n_elements; e++) {
    const int *node = connectivity + offset[e];
    assert_int_equal(offset[e], nodes * e);
    assert_int_equal(type[e], is_tet ? 24 : 25);
    for (int m = corners; m < nodes; m++) {
      const int *edge = is_tet ? tet[m - 4] : hex[m - 8];
      for (int d = 0; d < 3; d++)
        assert_near(
            mesh->coordinates[3 * node[m] + d],
            (mesh->coordinates[3 * node[edge[0]] + d] + mesh->coordinates[3 * node[edge[1]] + d]) /
                2,
            1e-12);
    }
  }
  free(connectivity);
  free(offset);
  free(type);
}

static void check_views(hid_t file, const mesh_fe *mesh) {
  static const char *const names[MODES] = {"mode_001 10 Hz", "mode_002 20 Hz"};
  for (int i = 0; i < MODES; i++) {
    char     name[64];
    double  *u;
    h5_shape shape = H5_SHAPE((hsize_t)mesh->n_nodes, 3);
    snprintf(name, sizeof name, "VTKHDF/PointData/%s", names[i]);
    hid_t set    = H5Dopen2(file, name, H5P_DEFAULT);
    hid_t memory = H5Screate_simple(2, shape.dim, NULL);
    assert_true(set >= 0);
    u = malloc(3 * (size_t)mesh->n_nodes * sizeof *u);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, memory, H5S_ALL, H5P_DEFAULT, u) >= 0);
    for (int k = 0; k < mesh->n_nodes; k++)
      assert_true(u[3 * k] == i + 1 && u[3 * k + 1] == k && u[3 * k + 2] == i * k);
    H5Sclose(memory);
    H5Dclose(set);
    free(u);
  }
}

static void group_is_read_back(void **state) {
  (void)state;
  const double    size[3]  = {0.3, 0.2, 0.1};
  const int       cells[3] = {2, 1, 1};
  const mesh_kind kind[2]  = {MESH_TET10, MESH_HEX20};
  for (int k = 0; k < 2; k++) {
    hid_t file;
    use_elements(kind[k]);
    mesh_fe mesh = make_box(size, cells);
    write(&mesh);
    assert_ok(h5_open(path, &file));
    check_header(file, &mesh);
    check_cells(file, &mesh);
    check_views(file, &mesh);
    assert_true(h5_exists(file, "VTKHDF/Points"));
    assert_false(h5_exists(file, "VTKHDF/CellData")); /* no static results */
    assert_ok(h5_close(file));
    remove(path);
    mesh_fe_free(&mesh);
  }
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(group_is_read_back)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
