/* Displacement and stress at every node from modal amplitudes. They are compared with a direct
 * solution of (K - w^2 M + j w C) u = f on the same mesh, with the contact open or stuck.
 * C = alpha M + beta K.
 * With a mesh file as argument: the figures of that mesh. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/body/stress.h"
#include "mesh/base/constants.h"
#include "mesh/base/progress.h"
#include "mesh/blade/blade.h"
#include "mesh/io/read.h"
#include "mhb/branches/forced_response.h"
#include "mhb/response/modal_motion.h"
#include "mhb/structure/receptance.h"
#include "modal/common/session.h"
#include "modal/condense/load_patterns.h"
#include "modal/stage/solve.h"
#include "tests/support/files.h"
#include "tests/support/odd_blade.h"
#include "tests/support/one_of_each.h"

enum { MODES = 20, HARMONICS = 1 };

static const char  *mesh_path;
static const double alpha = 1.5, beta = 2e-6;

/* A blade, its modes and the stresses of the modes. */
typedef struct {
  mesh_fe        mesh;
  modal_settings settings;
  modal_result   result;
  modal_body    *body;
  double        *shape;           /* [mode][node][3] */
  float         *stress;          /* [mode][node][6] */
  float         *residual_stress; /* [column][node][6] */
} model;

static const shb_provenance from = {"case.yaml", "name: x\n", "", "shroudhb-mesh"};

static void make_mesh(mesh_fe *mesh, int *blades) {
  mesh_names   names = {0};
  mesh_blade   blade = odd_blade();
  char         path[512];
  shb_progress quiet = shb_progress_start("mesh", true, false);
  snprintf(path, sizeof path, "%s", mesh_path ? mesh_path : scratch("blade.msh"));
  blade.elements    = MESH_HEX20;
  blade.size        = 0.03;
  blade.shroud_size = 0;
  *blades           = mesh_path ? 40 : blade.blades;
  if (!mesh_path) assert_ok(mesh_blade_write(&blade, path, &from, &quiet));
  assert_ok(mesh_fe_read(path, &names, mesh));
  assert_ok(mesh_fe_orient(mesh, MESH_AXIS_X));
}

static void make_model(model *m) {
  memset(m, 0, sizeof *m);
  make_mesh(&m->mesh, &m->settings.blades);
  m->settings.axis    = MESH_AXIS_X;
  m->settings.modes   = MODES;
  m->settings.damping = (modal_damping){MODAL_DAMPING_RAYLEIGH, .alpha = alpha, .beta = beta};
  const fem_load load = {
      .kind = FEM_LOAD_PRESSURE, .pressure = 1000, .n_harmonics = 1, .factor = {0, 1}};
  m->settings = one_of_each(m->settings, 1, false, load);
  assert_ok(modal_solve(PETSC_COMM_SELF, &m->mesh, &m->settings, NULL, &m->result));
  const size_t n = (size_t)m->mesh.n_nodes;
  m->shape       = malloc(MODES * 3 * n * sizeof *m->shape);
  m->stress      = malloc(MODES * 6 * n * sizeof *m->stress);
  for (int i = 0; i < MODES; i++) {
    Vec phi;
    assert_int_equal(MatDenseGetColumnVecRead(m->result.eigen.phi, i, &phi), 0);
    assert_int_equal(fem_system_gather(&m->result.system, phi, m->shape + 3 * n * (size_t)i), 0);
    assert_int_equal(MatDenseRestoreColumnVecRead(m->result.eigen.phi, i, &phi), 0);
  }
  assert_ok(modal_body_create(&m->mesh, &m->settings, &m->body));
  fem_nodal_stress_change(&m->body->body, NULL, MODES, m->shape, m->stress);
  const modal_residual_shapes *residual = &m->result.residual;
  assert_int_equal(residual->n, 7);
  m->residual_stress = malloc(7 * 6 * n * sizeof *m->residual_stress);
  fem_nodal_stress_change(&m->body->body, NULL, residual->n, residual->shape, m->residual_stress);
}

static void free_model(model *m) {
  free(m->shape), free(m->stress), free(m->residual_stress), free(m->body);
  modal_result_free(&m->result);
  mesh_fe_free(&m->mesh);
}

static mhb_settings contact(const model *m, double low, double high) {
  return (mhb_settings){.engine_order = 5,
                        .blades       = m->settings.blades,
                        .mu           = 0.3,
                        .kv           = 8e5,
                        .ku           = {5e5, 0, 5e5},
                        .n_preloads   = 1,
                        .n0           = {1e6}, /* stuck throughout */
                        .frequency    = {low, high},
                        .harmonics    = HARMONICS,
                        .subharmonics = 1,
                        .scale        = 1,
                        .tolerance    = 1e-8,
                        .max_points   = 5000,
                        .save         = {.what = MHB_SAVE_ALL},
                        .stability    = MHB_STABILITY_NEVER,
                        .lasting      = MHB_LASTING_NEVER};
}

/* f[node][3] += factor times the nodal forces of a dof. */
static void add_dof(const modal_dofs *dofs, int c, double complex factor, double complex *f) {
  for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++)
    for (int d = 0; d < 3; d++) f[3 * dofs->node[e] + d] += factor * dofs->weight[3 * e + d];
}

static double complex sample(const modal_dofs *dofs, int c, const double complex *u) {
  double complex sum = 0;
  for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++)
    for (int d = 0; d < 3; d++) sum += dofs->weight[3 * e + d] * u[3 * dofs->node[e] + d];
  return sum;
}

/* u[node][3] <- solution of (K - w^2 M + j w C) u = f, as a real system of twice the order. */
static void solve_directly(const fem_system *system, double w, const double complex *f,
                           double complex *u) {
  Mat            K, M, A, D, E, nest, all;
  KSP            ksp;
  PC             pc;
  Vec            x, b;
  double        *value;
  const PetscInt n = 3 * system->n_free;
  assert_int_equal(MatConvert(system->K, MATAIJ, MAT_INITIAL_MATRIX, &K), 0);
  assert_int_equal(MatConvert(system->M, MATAIJ, MAT_INITIAL_MATRIX, &M), 0);
  assert_int_equal(MatDuplicate(K, MAT_COPY_VALUES, &A), 0);
  assert_int_equal(MatAXPY(A, -w * w, M, DIFFERENT_NONZERO_PATTERN), 0);
  assert_int_equal(MatDuplicate(K, MAT_COPY_VALUES, &D), 0);
  assert_int_equal(MatScale(D, w * beta), 0);
  assert_int_equal(MatAXPY(D, w * alpha, M, DIFFERENT_NONZERO_PATTERN), 0);
  assert_int_equal(MatDuplicate(D, MAT_COPY_VALUES, &E), 0);
  assert_int_equal(MatScale(E, -1), 0);
  assert_int_equal(MatCreateNest(PETSC_COMM_SELF, 2, NULL, 2, NULL, (Mat[]){A, E, D, A}, &nest), 0);
  assert_int_equal(MatConvert(nest, MATAIJ, MAT_INITIAL_MATRIX, &all), 0);
  assert_int_equal(MatCreateVecs(all, &x, &b), 0);
  assert_int_equal(VecGetArray(b, &value), 0);
  for (int i = 0; i < system->n_nodes; i++)
    for (int d = 0; d < 3 && system->row[i] >= 0; d++) {
      value[3 * system->row[i] + d]     = creal(f[3 * i + d]);
      value[n + 3 * system->row[i] + d] = cimag(f[3 * i + d]);
    }
  assert_int_equal(VecRestoreArray(b, &value), 0);
  assert_int_equal(KSPCreate(PETSC_COMM_SELF, &ksp), 0);
  assert_int_equal(KSPSetOperators(ksp, all, all), 0);
  assert_int_equal(KSPSetType(ksp, KSPPREONLY), 0);
  assert_int_equal(KSPGetPC(ksp, &pc), 0);
  assert_int_equal(PCSetType(pc, PCLU), 0);
  assert_int_equal(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), 0);
  assert_int_equal(KSPSolve(ksp, b, x), 0);
  assert_int_equal(VecGetArray(x, &value), 0);
  for (int i = 0; i < system->n_nodes; i++)
    for (int d = 0; d < 3; d++)
      u[3 * i + d] = system->row[i] < 0
                         ? 0
                         : CMPLX(value[3 * system->row[i] + d], value[n + 3 * system->row[i] + d]);
  assert_int_equal(VecRestoreArray(x, &value), 0);
  (void)KSPDestroy(&ksp);
  Mat *done[] = {&K, &M, &A, &D, &E, &nest, &all};
  for (size_t i = 0; i < sizeof done / sizeof *done; i++) (void)MatDestroy(done[i]);
  (void)VecDestroy(&x), (void)VecDestroy(&b);
}

/* sigma[node][6] of the displacement u. */
static void stress_of(const model *m, const double complex *u, double complex *sigma) {
  const size_t n      = (size_t)m->mesh.n_nodes;
  double      *parts  = malloc(6 * n * sizeof *parts);
  float       *stress = malloc(12 * n * sizeof *stress);
  for (size_t i = 0; i < 3 * n; i++) parts[i] = creal(u[i]), parts[3 * n + i] = cimag(u[i]);
  fem_nodal_stress_change(&m->body->body, NULL, 2, parts, stress);
  for (size_t i = 0; i < 6 * n; i++) sigma[i] = CMPLX(stress[i], stress[6 * n + i]);
  free(parts), free(stress);
}

/* Largest difference of two complex fields, relative to the largest value of the second. */
static double difference(size_t n, const double complex *a, const double complex *b) {
  double error = 0, most = 0;
  for (size_t i = 0; i < n; i++) {
    error = fmax(error, cabs(a[i] - b[i]));
    most  = fmax(most, cabs(b[i]));
  }
  return error / most;
}

/* Errors of displacement and stress at a kept point of a linear branch, harmonic 1. The direct
 * solution carries the contact force of the response. That force must be the one of the springs
 * under the direct motion: then the coupled system is solved. */
static void compare(const model *m, const mhb_settings *s, const mhb_response *r, int branch,
                    int point, double *of_u, double *of_stress, double *of_modes) {
  const mhb_branch *b = &r->branch[branch];
  const size_t      n = (size_t)m->mesh.n_nodes, K = (size_t)b->n_harmonics + 1;
  mhb_receptance   *receptance;
  modal_dofs        dofs = {0};
  modal_load        load;
  double complex   *f = calloc(3 * n, sizeof *f), *u = calloc(3 * n, sizeof *f);
  double complex   *sum = calloc(3 * n, sizeof *f), *sigma = calloc(6 * n, sizeof *f);
  double complex   *sum_sigma = calloc(6 * n, sizeof *f), x[6], du[3], p[3];
  assert_ok(mhb_receptance_create(&m->result.model, s, HARMONICS, &receptance));
  modal_patches_dofs(&m->result.patches, &dofs);
  assert_ok(modal_load_create(&m->mesh, 1, m->settings.loads, NULL, &load));
  for (int c = 0; c < load.dofs.n; c++) add_dof(&load.dofs, c, load.weight[load.dofs.n + c], f);
  const mhb_relative *t = &receptance->part->relative;
  for (int row = 0; row < 3; row++) {
    p[row] = b->force[((size_t)point * 3 + (size_t)row) * K + 1];
    for (int c = 0; c < 6; c++)
      add_dof(&dofs, c,
              -conj(mhb_relative_weight(t, row, c / 3, c % 3, receptance->phase[1])) * p[row], f);
  }
  solve_directly(&m->result.system, SHB_TWO_PI * b->frequency[point], f, u);
  for (int c = 0; c < 6; c++) x[c] = sample(&dofs, c, u);
  mhb_relative_motion(t, receptance->phase[1], x, 1, du, 1);
  const double k[3] = {s->kv, s->ku[0], s->ku[2]};
  for (int row = 0; row < 3 && b->kind == MHB_BRANCH_STUCK; row++)
    if (cabs(k[row] * du[row] - p[row]) > 1e-4 * cabs(p[0]))
      fail_msg("contact force %d off by %.1e", row, cabs(k[row] * du[row] / p[row] - 1));
  stress_of(m, u, sigma);
  for (size_t i = 0; i < MODES; i++) {
    double complex q = b->modal.amplitude[((size_t)point * K + 1) * MODES + i];
    for (size_t a = 0; a < 3 * n; a++) sum[a] += q * m->shape[3 * n * i + a];
    for (size_t a = 0; a < 6 * n; a++) sum_sigma[a] += q * m->stress[6 * n * i + a];
  }
  *of_modes = difference(6 * n, sum_sigma, sigma);
  /* what the modes leave out */
  const modal_residual_shapes *residual = &m->result.residual;
  for (size_t c = 0; c < (size_t)residual->n; c++) {
    const size_t   contact = (size_t)residual->n_contact, patterns = (size_t)residual->n - contact;
    double complex by = c < contact
                            ? b->modal.force[((size_t)point * K + 1) * contact + c]
                            : b->modal.scale[point] * residual->load_weight[patterns + c - contact];
    for (size_t a = 0; a < 3 * n; a++) sum[a] += by * residual->shape[3 * n * c + a];
    for (size_t a = 0; a < 6 * n; a++) sum_sigma[a] += by * m->residual_stress[6 * n * c + a];
  }
  *of_u      = difference(3 * n, sum, u);
  *of_stress = difference(6 * n, sum_sigma, sigma);
  free(f), free(u), free(sum), free(sigma), free(sum_sigma);
  modal_dofs_free(&dofs);
  modal_load_free(&load);
  mhb_receptance_destroy(receptance);
}

static int highest(const mhb_response *r, int branch) {
  int at = 0;
  for (int i = 0; i < r->branch[branch].n_points; i++)
    if (mhb_response_output(r, &r->branch[branch], i) >
        mhb_response_output(r, &r->branch[branch], at))
      at = i;
  return at;
}

static void sum_over_modes_agrees(void **state) {
  (void)state;
  model m;
  make_model(&m);
  const double *hz = m.result.model.frequency;
  mhb_settings  s  = contact(&m, 0.7 * hz[0], 1.2 * hz[1]);
  mhb_response *r;
  if (mhb_forced_response(&m.result.model, &s, NULL, NULL, NULL, &r) != SHB_OK)
    fail_msg("%s", shb_message());
  for (int branch = 0; branch < 2; branch++) {
    const mhb_branch *b    = &r->branch[branch];
    const int         at[] = {0, highest(r, branch), b->n_points / 2, b->n_points - 1};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
      double of_u, of_stress, of_modes;
      compare(&m, &s, r, branch, at[i], &of_u, &of_stress, &of_modes);
      print_message(
          "%d nodes, %s, %8.3f Hz%s: displacement off by %.1e, stress %.1e (modes alone %.1e)\n",
          m.mesh.n_nodes, branch ? "stuck" : "open", b->frequency[at[i]], i == 1 ? ", highest" : "",
          of_u, of_stress, of_modes);
      assert_true(of_stress < 1e-3);
    }
  }
  mhb_response_destroy(r);
  free_model(&m);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sum_over_modes_agrees)};
  modal_session           session;
  int                     none = 1;
  if (argc > 1) mesh_path = argv[1];
  if (modal_session_start(&none, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, scratch_make, scratch_remove);
  modal_session_end(&session, SHB_OK);
  return failures;
}
