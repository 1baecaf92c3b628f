#include "modal/model/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

static int n_contact(const modal_model *model) {
  return 3 * model->n_pairs * (model->has_left ? 2 : 1);
}

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

static bool make(double **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

static bool make_complex(double complex **part, size_t n) {
  if (!*part) *part = calloc(n, sizeof **part);
  return *part;
}

/* Zeros where the file holds none. To inertia without a next term none is added: it would be that of a few modes. */
static bool make_residuals(modal_model *model) {
  size_t c = (size_t)n_contact(model), q = 3 * (size_t)model->n_probes;
  size_t k      = (size_t)model->n_load + 1;
  bool   fourth = model->residual_fourth || !model->residual_inertia;
  bool made = make(&model->residual_flexibility, c * c) && make(&model->residual_inertia, c * c) &&
              make_complex(&model->load_residual, k * c) &&
              make_complex(&model->load_inertia, k * c);
  if (fourth)
    made = made && make(&model->residual_fourth, c * c) && make_complex(&model->load_fourth, k * c);
  if (q == 0) return made;
  if (fourth)
    made = made && make(&model->probe_contact_fourth, q * c) &&
           make_complex(&model->probe_load_fourth, k * q);
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

/* term[t][n] += shape f / w2^t */
static void add_forced(double complex *const term[3], size_t at, int n, const double *shape,
                       double complex f, double w2) {
  for (int t = 0; t < 3; t++, f /= w2)
    for (int i = 0; term[t] && i < n; i++) term[t][at + (size_t)i] += shape[i] * f;
}

/* One mode's answer to w^4, phi and psi its shape at contact and probes. */
static void add_terms(modal_model *model, int mode, const double *phi, const double *psi) {
  int             c = n_contact(model), q = 3 * model->n_probes;
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

/* [rows][n] with `more` columns, zero, before them. */
static void *widen(const void *data, size_t rows, size_t n, size_t more, size_t size) {
  char *wide = calloc(rows * (n + more) + 1, size);
  for (size_t i = 0; wide && data && i < rows; i++)
    memcpy(wide + (i * (n + more) + more) * size, (const char *)data + i * n * size, n * size);
  return wide;
}

/* Room for `more` residual modes before those that are there. */
static bool widen_residual_modes(modal_model *model, int more) {
  const size_t    n = (size_t)model->n_residual, m = (size_t)more, c = (size_t)n_contact(model);
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

/* Mode `mode` as residual mode `at`: exactly itself, but for its damping. */
static void set_residual_mode(modal_model *model, int mode, int at, const double *phi,
                              const double *psi) {
  const size_t n = (size_t)model->n_residual, i = (size_t)at;
  model->residual_frequency[i] = model->frequency[mode];
  for (int c = 0; c < n_contact(model); c++) model->residual_shape[(size_t)c * n + i] = phi[c];
  for (int c = 0; c < 3 * model->n_probes; c++) model->residual_probe[(size_t)c * n + i] = psi[c];
  for (int k = 0; k <= model->n_load; k++)
    model->residual_force[(size_t)k * n + i] =
        model->modal_force[(size_t)k * (size_t)model->n_modes + (size_t)mode];
}

/* Modes from `modes` on join those that are left out. */
static shb_status leave_out(modal_model *model, int modes) {
  int     c = n_contact(model), q = 3 * model->n_probes;
  double *phi = calloc((size_t)(c + q) + 1, sizeof *phi), *psi = phi ? phi + c : NULL;
  bool    made = phi && make_residuals(model), exact = made && model->residual_fourth;
  if (exact) made = widen_residual_modes(model, model->n_modes - modes);
  for (int mode = modes; made && mode < model->n_modes; mode++) {
    for (int i = 0; i < c; i++) phi[i] = at_contact(model, i, mode);
    for (int i = 0; i < q; i++)
      psi[i] = model->probe[(size_t)i * (size_t)model->n_modes + (size_t)mode];
    add_terms(model, mode, phi, psi);
    if (exact) set_residual_mode(model, mode, mode - modes, phi, psi);
  }
  free(phi);
  SHB_CHECK(made, SHB_ERR_IO, "no memory for the residual terms of %d contact dofs", c);
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
  if (residuals && modes < model->n_modes) SHB_TRY(leave_out(model, modes));
  size_t pairs = 3 * (size_t)model->n_pairs, from = (size_t)model->n_modes, to = (size_t)modes;
  narrow(model->right, pairs, from, to, sizeof(double));
  if (model->has_left) narrow(model->left, pairs, from, to, sizeof(double));
  narrow(model->probe, 3 * (size_t)model->n_probes, from, to, sizeof(double));
  narrow(model->modal_force, (size_t)model->n_load + 1, from, to, sizeof(double complex));
  model->n_modes = modes;
  return SHB_OK;
}

/* tail[2] <- that of the three terms. */
static void widen_tail(const modal_model *model, const double complex *shape, double *tail) {
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
  for (int c = 0; model->contact_tail && c < n_contact(model); c++) {
    for (size_t i = 0; i < r; i++) row[i] = model->residual_shape[(size_t)c * r + i];
    widen_tail(model, row, model->contact_tail + 2 * c);
  }
  for (int k = 0; model->load_tail && k <= model->n_load; k++)
    widen_tail(model, model->residual_force + (size_t)k * r, model->load_tail + 2 * k);
  free(model->residual_frequency);
  free(model->residual_shape);
  free(model->residual_force);
  free(model->residual_probe);
  model->residual_frequency = model->residual_shape = model->residual_probe = NULL;
  model->residual_force                                                     = NULL;
  model->n_residual                                                         = 0;
  model->tail_order                                                         = 3;
}
