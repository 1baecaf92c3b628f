/* Modes of a twisted blade at speed against CalculiX, on the same mesh with its integration rules.
 * Argument: the program ccx. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "fem/body/equilibrium.h"
#include "fem/body/stress.h"
#include "mesh/base/constants.h"
#include "mesh/io/inp_read.h"
#include "mesh/io/inp_write.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"

enum { MODES = 6 };

static const double size[3] = {0.2, 0.03, 0.005}, hub = 0.15, twist = 0.7;
static const int    cells[3] = {10, 2, 1};
static const char  *program;
static char         folder[] = "/tmp/shroudhb-calculix-XXXXXX";

static const fem_orthotropic crystal = {{127e9, 141e9, 118e9},
                                        {0.38, 0.31, 0.27},
                                        {120e9, 97e9, 71e9},
                                        {0.3, -0.8, 0.52},
                                        {0.9, 0.2, -0.4}};

/* A CalculiX element, and ours with the same integration rules. */
typedef struct {
  const char *name;
  mesh_kind   kind;
  fem_rules   rules;
} element_kind;

/* A twisted blade along x from the hub radius on, of curved elements. */
static mesh_fe make_curved_blade(mesh_kind kind) {
  use_elements(kind);
  mesh_fe mesh = make_box(size, cells);
  for (int i = 0; i < mesh.n_nodes; i++) {
    double *x = mesh.coordinates + 3 * i, angle = 0.3 + twist * x[0] / size[0];
    double  y = x[1] - size[1] / 2, z = x[2] - size[2] / 2;
    x[0] += hub;
    x[1] = y * cos(angle) - z * sin(angle);
    x[2] = y * sin(angle) + z * cos(angle);
  }
  return mesh;
}

/* The same; tetrahedra have straight sides. */
static mesh_fe make_blade(mesh_kind kind) {
  mesh_fe mesh = make_curved_blade(kind);
  if (kind == MESH_TET10) straighten(&mesh);
  return mesh;
}

/* Write the mesh; hexahedra as C3D20R. */
static void use_type(const char *name) {
  char command[256];
  snprintf(command, sizeof command, "sed -i 's/TYPE=C3D20R/TYPE=%s/' %s/blade.inp", name, folder);
  assert_int_equal(system(command), 0);
}

/* D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323 in the material's own axes. */
static void write_crystal(FILE *deck) {
  fem_orthotropic own = crystal;
  fem_material    material;
  own.axis[0] = 1, own.axis[1] = own.axis[2] = 0;
  own.in_plane[1] = 1, own.in_plane[0] = own.in_plane[2] = 0;
  assert_int_equal(fem_material_orthotropic(&own, 8500, &material), SHB_OK);
  const double(*C)[6] = (const double(*)[6])material.C;
  fprintf(deck,
          "*ORIENTATION, NAME=AXES, SYSTEM=RECTANGULAR\n%g, %g, %g, %g, %g, %g\n*MATERIAL, "
          "NAME=CRYSTAL\n*ELASTIC, TYPE=ORTHO\n",
          crystal.axis[0], crystal.axis[1], crystal.axis[2], crystal.in_plane[0],
          crystal.in_plane[1], crystal.in_plane[2]);
  fprintf(deck, "%.13g, %.13g, %.13g, %.13g, %.13g, %.13g, %.13g, %.13g,\n%.13g\n", C[0][0],
          C[0][1], C[1][1], C[0][2], C[1][2], C[2][2], C[3][3], C[4][4], C[5][5]);
  fprintf(deck, "*DENSITY\n8500\n*SOLID SECTION, ELSET=body, MATERIAL=CRYSTAL, ORIENTATION=AXES\n");
}

/* A material for each region of the mesh. */
static void write_parts(const mesh_fe *mesh, const fem_material *part, FILE *deck) {
  for (int i = 0; i < mesh->n_regions; i++)
    fprintf(deck,
            "*MATERIAL, NAME=PART%d\n*ELASTIC\n%.13g, %.13g\n*DENSITY\n%.13g\n"
            "*SOLID SECTION, ELSET=%s, MATERIAL=PART%d\n",
            i, part[i].E, part[i].nu, part[i].rho, mesh->region_name[i], i);
}

static void write_material(const fem_material *material, FILE *deck) {
  if (material->anisotropic) {
    write_crystal(deck);
    return;
  }
  fprintf(deck,
          "*MATERIAL, NAME=STEEL\n*ELASTIC\n%.13g, %.13g\n*DENSITY\n%.13g\n"
          "*SOLID SECTION, ELSET=body, MATERIAL=STEEL\n",
          material->E, material->nu, material->rho);
}

/* The controls of the static step are tightened: CalculiX's default leaves errors of 1e-4 in
 * frequencies. */
static void write_deck(const element_kind *element, const mesh_fe *mesh,
                       const fem_material *material, double speed, double pressure) {
  char path[128];
  snprintf(path, sizeof path, "%s/blade.inp", folder);
  assert_int_equal(mesh_inp_write(mesh, path), SHB_OK);
  if (element->kind == MESH_HEX20) use_type(element->name);
  FILE *deck = fopen(path, "a");
  assert_non_null(deck);
  fprintf(deck, "*BOUNDARY\nroot, 1, 3\n");
  if (mesh->region)
    write_parts(mesh, material, deck);
  else
    write_material(material, deck);
  if (speed != 0)
    fprintf(deck,
            "*STEP, NLGEOM\n*STATIC\n0.25, 1., 1e-5, 0.25\n*CONTROLS, PARAMETERS=FIELD\n"
            "1.e-8,1.e-8,,,1.e-8,1.e-7\n*DLOAD\nbody, CENTRIF, %.13g, 0, 0, 0, 0, 0, 1\n",
            speed * speed);
  if (pressure != 0) fprintf(deck, "*DSLOAD\nload, P, %.13g\n", pressure);
  if (speed != 0) fprintf(deck, "*NODE PRINT, NSET=load\nU\n*END STEP\n");
  fprintf(deck, "*STEP%s\n*FREQUENCY, STORAGE=YES\n%d\n*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n",
          speed != 0 ? ", PERTURBATION" : "", MODES);
  fclose(deck);
}

/* blade.eig holds three integers; the last is 1 after a static step. Four numbers for each node of
 * that step follow, then the number of modes and their eigenvalues. blade.dat prints seven digits
 * only. */
static void read_frequencies(const mesh_fe *mesh, double frequency[MODES]) {
  char    path[128];
  int32_t head[3], n = 0;
  double  value[MODES];
  snprintf(path, sizeof path, "%s/blade.eig", folder);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  assert_int_equal(fread(head, sizeof *head, 3, file), 3);
  if (head[2] == 1)
    assert_int_equal(fseek(file, 4L * mesh->n_nodes * (long)sizeof *value, SEEK_CUR), 0);
  assert_int_equal(fread(&n, sizeof n, 1, file), 1);
  assert_int_equal(n, MODES);
  assert_int_equal(fread(value, sizeof *value, MODES, file), MODES);
  fclose(file);
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(value[i]) / SHB_TWO_PI;
}

static void run_calculix(const element_kind *element, const mesh_fe *mesh,
                         const fem_material *material, double speed, double pressure,
                         double frequency[MODES]) {
  char command[512];
  write_deck(element, mesh, material, speed, pressure);
  snprintf(command, sizeof command, "cd %s && OMP_NUM_THREADS=1 '%s' blade >blade.log 2>&1", folder,
           program);
  assert_int_equal(system(command), 0);
  read_frequencies(mesh, frequency);
}

static void run_own(const mesh_fe *mesh, const fem_material *material, fem_rules rules,
                    double speed, double pressure, double frequency[MODES], double *displacement) {
  fem_element         *element = malloc(sizeof *element);
  const fem_body       body    = {mesh, material, element, {MESH_AXIS_Z, speed}, pressure};
  fem_system           system;
  fem_equilibrium      at = {0};
  modal_eigen          eigen;
  modal_eigen_settings wanted = {.modes = MODES};
  assert_non_null(element);
  assert_int_equal(fem_element_create(mesh->kind, rules, element), 0);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, mesh, material, rules, &system), 0);
  if (speed != 0) assert_int_equal(fem_equilibrium_solve(&body, &system, NULL, &at), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  for (int i = 0; i < MODES; i++) frequency[i] = sqrt(eigen.lambda[i]) / SHB_TWO_PI;
  if (displacement)
    memcpy(displacement, at.displacement, 3 * (size_t)mesh->n_nodes * sizeof *displacement);
  modal_eigen_destroy(&eigen);
  fem_equilibrium_free(&at);
  fem_system_destroy(&system);
  free(element);
}

static void compare_on(const element_kind *element, const mesh_fe *mesh,
                       const fem_material *material) {
  const double speed[] = {0, 400, 1000};
  for (int s = 0; s < 3; s++) {
    double own[MODES], other[MODES], worst = 0;
    run_own(mesh, material, element->rules, speed[s], 0, own, NULL);
    run_calculix(element, mesh, material, speed[s], 0, other);
    for (int i = 0; i < MODES; i++) worst = fmax(worst, fabs(own[i] / other[i] - 1));
    print_message("%s, %g rad/s: first mode %.7g Hz, CalculiX %.7g; six modes to %.1e\n",
                  element->name, speed[s], own[0], other[0], worst);
    for (int i = 0; i < MODES; i++) check_close(own[i], other[i], 1e-8, "frequency");
  }
}

static void compare(const element_kind *element, const fem_material *material) {
  mesh_fe mesh = make_blade(element->kind);
  compare_on(element, &mesh, material);
  mesh_fe_free(&mesh);
}

/* Displacements of group load at the end of the static step, by node; others stay unchanged. */
static void read_displacements(const mesh_fe *mesh, double *u) {
  char   path[128], line[512];
  long   tag, last = 0;
  double value[3];
  snprintf(path, sizeof path, "%s/blade.dat", folder);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file) && !strstr(line, "E I G E N V A L U E")) {
    if (sscanf(line, "%ld %lf %lf %lf", &tag, value, value + 1, value + 2) != 4) continue;
    assert_int_equal(mesh->node_tag[tag - 1], tag);
    memcpy(u + 3 * (tag - 1), value, sizeof value);
    last = tag;
  }
  fclose(file);
  assert_true(last > 0);
}

/* Displacements under rotation and a follower pressure. Frequencies must agree to 1e-2 only: the
 * load stiffness of the pressure is not symmetric, and CalculiX's eigensolver treats it as
 * symmetric. tests/fem/body/test_pressure.c compares ours with the eigenvalues of the full load
 * stiffness. */
static void pressure_agrees(void **state) {
  (void)state;
  const element_kind kinds[] = {{"C3D10", MESH_TET10, FEM_CALCULIX},
                                {"C3D20R", MESH_HEX20, FEM_CALCULIX}};
  for (int k = 0; k < 2; k++) {
    mesh_fe      mesh = make_blade(kinds[k].kind);
    const size_t n    = 3 * (size_t)mesh.n_nodes;
    double       own[MODES], other[MODES], worst = 0, most = 0, off = 0;
    double      *u = calloc(n, sizeof *u), *v = calloc(n, sizeof *v);
    assert_true(u && v);
    run_own(&mesh, &steel, kinds[k].rules, 400, 2e5, own, u);
    run_calculix(&kinds[k], &mesh, &steel, 400, 2e5, other);
    memcpy(v, u, n * sizeof *v);
    read_displacements(&mesh, v);
    for (size_t i = 0; i < n; i++) {
      most = fmax(most, fabs(u[i]));
      off  = fmax(off, fabs(u[i] - v[i]));
    }
    for (int i = 0; i < MODES; i++) worst = fmax(worst, fabs(own[i] / other[i] - 1));
    print_message(
        "%s, 400 rad/s and .2 MPa: displacement %.4g m, off by %.1e; first mode %.7g Hz, "
        "CalculiX %.7g; six modes to %.1e\n",
        kinds[k].name, most, off / most, own[0], other[0], worst);
    check_below(off, 1e-6 * most, "displacement");
    for (int i = 0; i < MODES; i++) check_close(own[i], other[i], 1e-2, "frequency");
    free(u), free(v);
    mesh_fe_free(&mesh);
  }
}

/* Nodal stresses of the first mode from blade.frd, six digits: [n_nodes][6]. */
static void read_stresses(const mesh_fe *mesh, double *stress) {
  char path[128], line[256], head[16];
  bool inside = false;
  int  n      = 0;
  snprintf(path, sizeof path, "%s/blade.frd", folder);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  while (n < mesh->n_nodes && fgets(line, sizeof line, file)) {
    if (sscanf(line, " -4 %15s", head) == 1) inside = strcmp(head, "STRESS") == 0;
    if (!inside || strncmp(line, " -1", 3) != 0) continue;
    int tag = 0;
    assert_int_equal(sscanf(line + 3, "%10d", &tag), 1);
    for (int c = 0; c < 6; c++) {
      char number[13] = "";
      memcpy(number, line + 13 + 12 * c, 12);
      stress[6 * (tag - 1) + c] = strtod(number, NULL);
    }
    n++;
  }
  fclose(file);
  assert_int_equal(n, mesh->n_nodes);
}

/* Of a straight bar whose tetrahedra have equal volumes: CalculiX takes the plain mean at a node.
 * Both extrapolate from four points by a linear function. */
static void stresses_agree(void **state) {
  (void)state;
  const element_kind   kind   = {"C3D10", MESH_TET10, FEM_CALCULIX};
  modal_eigen_settings wanted = {.modes = MODES};
  use_elements(kind.kind);
  mesh_fe        mesh    = make_box(size, cells);
  const size_t   n       = (size_t)mesh.n_nodes;
  fem_element   *element = make_element_tables(kind.rules);
  const fem_body body    = {&mesh, &steel, element, {MESH_AXIS_Z, 0}, 0};
  fem_system     system;
  modal_eigen    eigen;
  Vec            phi;
  double         frequency[MODES], inner = 0, most = 0, plus = 0, minus = 0;
  double        *shape = malloc(3 * n * sizeof *shape), *other = malloc(6 * n * sizeof *other);
  float         *own = malloc(6 * n * sizeof *own);
  run_calculix(&kind, &mesh, &steel, 0, 0, frequency);
  read_stresses(&mesh, other);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, kind.rules, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  assert_int_equal(MatDenseGetColumnVecRead(eigen.phi, 0, &phi), 0);
  assert_int_equal(fem_system_gather(&system, phi, shape), 0);
  assert_int_equal(MatDenseRestoreColumnVecRead(eigen.phi, 0, &phi), 0);
  fem_nodal_stress_change(&body, NULL, 1, shape, own);
  for (size_t i = 0; i < 6 * n; i++) {
    inner += own[i] * other[i];
    most  = fmax(most, fabs(other[i]));
    plus  = fmax(plus, fabs(own[i] - other[i]));
    minus = fmax(minus, fabs(own[i] + other[i]));
  }
  print_message("stress of the first mode %.4g Pa kg^-1/2, off by %.1e\n", most,
                fmin(plus, minus) / most);
  check_below(inner > 0 ? plus : minus, 1e-5 * most, "stress");
  free(shape), free(own), free(other), free(element);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  mesh_fe_free(&mesh);
}

static void tetrahedra_agree(void **state) {
  (void)state;
  compare(&(element_kind){"C3D10", MESH_TET10, FEM_CALCULIX}, &steel);
}

/* CalculiX integrates every C3D10 at four points, curved or not. Four points with the exact mass
 * stay near, 27 points do not. */
static void curved_tetrahedra_agree(void **state) {
  (void)state;
  const element_kind element = {"C3D10", MESH_TET10, FEM_CALCULIX};
  mesh_fe            mesh    = make_curved_blade(MESH_TET10);
  double             other[MODES], standard[MODES], full[MODES], near = 0, far = 0;
  compare_on(&element, &mesh, &steel);
  run_calculix(&element, &mesh, &steel, 0, 0, other);
  run_own(&mesh, &steel, FEM_STANDARD, 0, 0, standard, NULL);
  run_own(&mesh, &steel, FEM_FULL, 0, 0, full, NULL);
  for (int i = 0; i < MODES; i++) {
    near = fmax(near, fabs(standard[i] / other[i] - 1));
    far  = fmax(far, fabs(full[i] / other[i] - 1));
  }
  print_message("exact mass: 4 points within %.1e of C3D10, 27 points %.1e\n", near, far);
  check_below(near, 0.2 * far, "four points");
  mesh_fe_free(&mesh);
}

static void reduced_hexahedra_agree(void **state) {
  (void)state;
  compare(&(element_kind){"C3D20R", MESH_HEX20, FEM_CALCULIX}, &steel);
}

static void full_hexahedra_agree(void **state) {
  (void)state;
  compare(&(element_kind){"C3D20", MESH_HEX20, FEM_FULL}, &steel);
}

/* CalculiX gets the constants in material axes and their orientation; ours are rotated
 * beforehand. */
static void crystals_agree(void **state) {
  (void)state;
  fem_material material;
  assert_int_equal(fem_material_orthotropic(&crystal, 8500, &material), SHB_OK);
  compare(&(element_kind){"C3D10", MESH_TET10, FEM_CALCULIX}, &material);
  compare(&(element_kind){"C3D20R", MESH_HEX20, FEM_CALCULIX}, &material);
}

/* A steel blade with a lighter titanium tip. */
static void two_materials_agree(void **state) {
  (void)state;
  const fem_material parts[]   = {steel, {.E = 1.14e11, .nu = 0.33, .rho = 4430}};
  const element_kind element[] = {{"C3D10", MESH_TET10, FEM_CALCULIX},
                                  {"C3D20R", MESH_HEX20, FEM_CALCULIX}};
  for (int k = 0; k < 2; k++) {
    mesh_fe              mesh     = make_blade(element[k].kind);
    const mesh_topology *topology = mesh_topology_of(mesh.kind);
    mesh.n_regions                = 2;
    mesh.region_name              = calloc(2, sizeof *mesh.region_name);
    mesh.region                   = malloc((size_t)mesh.n_elements * sizeof(int));
    assert_true(mesh.region_name && mesh.region);
    strcpy(mesh.region_name[0], "shank");
    strcpy(mesh.region_name[1], "tip");
    for (int e = 0; e < mesh.n_elements; e++) {
      double x = 0;
      for (int i = 0; i < topology->corners; i++)
        x += mesh.coordinates[3 * mesh.connectivity[topology->nodes * e + i]] / topology->corners;
      mesh.region[e] = x > hub + 0.6 * size[0];
    }
    compare_on(&element[k], &mesh, parts);
    mesh_fe_free(&mesh);
  }
}

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  char command[128];
  (void)state;
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tetrahedra_agree),        cmocka_unit_test(curved_tetrahedra_agree),
      cmocka_unit_test(reduced_hexahedra_agree), cmocka_unit_test(full_hexahedra_agree),
      cmocka_unit_test(crystals_agree),          cmocka_unit_test(pressure_agrees),
      cmocka_unit_test(two_materials_agree),     cmocka_unit_test(stresses_agree)};
  if (argc < 2) return 77;
  program = argv[1];
  if (SlepcInitialize(NULL, NULL, NULL, NULL)) return 1;
  int failures = cmocka_run_group_tests(tests, make_folder, remove_folder);
  SlepcFinalize();
  return failures;
}
