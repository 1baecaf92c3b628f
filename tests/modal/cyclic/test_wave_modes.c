/* Matrices, solutions and modes of a sector at each nodal diameter against the explicit ring. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/solver/factor.h"
#include "mesh/base/constants.h"
#include "mesh/core/cyclic_sides.h"
#include "modal/common/session.h"
#include "modal/cyclic/wave_modes.h"
#include "modal/eigen/eigen.h"
#include "tests/support/fem.h"
#include "tests/support/sector.h"

enum { BLADES = 6, MODES = 8 };

static const mesh_axis axis = MESH_AXIS_X;

/* The sector, its system at nodal diameter 0, and the explicit ring. */
typedef struct {
  mesh_fe              mesh;
  fem_element         *element;
  fem_body             body;
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
  sector_ring          ring;
  fem_system           whole;
  fem_factor          *factor; /* of the ring */
} scene;

static void create(scene *s) {
  mesh_cyclic_sides sides;
  bool              definite;
  s->mesh = make_bladed_sector(BLADES, 1);
  assert_ok(mesh_cyclic_pair(&s->mesh, axis, BLADES, &sides));
  s->element = make_element_tables(FEM_STANDARD);
  s->body    = (fem_body){&s->mesh, &steel, s->element, {axis, 0}, 0};
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &s->mesh, &steel, FEM_STANDARD, &s->system),
                   0);
  assert_int_equal(fem_sector_create(&s->body, NULL, &s->system, &s->sector), 0);
  assert_ok(fem_sector_analyse(&s->sector, &s->order));
  s->ring = make_sector_ring(&s->mesh, axis, BLADES);
  assert_int_equal(
      fem_system_create(PETSC_COMM_SELF, &s->ring.mesh, &steel, FEM_STANDARD, &s->whole), 0);
  assert_int_equal(fem_factor_create(s->whole.K, 0, &s->factor), 0);
  assert_int_equal(fem_factor_update(s->factor, s->whole.K, &definite), 0);
  assert_true(definite);
}

static void destroy(scene *s) {
  fem_factor_destroy(&s->factor);
  fem_system_destroy(&s->whole);
  free_sector_ring(&s->ring);
  fem_hermitian_order_free(s->order);
  fem_sector_free(&s->sector);
  fem_system_destroy(&s->system);
  free(s->element);
  mesh_fe_free(&s->mesh);
}

/* A force on a node of the blade and on one of cyclic_right, which belongs to two sectors. */
static void force_at(const scene *s, int which, int *node, double complex f[3]) {
  const int load = s->mesh.set[MESH_LOAD].nodes[0];
  const int side = s->mesh.set[MESH_CYCLIC_RIGHT].nodes[5];
  *node          = which ? side : load;
  f[0]           = 2.385 + 0.4 * I;
  f[1]           = -1.1 + 0.9 * I;
  f[2]           = 0.7 - 1.3 * I;
}

/* Add the travelling wave of a nodal force to the ring: on sector b turned by b sectors and with
 * the phase e^(-j b theta). */
static void spread_wave(const scene *s, int n, bool imaginary, Vec f) {
  double *value;
  assert_int_equal(VecZeroEntries(f), 0);
  assert_int_equal(VecGetArray(f, &value), 0);
  for (int b = 0; b < BLADES; b++)
    for (int which = 0; which < 2; which++) {
      double complex force[3];
      double         part[3], turned[3];
      int            node;
      force_at(s, which, &node, force);
      for (int d = 0; d < 3; d++) {
        const double complex now = force[d] * cpow(fem_sector_phase(n, BLADES), b);
        part[d]                  = imaginary ? cimag(now) : creal(now);
      }
      mesh_axis_rotate(axis, SHB_TWO_PI * b / BLADES, part, turned);
      const PetscInt row = s->whole.row[s->ring.node[b * s->mesh.n_nodes + node]];
      for (int d = 0; d < 3 && row >= 0; d++) value[3 * row + d] += turned[d];
    }
  assert_int_equal(VecRestoreArray(f, &value), 0);
}

/* K^-1 f, or K^-1 M K^-1 f, of the ring at the nodes of sector b: [n_nodes][3]. */
static void solve_ring(const scene *s, int diameter, bool twice, int b, double complex *out) {
  const size_t n     = (size_t)s->mesh.n_nodes;
  double      *nodal = malloc(3 * (size_t)s->ring.mesh.n_nodes * sizeof *nodal);
  Vec          f, x;
  assert_non_null(nodal);
  assert_int_equal(MatCreateVecs(s->whole.K, &f, &x), 0);
  memset(out, 0, 3 * n * sizeof *out);
  for (int imaginary = 0; imaginary < 2; imaginary++) {
    spread_wave(s, diameter, imaginary, f);
    assert_int_equal(fem_factor_solve(s->factor, f, x), 0);
    if (twice) {
      assert_int_equal(MatMult(s->whole.M, x, f), 0);
      assert_int_equal(fem_factor_solve(s->factor, f, x), 0);
    }
    assert_int_equal(fem_system_gather(&s->whole, x, nodal), 0);
    for (size_t i = 0; i < n; i++) {
      const double *from = nodal + 3 * s->ring.node[(size_t)b * n + i];
      for (int d = 0; d < 3; d++) out[3 * i + (size_t)d] += (imaginary ? I : 1) * from[d];
    }
  }
  VecDestroy(&f);
  VecDestroy(&x);
  free(nodal);
}

/* The same of the sector as it moves at sector b. */
static void solve_sector(const scene *s, int diameter, bool twice, int b, double complex *out) {
  const size_t    order = 3 * (size_t)s->sector.n_rows, n = (size_t)s->mesh.n_nodes;
  double complex *f = calloc(order, sizeof *f), *x = malloc(order * sizeof *x);
  wave_operator   op;
  assert_true(f && x);
  assert_ok(wave_operator_create(&s->sector, s->order, diameter, BLADES, &op));
  for (int which = 0; which < 2; which++) {
    double complex force[3], share[3];
    double         part[3];
    int            node;
    force_at(s, which, &node, force);
    for (int imaginary = 0; imaginary < 2; imaginary++) {
      for (int d = 0; d < 3; d++) part[d] = imaginary ? cimag(force[d]) : creal(force[d]);
      fem_sector_force(&s->sector, node, op.phase, part, share);
      for (int d = 0; d < 3 && s->sector.row[node] >= 0; d++)
        f[3 * s->sector.row[node] + d] += (imaginary ? I : 1) * share[d];
    }
  }
  wave_operator_solve(&op, 1, f, x);
  if (twice) {
    wave_operator_mass(&op, 1, x, f);
    wave_operator_solve(&op, 1, f, x);
  }
  fem_sector_expand(&s->sector, op.phase, x, out);
  for (size_t i = 0; i < n; i++) {
    double part[2][3];
    for (int d = 0; d < 3; d++) {
      const double complex now = out[3 * i + (size_t)d] * cpow(op.phase, b);
      part[0][d] = creal(now), part[1][d] = cimag(now);
    }
    for (int p = 0; p < 2; p++) mesh_axis_rotate(axis, SHB_TWO_PI * b / BLADES, part[p], part[p]);
    for (int d = 0; d < 3; d++) out[3 * i + (size_t)d] = CMPLX(part[0][d], part[1][d]);
  }
  wave_operator_free(&op);
  free(f);
  free(x);
}

static double distance(size_t n, const double complex *a, const double complex *b) {
  double most = 0, off = 0;
  for (size_t i = 0; i < n; i++) {
    most = fmax(most, cabs(b[i]));
    off  = fmax(off, cabs(a[i] - b[i]));
  }
  return off / most;
}

static void travelling_waves_of_the_ring(void **state) {
  scene *s = *state;
  for (int n = 0; n <= BLADES / 2; n++)
    for (int k = 0; k < 4; k++) {
      const size_t    size  = 3 * (size_t)s->mesh.n_nodes;
      const bool      twice = k > 1;
      const int       b     = k % 2 ? BLADES - 1 : 0;
      double complex *ring = malloc(size * sizeof *ring), *own = malloc(size * sizeof *own);
      assert_true(ring && own);
      solve_ring(s, n, twice, b, ring);
      solve_sector(s, n, twice, b, own);
      const double off = distance(size, own, ring);
      solve_sector(s, -n, twice, b, own);
      const double wrong = distance(size, own, ring);
      print_message("nodal diameter %d, sector %d, K^-1%s: off by %.1e; opposite sign %.1e\n", n, b,
                    twice ? " M K^-1" : "", off, wrong);
      check_below(off, 1e-9, "solution");
      if (n > 0 && 2 * n < BLADES) assert_true(wrong > 1e-3);
      free(ring);
      free(own);
    }
}

static int ascending(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* The eigenvalues of nodal diameters 0 and N/2, and twice those between, are those of the ring. */
static void modes_of_the_ring(void **state) {
  scene        *s = *state;
  double        all[BLADES * MODES];
  int           n_all  = 0;
  wave_settings wanted = {.modes = MODES};
  for (int n = 0; n <= BLADES / 2; n++) {
    wave_operator op;
    wave_modes    modes;
    assert_ok(wave_operator_create(&s->sector, s->order, n, BLADES, &op));
    assert_ok(wave_modes_solve(&op, &wanted, &s->body, NULL, &modes));
    assert_string_equal(modes.check.method, "restart");
    for (int i = 0; i < MODES; i++) {
      check_below(modes.eigen_residual[i], 1e-8, "residual");
      all[n_all++] = modes.lambda[i];
      if (n > 0 && 2 * n < BLADES) all[n_all++] = modes.lambda[i];
    }
    print_message("nodal diameter %d: %.6g to %.6g Hz, checked below %.6g Hz to %.1e\n", n,
                  sqrt(modes.lambda[0]) / SHB_TWO_PI, sqrt(modes.lambda[MODES - 1]) / SHB_TWO_PI,
                  modal_check_frequency(&modes.check), modes.check.probability);
    wave_modes_free(&modes);
    wave_operator_free(&op);
  }
  qsort(all, (size_t)n_all, sizeof *all, ascending);
  modal_eigen_settings settings = {.modes = 3 * MODES};
  modal_eigen          eigen;
  double               worst = 0;
  assert_int_equal(modal_eigen_solve(&s->whole, &settings, &eigen), 0);
  for (int i = 0; i < settings.modes; i++) worst = fmax(worst, fabs(eigen.lambda[i] / all[i] - 1));
  print_message("%d modes of the ring, eigenvalues off by %.1e\n", settings.modes, worst);
  check_below(worst, 1e-9, "eigenvalues");
  modal_eigen_destroy(&eigen);
}

/* The real systems of nodal diameters 0 and N/2 give the same modes as the complex one. */
static void real_nodal_diameters(void **state) {
  scene        *s      = *state;
  wave_settings wanted = {.modes = MODES};
  for (int half = 0; half < 2; half++) {
    mesh_fe              mesh = half ? mesh_cyclic_alternating(&s->mesh) : s->mesh;
    fem_system           system;
    modal_eigen_settings settings = {.modes = MODES};
    modal_eigen          eigen;
    wave_operator        op;
    wave_modes           modes;
    double               worst = 0;
    assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
    assert_int_equal(modal_eigen_solve(&system, &settings, &eigen), 0);
    assert_ok(wave_operator_create(&s->sector, s->order, half * BLADES / 2, BLADES, &op));
    assert_ok(wave_modes_solve(&op, &wanted, &s->body, NULL, &modes));
    for (int i = 0; i < MODES; i++)
      worst = fmax(worst, fabs(eigen.lambda[i] / modes.lambda[i] - 1));
    for (size_t i = 0; i < modes.order * MODES; i++) assert_true(cimag(modes.phi[i]) == 0);
    print_message("nodal diameter %s: eigenvalues off by %.1e\n", half ? "N/2" : "0", worst);
    check_below(worst, 1e-9, "eigenvalues");
    wave_modes_free(&modes);
    wave_operator_free(&op);
    modal_eigen_destroy(&eigen);
    fem_system_destroy(&system);
  }
}

/* Two modes of one frequency are no reason to miss one: a ring of identical sectors without twist
 * has them at every nodal diameter. Too many modes are refused. */
static void too_many_modes(void **state) {
  scene        *s      = *state;
  wave_settings wanted = {.modes = 1000000};
  wave_operator op;
  wave_modes    modes;
  assert_ok(wave_operator_create(&s->sector, s->order, 1, BLADES, &op));
  assert_refused(wave_modes_solve(&op, &wanted, &s->body, NULL, &modes), SHB_ERR_INPUT,
                 "1000000 modes asked of a mesh with");
  wave_modes_free(&modes);
  wave_operator_free(&op);
}

/* Lowest frequencies of the blade whose disc is clamped as a whole, rad/s. */
static void clamped_blade(const mesh_fe *sector, int n, double *omega) {
  modal_eigen_settings wanted = {.modes = n};
  const mesh_fe        mesh   = sector_clamp_disc(sector);
  fem_system           system;
  modal_eigen          eigen;
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, &steel, FEM_STANDARD, &system), 0);
  assert_int_equal(modal_eigen_solve(&system, &wanted, &eigen), 0);
  for (int i = 0; i < n; i++) omega[i] = sqrt(eigen.lambda[i]);
  modal_eigen_destroy(&eigen);
  fem_system_destroy(&system);
  free(mesh.set[MESH_ROOT].nodes);
}

/* The same at nodal diameter 2 with a disc that many times stiffer than steel. */
static void stiff_disc(scene *s, double stiffer, int n, double *omega) {
  fem_material         material[2] = {steel, steel};
  mesh_fe              mesh        = s->mesh;
  const fem_body       body        = {&mesh, material, s->element, {axis, 0}, 0};
  const wave_settings  wanted      = {.modes = n};
  fem_system           system;
  fem_sector           sector;
  fem_hermitian_order *order;
  wave_operator        op;
  wave_modes           modes;
  material[1].E *= stiffer;
  sector_mark_disc(&mesh);
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &mesh, material, FEM_STANDARD, &system), 0);
  assert_int_equal(fem_sector_create(&body, NULL, &system, &sector), 0);
  assert_ok(fem_sector_analyse(&sector, &order));
  assert_ok(wave_operator_create(&sector, order, 2, BLADES, &op));
  assert_ok(wave_modes_solve(&op, &wanted, &body, NULL, &modes));
  for (int i = 0; i < n; i++) omega[i] = sqrt(modes.lambda[i]);
  wave_modes_free(&modes);
  wave_operator_free(&op);
  fem_hermitian_order_free(order);
  fem_sector_free(&sector);
  fem_system_destroy(&system);
  free(mesh.region);
}

/* A stiff disc gives the clamped blade back; the difference falls as the inverse stiffness. */
static void a_stiff_disc_is_a_clamp(void **state) {
  enum { LOWEST = 4 };
  scene *s = *state;
  double clamped[LOWEST], omega[LOWEST], off[2] = {0};
  clamped_blade(&s->mesh, LOWEST, clamped);
  for (int k = 0; k < 2; k++) {
    stiff_disc(s, k ? 1e5 : 1e4, LOWEST, omega);
    for (int i = 0; i < LOWEST; i++) off[k] = fmax(off[k], fabs(omega[i] / clamped[i] - 1));
  }
  print_message("disc 1e4 and 1e5 times stiffer: frequencies off by %.1e and %.1e\n", off[0],
                off[1]);
  check_below(off[0], 1e-4, "stiff disc");
  assert_true(fabs(log10(off[0] / off[1]) - 1) < 0.05);
}

static int set_up(void **state) {
  static scene s;
  create(&s);
  *state = &s;
  return 0;
}

static int tear_down(void **state) {
  destroy(*state);
  return 0;
}

int main(int argc, char **argv) {
  modal_session           session;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(travelling_waves_of_the_ring), cmocka_unit_test(modes_of_the_ring),
      cmocka_unit_test(real_nodal_diameters), cmocka_unit_test(a_stiff_disc_is_a_clamp),
      cmocka_unit_test(too_many_modes)};
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failed = run_with_both_elements(tests, set_up, tear_down);
  modal_session_end(&session, SHB_OK);
  return failed;
}
