#include "modal/model/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

static double at_contact(const modal_model *model, int dof, int mode) {
  int           side  = 3 * model->n_pairs;
  const double *shape = dof < side ? model->right : model->left;
  return shape[(size_t)(dof % side) * (size_t)model->n_modes + (size_t)mode];
}

static void drop_residuals(modal_model *model) {
  double **const         real[]      = {&model->residual_flexibility,
                                        &model->residual_inertia,
                                        &model->residual_fourth,
                                        &model->probe_contact_residual,
                                        &model->probe_contact_inertia,
                                        &model->probe_contact_fourth,
                                        &model->residual_frequency,
                                        &model->residual_shape,
                                        &model->residual_probe,
                                        &model->contact_tail,
                                        &model->load_tail};
  double complex **const complexes[] = {&model->load_residual,      &model->load_inertia,
                                        &model->load_fourth,        &model->probe_load_residual,
                                        &model->probe_load_inertia, &model->probe_load_fourth,
                                        &model->residual_force};
  for (size_t i = 0; i < sizeof real / sizeof *real; i++) {
    free(*real[i]);
    *real[i] = NULL;
  }
  for (size_t i = 0; i < sizeof complexes / sizeof *complexes; i++) {
    free(*complexes[i]);
    *complexes[i] = NULL;
  }
  model->n_residual = 0;
}

static bool allocate_real(double **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

static bool allocate_complex(double complex **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

/* Allocate missing residual terms as zeros. R3 is not added to a model with R2 but without R3: it
 * would hold the few modes left out here only. */
static bool allocate_residuals(modal_model *model) {
  size_t c = (size_t)modal_model_contact_dofs(model), q = 3 * (size_t)model->n_probes;
  size_t k        = (size_t)model->n_load + 1;
  bool   fourth   = model->residual_fourth || !model->residual_inertia;
  bool   complete = allocate_real(&model->residual_flexibility, c * c) &&
                  allocate_real(&model->residual_inertia, c * c) &&
                  allocate_complex(&model->load_residual, k * c) &&
                  allocate_complex(&model->load_inertia, k * c);
  if (fourth)
    complete = complete && allocate_real(&model->residual_fourth, c * c) &&
               allocate_complex(&model->load_fourth, k * c);
  if (q == 0) return complete;
  if (fourth)
    complete = complete && allocate_real(&model->probe_contact_fourth, q * c) &&
               allocate_complex(&model->probe_load_fourth, k * q);
  return complete && allocate_real(&model->probe_contact_residual, q * c) &&
         allocate_real(&model->probe_contact_inertia, q * c) &&
         allocate_complex(&model->probe_load_residual, k * q) &&
         allocate_complex(&model->probe_load_inertia, k * q);
}

/* to[rows][columns] += a b^T / scale */
static void add_outer(double *to, int rows, const double *a, int columns, const double *b,
                      double scale) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++)
      to[(size_t)i * (size_t)columns + (size_t)j] += a[i] * b[j] / scale;
}

/* term[t][at + i] += shape[i] f / w2^t for the terms that exist */
static void add_forced(double complex *const term[3], size_t at, int n, const double *shape,
                       double complex f, double w2) {
  for (int t = 0; t < 3; t++, f /= w2)
    for (int i = 0; term[t] && i < n; i++) term[t][at + (size_t)i] += shape[i] * f;
}

/* Add one mode to the residual terms up to w^4. phi, psi: its shape at the contact and the
 * probes. */
static void add_terms(modal_model *model, int mode, const double *phi, const double *psi) {
  int             c = modal_model_contact_dofs(model), q = 3 * model->n_probes;
  double          w = SHB_TWO_PI * model->frequency[mode], w2 = w * w, power = w2;
  double         *contact[]    = {model->residual_flexibility, model->residual_inertia,
                                  model->residual_fourth};
  double         *probe[]      = {model->probe_contact_residual, model->probe_contact_inertia,
                                  model->probe_contact_fourth};
  double complex *load[]       = {model->load_residual, model->load_inertia, model->load_fourth};
  double complex *probe_load[] = {model->probe_load_residual, model->probe_load_inertia,
                                  model->probe_load_fourth};
  for (int t = 0; t < 3; t++, power *= w2) {
    if (contact[t]) add_outer(contact[t], c, phi, c, phi, power);
    if (probe[t]) add_outer(probe[t], q, psi, c, phi, power);
  }
  for (int k = 0; k <= model->n_load; k++) {
    double complex f = model->modal_force[(size_t)k * (size_t)model->n_modes + (size_t)mode] / w2;
    add_forced(load, (size_t)k * (size_t)c, c, phi, f, w2);
    if (q > 0) add_forced(probe_load, (size_t)k * (size_t)q, q, psi, f, w2);
  }
}

/* Copy [rows][n] to [rows][more + n]; the first more columns are zero. */
static void *widen(const void *data, size_t rows, size_t n, size_t more, size_t size) {
  char *wide = calloc(rows * (n + more) + 1, size);
  for (size_t i = 0; wide && data && i < rows; i++)
    memcpy(wide + (i * (n + more) + more) * size, (const char *)data + i * n * size, n * size);
  return wide;
}

/* Insert more residual modes, zero, before those that exist. */
static bool widen_residual_modes(modal_model *model, int more) {
  const size_t n = (size_t)model->n_residual, m = (size_t)more,
               c    = (size_t)modal_model_contact_dofs(model);
  const size_t    q = 3 * (size_t)model->n_probes, k = (size_t)model->n_load + 1;
  double         *frequency = widen(model->residual_frequency, 1, n, m, sizeof *frequency);
  double         *shape     = widen(model->residual_shape, c, n, m, sizeof *shape);
  double         *probe     = widen(model->residual_probe, q, n, m, sizeof *probe);
  double complex *force     = widen(model->residual_force, k, n, m, sizeof *force);
  free(model->residual_frequency);
  free(model->residual_shape);
  free(model->residual_probe);
  free(model->residual_force);
  model->residual_frequency = frequency;
  model->residual_shape     = shape;
  model->residual_probe     = probe;
  model->residual_force     = force;
  model->n_residual += more;
  return frequency && shape && probe && force;
}

/* Store a mode as residual mode at: exact but for its damping. */
static void set_residual_mode(modal_model *model, int mode, int at, const double *phi,
                              const double *psi) {
  const size_t n = (size_t)model->n_residual, i = (size_t)at;
  model->residual_frequency[i] = model->frequency[mode];
  for (int c = 0; c < modal_model_contact_dofs(model); c++)
    model->residual_shape[(size_t)c * n + i] = phi[c];
  for (int c = 0; c < 3 * model->n_probes; c++) model->residual_probe[(size_t)c * n + i] = psi[c];
  for (int k = 0; k <= model->n_load; k++)
    model->residual_force[(size_t)k * n + i] =
        model->modal_force[(size_t)k * (size_t)model->n_modes + (size_t)mode];
}

/* Move the modes from index modes on to the residual terms and residual modes. */
static shb_status move_to_residuals(modal_model *model, int modes) {
  int     c = modal_model_contact_dofs(model), q = 3 * model->n_probes;
  double *phi = calloc((size_t)(c + q) + 1, sizeof *phi), *psi = phi ? phi + c : NULL;
  bool    complete = phi && allocate_residuals(model), exact = complete && model->residual_fourth;
  if (exact) complete = widen_residual_modes(model, model->n_modes - modes);
  for (int mode = modes; complete && mode < model->n_modes; mode++) {
    for (int i = 0; i < c; i++) phi[i] = at_contact(model, i, mode);
    for (int i = 0; i < q; i++)
      psi[i] = model->probe[(size_t)i * (size_t)model->n_modes + (size_t)mode];
    add_terms(model, mode, phi, psi);
    if (exact) set_residual_mode(model, mode, mode - modes, phi, psi);
  }
  free(phi);
  SHB_CHECK(complete, SHB_ERR_IO, "no memory for the residual terms of %d contact dofs", c);
  return SHB_OK;
}

/* Shrink [rows][from] to [rows][to] in place. */
static void shrink(void *data, size_t rows, size_t from, size_t to, size_t size) {
  char *bytes = data;
  for (size_t i = 1; data && i < rows; i++)
    memmove(bytes + i * to * size, bytes + i * from * size, to * size);
}

shb_status modal_model_reduce(modal_model *model, int modes, bool residuals) {
  SHB_CHECK(modes >= 1 && modes <= model->n_modes, SHB_ERR_INPUT,
            "%d modes are to be kept; there are 1 to %d", modes, model->n_modes);
  if (!residuals) drop_residuals(model);
  if (residuals && modes < model->n_modes) SHB_TRY(move_to_residuals(model, modes));
  size_t pairs = 3 * (size_t)model->n_pairs, from = (size_t)model->n_modes, to = (size_t)modes;
  shrink(model->right, pairs, from, to, sizeof(double));
  if (model->has_left) shrink(model->left, pairs, from, to, sizeof(double));
  shrink(model->probe, 3 * (size_t)model->n_probes, from, to, sizeof(double));
  shrink(model->modal_force, (size_t)model->n_load + 1, from, to, sizeof(double complex));
  model->n_modes = modes;
  return SHB_OK;
}

/* Tail of the three terms alone: add the residual modes' part to the old tail, or replace it. */
static void extend_tail(const modal_model *model, const double complex *shape, double *tail) {
  double sum[2] = {0, 0};
  for (int i = 0; i < model->n_residual; i++) {
    double lambda = pow(SHB_TWO_PI * model->residual_frequency[i], 2);
    double term   = pow(cabs(shape[i]), 2) / pow(lambda, 4);
    sum[0] += term;
    sum[1] += term / lambda;
  }
  for (int j = 0; j < 2; j++) tail[j] = sum[j] + (model->tail_order == 3 ? tail[j] : 0);
}

void modal_model_drop_residual_modes(modal_model *model) {
  const size_t r = (size_t)model->n_residual;
  if (r == 0) return;
  double complex row[r];
  for (int c = 0; model->contact_tail && c < modal_model_contact_dofs(model); c++) {
    for (size_t i = 0; i < r; i++) row[i] = model->residual_shape[(size_t)c * r + i];
    extend_tail(model, row, model->contact_tail + 2 * c);
  }
  for (int k = 0; model->load_tail && k <= model->n_load; k++)
    extend_tail(model, model->residual_force + (size_t)k * r, model->load_tail + 2 * k);
  free(model->residual_frequency);
  free(model->residual_shape);
  free(model->residual_force);
  free(model->residual_probe);
  model->residual_frequency = model->residual_shape = model->residual_probe = NULL;
  model->residual_force                                                     = NULL;
  model->n_residual                                                         = 0;
  model->tail_order                                                         = 3;
}
