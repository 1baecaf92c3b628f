#include "mhb/ring/merged_modes.h"

#include <lapacke.h>
#include <math.h>

#include "mesh/base/constants.h"

/* Directions softer than this share of the largest flexibility count; others are left out. */
static const double SOFT_ENOUGH = 1e-8;

/* Scratch: n contact dofs (side, pair, axis) in the axes of the pairs. */
typedef struct {
  const mhb_receptance *r;
  int                   n, p;                     /* dofs; directions that count */
  double               *R, *R2, *value, *A, *tau; /* [n][n], [n][n], [n], [n][n], [n] */
  double               *G;                        /* [3][n] m/N */
} merging;

/* Component of contact dof c along an axis of the blade; the left side is negative. */
static double axis_of(const merging *g, int c, int axis) {
  int    row = c % g->r->n, side = c / g->r->n;
  double part = g->r->T0[(row / 3) * 9 + axis * 3 + row % 3];
  return side ? -part : part;
}

/* Contact dof of the model for dof c and an axis of the blade. */
static int dof_of(const merging *g, int c, int axis) {
  int row = c % g->r->n, side = c / g->r->n;
  return side * g->r->n + row / 3 * 3 + axis;
}

/* out[n][n] += T matrix T^T */
static void add_matrix(const merging *g, const double *matrix, double *out) {
  size_t nc = (size_t)g->r->n * (g->r->model->has_left ? 2 : 1);
  for (int a = 0; a < g->n; a++)
    for (int b = 0; b < g->n; b++)
      for (int k = 0; k < 9; k++)
        out[a * g->n + b] += axis_of(g, a, k / 3) * axis_of(g, b, k % 3) *
                             matrix[(size_t)dof_of(g, a, k / 3) * nc + (size_t)dof_of(g, b, k % 3)];
}

static void add_probe(const merging *g, int probe, const double *matrix) {
  size_t nc = (size_t)g->r->n * (g->r->model->has_left ? 2 : 1);
  for (int i = 0; i < 3; i++)
    for (int a = 0; a < g->n; a++)
      for (int k = 0; k < 3; k++)
        g->G[i * g->n + a] +=
            axis_of(g, a, k) * matrix[(size_t)(3 * probe + i) * nc + (size_t)dof_of(g, a, k)];
}

static void add_mode(const merging *g, int mode, int probe) {
  const modal_model *model = g->r->model;
  double             w     = SHB_TWO_PI * model->frequency[mode], x[g->n];
  for (int a = 0; a < g->n; a++) {
    x[a] = 0;
    for (int k = 0; k < 3; k++) {
      int           c = dof_of(g, a, k), m = model->n_modes, n = g->r->n;
      const double *shape = c < n ? model->right + c * m : model->left + (c - n) * m;
      x[a] += axis_of(g, a, k) * shape[mode] / w;
    }
  }
  for (int a = 0; a < g->n; a++) {
    for (int b = 0; b < g->n; b++) {
      g->R[a * g->n + b] += x[a] * x[b];
      g->R2[a * g->n + b] += x[a] * x[b] / (w * w);
    }
    for (int i = 0; i < 3 && probe >= 0; i++)
      g->G[i * g->n + a] +=
          model->probe[(size_t)(3 * probe + i) * (size_t)model->n_modes + (size_t)mode] / w * x[a];
  }
}

static void add_all(const merging *g, int first, int probe) {
  const modal_model *model = g->r->model;
  for (int i = first; i < model->n_modes; i++) add_mode(g, i, probe);
  if (model->residual_flexibility) add_matrix(g, model->residual_flexibility, g->R);
  if (model->residual_inertia) add_matrix(g, model->residual_inertia, g->R2);
  if (model->probe_contact_residual && probe >= 0)
    add_probe(g, probe, model->probe_contact_residual);
}

/* a[n][n] <- its eigenvectors as rows, ascending. */
static bool symmetric_eigen(int n, double *a, double *value) {
  return n == 0 || LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', n, a, n, value) == 0;
}

/* A[p][p] <- Q^-1 R2 Q^-T in the directions that count, the last p rows of R. */
static void reduce(const merging *g) {
  int n = g->n, p = g->p;
  for (int a = 0; a < p; a++)
    for (int b = 0; b < p; b++) {
      const double *x = g->R + (n - p + a) * n, *y = g->R + (n - p + b) * n;
      double        sum = 0;
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) sum += x[i] * g->R2[i * n + j] * y[j];
      g->A[a * p + b] = sum / sqrt(g->value[n - p + a] * g->value[n - p + b]);
    }
}

/* Mode i from row i of A. */
static void set_mode(const merging *g, int i, mhb_merged_modes *out) {
  int n = g->n, p = g->p, wide = 2 * g->r->n;
  out->w[i] = g->tau[i] > 0 ? 1 / sqrt(g->tau[i]) : INFINITY;
  for (int k = 0; k < p; k++) {
    const double *v = g->R + (n - p + k) * n;
    double        u = g->A[i * p + k], root = sqrt(g->value[n - p + k]);
    for (int c = 0; c < n; c++) out->shape[i * wide + c] += root * u * v[c];
    for (int axis = 0; axis < 3; axis++)
      for (int c = 0; c < n; c++) out->out[3 * i + axis] += g->G[axis * n + c] * v[c] * u / root;
  }
}

static shb_status find(merging *g, mhb_merged_modes *out) {
  int n = g->n;
  SHB_CHECK(symmetric_eigen(n, g->R, g->value), SHB_ERR_INPUT,
            "/contact/residual_flexibility has no eigenvalues; it must be finite");
  while (g->p < n && g->value[n - 1] > 0 && g->value[n - 1 - g->p] > SOFT_ENOUGH * g->value[n - 1])
    g->p++;
  reduce(g);
  SHB_CHECK(symmetric_eigen(g->p, g->A, g->tau), SHB_ERR_INPUT,
            "/contact/residual_inertia has no eigenvalues; it must be finite");
  for (int i = 0; i < g->p; i++) set_mode(g, i, out);
  out->n = g->p;
  return SHB_OK;
}

shb_status mhb_merged_modes_create(const mhb_receptance *r, const mhb_settings *settings, int first,
                                   int probe, mhb_merged_modes *out) {
  merging   g = {.r = r, .n = r->n * (settings->to_ground ? 1 : 2)};
  size_t    n = (size_t)g.n, wide = 2 * (size_t)r->n;
  shb_arena arena = {0};
  *out            = (mhb_merged_modes){0};
  g.R             = shb_arena_take(&arena, n * n, sizeof(double));
  g.R2            = shb_arena_take(&arena, n * n, sizeof(double));
  g.A             = shb_arena_take(&arena, n * n, sizeof(double));
  g.value         = shb_arena_take(&arena, n, sizeof(double));
  g.tau           = shb_arena_take(&arena, n, sizeof(double));
  g.G             = shb_arena_take(&arena, 3 * n, sizeof(double));
  out->w          = shb_arena_take(&out->arena, n, sizeof(double));
  out->shape      = shb_arena_take(&out->arena, n * wide, sizeof(double));
  out->out        = shb_arena_take(&out->arena, 3 * n, sizeof(double));
  add_all(&g, first, probe);
  const shb_status status = find(&g, out);
  shb_arena_free(&arena);
  if (status != SHB_OK) mhb_merged_modes_destroy(out);
  return status;
}

void mhb_merged_modes_destroy(mhb_merged_modes *merged) {
  shb_arena_free(&merged->arena);
  *merged = (mhb_merged_modes){0};
}
