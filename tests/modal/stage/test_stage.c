/* The whole stage: a mesh file in, a complete modal file out, nothing written on failure. */
#include <math.h>

#include "fem/body/stress.h"
#include "fem/element/surface.h"
#include "mesh/base/constants.h"
#include "mesh/io/inp_read.h"
#include "mesh/io/inp_write.h"
#include "modal/common/session.h"
#include "modal/model/receptance.h"
#include "modal/stage/model_export.h"
#include "modal/stage/stage.h"
#include "tests/support/box.h"
#include "tests/support/fem.h"
#include "tests/support/files.h"
#include "tests/support/one_of_each.h"

enum { BLADES = 23 };

static const double      size[3] = {0.04, 1, 0.12}, inner = 0.1;
static const int         cells[3] = {2, 2, 4};
static const modal_probe probe[2] = {{"tip", {0.04, 0.0, 0.22}}, {"middle", {0, 0.01, 0.16}}};

static modal_settings default_settings(void) {
  const modal_settings own = {
      .axis     = MESH_AXIS_X,
      .blades   = BLADES,
      .modes    = 8,
      .damping  = {.ratio = 0.002},
      .n_probes = 2,
      .probe    = probe,
  };
  const fem_load load = {
      .kind = FEM_LOAD_PRESSURE, .pressure = 200, .n_harmonics = 1, .factor = {0, 1}};
  return one_of_each(own, 2, false, load);
}

static const shb_provenance provenance = {"case.yaml", "name: case\n", "modal.modes = 8\n",
                                          "shroudhb-modal"};

/* Write the sector as a .msh file. With swap the two sides are exchanged: the stage must swap them
 * back. */
static void write_mesh(const char *path, bool swap) {
  mesh_fe mesh = make_sector(size, inner, BLADES, cells);
  if (swap) {
    mesh_face_set right          = mesh.set[MESH_CONTACT_RIGHT];
    mesh.set[MESH_CONTACT_RIGHT] = mesh.set[MESH_CONTACT_LEFT];
    mesh.set[MESH_CONTACT_LEFT]  = right;
  }
  assert_int_equal(box_write(&mesh, path), SHB_OK);
  mesh_fe_free(&mesh);
}

static void check_is_in_the_file(const char *path) {
  hid_t  file;
  char  *by;
  double below, chance;
  int    count;
  assert_ok(h5_open(path, &file));
  assert_ok(h5_read_attribute_text(file, "/modes", "checked", &by));
  assert_ok(h5_read_attribute_int(file, "/modes", "checked_count", 0, &count));
  assert_ok(h5_read_attribute_double(file, "/modes", "checked_below", 0, &below));
  assert_ok(h5_read_attribute_double(file, "/modes", "missed_chance", 2, &chance));
  assert_ok(h5_close(file));
  assert_string_equal(by, "restart");
  assert_int_equal(count, 7);
  assert_true(below > 0 && chance > 0 && chance <= 1e-9);
  free(by);
}

/* The stress of the modes in the file is that of the shapes in the file. */
static void check_stress(const char *path) {
  modal_settings settings = default_settings();
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  const size_t   n = (size_t)mesh.n_nodes, all = 8 * n;
  h5_shape       of_shape = H5_SHAPE(8, n, 3), of_stress = H5_SHAPE(8, n, 6);
  double        *shape, *stress, most = 0, error = 0;
  float         *wanted = malloc(6 * all * sizeof *wanted);
  modal_body    *body;
  hid_t          file;
  assert_ok(h5_open(path, &file));
  assert_ok(h5_read_double(file, "/modes/shape", &of_shape, &shape));
  assert_ok(h5_read_double(file, "/modes/stress", &of_stress, &stress));
  assert_ok(h5_close(file));
  assert_ok(modal_body_create(&mesh, &settings, &body));
  fem_nodal_stress_change(&body->body, NULL, 8, shape, wanted);
  for (size_t i = 0; i < 6 * all; i++) {
    error = fmax(error, fabs(stress[i] - wanted[i]));
    most  = fmax(most, fabs(stress[i]));
  }
  check_below(error, 1e-6 * most, "stress in the file");
  assert_true(most > 0);
  free(body), free(shape), free(stress), free(wanted);
  mesh_fe_free(&mesh);
}

static void file_is_complete(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  modal_model    model;
  char           mesh[512], out[512];
  snprintf(mesh, sizeof mesh, "%s", scratch("sector.msh"));
  snprintf(out, sizeof out, "%s", scratch("sector.modal.h5"));
  write_mesh(mesh, false);
  assert_ok(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, NULL));
  assert_int_equal(files_in_scratch(), 2); /* no temporary left */
  assert_ok(modal_model_read(out, &model));
  assert_int_equal(model.n_modes, 8);
  assert_int_equal(model.n_pairs, 2);
  assert_true(model.has_left);
  assert_int_equal(model.n_probes, 2);
  assert_int_equal(model.n_load, 1);
  assert_string_equal(model.probe_name[1], "middle");
  assert_true(model.residual_flexibility && model.residual_inertia && model.load_residual);
  assert_true(model.residual_fourth && model.load_inertia && model.probe_contact_inertia &&
              model.probe_load_inertia);
  assert_true(model.probe_contact_residual && model.probe_load_residual && model.normal);
  for (int i = 0; i < 8; i++) check_below(model.eigen_residual[i], 1e-9, "mode residual");
  modal_model_free(&model);
  assert_true(assert_described(out) >= 30);
  check_is_in_the_file(out);
  check_stress(out);
}

/* Every phase occurs once and in order. Peak memory never falls. With two speeds the times add
 * up. */
static void phases_are_in_the_file(void **state) {
  (void)state;
  static const char *const wanted[] = {
      "mesh",          "assembly",        "equilibrium",    "analysis",   "factor",
      "modes",         "check",           "mode residuals", "refinement", "residuals",
      "participation", "residual shapes", "stress",         "write"};
  static const double speeds[] = {200, 300};
  enum { PHASES = sizeof wanted / sizeof *wanted };
  modal_settings settings = default_settings();
  h5_shape       shape    = H5_SHAPE(PHASES);
  char           mesh[512], out[512], **name;
  double        *seconds, *cpu, *memory, *greatest, sum = 0;
  int            n, ranks;
  hid_t          file;
  snprintf(mesh, sizeof mesh, "%s", scratch("sector.msh"));
  snprintf(out, sizeof out, "%s", scratch("phases.modal.h5"));
  settings.speed        = 300;
  settings.n_speeds     = 2;
  settings.speeds       = speeds;
  shb_progress progress = shb_progress_start("modal", true, false);
  assert_ok(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, &progress));
  const double whole = shb_seconds() - progress.started;
  assert_ok(h5_open(out, &file));
  assert_ok(h5_read_strings(file, "/phases/name", &n, &name));
  assert_ok(h5_read_double(file, "/phases/seconds", &shape, &seconds));
  assert_ok(h5_read_double(file, "/phases/cpu", &shape, &cpu));
  assert_ok(h5_read_double(file, "/phases/memory", &shape, &memory));
  assert_ok(h5_read_double(file, "/phases/greatest_memory", &shape, &greatest));
  assert_ok(h5_read_attribute_int(file, "/phases", "ranks", 0, &ranks));
  assert_ok(h5_close(file));
  assert_int_equal(ranks, 1);
  assert_int_equal(n, PHASES);
  for (int i = 0; i < n; i++) {
    assert_string_equal(name[i], wanted[i]);
    assert_true(seconds[i] > 0 && cpu[i] > 0);
    assert_true(memory[i] > 1e6 && memory[i] == greatest[i]);
    assert_true(i == 0 || i == n - 1 || memory[i] >= memory[0]);
    sum += seconds[i];
    free(name[i]);
  }
  assert_true(sum <= whole && sum > 0.5 * whole);
  free(name), free(seconds), free(cpu), free(memory), free(greatest);
  remove(out);
}

/* Rayleigh damping in the file, mode by mode. */
static void damping_follows_its_law(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  modal_model    model;
  char           mesh[512], out[512];
  snprintf(mesh, sizeof mesh, "%s", scratch("sector.msh"));
  snprintf(out, sizeof out, "%s", scratch("damped.modal.h5"));
  settings.damping = (modal_damping){.kind = MODAL_DAMPING_RAYLEIGH, .alpha = 20, .beta = 1e-7};
  assert_ok(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, NULL));
  assert_ok(modal_model_read(out, &model));
  for (int i = 0; i < model.n_modes; i++) {
    double omega = SHB_TWO_PI * model.frequency[i];
    check_close(2 * model.damping_ratio[i] * omega, 20 + 1e-7 * omega * omega, 1e-12, "damping");
  }
  modal_model_free(&model);
  remove(out);
  settings.damping.beta = 1;
  assert_int_equal(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, NULL),
                   SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "modal.damping: mode 1 at "));
  assert_int_equal(access(out, F_OK), -1);
}

/* The same body from an .inp file gives the same modes and receptance. */
static void abaqus_mesh_gives_the_same(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  modal_model    first, second;
  char           mesh[512], out[512];
  mesh_fe        sector = make_sector(size, inner, BLADES, cells);
  snprintf(mesh, sizeof mesh, "%s", scratch("sector.inp"));
  snprintf(out, sizeof out, "%s", scratch("inp.modal.h5"));
  assert_int_equal(mesh_inp_write(&sector, mesh), SHB_OK);
  mesh_fe_free(&sector);
  assert_ok(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, NULL));
  assert_ok(modal_model_read(out, &second));
  assert_ok(modal_model_read(scratch("sector.modal.h5"), &first));
  for (int i = 0; i < 8; i++)
    check_close(second.frequency[i], first.frequency[i], 1e-12, "frequency");
  for (int i = 0; i < 144; i += 13)
    check_close(second.residual_flexibility[i], first.residual_flexibility[i], 1e-9, "residual");
  modal_model_free(&first);
  modal_model_free(&second);
  remove(mesh);
  remove(out);
}

/* A dataset [n][3] as other programs read it, views of other datasets too; to be freed. */
static double *read_view(hid_t file, const char *path, h5_shape *shape) {
  const hid_t set = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(set);
  assert_true(set >= 0 && H5Sget_simple_extent_dims(space, shape->dim, NULL) == 2);
  double *values = malloc(sizeof *values * (size_t)(shape->dim[0] * shape->dim[1]));
  assert_non_null(values);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

/* /VTKHDF as ParaView reads it; "mode_00i f Hz" is /modes/shape[i]. */
static void vtk_group_shows_the_modes(void **state) {
  (void)state;
  hid_t    file;
  h5_shape all = {3, {8, 0, 3}}, one = {2, {0, 3}}, nodes = {2, {0, 3}}, points = {2, {0, 3}};
  h5_shape cells_shape = {2, {0, 10}}, flat = {1, {0}}, types = {1, {0}};
  h5_shape modes = {1, {0}};
  double  *shape, *mode, *coordinates, *linked, *frequency;
  int     *gmsh, *vtk, *type;
  char    *text;
  assert_ok(h5_open(scratch("sector.modal.h5"), &file));
  assert_ok(h5_read_double(file, "/modes/shape", &all, &shape));
  char third[32 + MODAL_VTK_NAME] = "/VTKHDF/PointData/";
  assert_ok(h5_read_double(file, "/modes/frequency", &modes, &frequency));
  modal_vtk_name(2, frequency[2], third + strlen(third));
  mode = read_view(file, third, &one);
  free(frequency);
  assert_ok(h5_read_double(file, "/mesh/nodes", &nodes, &coordinates));
  assert_ok(h5_read_double(file, "/VTKHDF/Points", &points, &linked));
  assert_int_equal(one.dim[0], all.dim[1]);
  assert_int_equal(points.dim[0], all.dim[1]);
  double largest = 0;
  for (size_t i = 0; i < 3 * one.dim[0]; i++) {
    assert_true(mode[i] == shape[2 * 3 * one.dim[0] + i]);
    assert_true(coordinates[i] == linked[i]);
    largest = fmax(largest, fabs(mode[i]));
  }
  assert_true(largest > 0.1);
  assert_ok(h5_read_int(file, "/mesh/connectivity", &cells_shape, &gmsh));
  assert_ok(h5_read_int(file, "/VTKHDF/Connectivity", &flat, &vtk));
  assert_ok(h5_read_int(file, "/VTKHDF/Types", &types, &type));
  assert_int_equal(flat.dim[0], 10 * cells_shape.dim[0]);
  assert_int_equal(types.dim[0], cells_shape.dim[0]);
  for (size_t e = 0; e < cells_shape.dim[0]; e++) {
    assert_int_equal(type[e], 24);
    for (size_t i = 0; i < 8; i++) assert_int_equal(vtk[10 * e + i], gmsh[10 * e + i]);
    assert_int_equal(vtk[10 * e + 8], gmsh[10 * e + 9]);
    assert_int_equal(vtk[10 * e + 9], gmsh[10 * e + 8]);
  }
  assert_ok(h5_read_attribute_text(file, "/VTKHDF", "Type", &text));
  assert_string_equal(text, "UnstructuredGrid");
  free(text);
  assert_ok(h5_close(file));
  free(shape), free(mode), free(coordinates), free(linked), free(gmsh), free(vtk), free(type);
}

/* The same with hexahedra: VTK cells of type 25, whose edges are numbered ring by ring. */
static void hexahedra_go_through(void **state) {
  (void)state;
  static const int ends[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                  {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  modal_settings   settings    = default_settings();
  hid_t            file;
  h5_shape         flat = {1, {0}}, types = {1, {0}}, nodes = {2, {0, 3}}, faces = {2, {0, 8}};
  double          *x;
  h5_shape         count = {1, {0}};
  int             *vtk, *type, *face, *ids;
  char             mesh[512], out[512];
  snprintf(mesh, sizeof mesh, "%s", scratch("hex.msh"));
  snprintf(out, sizeof out, "%s", scratch("hex.modal.h5"));
  use_elements(MESH_HEX20);
  write_mesh(mesh, false);
  use_elements(MESH_TET10);
  settings.speed = 300;
  assert_ok(modal_stage(PETSC_COMM_WORLD, mesh, out, &settings, &provenance, NULL));
  assert_ok(h5_open(out, &file));
  assert_ok(h5_read_double(file, "/mesh/nodes", &nodes, &x));
  assert_ok(h5_read_int(file, "/mesh/sets/contact_right", &faces, &face));
  assert_ok(h5_read_int(file, "/VTKHDF/Connectivity", &flat, &vtk));
  assert_ok(h5_read_int(file, "/VTKHDF/Types", &types, &type));
  assert_ok(h5_read_int(file, "/VTKHDF/NumberOfConnectivityIds", &count, &ids));
  assert_ok(h5_close(file));
  assert_int_equal(types.dim[0], 2 * 2 * 4);
  assert_int_equal(flat.dim[0], 20 * types.dim[0]);
  assert_int_equal(ids[0], 20 * types.dim[0]);
  free(ids);
  assert_int_equal(faces.dim[0], 2 * 4);
  for (size_t e = 0; e < types.dim[0]; e++) {
    const int *cell = vtk + 20 * e;
    assert_int_equal(type[e], 25);
    for (int s = 0; s < 12; s++) { /* axial and radial coordinates are linear along an edge */
      double r[3];
      int    n[3] = {cell[ends[s][0]], cell[8 + s], cell[ends[s][1]]};
      for (int i = 0; i < 3; i++) r[i] = hypot(x[3 * n[i] + 1], x[3 * n[i] + 2]);
      check_below(x[3 * n[1]] - (x[3 * n[0]] + x[3 * n[2]]) / 2, 1e-15, "middle of an edge");
      check_below(r[1] - (r[0] + r[2]) / 2, 1e-15, "middle of an edge");
    }
  }
  free(x), free(face), free(vtk), free(type);
}

/* A column of single hexahedra has motions without strain energy: refused, unless fully
 * integrated. */
static void columns_need_all_points(void **state) {
  (void)state;
  modal_settings settings  = default_settings();
  const int      single[3] = {1, 1, 5};
  modal_result   result;
  modal_contact  contact = *settings.contact;
  contact.points         = 1;
  settings.contact       = &contact;
  use_elements(MESH_HEX20);
  mesh_fe mesh = make_sector(size, inner, BLADES, single);
  use_elements(MESH_TET10);
  assert_int_equal(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &result), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "5 hexahedra (the first has tag 1) stand in a column"));
  modal_result_free(&result);
  settings.full_integration = true;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &result));
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* A sector of curved tetrahedra: 27 points are stiffer than four in every mode. */
static void full_integration_is_stiffer(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  modal_result   reduced, full;
  mesh_fe        mesh = make_sector(size, inner, BLADES, cells);
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &reduced));
  settings.full_integration = true;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &full));
  for (int i = 0; i < settings.modes; i++)
    assert_true(full.eigen.lambda[i] > (1 + 1e-7) * reduced.eigen.lambda[i]);
  modal_result_free(&reduced);
  modal_result_free(&full);
  mesh_fe_free(&mesh);
}

/* The sampled receptance equals that of the model. */
static void receptance_is_sampled(void **state) {
  (void)state;
  hid_t           file;
  h5_shape        steps = {1, {0}}, shape = {3, {0, 12, 12}};
  double         *frequency;
  double complex *value, at[12 * 12];
  modal_model     model;
  assert_ok(modal_model_read(scratch("sector.modal.h5"), &model));
  assert_ok(h5_open(scratch("sector.modal.h5"), &file));
  assert_ok(h5_read_double(file, "/receptance/frequency", &steps, &frequency));
  assert_ok(h5_read_complex(file, "/receptance/contact", &shape, &value));
  assert_ok(h5_close(file));
  assert_int_equal(steps.dim[0], 201 + 8);
  assert_true(frequency[0] == 0 && frequency[208] > model.frequency[7]);
  modal_receptance(&model, SHB_TWO_PI * frequency[77], at);
  for (int i = 0; i < 144; i++)
    check_below(cabs(value[77 * 144 + i] - at[i]), 1e-12 * cabs(at[0]), "sampled receptance");
  free(frequency);
  free(value);
  modal_model_free(&model);
}

/* Exchanged names of the sides give the same model. */
static void sides_are_turned_round(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  modal_model    a, b;
  write_mesh(scratch("swapped.msh"), true);
  assert_ok(modal_stage(PETSC_COMM_WORLD, scratch("swapped.msh"), scratch("swapped.modal.h5"),
                        &settings, &provenance, NULL));
  assert_ok(modal_model_read(scratch("sector.modal.h5"), &a));
  assert_ok(modal_model_read(scratch("swapped.modal.h5"), &b));
  for (int i = 0; i < 2 * 3 * 8; i++) {
    check_below(a.right[i] - b.right[i], 1e-6, "right shape");
    check_below(a.left[i] - b.left[i], 1e-6, "left shape");
  }
  modal_model_free(&a);
  modal_model_free(&b);
  unlink(scratch("swapped.msh"));
  unlink(scratch("swapped.modal.h5"));
}

static double *read_static(hid_t file, const char *path, size_t *n) {
  h5_shape shape;
  double  *value;
  assert_ok(h5_shape_of(file, path, &shape));
  assert_ok(h5_read_double(file, path, &shape, &value));
  *n = h5_count(shape);
  return value;
}

/* /static: the deflection at every node, at the contact and at the probes. */
static void deflection_is_in_the_file(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  double         speed, greatest, most = 0, axes[3][3];
  size_t         n_u, n_contact, n_probe, n_closing, n_normal, n_stress;
  hid_t          file;
  char           out[512];
  settings.speed = 3000;
  snprintf(out, sizeof out, "%s", scratch("turning.modal.h5"));
  assert_ok(
      modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), out, &settings, &provenance, NULL));
  assert_true(assert_described(out) >= 34);
  assert_ok(h5_open(out, &file));
  assert_ok(h5_read_attribute_double(file, "/", "rotor_speed", -1, &speed));
  assert_true(speed == 3000);
  double *u        = read_static(file, "/static/displacement", &n_u);
  double *contact  = read_static(file, "/static/contact", &n_contact);
  double *at_probe = read_static(file, "/static/probe", &n_probe);
  double *closing  = read_static(file, "/static/closing", &n_closing);
  double *normal   = read_static(file, "/contact/normal", &n_normal);
  double *shown    = read_static(file, "/VTKHDF/PointData/static_displacement", &n_u);
  assert_true(memcmp(shown, u, n_u * sizeof *u) == 0);
  free(shown);
  shown = read_static(file, "/VTKHDF/CellData/static_von_mises", &n_stress);
  assert_int_equal(n_stress, mesh.n_elements);
  free(shown);
  double *stress = read_static(file, "/static/stress", &n_stress);
  assert_true(n_contact == 12 && n_probe == 6 && n_closing == 2 && n_normal == 6);
  assert_int_equal(n_u, 3 * mesh.n_nodes);
  assert_int_equal(n_stress, mesh.n_elements);
  for (int q = 0; q < 2; q++) {
    int node = mesh_fe_nearest(&mesh, probe[q].at);
    mesh_axes_at(MESH_AXIS_X, mesh.coordinates + 3 * node, axes);
    for (int a = 0; a < 3; a++) {
      const double *v = u + 3 * node;
      check_below(at_probe[3 * q + a] - axes[a][0] * v[0] - axes[a][1] * v[1] - axes[a][2] * v[2],
                  1e-15, "probe");
    }
    assert_true(at_probe[3 * q + 2] > 1e-6); /* outward */
  }
  for (int p = 0; p < 2; p++) {
    double wanted = 0;
    for (int a = 0; a < 3; a++)
      wanted += normal[3 * p + a] * (contact[3 * p + a] - contact[6 + 3 * p + a]);
    check_below(closing[p] - wanted, 1e-15, "closing");
  }
  for (size_t e = 0; e < n_stress; e++) most = fmax(most, stress[e]);
  assert_ok(h5_read_attribute_double(file, "/static", "greatest_stress", 0, &greatest));
  assert_true(greatest > 0.5 * most && most > 1e7);
  assert_ok(h5_close(file));
  free(u), free(contact), free(at_probe), free(closing), free(normal), free(stress);
  mesh_fe_free(&mesh);
  unlink(out);
}

/* Reactions and nodal stresses: their sums, and the links for ParaView. */
static void statics_are_in_the_file(void **state) {
  (void)state;
  modal_settings settings = default_settings();
  double         sum[3] = {0}, greatest = 0, most = 0;
  size_t         n_node, n_force, n_stress, n_mises;
  hid_t          file;
  char           out[512];
  settings.speed = 3000;
  snprintf(out, sizeof out, "%s", scratch("static.modal.h5"));
  assert_ok(
      modal_stage(PETSC_COMM_WORLD, scratch("sector.msh"), out, &settings, &provenance, NULL));
  assert_ok(h5_open(out, &file));
  int     *node;
  h5_shape nodes = {1, {0}};
  assert_ok(h5_read_int(file, "/static/reaction_node", &nodes, &node));
  n_node         = nodes.dim[0];
  double *force  = read_static(file, "/static/reaction", &n_force);
  double *whole  = read_static(file, "/static/reaction_force", &n_mises);
  double *load   = read_static(file, "/static/load_force", &n_mises);
  double *stress = read_static(file, "/VTKHDF/PointData/static_stress", &n_stress);
  double *mises  = read_static(file, "/VTKHDF/PointData/static_von_mises", &n_mises);
  assert_int_equal(n_force, 3 * n_node);
  assert_int_equal(n_stress, 6 * n_mises);
  for (size_t i = 0; i < n_force; i++) sum[i % 3] += force[i];
  for (int d = 0; d < 3; d++) {
    check_below(sum[d] - whole[d], 1e-12 * fabs(whole[2]), "sum of the reactions");
    check_below(whole[d] + load[d], 1e-9 * fabs(load[2]), "reaction and load");
  }
  assert_true(load[2] > 1e5); /* the blade points along z */
  for (size_t i = 0; i < n_mises; i++) most = fmax(most, mises[i]);
  assert_ok(h5_read_attribute_double(file, "/static", "greatest_stress", 0, &greatest));
  assert_true(most == greatest); /* the one greatest static stress */
  assert_ok(h5_close(file));
  free(node), free(force), free(whole), free(load), free(stress), free(mises);
  unlink(out);
}

static void refused(const modal_settings *settings, const char *mesh, shb_status code,
                    const char *text) {
  char before[17], after[17], out[512];
  snprintf(out, sizeof out, "%s", scratch("sector.modal.h5"));
  assert_ok(shb_fingerprint(out, before));
  assert_refused(modal_stage(PETSC_COMM_WORLD, scratch(mesh), out, settings, &provenance, NULL),
                 code, text);
  assert_ok(shb_fingerprint(out, after));
  assert_string_equal(before, after);
  assert_int_equal(files_in_scratch(), 2);
}

static void failures_leave_the_file_alone(void **state) {
  (void)state;
  const double   psi      = 0.6;
  modal_settings settings = default_settings();
  refused(&settings, "missing.msh", SHB_ERR_IO, "missing.msh");
  settings.speed = 9e4;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "rotor.speed");
  settings        = default_settings();
  settings.blades = 24;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "contact");
  settings              = default_settings();
  modal_contact contact = *settings.contact;
  contact.psi           = &psi;
  settings.contact      = &contact;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "contact.psi: 34.38 deg given");
  contact.psi    = NULL;
  contact.points = 17;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "17 patches");
  settings       = default_settings();
  settings.modes = 100000;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "modal.modes: 100000");
  settings          = default_settings();
  fem_load force    = *settings.loads;
  force.kind        = FEM_LOAD_FORCE;
  settings.loads    = &force;
  settings.n_probes = 0;
  refused(&settings, "sector.msh", SHB_ERR_INPUT, "excitation.force");
}

/* A new group of the faces of a group whose first corner lies on one side of a radius. */
static mesh_face_set part_of(const mesh_fe *mesh, mesh_set_id id, bool outer) {
  const int     each = mesh_topology_of(mesh->kind)->face_nodes;
  mesh_face_set out  = {0, malloc((size_t)(each * mesh->set[id].n) * sizeof(int))};
  assert_non_null(out.nodes);
  for (int f = 0; f < mesh->set[id].n; f++) {
    const int *face = mesh->set[id].nodes + each * f;
    double     far  = 0;
    for (int i = 0; i < each; i++) {
      const double *x = mesh->coordinates + 3 * face[i];
      far             = fmax(far, hypot(x[1], x[2]));
    }
    if ((far > inner + 0.55 * size[2]) != outer) continue;
    memcpy(out.nodes + each * out.n++, face, (size_t)each * sizeof(int));
  }
  return out;
}

/* Two interfaces of one and two patches: each as if alone, with symmetric coupling. */
static void interfaces_are_condensed_together(void **state) {
  (void)state;
  mesh_fe             mesh       = make_sector(size, inner, BLADES, cells);
  modal_settings      settings   = default_settings();
  const modal_contact contact[2] = {
      {.name = "shroud", .right = "outer right", .left = "outer left", .points = 1},
      {.name = "snubber", .right = "inner right", .left = "inner left", .points = 2}};
  static const mesh_set_id side[2] = {MESH_CONTACT_RIGHT, MESH_CONTACT_LEFT};
  modal_result             both, one;
  mesh.n_more = 4;
  for (int i = 0; i < 4; i++) {
    snprintf(mesh.more[i], MESH_WORD, "%s", i % 2 ? contact[i / 2].left : contact[i / 2].right);
    mesh.set[MESH_N_SETS + i] = part_of(&mesh, side[i % 2], i < 2);
    assert_true(mesh.set[MESH_N_SETS + i].n > 2);
  }
  settings.contact    = contact;
  settings.n_contacts = 2;
  assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &both));
  const modal_model *all = &both.model;
  assert_int_equal(all->n_pairs, 3);
  assert_int_equal(all->n_interfaces, 2);
  assert_string_equal(all->interface_name[1], "snubber");
  for (int a = 0; a < 3; a++) assert_int_equal(all->interface[a], a > 0);
  for (int i = 0; i < 2; i++) {
    const int first = i, pairs = i + 1, m = all->n_modes;
    settings.contact    = &contact[i];
    settings.n_contacts = 1;
    assert_ok(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &one));
    const modal_model *own = &one.model;
    assert_int_equal(own->n_pairs, pairs);
    assert_int_equal(own->n_interfaces, 0);
    double most = 0;
    for (int k = 0; k < 3 * pairs * m; k++) most = fmax(most, fabs(own->right[k]));
    for (int k = 0; k < 3 * pairs * m; k++) { /* the solver chooses the signs of modes */
      check_below(fabs(all->right[3 * first * m + k]) - fabs(own->right[k]), 1e-7 * most, "right");
      check_below(fabs(all->left[3 * first * m + k]) - fabs(own->left[k]), 1e-7 * most, "left");
    }
    for (int a = 0; a < pairs; a++) check_close(all->area[first + a], own->area[a], 1e-14, "area");
    const int n = 6 * pairs;
    most        = 0;
    for (int k = 0; k < n * n; k++) most = fmax(most, fabs(own->residual_flexibility[k]));
    for (int k = 0; k < n * n; k++) {
      int at[2] = {k / n, k % n};
      for (int j = 0; j < 2; j++)
        at[j] = (at[j] / (3 * pairs) * 3 + first) * 3 + at[j] % (3 * pairs);
      check_below(all->residual_flexibility[18 * at[0] + at[1]] - own->residual_flexibility[k],
                  1e-8 * most, "residual flexibility");
    }
    modal_result_free(&one);
  }
  modal_result_free(&both);
  modal_contact lost = {.name = "shroud", .right = "nowhere", .left = "outer left", .points = 1};
  settings.contact   = &lost;
  assert_int_equal(modal_solve(PETSC_COMM_WORLD, &mesh, &settings, NULL, &one), SHB_ERR_INPUT);
  assert_non_null(
      strstr(shb_message(), "contact interface shroud: the mesh has no group \"nowhere\""));
  modal_result_free(&one);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(file_is_complete),
      cmocka_unit_test(phases_are_in_the_file),
      cmocka_unit_test(damping_follows_its_law),
      cmocka_unit_test(abaqus_mesh_gives_the_same),
      cmocka_unit_test(vtk_group_shows_the_modes),
      cmocka_unit_test(receptance_is_sampled),
      cmocka_unit_test(sides_are_turned_round),
      cmocka_unit_test(deflection_is_in_the_file),
      cmocka_unit_test(statics_are_in_the_file),
      cmocka_unit_test(failures_leave_the_file_alone),
      cmocka_unit_test(hexahedra_go_through),
      cmocka_unit_test(columns_need_all_points),
      cmocka_unit_test(full_integration_is_stiffer),
      cmocka_unit_test(interfaces_are_condensed_together),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures  = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  session.fault = false;
  modal_session_end(&session, SHB_OK);
  return failures;
}
