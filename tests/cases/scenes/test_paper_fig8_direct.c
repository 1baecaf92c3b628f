/* cases/paper_fig8: the linear limits against direct solutions of the full finite-element model.
 *
 * At omega, with K and M of the blade (free dofs), the neighbour coupled by springs and one phase
 * from blade to blade,
 *   (K - omega^2 M + j omega C + B^H diag(kv, ku, ku) B) x = f,   B = D_right - exp(-j phi) D_left
 * D is the mean displacement of a contact face along v, u, w, given by psi and the place of the
 * face. The damping of the case is modal, so C is defined by the modes kept:
 *   C = sum 2 zeta w_i (M phi_i)(M phi_i)^T
 * C is dense. GMRES applies it, preconditioned by a sparse LU of the other terms. Complex numbers
 * are pairs of real ones: A = [Re -Im; Im Re]. */
#include <complex.h>
#include <petscksp.h>
#include <stdlib.h>
#include <string.h>

#include "cases/schema/case.h"
#include "fem/body/assemble.h"
#include "fem/element/surface.h"
#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/eigen/eigen.h"
#include "tests/support/check.h"
#include "tests/support/read_mesh.h"
#include "tests/support/scene.h"

typedef struct {
  int             n_entries; /* nodes of both faces */
  PetscInt       *dof;       /* [n_entries][3] */
  double complex *b[3];      /* v, u, w: [n_entries][3] */
} coupling;

typedef struct {
  case_file   file;
  mesh_fe     mesh;
  fem_system  system;
  modal_eigen eigen;
  Mat         K, M; /* AIJ */
  coupling    spring;
  PetscInt    n; /* real dofs */
  int         probe;
} body;

static char          folder[SCRATCH_PATH];
static mhb_response *response;
static body          whole;

static void ok(PetscErrorCode code) {
  if (code != 0) fail_msg("PETSc error %d", (int)code);
}

/* Rows tangential, axial, radial at a point; the engine axis is x. */
static void axes_at(const double at[3], double axes[3][3]) {
  double r = hypot(at[1], at[2]), z[3] = {0, at[1] / r, at[2] / r}, y[3] = {1, 0, 0};
  for (int d = 0; d < 3; d++) {
    axes[0][d] = y[(d + 1) % 3] * z[(d + 2) % 3] - y[(d + 2) % 3] * z[(d + 1) % 3];
    axes[1][d] = y[d];
    axes[2][d] = z[d];
  }
}

/* Area and centroid of a face of flat parallelograms, and every node's share of the mean. A midside
 * node gets a third of an element's share; each corner subtracts a twelfth. */
static double face_mean(const mesh_fe *mesh, const mesh_face_set *set, double centroid[3],
                        double *share) {
  double area = 0;
  assert_int_equal(mesh->kind, MESH_HEX20);
  memset(centroid, 0, 3 * sizeof *centroid);
  for (int f = 0; f < set->n; f++) {
    const int *node = set->nodes + 8 * f;
    double     x[4][3], c[3];
    for (int i = 0; i < 4; i++) memcpy(x[i], mesh->coordinates + 3 * node[i], sizeof x[i]);
    for (int d = 0; d < 3; d++) {
      int p = (d + 1) % 3, q = (d + 2) % 3;
      c[d] = (x[1][p] - x[0][p]) * (x[3][q] - x[0][q]) - (x[1][q] - x[0][q]) * (x[3][p] - x[0][p]);
      assert_true(fabs(x[0][d] - x[1][d] + x[2][d] - x[3][d]) < 1e-9);
    }
    double a = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    area += a;
    for (int i = 0; i < 4; i++) {
      share[node[i]] -= a / 12;
      share[node[4 + i]] += a / 3;
      for (int d = 0; d < 3; d++) centroid[d] += a / 4 * x[i][d];
    }
  }
  for (int d = 0; d < 3; d++) centroid[d] /= area;
  for (int i = 0; i < mesh->n_nodes; i++) share[i] /= area;
  return area;
}

/* Appends the part of one side to B: factor times the mean displacement along v, u, w. */
static void add_side(body *w, mesh_set_id side, double complex factor) {
  double *share = calloc((size_t)w->mesh.n_nodes, sizeof *share), centroid[3], axes[3][3];
  double  psi   = w->file.mhb.psi;
  face_mean(&w->mesh, &w->mesh.set[side], centroid, share);
  axes_at(centroid, axes);
  for (int i = 0; i < w->mesh.n_nodes; i++) {
    if (share[i] == 0) continue;
    int e = w->spring.n_entries++;
    for (int d = 0; d < 3; d++) {
      double v                  = cos(psi) * axes[0][d] + sin(psi) * axes[1][d];
      double u                  = -sin(psi) * axes[0][d] + cos(psi) * axes[1][d];
      w->spring.dof[3 * e + d]  = 3 * w->system.row[i] + d;
      w->spring.b[0][3 * e + d] = factor * share[i] * v;
      w->spring.b[1][3 * e + d] = factor * share[i] * u;
      w->spring.b[2][3 * e + d] = factor * share[i] * axes[2][d];
    }
  }
  free(share);
}

static void create_coupling(body *w) {
  size_t most   = 3 * (size_t)w->mesh.n_nodes;
  w->spring.dof = malloc(most * sizeof *w->spring.dof);
  for (int c = 0; c < 3; c++) w->spring.b[c] = malloc(most * sizeof *w->spring.b[c]);
  double lag = SHB_TWO_PI * w->file.engine_order / w->file.blades;
  add_side(w, MESH_CONTACT_RIGHT, 1);
  add_side(w, MESH_CONTACT_LEFT, -cexp(-I * lag));
}

static int create_body(void **state) {
  (void)state;
  char                 path[SCRATCH_PATH + 64];
  modal_eigen_settings eigen = {0};
  scratch_create(folder);
  scene_run(folder, SCENE, "case.yaml", "paper_fig8", &response);
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  assert_ok(case_read(path, CASE_MODAL | CASE_MHB, stderr, &whole.file));
  snprintf(path, sizeof path, "%s/paper_fig8.msh", folder);
  assert_ok(read_mesh(path, &whole.mesh));
  assert_ok(mesh_fe_orient(&whole.mesh, whole.file.axis));
  ok(fem_system_create(PETSC_COMM_SELF, &whole.mesh, &whole.file.materials[0].material,
                       FEM_STANDARD, &whole.system));
  ok(MatConvert(whole.system.K, MATSEQAIJ, MAT_INITIAL_MATRIX, &whole.K));
  ok(MatConvert(whole.system.M, MATSEQAIJ, MAT_INITIAL_MATRIX, &whole.M));
  eigen.modes = whole.file.modes;
  ok(modal_eigen_solve(&whole.system, &eigen, &whole.eigen));
  whole.n     = 3 * whole.system.n_free;
  whole.probe = mesh_fe_nearest(&whole.mesh, whole.file.probe[0].at);
  create_coupling(&whole);
  return 0;
}

static int free_body(void **state) {
  (void)state;
  mhb_response_destroy(response);
  case_free(&whole.file);
  mesh_fe_free(&whole.mesh);
  ok(MatDestroy(&whole.K));
  ok(MatDestroy(&whole.M));
  ok(modal_eigen_destroy(&whole.eigen));
  ok(fem_system_destroy(&whole.system));
  free(whole.spring.dof);
  for (int c = 0; c < 3; c++) free(whole.spring.b[c]);
  scratch_remove(folder);
  return 0;
}

/* Rows of K - omega^2 M twice on the diagonal. */
static void add_body(const body *w, double omega, Mat A) {
  Mat S;
  ok(MatDuplicate(w->K, MAT_COPY_VALUES, &S));
  ok(MatAXPY(S, -omega * omega, w->M, DIFFERENT_NONZERO_PATTERN));
  for (PetscInt r = 0; r < w->n; r++) {
    PetscInt           n, twin = r + w->n;
    const PetscInt    *column;
    const PetscScalar *value;
    ok(MatGetRow(S, r, &n, &column, &value));
    PetscInt shifted[n];
    for (PetscInt i = 0; i < n; i++) shifted[i] = column[i] + w->n;
    ok(MatSetValues(A, 1, &r, n, column, value, ADD_VALUES));
    ok(MatSetValues(A, 1, &twin, n, shifted, value, ADD_VALUES));
    ok(MatRestoreRow(S, r, &n, &column, &value));
  }
  ok(MatDestroy(&S));
}

static void add_springs(const body *w, Mat A) {
  const mhb_settings *mhb    = &w->file.mhb;
  const double        k[3]   = {mhb->kv, mhb->ku[0], mhb->ku[2]};
  const coupling     *spring = &w->spring;
  for (int i = 0; i < 3 * spring->n_entries; i++)
    for (int j = 0; j < 3 * spring->n_entries; j++) {
      double complex z = 0;
      for (int c = 0; c < 3; c++) z += k[c] * conj(spring->b[c][i]) * spring->b[c][j];
      const PetscInt rows[2]    = {spring->dof[i], spring->dof[i] + w->n};
      const PetscInt columns[2] = {spring->dof[j], spring->dof[j] + w->n};
      const double   block[4]   = {creal(z), -cimag(z), cimag(z), creal(z)};
      ok(MatSetValues(A, 2, rows, 2, columns, block, ADD_VALUES));
    }
}

static Mat undamped(const body *w, double omega, bool stuck) {
  Mat       A;
  PetscInt *width = malloc(2 * (size_t)w->n * sizeof *width);
  for (PetscInt r = 0; r < w->n; r++) {
    ok(MatGetRow(w->K, r, &width[r], NULL, NULL));
    PetscInt own = width[r];
    ok(MatRestoreRow(w->K, r, &width[r], NULL, NULL));
    width[r] = width[r + w->n] = own;
  }
  for (int i = 0; i < 3 * w->spring.n_entries; i++) {
    width[w->spring.dof[i]] += 6 * w->spring.n_entries;
    width[w->spring.dof[i] + w->n] += 6 * w->spring.n_entries;
  }
  ok(MatCreateSeqAIJ(PETSC_COMM_SELF, 2 * w->n, 2 * w->n, 0, width, &A));
  add_body(w, omega, A);
  if (stuck) add_springs(w, A);
  ok(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  ok(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  free(width);
  return A;
}

/* The undamped matrix, and the matrix with damping. */
typedef struct {
  const body *w;
  double      omega;
  Mat         A;
} damped;

/* y = A x + [-omega C x_im; omega C x_re] */
static PetscErrorCode apply(Mat shell, Vec x, Vec y) {
  damped            *d;
  const PetscScalar *in, *phi;
  PetscScalar       *out;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(shell, &d));
  PetscCall(MatMult(d->A, x, y));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  PetscCall(MatDenseGetArrayRead(d->w->eigen.m_phi, &phi));
  for (int i = 0; i < d->w->eigen.n; i++) {
    const PetscScalar *column = phi + (size_t)d->w->n * (size_t)i;
    double             c  = 2 * d->w->file.damping.ratio * sqrt(d->w->eigen.lambda[i]) * d->omega;
    double             re = 0, im = 0;
    for (PetscInt r = 0; r < d->w->n; r++) {
      re += column[r] * in[r];
      im += column[r] * in[r + d->w->n];
    }
    for (PetscInt r = 0; r < d->w->n; r++) {
      out[r] -= c * im * column[r];
      out[r + d->w->n] += c * re * column[r];
    }
  }
  PetscCall(MatDenseRestoreArrayRead(d->w->eigen.m_phi, &phi));
  PetscCall(VecRestoreArray(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(0);
}

/* The nodal forces of the case's load. */
static Vec load_vector(const body *w, Mat A) {
  Vec     f;
  double *force = malloc(3 * (size_t)w->mesh.n_nodes * sizeof *force);
  assert_ok(fem_load_pattern(&w->mesh, &w->file.loads[0].load, w->file.probe[0].at, force));
  ok(MatCreateVecs(A, &f, NULL));
  for (int i = 0; i < 3 * w->mesh.n_nodes; i++)
    if (w->system.row[i / 3] >= 0)
      ok(VecSetValue(f, 3 * w->system.row[i / 3] + i % 3, force[i], INSERT_VALUES));
  ok(VecAssemblyBegin(f));
  ok(VecAssemblyEnd(f));
  free(force);
  return f;
}

/* Relative motion along v, u, w and the probe's motion, tangential, axial, radial. */
static void outputs(const body *w, Vec x, double complex motion[3], double complex probe[3]) {
  const PetscScalar *value;
  double             axes[3][3];
  ok(VecGetArrayRead(x, &value));
  memset(motion, 0, 3 * sizeof *motion);
  memset(probe, 0, 3 * sizeof *probe);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 3 * w->spring.n_entries; i++) {
      PetscInt r = w->spring.dof[i];
      motion[c] += w->spring.b[c][i] * (value[r] + I * value[r + w->n]);
    }
  axes_at(w->mesh.coordinates + 3 * w->probe, axes);
  for (int a = 0; a < 3; a++)
    for (int d = 0; d < 3; d++) {
      PetscInt r = 3 * w->system.row[w->probe] + d;
      probe[a] += axes[a][d] * (value[r] + I * value[r + w->n]);
    }
  ok(VecRestoreArrayRead(x, &value));
}

static void solve(const body *w, double omega, bool stuck, double complex motion[3],
                  double complex probe[3]) {
  damped d = {w, omega, undamped(w, omega, stuck)};
  Mat    shell;
  KSP    ksp;
  PC     pc;
  Vec    f = load_vector(w, d.A), x;
  ok(VecDuplicate(f, &x));
  ok(MatCreateShell(PETSC_COMM_SELF, 2 * w->n, 2 * w->n, 2 * w->n, 2 * w->n, &d, &shell));
  ok(MatShellSetOperation(shell, MATOP_MULT, (void (*)(void))apply));
  ok(KSPCreate(PETSC_COMM_SELF, &ksp));
  ok(KSPSetType(ksp, KSPGMRES));
  ok(KSPGMRESSetRestart(ksp, 60));
  ok(KSPSetOperators(ksp, shell, d.A));
  ok(KSPGetPC(ksp, &pc));
  ok(PCSetType(pc, PCLU));
  ok(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  ok(KSPSetTolerances(ksp, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 200));
  ok(KSPSolve(ksp, f, x));
  KSPConvergedReason reason;
  ok(KSPGetConvergedReason(ksp, &reason));
  assert_true(reason > 0);
  outputs(w, x, motion, probe);
  ok(KSPDestroy(&ksp));
  ok(MatDestroy(&shell));
  ok(MatDestroy(&d.A));
  ok(VecDestroy(&f));
  ok(VecDestroy(&x));
}

static double distance(const double complex *a, const double complex *b) {
  double off = 0, norm = 0;
  for (int i = 0; i < 3; i++) {
    off += pow(cabs(a[i] - b[i]), 2);
    norm += pow(cabs(b[i]), 2);
  }
  return sqrt(off / norm);
}

static int nearest_point(const mhb_branch *b, double frequency) {
  int best = 0;
  for (int p = 1; p < b->n_points; p++)
    if (fabs(b->frequency[p] - frequency) < fabs(b->frequency[best] - frequency)) best = p;
  return best;
}

/* Frequencies below the first resonance, near the three, between and above them, all below a third
 * of mode 20 (12.2 kHz). On the third stuck resonance the contact's term of omega^4 matters:
 * without it the error is 5e-6. */
static void limit_is_the_direct_solution(bool stuck, int n, const double *frequency,
                                         const double *bound) {
  const mhb_branch *b = scene_branch(response, stuck ? MHB_BRANCH_STUCK : MHB_BRANCH_OPEN, 0);
  const int         K = response->n_harmonics + 1;
  for (int i = 0; i < n; i++) {
    double complex motion[3], probe[3], model_motion[3], model_probe[3];
    int            p = nearest_point(b, frequency[i]);
    for (int c = 0; c < 3; c++) {
      model_motion[c] = b->motion[(3 * p + c) * K + 1];
      model_probe[c]  = b->probe[(3 * p + c) * K + 1];
    }
    solve(&whole, SHB_TWO_PI * b->frequency[p], stuck, motion, probe);
    print_message("%s, %8.3f Hz: contact %.1e, probe %.1e off\n", stuck ? "stuck" : "open",
                  b->frequency[p], distance(model_motion, motion), distance(model_probe, probe));
    assert_true(distance(model_motion, motion) < bound[i]);
    assert_true(distance(model_probe, probe) < bound[i]);
  }
}

static void open_limit(void **state) {
  (void)state;
  /* beside the resonances: on them the direct solution itself loses ten digits to round-off */
  static const double frequency[] = {80, 115.47, 250, 366.48, 432.41, 781};
  static const double bound[]     = {1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6};
  limit_is_the_direct_solution(false, 6, frequency, bound);
}

static void stuck_limit(void **state) {
  (void)state;
  static const double frequency[] = {200, 431.2, 520, 606.2, 1101.7};
  static const double bound[]     = {1e-6, 1e-6, 1e-6, 1e-6, 1e-6};
  limit_is_the_direct_solution(true, 5, frequency, bound);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(open_limit),
      cmocka_unit_test(stuck_limit),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, create_body, free_body);
  modal_session_end(&session, SHB_OK);
  return failures;
}
