#include "modal/model/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

/* A model and, of a travelling wave, its imaginary parts and the load of the backward wave
 * (modal/model/nodal_diameters.h); both NULL of a real one. */
typedef struct {
  modal_model *re, *im, *back;
} parts;

static double complex entry(const double *re, const double *im, size_t i) {
  return CMPLX(re[i], im ? im[i] : 0);
}

static double complex at_contact(const parts *p, int dof, int mode) {
  const int     side = 3 * p->re->n_pairs;
  const size_t  i    = (size_t)(dof % side) * (size_t)p->re->n_modes + (size_t)mode;
  const bool    left = dof >= side;
  const double *im   = !p->im ? NULL : left ? p->im->left : p->im->right;
  return entry(left ? p->re->left : p->re->right, im, i);
}

static double complex at_probe(const parts *p, int dof, int mode) {
  const size_t i = (size_t)dof * (size_t)p->re->n_modes + (size_t)mode;
  return entry(p->re->probe, p->im ? p->im->probe : NULL, i);
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

/* Allocate missing terms of the contact, or of the load, as zeros. */
static bool allocate_contact(modal_model *of, size_t c, size_t q, bool fourth) {
  bool complete = allocate_real(&of->residual_flexibility, c * c) &&
                  allocate_real(&of->residual_inertia, c * c);
  if (fourth) complete = complete && allocate_real(&of->residual_fourth, c * c);
  if (q == 0) return complete;
  if (fourth) complete = complete && allocate_real(&of->probe_contact_fourth, q * c);
  return complete && allocate_real(&of->probe_contact_residual, q * c) &&
         allocate_real(&of->probe_contact_inertia, q * c);
}

static bool allocate_load(modal_model *of, size_t c, size_t q, size_t k, bool fourth) {
  bool complete =
      allocate_complex(&of->load_residual, k * c) && allocate_complex(&of->load_inertia, k * c);
  if (fourth) complete = complete && allocate_complex(&of->load_fourth, k * c);
  if (q == 0) return complete;
  if (fourth) complete = complete && allocate_complex(&of->probe_load_fourth, k * q);
  return complete && allocate_complex(&of->probe_load_residual, k * q) &&
         allocate_complex(&of->probe_load_inertia, k * q);
}

/* R3 is not added to a model with R2 but without R3: it would hold the few modes left out here
 * only. */
static bool allocate_residuals(const parts *p) {
  const size_t c = (size_t)modal_model_contact_dofs(p->re), q = 3 * (size_t)p->re->n_probes;
  const size_t k      = (size_t)p->re->n_load + 1;
  const bool   fourth = p->re->residual_fourth || !p->re->residual_inertia;
  return allocate_contact(p->re, c, q, fourth) && allocate_load(p->re, c, q, k, fourth) &&
         (!p->im || allocate_contact(p->im, c, q, fourth)) &&
         (!p->back || allocate_load(p->back, c, q, k, fourth));
}

/* re + j im [rows][columns] += a b^H / scale; im NULL: real */
static void add_outer(double *re, double *im, int rows, const double complex *a, int columns,
                      const double complex *b, double scale) {
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      const double complex value = a[i] * conj(b[j]) / scale;
      const size_t         at    = (size_t)i * (size_t)columns + (size_t)j;
      re[at] += creal(value);
      if (im) im[at] += cimag(value);
    }
}

/* term[t][at + i] += shape[i] f / w2^t for the terms that exist; conjugate shapes if backward */
static void add_forced(double complex *const term[3], size_t at, int n, const double complex *shape,
                       bool backward, double complex f, double w2) {
  for (int t = 0; t < 3; t++, f /= w2)
    for (int i = 0; term[t] && i < n; i++)
      term[t][at + (size_t)i] += (backward ? conj(shape[i]) : shape[i]) * f;
}

/* The load's terms of one direction of the wave. */
static void add_load_terms(const parts *p, bool backward, int mode, const double complex *phi,
                           const double complex *psi, double w2) {
  const modal_model    *of = backward ? p->back : p->re;
  const int             c = modal_model_contact_dofs(p->re), q = 3 * p->re->n_probes;
  double complex *const load[]       = {of->load_residual, of->load_inertia, of->load_fourth};
  double complex *const probe_load[] = {of->probe_load_residual, of->probe_load_inertia,
                                        of->probe_load_fourth};
  for (int k = 0; k <= p->re->n_load; k++) {
    double complex f = of->modal_force[(size_t)k * (size_t)p->re->n_modes + (size_t)mode] / w2;
    add_forced(load, (size_t)k * (size_t)c, c, phi, backward, f, w2);
    if (q > 0) add_forced(probe_load, (size_t)k * (size_t)q, q, psi, backward, f, w2);
  }
}

/* Add one mode to the residual terms up to w^4. phi, psi: its shape at the contact and the
 * probes. */
static void add_terms(const parts *p, int mode, const double complex *phi,
                      const double complex *psi) {
  const modal_model *re = p->re, *im = p->im;
  const int          c = modal_model_contact_dofs(re), q = 3 * re->n_probes;
  const double       w = SHB_TWO_PI * re->frequency[mode], w2 = w * w;
  double             power      = w2;
  double *const      term[3][2] = {
           {re->residual_flexibility, re->probe_contact_residual},
           {re->residual_inertia, re->probe_contact_inertia},
           {re->residual_fourth, re->probe_contact_fourth},
  };
  double *const imaginary[3][2] = {
      {im ? im->residual_flexibility : NULL, im ? im->probe_contact_residual : NULL},
      {im ? im->residual_inertia : NULL, im ? im->probe_contact_inertia : NULL},
      {im ? im->residual_fourth : NULL, im ? im->probe_contact_fourth : NULL},
  };
  for (int t = 0; t < 3; t++, power *= w2) {
    if (term[t][0]) add_outer(term[t][0], imaginary[t][0], c, phi, c, phi, power);
    if (term[t][1]) add_outer(term[t][1], imaginary[t][1], q, psi, c, phi, power);
  }
  add_load_terms(p, false, mode, phi, psi, w2);
  if (p->back) add_load_terms(p, true, mode, phi, psi, w2);
}

/* Copy [rows][n] to [rows][more + n], whose first more columns are zero, and free the old one. */
static void *widen(void *data, size_t rows, size_t n, size_t more, size_t size) {
  char *wide = calloc(rows * (n + more) + 1, size);
  for (size_t i = 0; wide && data && i < rows; i++)
    memcpy(wide + (i * (n + more) + more) * size, (const char *)data + i * n * size, n * size);
  free(data);
  return wide;
}

/* Insert more residual modes, zero, before those that exist. */
static bool widen_residual_modes(const parts *p, int more) {
  modal_model *re = p->re, *im = p->im;
  const size_t n = (size_t)re->n_residual, m = (size_t)more;
  const size_t c = (size_t)modal_model_contact_dofs(re);
  const size_t q = 3 * (size_t)re->n_probes, k = (size_t)re->n_load + 1;
  re->residual_frequency = widen(re->residual_frequency, 1, n, m, sizeof(double));
  re->residual_shape     = widen(re->residual_shape, c, n, m, sizeof(double));
  re->residual_probe     = widen(re->residual_probe, q, n, m, sizeof(double));
  re->residual_force     = widen(re->residual_force, k, n, m, sizeof(double complex));
  bool made =
      re->residual_frequency && re->residual_shape && re->residual_probe && re->residual_force;
  if (im) {
    im->residual_shape = widen(im->residual_shape, c, n, m, sizeof(double));
    im->residual_probe = widen(im->residual_probe, q, n, m, sizeof(double));
    made               = made && im->residual_shape && im->residual_probe;
  }
  if (p->back) {
    double complex **force = &p->back->residual_force;
    made                   = (*force = widen(*force, k, n, m, sizeof **force)) && made;
  }
  re->n_residual += more;
  return made;
}

/* Store a mode as residual mode at: exact but for its damping. */
static void set_residual_mode(const parts *p, int mode, int at, const double complex *phi,
                              const double complex *psi) {
  modal_model *re = p->re, *im = p->im, *back = p->back;
  const size_t n = (size_t)re->n_residual, i = (size_t)at;
  re->residual_frequency[i] = re->frequency[mode];
  for (size_t c = 0; c < (size_t)modal_model_contact_dofs(re); c++) {
    re->residual_shape[c * n + i] = creal(phi[c]);
    if (im) im->residual_shape[c * n + i] = cimag(phi[c]);
  }
  for (size_t c = 0; c < 3 * (size_t)re->n_probes; c++) {
    re->residual_probe[c * n + i] = creal(psi[c]);
    if (im) im->residual_probe[c * n + i] = cimag(psi[c]);
  }
  for (size_t k = 0; k <= (size_t)re->n_load; k++) {
    const size_t from             = k * (size_t)re->n_modes + (size_t)mode;
    re->residual_force[k * n + i] = re->modal_force[from];
    if (back) back->residual_force[k * n + i] = back->modal_force[from];
  }
}

/* Move the modes from index modes on to the residual terms and residual modes. */
static shb_status move_to_residuals(const parts *p, int modes) {
  const int       c = modal_model_contact_dofs(p->re), q = 3 * p->re->n_probes;
  double complex *phi = calloc((size_t)(c + q) + 1, sizeof *phi), *psi = phi ? phi + c : NULL;
  bool complete = phi && allocate_residuals(p), exact = complete && p->re->residual_fourth;
  if (exact) complete = widen_residual_modes(p, p->re->n_modes - modes);
  for (int mode = modes; complete && mode < p->re->n_modes; mode++) {
    for (int i = 0; i < c; i++) phi[i] = at_contact(p, i, mode);
    for (int i = 0; i < q; i++) psi[i] = at_probe(p, i, mode);
    add_terms(p, mode, phi, psi);
    if (exact) set_residual_mode(p, mode, mode - modes, phi, psi);
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

static void shrink_shapes(modal_model *of, size_t pairs, size_t probes, size_t from, size_t to) {
  shrink(of->coriolis, to, from, to, sizeof(double));
  shrink(of->right, pairs, from, to, sizeof(double));
  shrink(of->left, pairs, from, to, sizeof(double));
  shrink(of->probe, probes, from, to, sizeof(double));
}

static shb_status reduce(const parts *p, int modes, bool residuals) {
  modal_model *model = p->re;
  SHB_CHECK(modes >= 1 && modes <= model->n_modes, SHB_ERR_INPUT,
            "%d modes are to be kept; there are 1 to %d", modes, model->n_modes);
  if (!residuals) drop_residuals(model);
  if (!residuals && p->im) drop_residuals(p->im);
  if (!residuals && p->back) drop_residuals(p->back);
  if (residuals && modes < model->n_modes) SHB_TRY(move_to_residuals(p, modes));
  const size_t pairs = 3 * (size_t)model->n_pairs, probes = 3 * (size_t)model->n_probes;
  const size_t from = (size_t)model->n_modes, to = (size_t)modes, k = (size_t)model->n_load + 1;
  shrink_shapes(model, pairs, probes, from, to);
  if (p->im) shrink_shapes(p->im, pairs, probes, from, to);
  shrink(model->modal_force, k, from, to, sizeof(double complex));
  if (p->back) shrink(p->back->modal_force, k, from, to, sizeof(double complex));
  model->n_modes = modes;
  return SHB_OK;
}

shb_status modal_model_reduce(modal_model *model, int modes, bool residuals) {
  return reduce(&(parts){model, NULL, NULL}, modes, residuals);
}

shb_status modal_wave_reduce(modal_model *model, modal_model *imaginary, modal_model *backward,
                             int modes, bool residuals) {
  return reduce(&(parts){model, imaginary, backward}, modes, residuals);
}

shb_status modal_nodal_diameters_reduce(modal_nodal_diameters *d, int modes, bool residuals) {
  for (int i = 0; i < d->n; i++) {
    const parts p = {&d->model[i], d->imaginary[i].right ? &d->imaginary[i] : NULL,
                     d->backward[i].modal_force ? &d->backward[i] : NULL};
    SHB_TRY(reduce(&p, modes, residuals));
  }
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

static void free_imaginary(modal_model *imaginary) {
  free(imaginary->residual_shape);
  free(imaginary->residual_probe);
  imaginary->residual_shape = imaginary->residual_probe = NULL;
}

void modal_model_drop_residual_modes(modal_model *model) {
  modal_wave_drop_residual_modes(model, NULL, NULL);
}

void modal_wave_drop_residual_modes(modal_model *model, modal_model *imaginary,
                                    modal_model *backward) {
  const size_t  r  = (size_t)model->n_residual;
  const double *im = imaginary ? imaginary->residual_shape : NULL;
  if (r == 0) return;
  double complex row[r];
  for (int c = 0; model->contact_tail && c < modal_model_contact_dofs(model); c++) {
    for (size_t i = 0; i < r; i++) row[i] = entry(model->residual_shape, im, (size_t)c * r + i);
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
  if (imaginary) free_imaginary(imaginary);
  if (backward) {
    free(backward->residual_force);
    backward->residual_force = NULL;
  }
}
