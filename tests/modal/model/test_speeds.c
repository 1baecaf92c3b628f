/* Modes at several speeds: tracked through a crossing, written and read. */
#include <math.h>

#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/stage/speed_range.h"
#include "modal/stage/stage.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/files.h"
#include "tests/support/one_of_each.h"

enum { MODES = 5, SPEEDS = 4 };

/* A nearly square radial beam along z. Its flap motion (along x, the engine axis) is slightly
 * softer than its motion in the plane of rotation. Flap stiffens by Omega^2 more, so the two
 * frequencies cross. */
static const double size[3]  = {0.0200, 0.0202, 0.3};
static const int    cells[3] = {1, 1, 6};

static const double speeds[SPEEDS] = {700, 0, 100, 400};

static mesh_fe make_beam(void) {
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_box(size, cells);
  use_elements(MESH_TET10);
  assert_int_equal(box_set(&mesh, MESH_ROOT, 2, 0), SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_CONTACT_RIGHT, 1, 0), SHB_OK);
  assert_int_equal(box_set(&mesh, MESH_LOAD, 2, size[2]), SHB_OK);
  for (int i = 0; i < mesh.n_nodes; i++) {
    mesh.coordinates[3 * i + 1] -= size[1] / 2;
    mesh.coordinates[3 * i + 2] += 0.2;
  }
  return mesh;
}

static const modal_probe probe = {"tip", {0.01, 0, 0.5}};

static modal_settings make_settings(void) {
  const modal_settings own = {
      .axis             = MESH_AXIS_X,
      .blades           = 30,
      .speed            = 400,
      .n_speeds         = SPEEDS,
      .speeds           = speeds,
      .modes            = MODES,
      .damping          = {.ratio = 0.002},
      .full_integration = true,
      .n_probes         = 1,
      .probe            = &probe,
  };
  const fem_load load = {
      .kind = FEM_LOAD_TRACTION, .traction = {100, 70, 5}, .n_harmonics = 1, .factor = {0, 1}};
  return one_of_each(own, 1, true, load);
}

static double eigenvalue(const modal_speeds *s, int i, int track) {
  double w = SHB_TWO_PI * modal_speeds_frequency(s, i, track);
  return w * w;
}

static void check_tracks(const modal_speeds *s) {
  const double rest = eigenvalue(s, 0, 0) - eigenvalue(s, 0, 1);
  assert_true(rest < 0); /* flap is the lower one */
  for (int i = 0; i < SPEEDS; i++) {
    double square = s->speed[i] * s->speed[i];
    check_below(eigenvalue(s, i, 0) - eigenvalue(s, i, 1) - rest - square,
                1e-2 * square + 1e-9 * eigenvalue(s, i, 0), "flap less in-plane eigenvalue");
    for (int t = 0; t < 2; t++) assert_true(s->mac[i * MODES + t] > 0.99);
    assert_int_equal(s->mode[i * MODES], eigenvalue(s, i, 0) > eigenvalue(s, i, 1));
  }
  assert_int_equal(s->mode[3 * MODES], 1); /* they have crossed */
}

/* Overlap with the modes of the first speed: the same space, and the tracks where shapes hardly
 * change. */
static void check_overlaps(const modal_speeds *s) {
  for (int i = 0; i < SPEEDS; i++) {
    const double *C = s->overlap + i * MODES * MODES;
    for (int a = 0; i == 0 && a < MODES; a++)
      for (int b = 0; b < MODES; b++) assert_true(C[a * MODES + b] == (a == b));
    for (int a = 0; a < MODES; a++) {
      double inside = 0;
      for (int b = 0; b < MODES; b++) inside += C[a * MODES + b] * C[a * MODES + b];
      assert_true(inside < 1 + 1e-9);
      if (a < 2) assert_true(inside > 0.99 && C[a * MODES + s->mode[i * MODES + a]] > 0.99);
    }
  }
}

/* Every model is that of its speed alone, except for the signs of modes. */
static void check_models(const mesh_fe *mesh, const modal_speeds *s) {
  modal_settings settings = make_settings();
  for (int i = 0; i < SPEEDS; i++) {
    const modal_model *a = &s->model[i];
    modal_result       one;
    settings.speed = s->speed[i];
    assert_ok(modal_solve(PETSC_COMM_SELF, mesh, &settings, NULL, &one));
    for (int m = 0; m < MODES; m++) {
      check_close(a->frequency[m], one.model.frequency[m], 1e-10, "frequency");
      double sign =
          a->probe[m] * one.model.probe[m] + a->probe[MODES + m] * one.model.probe[MODES + m] < 0
              ? -1
              : 1;
      for (int d = 0; d < 3; d++) {
        check_below(a->probe[d * MODES + m] - sign * one.model.probe[d * MODES + m], 1e-5, "probe");
        check_below(a->right[d * MODES + m] - sign * one.model.right[d * MODES + m], 1e-5, "right");
      }
      check_below(cabs(a->modal_force[MODES + m] - sign * one.model.modal_force[MODES + m]), 1e-4,
                  "modal force");
    }
    modal_result_free(&one);
    for (int t = 0; i > 0 && t < MODES; t++) {
      const modal_model *b = &s->model[i - 1];
      int                m = s->mode[i * MODES + t], n = s->mode[(i - 1) * MODES + t];
      double             product = 0;
      for (int d = 0; d < 3; d++) product += a->probe[d * MODES + m] * b->probe[d * MODES + n];
      assert_true(product > -1e-6);
    }
  }
}

static void crossing_modes_are_tracked(void **state) {
  (void)state;
  modal_settings settings = make_settings();
  mesh_fe        mesh     = make_beam();
  modal_speeds   s;
  modal_result   result;
  assert_ok(modal_speed_range_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &s, NULL, &result));
  for (int i = 1; i < SPEEDS; i++) assert_true(s.speed[i] > s.speed[i - 1]);
  check_tracks(&s);
  check_overlaps(&s);
  check_models(&mesh, &s);
  assert_true(result.deflection.speed == 400);
  assert_true(s.model[2].frequency == result.model.frequency);
  modal_speed_range_free(&s, &result);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* modal.modes: auto gives one number of modes, enough for the lowest and the highest speed. */
static void auto_modes_suit_every_speed(void **state) {
  (void)state;
  static const double band[2]  = {900, 2500};
  modal_settings      settings = make_settings();
  mesh_fe             mesh     = make_beam();
  int                 before   = 0;
  settings.modes               = 0;
  settings.tolerance           = 1e-6;
  for (int k = 0; k < 2; k++) {
    modal_speeds s;
    modal_result result;
    int          single[2];
    settings.band = band[k];
    assert_ok(modal_speed_range_solve(PETSC_COMM_SELF, &mesh, &settings, NULL, &s, NULL, &result));
    for (int i = 0; i < 2; i++) {
      modal_settings one = settings;
      modal_result   at;
      one.n_speeds = 1;
      one.speed    = i ? 700 : 0;
      assert_ok(modal_solve(PETSC_COMM_SELF, &mesh, &one, NULL, &at));
      single[i] = at.model.n_modes;
      modal_result_free(&at);
    }
    print_message("to %.0f Hz: %d modes at rest, %d at 700 rad/s: %d\n", band[k], single[0],
                  single[1], s.n_modes);
    assert_int_equal(s.n_modes, single[0] > single[1] ? single[0] : single[1]);
    for (int i = 0; i < SPEEDS; i++) assert_int_equal(s.model[i].n_modes, s.n_modes);
    assert_true(s.n_modes > before);
    before = s.n_modes;
    modal_speed_range_free(&s, &result);
    modal_result_free(&result);
  }
  mesh_fe_free(&mesh);
}

static const shb_provenance provenance = {"case.yaml", "name: case\n", "modal.modes = 5\n",
                                          "shroudhb-modal"};

static void write_file(const char *name, int n_speeds, char path[512]) {
  modal_settings settings = make_settings();
  mesh_fe        mesh     = make_beam();
  settings.n_speeds       = n_speeds;
  snprintf(path, 512, "%s", scratch(name));
  assert_int_equal(box_write(&mesh, scratch("beam.msh")), SHB_OK);
  mesh_fe_free(&mesh);
  assert_ok(modal_stage(PETSC_COMM_SELF, scratch("beam.msh"), path, &settings, &provenance, NULL));
}

static void file_keeps_every_speed(void **state) {
  (void)state;
  char         path[512];
  modal_speeds s;
  modal_model  model;
  hid_t        file;
  write_file("speeds.modal.h5", SPEEDS, path);
  assert_ok(modal_speeds_read(path, &s));
  assert_int_equal(s.n, SPEEDS);
  check_tracks(&s);
  check_overlaps(&s);
  assert_ok(modal_model_read(path, &model)); /* that of settings.speed */
  for (int m = 0; m < MODES; m++) assert_true(model.frequency[m] == s.model[2].frequency[m]);
  for (int m = 0; m < 3 * MODES; m++) assert_true(model.right[m] == s.model[2].right[m]);
  modal_model_free(&model);
  modal_speeds_free(&s);
  assert_true(assert_described(path) > 80);
  assert_ok(h5_open(path, &file)); /* a program of version 1 only */
  assert_refused(h5_check_format(file, "shroudhb modal model", 1), SHB_ERR_INPUT,
                 "format_version is 2; this program reads versions 1 to 1");
  assert_ok(h5_close(file));
}

static void one_speed_changes_nothing(void **state) {
  (void)state;
  char         path[512];
  modal_speeds s;
  hid_t        file;
  write_file("one.modal.h5", 1, path);
  assert_ok(modal_speeds_read(path, &s));
  assert_int_equal(s.n, 0);
  assert_ok(h5_open(path, &file));
  assert_ok(h5_check_format(file, "shroudhb modal model", 1));
  assert_false(h5_exists(file, "/speeds") || h5_exists(file, "/speed_0"));
  assert_ok(h5_close(file));
}

/* A file with altered tracks is refused. */
static void damage_is_told(void **state) {
  (void)state;
  const char  *path                  = scratch("speeds.modal.h5");
  const int    twice[SPEEDS * MODES] = {0, 1, 2, 3, 4, 0, 1, 2, 2, 4};
  modal_speeds s;
  hid_t        file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), set;
  assert_true(file >= 0);
  assert_true(H5Ldelete(file, "/speed_3", H5P_DEFAULT) >= 0);
  H5Fclose(file);
  assert_refused(modal_speeds_read(path, &s), SHB_ERR_INPUT, "/speed_3 is missing");
  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  set  = H5Dopen2(file, "/speeds/mode", H5P_DEFAULT);
  assert_true(H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, twice) >= 0);
  H5Dclose(set);
  H5Fclose(file);
  assert_refused(modal_speeds_read(path, &s), SHB_ERR_INPUT,
                 "/speeds/mode: row 1 does not hold every mode from 0 to 4 once");
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crossing_modes_are_tracked), cmocka_unit_test(auto_modes_suit_every_speed),
      cmocka_unit_test(file_keeps_every_speed), cmocka_unit_test(one_speed_changes_nothing),
      cmocka_unit_test(damage_is_told)};
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failed;
}
