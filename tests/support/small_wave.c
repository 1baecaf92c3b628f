#include "tests/support/small_wave.h"

#include <cblas.h>

#include "mesh/core/cyclic_sides.h"
#include "modal/cyclic/small_hermitian.h"
#include "tests/support/fem.h"

static const mesh_axis      axis = MESH_AXIS_X;
static const double complex one = 1, zero = 0;

/* ------------------------------------------------------------------ sector */

/* Turn each node about the axis, and shift it along the axis, by its radius. The sector is thickest
 * in the middle between its sides: of equal halves it would be two sectors. */
static void lean(mesh_fe *mesh, double inner) {
  for (int i = 0; i < mesh->n_nodes; i++) {
    double      *x      = mesh->coordinates + 3 * i;
    const double height = hypot(x[1], x[2]) / inner - 1, angle = atan2(-x[1], x[2]);
    x[0] *= 1 + 0.5 * cos(SMALL_BLADES / 2. * angle);
    mesh_axis_rotate(axis, 0.7 * height, x, x);
    x[0] *= 1 - 0.8 * height;
    x[0] += 0.05 * height;
  }
}

void small_sector_create(small_sector *s) {
  const double      size[3] = {0.05, 1, 0.06}, inner = 0.1;
  const int         cells[3] = {1, 2, 2};
  mesh_cyclic_sides sides;
  use_elements(MESH_HEX20);
  *s = (small_sector){.mesh = make_sector(size, inner, SMALL_BLADES, cells)};
  s->mesh.set[MESH_CYCLIC_RIGHT]  = s->mesh.set[MESH_CONTACT_RIGHT];
  s->mesh.set[MESH_CYCLIC_LEFT]   = s->mesh.set[MESH_CONTACT_LEFT];
  s->mesh.set[MESH_CONTACT_RIGHT] = s->mesh.set[MESH_CONTACT_LEFT] = (mesh_face_set){0, NULL};
  lean(&s->mesh, inner);
  assert_ok(mesh_cyclic_pair(&s->mesh, axis, SMALL_BLADES, &sides));
  s->element = make_element_tables(FEM_STANDARD);
  s->body    = (fem_body){&s->mesh, &steel, s->element, {axis, 0}, 0};
  assert_int_equal(fem_system_create(PETSC_COMM_SELF, &s->mesh, &steel, FEM_STANDARD, &s->system),
                   0);
  assert_int_equal(fem_sector_create(&s->body, NULL, &s->system, &s->sector), 0);
  assert_ok(fem_sector_analyse(&s->sector, &s->order));
}

void small_sector_free(small_sector *s) {
  fem_hermitian_order_free(s->order);
  fem_sector_free(&s->sector);
  fem_system_destroy(&s->system);
  free(s->element);
  mesh_fe_free(&s->mesh);
}

/* ------------------------------------------------------------------ dense matrices */

static double complex *zeros(size_t n) {
  double complex *a = calloc(n + 1, sizeof *a);
  assert_non_null(a);
  return a;
}

void dense_multiply(int n, const double complex *A, int count, const double complex *X,
                    double complex *Y) {
  cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, count, n, &one, A, n, X, n, &zero, Y,
              n);
}

static void fill_motion(const fem_sector *s, dense_wave *w) {
  double complex *x = zeros((size_t)w->n);
  for (int j = 0; j < w->n; j++) {
    x[j] = 1;
    fem_sector_expand(s, w->phase, x, w->C + (size_t)j * (size_t)w->nodal);
    x[j] = 0;
  }
  free(x);
}

/* Add factor times a block and its conjugate transpose. */
static void add_block(double complex factor, const double *block, int r, int c, dense_wave *w) {
  for (int i = 0; i < 9; i++) {
    const size_t         row = (size_t)(3 * r + i % 3), column = (size_t)(3 * c + i / 3);
    const double complex v = factor * block[i];
    w->K[column * (size_t)w->n + row] += v;
    if (r != c) w->K[row * (size_t)w->n + column] += conj(v);
  }
}

/* K(0) + (cos theta - 1) (B + B^T) + j sin theta (B^T - B) */
static void fill_stiffness(const fem_sector *s, dense_wave *w) {
  const double cosine = creal(w->phase), sine = -cimag(w->phase);
  for (int r = 0; r < s->n_rows; r++)
    for (int q = s->blocks.start[r]; q < s->blocks.start[r + 1]; q++) {
      const int c = s->blocks.column[q];
      add_block(1, s->stiffness + 9 * (size_t)q, r, c, w);
      for (int k = 0; k < s->n_coupled; k++) {
        if (s->coupled[k] != q) continue;
        add_block(cosine - 1, s->cosine[k], r, c, w);
        add_block(I * sine, s->sine[k], r, c, w);
      }
    }
}

static void fill_mass(const fem_sector *s, dense_wave *w) {
  const size_t    nodal = (size_t)w->nodal;
  double complex *MC    = zeros(nodal * (size_t)w->n);
  for (size_t j = 0; j < (size_t)w->n; j++)
    for (int i = 0; i < s->n_nodes; i++)
      for (int k = s->mass_start[i]; k < s->mass_start[i + 1]; k++)
        for (int d = 0; d < 3; d++)
          MC[j * nodal + (size_t)(3 * i + d)] +=
              s->mass[k] * w->C[j * nodal + (size_t)(3 * s->mass_node[k] + d)];
  cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, w->n, w->n, w->nodal, &one, w->C,
              w->nodal, MC, w->nodal, &zero, w->M, w->n);
  free(MC);
}

/* With M = R^H R the modes are R^-1 times the eigenvectors of R^-H K R^-1. */
static void find_modes(dense_wave *w) {
  const int       n    = w->n;
  const size_t    size = (size_t)n * (size_t)n * sizeof *w->M;
  double complex *R    = zeros((size_t)n * (size_t)n);
  memcpy(R, w->M, size);
  memcpy(w->phi, w->K, size);
  assert_true(small_hermitian_cholesky(n, R));
  cblas_ztrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, n, n, &one, R, n,
              w->phi, n);
  cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasConjTrans, CblasNonUnit, n, n, &one, R, n,
              w->phi, n);
  assert_true(small_hermitian_eigen(n, w->phi, w->lambda, true));
  cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, n, n, &one, R, n,
              w->phi, n);
  free(R);
}

void dense_wave_create(const small_sector *s, int diameter, dense_wave *w) {
  *w             = (dense_wave){.n     = 3 * s->sector.n_rows,
                                .nodal = 3 * s->sector.n_nodes,
                                .phase = cexp(-I * 2 * M_PI * diameter / SMALL_BLADES)};
  const size_t n = (size_t)w->n;
  w->C           = zeros(n * (size_t)w->nodal);
  w->K           = zeros(n * n);
  w->M           = zeros(n * n);
  w->phi         = zeros(n * n);
  w->lambda      = malloc(n * sizeof *w->lambda);
  assert_non_null(w->lambda);
  fill_motion(&s->sector, w);
  fill_stiffness(&s->sector, w);
  fill_mass(&s->sector, w);
  find_modes(w);
}

void dense_wave_free(dense_wave *w) {
  free(w->C);
  free(w->K);
  free(w->M);
  free(w->lambda);
  free(w->phi);
  *w = (dense_wave){0};
}

void dense_wave_solve(const dense_wave *w, int count, double complex *X) {
  const int       n = w->n;
  double complex *R = zeros((size_t)n * (size_t)n);
  memcpy(R, w->K, (size_t)n * (size_t)n * sizeof *R);
  assert_true(small_hermitian_cholesky(n, R));
  cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasConjTrans, CblasNonUnit, n, count, &one, R,
              n, X, n);
  cblas_ztrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, n, count, &one, R,
              n, X, n);
  free(R);
}

void dense_wave_project_out(const dense_wave *w, int modes, int count, double complex *X) {
  const double complex minus = -1;
  double complex      *MX    = zeros((size_t)w->n * (size_t)count);
  double complex      *c     = zeros((size_t)modes * (size_t)count);
  dense_multiply(w->n, w->M, count, X, MX);
  cblas_zgemm(CblasColMajor, CblasConjTrans, CblasNoTrans, modes, count, w->n, &one, w->phi, w->n,
              MX, w->n, &zero, c, modes);
  cblas_zgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, w->n, count, modes, &minus, w->phi, w->n,
              c, modes, &one, X, w->n);
  free(MX);
  free(c);
}

/* ------------------------------------------------------------------ numbers */

double complex *random_complex(size_t n, uint64_t seed) {
  double complex *x = zeros(n);
  for (size_t i = 0; i < n; i++) {
    double part[2];
    for (int p = 0; p < 2; p++) {
      seed    = seed * 6364136223846793005u + 1442695040888963407u;
      part[p] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    x[i] = CMPLX(part[0], part[1]);
  }
  return x;
}

double complex_difference(size_t n, const double complex *a, const double complex *b) {
  double off = 0, most = 0;
  for (size_t i = 0; i < n; i++) {
    off  = fmax(off, cabs(a[i] - b[i]));
    most = fmax(most, cabs(b[i]));
  }
  return off / most;
}

/* ------------------------------------------------------------------ condensation */

static void add_dof(modal_dofs *dofs, int node, int d, int more) {
  const double weight[2] = {0.7, 0.3}, one_weight = 1;
  const int    nodes[2] = {node, more};
  const double along[3] = {d == 0, (d == 1) - 0.3 * (d == 2), d == 2};
  modal_dofs_add(dofs, more >= 0 ? 2 : 1, nodes, more >= 0 ? weight : &one_weight, along);
}

void small_condensation(const small_sector *s, int n_pairs, modal_condensation *to) {
  const int n_nodes = s->mesh.n_nodes, K = 1, patterns = 2;
  *to               = (modal_condensation){.n_pairs = n_pairs, .has_left = true};
  to->damping.ratio = 0.002;
  for (int side = 0; side < 2; side++)
    for (int p = 0; p < n_pairs; p++) {
      const mesh_face_set *set  = &s->mesh.set[side ? MESH_CYCLIC_LEFT : MESH_CYCLIC_RIGHT];
      const int            node = set->nodes[(set->n * 8 - 1 - p + 8) % (set->n * 8)];
      for (int d = 0; d < 3; d++) add_dof(&to->contact, node, d, d == 2 ? n_nodes / 2 + p : -1);
    }
  for (int d = 0; d < 3; d++) add_dof(&to->probe, n_nodes - 1, d, -1);
  add_dof(&to->load.dofs, n_nodes - 2, 1, n_nodes / 2);
  add_dof(&to->load.dofs, n_nodes - 3, 2, -1);
  to->load.n_harmonics = K;
  to->load.weight      = random_complex((size_t)((K + 1) * patterns), 5);
}

void small_condensation_free(modal_condensation *to) {
  modal_load_free(&to->load);
  modal_dofs_free(&to->contact);
  modal_dofs_free(&to->probe);
}

double complex *dense_wave_columns(const dense_wave *w, const modal_dofs *dofs) {
  double complex *B = zeros((size_t)dofs->n * (size_t)w->n);
  for (int c = 0; c < dofs->n; c++)
    for (int j = 0; j < w->n; j++)
      for (int e = dofs->start[c]; e < dofs->start[c + 1]; e++)
        for (int d = 0; d < 3; d++)
          B[c * w->n + j] +=
              conj(w->C[(size_t)j * (size_t)w->nodal + (size_t)(3 * dofs->node[e] + d)]) *
              dofs->weight[3 * e + d];
  return B;
}
