#include "modal/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static int n_contact(const modal_model *model) {
  return 3 * model->n_pairs * (model->has_left ? 2 : 1);
}

static double at_contact(const modal_model *model, int dof, int mode) {
  int           side  = 3 * model->n_pairs;
  const double *shape = dof < side ? model->right : model->left;
  return shape[(size_t)(dof % side) * (size_t)model->n_modes + (size_t)mode];
}

static void drop_residuals(modal_model *model) {
  free(model->residual_flexibility);
  free(model->residual_inertia);
  free(model->residual_fourth);
  free(model->moment_fourth);
  free(model->moment_fifth);
  model->moment_fourth = model->moment_fifth = NULL;
  free(model->load_residual);
  free(model->load_inertia);
  free(model->probe_contact_residual);
  free(model->probe_contact_inertia);
  free(model->probe_load_residual);
  free(model->probe_load_inertia);
  model->residual_flexibility = model->residual_inertia = model->residual_fourth = NULL;
  model->probe_contact_residual = model->probe_contact_inertia = NULL;
  model->load_residual = model->load_inertia = NULL;
  model->probe_load_residual = model->probe_load_inertia = NULL;
}

static bool make(double **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

static bool make_complex(double complex **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

/* Zeros where the file holds none. To an inertia without a next term none is added: it would be that of a few modes. */
static bool make_residuals(modal_model *model) {
  size_t c = (size_t)n_contact(model), q = 3 * (size_t)model->n_probes;
  size_t k    = (size_t)model->n_load + 1;
  bool   made = (model->residual_inertia || make(&model->residual_fourth, c * c)) &&
              make(&model->residual_flexibility, c * c) && make(&model->residual_inertia, c * c) &&
              make_complex(&model->load_residual, k * c) &&
              make_complex(&model->load_inertia, k * c);
  if (q == 0) return made;
  return made && make(&model->probe_contact_residual, q * c) &&
         make(&model->probe_contact_inertia, q * c) &&
         make_complex(&model->probe_load_residual, k * q) &&
         make_complex(&model->probe_load_inertia, k * q);
}

/* to[rows][columns] += a b^T / scale */
static void add_outer(double *to, int rows, const double *a, int columns, const double *b,
                      double scale) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++)
      to[(size_t)i * (size_t)columns + (size_t)j] += a[i] * b[j] / scale;
}

/* to[n] += shape f, inertia[n] += shape f / w2 */
static void add_forced(double complex *to, double complex *inertia, int n, const double *shape,
                       double complex f, double w2) {
  for (int i = 0; i < n; i++) {
    to[i] += shape[i] * f;
    inertia[i] += shape[i] * f / w2;
  }
}

/* One mode's answer to w^2, phi and psi its shape at contact and probes. */
static void add_static(modal_model *model, int mode, const double *phi, const double *psi) {
  int    c = n_contact(model), q = 3 * model->n_probes;
  double w = 2 * PI * model->frequency[mode], w2 = w * w;
  add_outer(model->residual_flexibility, c, phi, c, phi, w2);
  add_outer(model->residual_inertia, c, phi, c, phi, w2 * w2);
  if (model->residual_fourth) add_outer(model->residual_fourth, c, phi, c, phi, w2 * w2 * w2);
  for (int i = 0; model->moment_fourth && model->moment_fifth && i < c; i++) {
    model->moment_fourth[i] += phi[i] * phi[i] / (w2 * w2 * w2 * w2);
    model->moment_fifth[i] += phi[i] * phi[i] / (w2 * w2 * w2 * w2 * w2);
  }
  if (q > 0) {
    add_outer(model->probe_contact_residual, q, psi, c, phi, w2);
    add_outer(model->probe_contact_inertia, q, psi, c, phi, w2 * w2);
  }
  for (int k = 0; k <= model->n_load; k++) {
    double complex f  = model->modal_force[(size_t)k * (size_t)model->n_modes + (size_t)mode] / w2;
    size_t         at = (size_t)k * (size_t)c, by = (size_t)k * (size_t)q;
    add_forced(model->load_residual + at, model->load_inertia + at, c, phi, f, w2);
    if (q > 0)
      add_forced(model->probe_load_residual + by, model->probe_load_inertia + by, q, psi, f, w2);
  }
}

static shb_status add_statics(modal_model *model, int modes) {
  int     c = n_contact(model), q = 3 * model->n_probes;
  double *phi = calloc((size_t)(c + q) + 1, sizeof *phi), *psi = phi ? phi + c : NULL;
  bool    made = phi && make_residuals(model);
  for (int mode = modes; made && mode < model->n_modes; mode++) {
    for (int i = 0; i < c; i++) phi[i] = at_contact(model, i, mode);
    for (int i = 0; i < q; i++)
      psi[i] = model->probe[(size_t)i * (size_t)model->n_modes + (size_t)mode];
    add_static(model, mode, phi, psi);
  }
  free(phi);
  SHB_CHECK(made, SHB_ERR_IO, "no memory for the residual flexibility of %d contact dofs", c);
  return SHB_OK;
}

/* [rows][from] to [rows][to], in place. */
static void narrow(void *data, size_t rows, size_t from, size_t to, size_t size) {
  char *bytes = data;
  for (size_t i = 1; data && i < rows; i++)
    memmove(bytes + i * to * size, bytes + i * from * size, to * size);
}

shb_status modal_model_keep(modal_model *model, int modes, bool residuals) {
  SHB_CHECK(modes >= 1 && modes <= model->n_modes, SHB_ERR_INPUT,
            "%d modes are to be kept; there are 1 to %d", modes, model->n_modes);
  if (!residuals) drop_residuals(model);
  if (residuals && modes < model->n_modes) SHB_TRY(add_statics(model, modes));
  size_t pairs = 3 * (size_t)model->n_pairs, from = (size_t)model->n_modes, to = (size_t)modes;
  narrow(model->right, pairs, from, to, sizeof(double));
  if (model->has_left) narrow(model->left, pairs, from, to, sizeof(double));
  narrow(model->probe, 3 * (size_t)model->n_probes, from, to, sizeof(double));
  narrow(model->modal_force, (size_t)model->n_load + 1, from, to, sizeof(double complex));
  model->n_modes = modes;
  return SHB_OK;
}
