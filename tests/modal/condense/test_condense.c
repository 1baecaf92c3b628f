/* The condensed model against direct solutions of the whole body. */
#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element/surface.h"
#include "mesh/base/constants.h"
#include "modal/common/session.h"
#include "modal/model/receptance.h"
#include "modal/model/reduce.h"
#include "modal/stage/stage.h"
#include "tests/support/fem.h"
#include "tests/support/one_of_each.h"

enum { BLADES = 23 };

static const double      size[3] = {0.04, 1, 0.12}, inner = 0.1, zeta = 0.003;
static const modal_probe probe[2] = {{"tip", {0.04, 0.0, 0.22}}, {"middle", {0, 0.01, 0.16}}};

static modal_settings default_settings(int points) {
  const modal_settings own  = {.axis     = MESH_AXIS_X,
                               .blades   = BLADES,
                               .modes    = 20,
                               .damping  = {.ratio = zeta},
                               .n_probes = 2,
                               .probe    = probe};
  const fem_load       load = {.kind        = FEM_LOAD_PRESSURE,
                               .pressure    = 2385,
                               .n_harmonics = 2,
                               .factor      = {0.3, 1, -0.2 + 0.1 * I}};
  return one_of_each(own, points, false, load);
}

static modal_result solve(const mesh_fe *mesh, const modal_settings *settings) {
  modal_result result;
  if (modal_solve(PETSC_COMM_SELF, mesh, settings, NULL, &result) != SHB_OK)
    fail_msg("%s", shb_message());
  return result;
}

/* The whole matrix as a dense array, by columns. */
static double *dense_of(Mat A, int n) {
  double *full = malloc((size_t)n * (size_t)n * sizeof *full);
  Vec     unit, column;
  assert_int_equal(MatCreateVecs(A, &unit, &column), 0);
  for (int j = 0; j < n; j++) {
    const PetscScalar *value;
    assert_int_equal(VecZeroEntries(unit), 0);
    assert_int_equal(VecSetValue(unit, j, 1, INSERT_VALUES), 0);
    assert_int_equal(VecAssemblyBegin(unit), 0);
    assert_int_equal(VecAssemblyEnd(unit), 0);
    assert_int_equal(MatMult(A, unit, column), 0);
    assert_int_equal(VecGetArrayRead(column, &value), 0);
    memcpy(full + (size_t)n * (size_t)j, value, (size_t)n * sizeof *full);
    assert_int_equal(VecRestoreArrayRead(column, &value), 0);
  }
  VecDestroy(&unit);
  VecDestroy(&column);
  return full;
}

/* All matrices of the body as dense arrays for the reference solution. Column-major. */
typedef struct {
  int     n, n_dofs; /* order, condensed dofs (contact, probes, load) */
  double *K, *M, *C, *B;
} body;

/* C = sum 2 zeta w_i M phi phi^T M: kept modes are damped, the others are not. */
static double *damping_matrix(const modal_eigen *eigen, int n) {
  double            *C = calloc((size_t)n * (size_t)n, sizeof *C);
  const PetscScalar *m_phi;
  assert_int_equal(MatDenseGetArrayRead(eigen->m_phi, &m_phi), 0);
  for (int i = 0; i < eigen->n; i++) {
    const double *v = m_phi + (size_t)i * (size_t)n, c = 2 * zeta * sqrt(eigen->lambda[i]);
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++) C[(size_t)a * (size_t)n + (size_t)b] += c * v[a] * v[b];
  }
  assert_int_equal(MatDenseRestoreArrayRead(eigen->m_phi, &m_phi), 0);
  return C;
}

/* b_c from the patches, the probes and the load's own nodal forces. */
static double *condensed_dofs(const mesh_fe *mesh, const modal_settings *settings,
                              const modal_result *result, int n, int n_dofs) {
  double              *B    = calloc((size_t)n * (size_t)n_dofs, sizeof *B);
  const modal_patches *face = &result->patches;
  const PetscInt      *row  = result->system.row;
  int                  c    = 0;
  for (int side = 0; side <= (int)face->has_left; side++)
    for (int p = 0; p < face->n_pairs; p++)
      for (int a = 0; a < 3; a++, c++)
        for (int e = face->start[p]; e < face->start[p + 1]; e++) {
          PetscInt r = row[face->node[side][e]];
          for (int d = 0; d < 3 && r >= 0; d++)
            B[(size_t)n * (size_t)c + (size_t)(3 * r + d)] +=
                face->weight[e] * face->axes[side][p][a][d];
        }
  for (int q = 0; q < settings->n_probes; q++) {
    double axes[3][3];
    int    node = mesh_fe_nearest(mesh, settings->probe[q].at);
    mesh_axes_at(settings->axis, mesh->coordinates + 3 * node, axes);
    for (int a = 0; a < 3; a++, c++)
      for (int d = 0; d < 3; d++)
        B[(size_t)n * (size_t)c + (size_t)(3 * row[node] + d)] = axes[a][d];
  }
  double *force = malloc(3 * (size_t)mesh->n_nodes * sizeof *force);
  assert_int_equal(fem_load_pattern(mesh, settings->loads, NULL, force), SHB_OK);
  for (int i = 0; i < mesh->n_nodes; i++)
    for (int d = 0; d < 3 && row[i] >= 0; d++)
      B[(size_t)n * (size_t)c + (size_t)(3 * row[i] + d)] = force[3 * i + d];
  free(force);
  assert_int_equal(c + 1, n_dofs);
  return B;
}

static body create_body(const mesh_fe *mesh, const modal_settings *settings,
                        const modal_result *result) {
  int contact = 3 * result->model.n_pairs * (result->model.has_left ? 2 : 1);
  int n = (int)(3 * result->system.n_free), n_dofs = contact + 3 * settings->n_probes + 1;
  return (body){n,
                n_dofs,
                dense_of(result->system.K, n),
                dense_of(result->system.M, n),
                damping_matrix(&result->eigen, n),
                condensed_dofs(mesh, settings, result, n, n_dofs)};
}

static void free_body(body *b) {
  free(b->K);
  free(b->M);
  free(b->C);
  free(b->B);
}

/* B^T (K - w^2 M + j w C)^-1 B, [n_dofs][n_dofs]; free with free. */
static double complex *direct(const body *b, double omega) {
  const size_t    n = (size_t)b->n, m = (size_t)b->n_dofs;
  double complex *A = malloc(n * n * sizeof *A), *X = malloc(n * m * sizeof *X);
  double complex *r     = calloc(m * m, sizeof *r);
  lapack_int     *pivot = malloc(n * sizeof *pivot);
  for (size_t i = 0; i < n * n; i++) A[i] = b->K[i] - omega * omega * b->M[i] + I * omega * b->C[i];
  for (size_t i = 0; i < n * m; i++) X[i] = b->B[i];
  assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, b->n, b->n_dofs, A, b->n, pivot, X, b->n), 0);
  for (size_t p = 0; p < m; p++)
    for (size_t l = 0; l < m; l++)
      for (size_t i = 0; i < n; i++) r[p * m + l] += b->B[n * p + i] * X[n * l + i];
  free(A);
  free(X);
  free(pivot);
  return r;
}

/* Relative Frobenius distance of the leading nc x nc block. */
static double distance(const double complex *a, const double complex *b, int nc, int stride) {
  double off = 0, norm = 0;
  for (int p = 0; p < nc; p++)
    for (int l = 0; l < nc; l++) {
      double complex x = a[p * nc + l], y = b[p * stride + l];
      off += creal((x - y) * conj(x - y));
      norm += creal(y * conj(y));
    }
  return sqrt(off / norm);
}

/* Below the first mode, between the second and the third, and near the third. */
static void check_receptance(double speed) {
  const int      cells[3] = {2, 2, 4};
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings settings = default_settings(2);
  settings.speed          = speed;
  modal_result  result    = solve(&mesh, &settings);
  body          whole     = create_body(&mesh, &settings, &result);
  const double *f         = result.model.frequency;
  const double  test[3]   = {0.4 * f[0], (f[1] + f[2]) / 2, 1.01 * f[2]};
  const int     nc        = 12;
  for (int i = 0; i < 3; i++) {
    double complex *exact = direct(&whole, SHB_TWO_PI * test[i]);
    double complex  model[12 * 12], plain[12 * 12];
    modal_receptance(&result.model, SHB_TWO_PI * test[i], model);
    modal_model bare          = result.model;
    bare.residual_flexibility = bare.residual_inertia = bare.residual_fourth = NULL;
    modal_receptance(&bare, SHB_TWO_PI * test[i], plain);
    print_message("%.0f Hz (modes 1 and 20: %.0f, %.0f): error %.2e, modes alone %.2e\n", test[i],
                  f[0], f[19], distance(model, exact, nc, whole.n_dofs),
                  distance(plain, exact, nc, whole.n_dofs));
    check_below(distance(model, exact, nc, whole.n_dofs), 1e-8, "receptance");
    free(exact);
  }
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

static void receptance_matches_a_direct_solve(void **state) {
  (void)state;
  check_receptance(0);
}

/* At speed every part uses the tangent stiffness of the equilibrium, which is K of the whole
 * body. */
static void receptance_at_speed_matches_a_direct_solve(void **state) {
  (void)state;
  check_receptance(6000);
}

/* Condensed dofs in the order of body: contact, probes, load (harmonic 1, factor 1). */
enum { NC = 12, NQ = 6, LOAD = NC + NQ };

static double shape_at(const modal_model *model, int dof, int mode) {
  const int m = model->n_modes;
  if (dof == LOAD) return creal(model->modal_force[m + mode]);
  if (dof >= NC) return model->probe[(dof - NC) * m + mode];
  return dof < NC / 2 ? model->right[dof * m + mode] : model->left[(dof - NC / 2) * m + mode];
}

static double residual_shape_at(const modal_model *model, int dof, int i) {
  const int r = model->n_residual;
  if (dof == LOAD) return creal(model->residual_force[r + i]);
  return dof < NC ? model->residual_shape[dof * r + i] : model->residual_probe[(dof - NC) * r + i];
}

/* Contribution of the residual modes beyond the three terms. */
static double by_modes(const modal_model *model, double w2, int to, int by) {
  double sum = 0;
  for (int i = 0; i < model->n_residual; i++) {
    double theta = pow(SHB_TWO_PI * model->residual_frequency[i], 2);
    sum += residual_shape_at(model, to, i) * residual_shape_at(model, by, i) * pow(w2 / theta, 3) /
           (theta - w2);
  }
  return sum;
}

/* Contribution of the modes left out at dof to (contact, probe) under a force at by (contact,
 * load). terms: 1 static, 2 with inertia, 3 with the term of w^4, 4 with residual modes. */
static double left_out(const modal_model *model, double omega, int to, int by, int terms) {
  const int q    = to - NC;
  double    x[3] = {0, 0, 0}, w2 = omega * omega;
  if (to < NC && by < NC) {
    x[0] = model->residual_flexibility[to * NC + by];
    x[1] = model->residual_inertia[to * NC + by];
    x[2] = model->residual_fourth[to * NC + by];
  } else if (by < NC) {
    x[0] = model->probe_contact_residual[q * NC + by];
    x[1] = model->probe_contact_inertia[q * NC + by];
    x[2] = model->probe_contact_fourth[q * NC + by];
  } else if (to < NC) {
    x[0] = creal(model->load_residual[NC + to]);
    x[1] = creal(model->load_inertia[NC + to]);
    x[2] = creal(model->load_fourth[NC + to]);
  } else {
    x[0] = creal(model->probe_load_residual[NQ + q]);
    x[1] = creal(model->probe_load_inertia[NQ + q]);
    x[2] = creal(model->probe_load_fourth[NQ + q]);
  }
  return x[0] + (terms > 1 ? w2 * x[1] : 0) + (terms > 2 ? w2 * w2 * x[2] : 0) +
         (terms > 3 ? by_modes(model, w2, to, by) : 0);
}

/* Ranges of loaded and of observed dofs, [first, end). */
typedef struct {
  const char *name;
  int         to, to_end, by, by_end;
} way;

static const way ways[4] = {{"contact to contact", 0, NC, 0, NC},
                            {"load to contact", 0, NC, LOAD, LOAD + 1},
                            {"contact to probe", NC, LOAD, 0, NC},
                            {"load to probe", NC, LOAD, LOAD, LOAD + 1}};

/* Frobenius distance of the model from the direct solution; length: norm of the latter. */
static double error_of(const modal_model *model, double omega, const way *w, int terms,
                       const double complex *exact, double *length) {
  double off = 0, norm = 0;
  for (int to = w->to; to < w->to_end; to++)
    for (int by = w->by; by < w->by_end; by++) {
      double complex u      = left_out(model, omega, to, by, terms),
                     wanted = exact[to * (LOAD + 1) + by];
      for (int i = 0; i < model->n_modes; i++) {
        double wi = SHB_TWO_PI * model->frequency[i];
        u += shape_at(model, to, i) * shape_at(model, by, i) /
             (wi * wi - omega * omega + 2 * I * zeta * wi * omega);
      }
      off += pow(cabs(u - wanted), 2);
      norm += pow(cabs(wanted), 2);
    }
  *length = sqrt(norm);
  return sqrt(off);
}

/* The modes left out form a series in w^2. The first missing term gives the order of the error in
 * w: 2 with the static term, 4 with inertia, 6 with the third term. This holds from contact and
 * load to contact and probes. */
static void every_receptance_errs_by_the_first_term_left_out(void **state) {
  (void)state;
  const int      cells[3] = {2, 2, 4};
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings settings = default_settings(2);
  modal_result   result   = solve(&mesh, &settings);
  body           whole    = create_body(&mesh, &settings, &result);
  const double   omega    = SHB_TWO_PI * result.model.frequency[19] / 5;
  assert_int_equal(whole.n_dofs, LOAD + 1);
  double complex *exact = direct(&whole, omega), *half = direct(&whole, omega / 2);
  for (int w = 0; w < 4; w++)
    for (int terms = 1; terms <= 3; terms++) {
      double norm, error = error_of(&result.model, omega, &ways[w], terms, exact, &norm);
      double less, least = error_of(&result.model, omega / 2, &ways[w], terms, half, &less);
      double order = log2(error / least);
      print_message("%s, %d term(s), %.0f Hz: error %.1e, order %.3f\n", ways[w].name, terms,
                    omega / SHB_TWO_PI, error / norm, order);
      assert_true(fabs(order - 2 * terms) < 0.1);
      if (terms > 1) check_below(error / norm, 1e-4, ways[w].name);
    }
  free(exact);
  free(half);
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* Residual modes are built from the columns of contact, load and probes. At a third of the last
 * kept mode they make all receptances accurate to 1e-10, with an error of order 12 in omega. That
 * is twice the order of the three terms. */
static void residual_modes_double_the_order(void **state) {
  (void)state;
  const int           cells[3] = {2, 2, 4};
  mesh_fe             mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings      settings = default_settings(2);
  modal_result        result   = solve(&mesh, &settings);
  body                whole    = create_body(&mesh, &settings, &result);
  const double        top      = SHB_TWO_PI * result.model.frequency[19];
  static const double allowed = 1e-10, order_of = 12;
  static const double share[3] = {1. / 3, 0.4, 0.32};
  double complex     *exact[3];
  for (int i = 0; i < 3; i++) exact[i] = direct(&whole, share[i] * top);
  for (int w = 0; w < 4; w++) {
    double norm[3], error[3];
    for (int i = 0; i < 3; i++)
      error[i] = error_of(&result.model, share[i] * top, &ways[w], 4, exact[i], &norm[i]);
    double order = log(error[1] / error[2]) / log(share[1] / share[2]);
    print_message("%s, a third of the last of 20 modes: error %.1e, order %.1f\n", ways[w].name,
                  error[0] / norm[0], order);
    check_below(error[0] / norm[0], allowed, ways[w].name);
    assert_true(order > order_of - 0.5);
  }
  double complex model[NC * NC];
  modal_receptance(&result.model, top / 3, model);
  check_below(distance(model, exact[0], NC, LOAD + 1), 1e-10, "modal_receptance");
  for (int i = 0; i < 3; i++) free(exact[i]);
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* Above the limit of columns there are no residual modes, and the tail estimates the error of the
 * terms. */
static void many_contact_dofs_have_three_terms(void **state) {
  (void)state;
  const int      cells[3]   = {2, 3, 6};
  mesh_fe        mesh       = make_sector(size, inner, BLADES, cells);
  modal_settings settings   = default_settings(0);
  settings.modes            = 12;
  modal_result       result = solve(&mesh, &settings);
  const modal_model *model  = &result.model;
  const int          n      = 6 * model->n_pairs;
  const double       omega  = SHB_TWO_PI * model->frequency[11] / 3;
  double complex    *R      = malloc((size_t)n * (size_t)n * sizeof *R);
  assert_true(n > 96);
  assert_int_equal(model->n_residual, 0);
  assert_int_equal(model->tail_order, 3);
  body            whole = create_body(&mesh, &settings, &result);
  double complex *exact = direct(&whole, omega);
  modal_receptance(model, omega, R);
  double worst = 0, most = 0, estimate = modal_receptance_error(model, omega, R);
  for (int c = 0; c < n; c++) {
    worst = fmax(worst, cabs(R[c * n + c] - exact[c * whole.n_dofs + c]));
    most  = fmax(most, cabs(exact[c * whole.n_dofs + c]));
  }
  print_message("%d contact dofs, a third of the last of 12 modes: error %.1e, estimate %.1e\n", n,
                worst / most, estimate);
  assert_true(estimate > worst / most / 3 && estimate < 3 * worst / most);
  free(R);
  free(exact);
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* X -= phi phi^T M X for m columns. */
static void project_out(const modal_eigen *eigen, int n, int m, double *X) {
  const PetscScalar *phi, *m_phi;
  double            *share = malloc((size_t)eigen->n * (size_t)m * sizeof *share);
  assert_int_equal(MatDenseGetArrayRead(eigen->phi, &phi), 0);
  assert_int_equal(MatDenseGetArrayRead(eigen->m_phi, &m_phi), 0);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, eigen->n, m, n, 1, m_phi, n, X, n, 0, share,
              eigen->n);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, m, eigen->n, -1, phi, n, share,
              eigen->n, 1, X, n);
  assert_int_equal(MatDenseRestoreArrayRead(eigen->m_phi, &m_phi), 0);
  assert_int_equal(MatDenseRestoreArrayRead(eigen->phi, &phi), 0);
  free(share);
}

/* Greatest difference from B^T X over the first nc dofs, relative to the greatest entry of that. */
static double term_error(const body *b, int nc, const double *X, const double *term, double *most) {
  const size_t count = (size_t)nc * (size_t)nc;
  double      *exact = malloc(count * sizeof *exact), off = 0;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, nc, nc, b->n, 1, b->B, b->n, X, b->n, 0,
              exact, nc);
  *most = 0;
  for (size_t i = 0; i < count; i++) {
    off   = fmax(off, fabs(exact[i] - term[i]));
    *most = fmax(*most, fabs(exact[i]));
  }
  free(exact);
  return off / *most;
}

/* Errors of R, R2, s^2 R3 and of the tail; s belongs to a third of the last mode's frequency. */
static void errors_of_many(const mesh_fe *mesh, int modes, double error[4]) {
  modal_settings settings   = default_settings(0);
  settings.modes            = modes;
  modal_result       result = solve(mesh, &settings);
  const modal_model *model  = &result.model;
  body               whole  = create_body(mesh, &settings, &result);
  const int          n = whole.n, nc = 6 * model->n_pairs;
  const size_t       bytes = (size_t)n * (size_t)nc * sizeof(double);
  const double       s     = result.eigen.lambda[modes - 1] / 9;
  double            *X = malloc(bytes), *MX = malloc(bytes), most[3], most_tail = 0;
  const double      *term[3] = {model->residual_flexibility, model->residual_inertia,
                                model->residual_fourth};
  assert_true(nc > 96);
  assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, whole.K, n), 0);
  memcpy(MX, whole.B, bytes);
  for (int t = 0; t < 4; t++) {
    memcpy(X, MX, bytes);
    LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, nc, whole.K, n, X, n);
    project_out(&result.eigen, n, nc, X);
    if (t < 3) error[t] = term_error(&whole, nc, X, term[t], &most[t]);
    cblas_dsymm(CblasColMajor, CblasLeft, CblasLower, n, nc, 1, whole.M, n, X, n, 0, MX, n);
  }
  error[2] *= s * s * most[2] / most[0];
  error[3] = 0;
  for (size_t c = 0; c < (size_t)nc; c++) {
    const double exact = cblas_ddot(n, X + (size_t)n * c, 1, whole.B + (size_t)n * c, 1);
    error[3]           = fmax(error[3], fabs(exact - model->contact_tail[2 * c]));
    most_tail          = fmax(most_tail, exact);
  }
  error[3] /= most_tail;
  print_message("%d contact dofs, %d modes: R %.1e, R2 %.1e, s^2 R3 %.1e of R, tail %.1e\n", nc,
                modes, error[0], error[1], error[2], error[3]);
  free(X);
  free(MX);
  free_body(&whole);
  modal_result_free(&result);
}

/* Of more contact dofs than fit into one batch, R and R2 are those of the whole body. Eighty of
 * them hold R3 and the tail well enough at the frequencies of two modes, not at those of twelve. */
static void terms_of_many_contact_dofs_are_those_of_the_body(void **state) {
  (void)state;
  const int cells[3] = {2, 3, 6};
  mesh_fe   mesh     = make_sector(size, inner, BLADES, cells);
  double    few[4], many[4];
  errors_of_many(&mesh, 2, few);
  errors_of_many(&mesh, 12, many);
  check_below(fmax(few[0], many[0]), 1e-11, "R");
  check_below(fmax(few[1], many[1]), 1e-10, "R2");
  check_below(few[2], 1e-8, "R3 from eighty dofs");
  check_below(few[3], 1e-3, "tail from eighty dofs");
  check_below(many[2], 1e-10, "R3 from all");
  check_below(many[3], 1e-9, "tail from all");
  mesh_fe_free(&mesh);
}

/* Largest error of a contact dof with itself, relative to the largest such receptance. */
static double worst_error(const double complex *model, const double complex *exact) {
  double off = 0, most = 0;
  for (int c = 0; c < NC; c++) {
    off  = fmax(off, cabs(model[c * NC + c] - exact[c * (LOAD + 1) + c]));
    most = fmax(most, cabs(exact[c * (LOAD + 1) + c]));
  }
  return off / most;
}

/* The error estimate against direct solutions without damping, from low frequencies to just below
 * the modes left out, for few and many modes. No entry of the matrix exceeds the estimate. */
static void error_is_estimated(void **state) {
  (void)state;
  static const double share[]  = {0.1, 0.2, 1. / 3, 0.5, 0.7, 0.85};
  const int           cells[3] = {2, 2, 4};
  mesh_fe             mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings      settings = default_settings(2);
  modal_result        result   = solve(&mesh, &settings);
  body                whole    = create_body(&mesh, &settings, &result);
  double              frequency[20], low = INFINITY, high = 0;
  memset(whole.C, 0, (size_t)whole.n * (size_t)whole.n * sizeof *whole.C);
  for (int i = 0; i < result.model.n_modes; i++) result.model.damping_ratio[i] = 0;
  memcpy(frequency, result.model.frequency, sizeof frequency);
  for (int modes = 20; modes > 2; modes -= 5) {
    assert_int_equal(modal_model_reduce(&result.model, modes, true), SHB_OK);
    double top = frequency[modes < 20 ? modes : 19]; /* first mode left out */
    for (int i = 0; i < 6; i++) {
      double         omega = SHB_TWO_PI * share[i] * top;
      double complex model[NC * NC], *exact = direct(&whole, omega);
      modal_receptance(&result.model, omega, model);
      double estimate = modal_receptance_error(&result.model, omega, model);
      double error    = worst_error(model, exact);
      print_message("%d modes, %.2f of %.0f Hz: error %.2e, estimate %.2e\n", modes, share[i], top,
                    error, estimate);
      free(exact);
      if (error < 1e-11) continue; /* rounding of the direct solve */
      low  = fmin(low, estimate / error);
      high = fmax(high, estimate / error);
    }
  }
  print_message("estimate over error: %.3f to %.3f\n", low, high);
  assert_true(low > 1. / 3 && high < 3);
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

/* Largest error over the band, against direct solutions without damping. */
static double worst_in_band(modal_model *model, const body *whole, double band) {
  double worst = 0;
  for (int i = 1; i <= 10; i++) {
    double         omega = SHB_TWO_PI * band * i / 10;
    double complex found[NC * NC], *exact = direct(whole, omega);
    modal_receptance(model, omega, found);
    worst = fmax(worst, worst_error(found, exact));
    free(exact);
  }
  return worst;
}

/* modal.modes: auto keeps exactly the modes that tolerance and band need. */
static void modes_are_just_enough(void **state) {
  (void)state;
  const int      cells[3] = {2, 2, 4};
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings settings = default_settings(2);
  settings.modes          = 0;
  settings.band           = 26000;
  int before              = 0;
  for (int k = 0; k < 2; k++) {
    settings.tolerance  = k ? 1e-9 : 1e-4;
    modal_result result = solve(&mesh, &settings);
    body         whole  = create_body(&mesh, &settings, &result);
    const int    n      = result.model.n_modes;
    memset(whole.C, 0, (size_t)whole.n * (size_t)whole.n * sizeof *whole.C);
    for (int i = 0; i < n; i++) result.model.damping_ratio[i] = 0;
    double error = worst_in_band(&result.model, &whole, settings.band);
    assert_int_equal(modal_model_reduce(&result.model, n - 1, true), SHB_OK);
    double fewer = worst_in_band(&result.model, &whole, settings.band);
    print_message("tolerance %.0e: %d modes err by %.1e, one less by %.1e\n", settings.tolerance, n,
                  error, fewer);
    assert_true(n > before);
    check_below(error, 1.1 * settings.tolerance, "error in the band");
    assert_true(fewer > 0.9 * settings.tolerance);
    before = n;
    free_body(&whole);
    modal_result_free(&result);
  }
  mesh_fe_free(&mesh);
}

/* At w = 0 every part is exact: contact, load and probes. */
static void check_static_response(double speed) {
  const int      cells[3] = {2, 2, 4}, nc = 12;
  mesh_fe        mesh       = make_sector(size, inner, BLADES, cells);
  modal_settings settings   = default_settings(2);
  settings.speed            = speed;
  modal_result       result = solve(&mesh, &settings);
  const modal_model *model  = &result.model;
  body               whole  = create_body(&mesh, &settings, &result);
  double complex    *exact  = direct(&whole, 0), contact[12 * 12];
  const int          m = model->n_modes, load = whole.n_dofs - 1;
  modal_receptance(model, 0, contact);
  check_below(distance(contact, exact, nc, whole.n_dofs), 1e-10, "static receptance");
  for (int k = 0; k <= 2; k++)
    for (int c = 0; c < nc; c++) {
      const double  *shape = c < 6 ? model->right + c * m : model->left + (c - 6) * m;
      double complex u     = model->load_residual[k * nc + c];
      for (int i = 0; i < m; i++)
        u += shape[i] * model->modal_force[k * m + i] / pow(SHB_TWO_PI * model->frequency[i], 2);
      double complex wanted = settings.loads->factor[k] * exact[c * whole.n_dofs + load];
      check_below(cabs(u - wanted), 1e-9 * cabs(exact[2 * whole.n_dofs + load]), "contact, load");
    }
  for (int q = 0; q < 6; q++) {
    double complex u = model->probe_load_residual[6 + q];
    for (int i = 0; i < m; i++)
      u += model->probe[q * m + i] * model->modal_force[m + i] /
           pow(SHB_TWO_PI * model->frequency[i], 2);
    check_below(cabs(u - exact[(nc + q) * whole.n_dofs + load]),
                1e-9 * cabs(exact[(nc + 2) * whole.n_dofs + load]), "probe, load");
    for (int c = 0; c < nc; c++) {
      const double *shape = c < 6 ? model->right + c * m : model->left + (c - 6) * m;
      u                   = model->probe_contact_residual[q * nc + c];
      for (int i = 0; i < m; i++)
        u += model->probe[q * m + i] * shape[i] / pow(SHB_TWO_PI * model->frequency[i], 2);
      check_below(cabs(u - exact[(nc + q) * whole.n_dofs + c]),
                  1e-9 * cabs(exact[nc * whole.n_dofs]), "probe, contact");
    }
  }
  free(exact);
  free_body(&whole);
  modal_result_free(&result);
  mesh_fe_free(&mesh);
}

static void static_response_is_exact(void **state) {
  (void)state;
  check_static_response(0);
  check_static_response(6000);
}

/* Patches divide the same face: the area-weighted mean of their flexibilities is that of the
 * face. */
static void patches_add_up_to_the_face(void **state) {
  (void)state;
  const int cells[3] = {2, 2, 4}, points[3] = {4, 7, 0};
  mesh_fe   mesh     = make_sector(size, inner, BLADES, cells);
  double    whole[3] = {0};
  for (int i = -1; i < 3; i++) {
    modal_settings     settings = default_settings(i < 0 ? 1 : points[i]);
    modal_result       result   = solve(&mesh, &settings);
    const modal_model *model    = &result.model;
    const int          m        = model->n_modes;
    /* mean tangential, axial and radial motion in mode 1: all axes of one face are parallel */
    for (int a = 0; a < 3; a++) {
      double mean = 0;
      for (int p = 0; p < model->n_pairs; p++)
        mean += model->area[p] / result.patches.total_area * model->right[(3 * p + a) * m];
      if (i < 0)
        whole[a] = mean;
      else
        check_close(mean, whole[a], 1e-8, "mean motion of the face");
    }
    modal_result_free(&result);
  }
  mesh_fe_free(&mesh);
}

/* The flexibility under a load spread over the face converges with the mesh. The order is not that
 * of smooth solutions, since the face ends at the singular clamped edge. */
static void receptance_converges_with_the_mesh(void **state) {
  (void)state;
  double flexibility[4];
  for (int level = 0; level < 4; level++) {
    const int      n        = 1 << level;
    const int      cells[3] = {n, n, 2 * n};
    mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
    modal_settings settings = default_settings(1);
    double complex r[36];
    modal_result   result = solve(&mesh, &settings);
    modal_receptance(&result.model, 0.5 * SHB_TWO_PI * result.model.frequency[0], r);
    flexibility[level] = cabs(r[0]);
    modal_result_free(&result);
    mesh_fe_free(&mesh);
  }
  double change[3];
  for (int i = 0; i < 3; i++) change[i] = fabs(flexibility[i + 1] / flexibility[i] - 1);
  print_message("receptance of the face, change from mesh to mesh: %.2e %.2e %.2e\n", change[0],
                change[1], change[2]);
  assert_true(change[1] < change[0] / 2 && change[2] < change[1] / 2);
  check_below(change[2], 2e-2, "last change");
}

static double relative_change(const double *a, const double *b, int n) {
  double off = 0, norm = 0;
  for (int i = 0; i < n; i++) {
    off += (a[i] - b[i]) * (a[i] - b[i]);
    norm += b[i] * b[i];
  }
  return sqrt(off / norm);
}

/* A speed of 0.001 rad/s equals rest, through the equilibrium solver. At 6000 rad/s the blade is
 * stiffer in flap and, by Omega^2, softer in the plane of rotation. */
static void speed_leads_back_to_rest(void **state) {
  (void)state;
  const int      cells[3] = {2, 2, 4};
  mesh_fe        mesh     = make_sector(size, inner, BLADES, cells);
  modal_settings settings = default_settings(2);
  modal_result   rest     = solve(&mesh, &settings);
  settings.speed          = 1e-3;
  modal_result slow       = solve(&mesh, &settings);
  settings.speed          = 6000;
  modal_result       fast = solve(&mesh, &settings);
  const modal_model *a = &slow.model, *b = &rest.model;
  assert_true(rest.deflection.speed == 0 && !rest.deflection.at.displacement);
  assert_true(slow.deflection.at.displacement && slow.deflection.at.steps == 1);
  check_below(relative_change(a->frequency, b->frequency, 20), 1e-12, "frequencies");
  check_below(relative_change(a->right, b->right, 6 * 20), 1e-6, "shapes");
  check_below(relative_change(a->residual_flexibility, b->residual_flexibility, 144), 1e-9,
              "residual flexibility");
  check_below(relative_change(a->residual_inertia, b->residual_inertia, 144), 1e-9,
              "residual inertia");
  assert_true(fast.model.frequency[0] > 1.05 * rest.model.frequency[0]);
  modal_result_free(&rest);
  modal_result_free(&slow);
  modal_result_free(&fast);
  mesh_fe_free(&mesh);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(receptance_matches_a_direct_solve),
      cmocka_unit_test(receptance_at_speed_matches_a_direct_solve),
      cmocka_unit_test(every_receptance_errs_by_the_first_term_left_out),
      cmocka_unit_test(residual_modes_double_the_order),
      cmocka_unit_test(many_contact_dofs_have_three_terms),
      cmocka_unit_test(terms_of_many_contact_dofs_are_those_of_the_body),
      cmocka_unit_test(error_is_estimated),
      cmocka_unit_test(modes_are_just_enough),
      cmocka_unit_test(static_response_is_exact),
      cmocka_unit_test(patches_add_up_to_the_face),
      cmocka_unit_test(receptance_converges_with_the_mesh),
      cmocka_unit_test(speed_leads_back_to_rest),
  };
  modal_session session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  int failures = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failures;
}
