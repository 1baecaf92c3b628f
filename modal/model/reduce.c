#include "modal/model/reduce.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

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

/* The models that hold an array of this kind: the first one, and that of a wave, or NULL. */
static modal_model *second_of(const parts *p, const modal_dataset *row) {
  return row->kind == MODAL_SPLIT ? p->im : row->kind == MODAL_LOAD ? p->back : NULL;
}

static void drop(const modal_dataset *row, const parts *p) {
  modal_dataset_free(row, p->re);
  if (second_of(p, row)) modal_dataset_free(row, second_of(p, row));
}

static void drop_residuals(const parts *p) {
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    if (modal_dataset_is_residual(row) || row->part == MODAL_RESIDUAL_MODES) drop(row, p);
  p->re->n_residual = 0;
}

/* Allocate an array as zeros, if it is missing. */
static void allocate(const modal_dataset *row, const modal_model *sizes, modal_model *of) {
  if (!modal_dataset_get(row, of))
    modal_dataset_set(row, of,
                      shb_alloc_zeroed(modal_dataset_count(row, sizes), modal_dataset_width(row)));
}

/* Allocate the terms that are missing. R3 is not added to a model with R2 but without R3: it would
 * hold the few modes left out here only. */
static void allocate_terms(const parts *p) {
  const bool fourth = p->re->residual_fourth || !p->re->residual_inertia;
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    if (!modal_dataset_is_term(row) || (row->part == MODAL_R3 && !fourth)) continue;
    allocate(row, p->re, p->re);
    if (second_of(p, row)) allocate(row, p->re, second_of(p, row));
  }
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

/* A mode that becomes a term: its shape at the contact and the probes. */
typedef struct {
  int                   mode;
  double                square; /* omega^2 */
  const double complex *contact, *probe;
} left_out;

static const double complex *shape_of(const left_out *of, char letter) {
  return letter == 'c' ? of->contact : of->probe;
}

/* term [K+1][n] += shape f/omega^2t, t from 1; conjugate shapes of the backward wave. */
static void add_forced(const modal_dataset *row, const modal_model *sizes, const left_out *of,
                       bool backward, modal_model *to) {
  double complex       *term  = modal_dataset_get(row, to);
  const double complex *shape = shape_of(of, row->dims[1]);
  const size_t          n     = (size_t)modal_size_of(sizes, row->dims[1]);
  for (size_t k = 0; k <= (size_t)sizes->n_load; k++) {
    double complex f = to->modal_force[k * (size_t)sizes->n_modes + (size_t)of->mode] / of->square;
    for (int t = MODAL_R; t < (int)row->part; t++) f /= of->square;
    for (size_t i = 0; i < n; i++) term[k * n + i] += (backward ? conj(shape[i]) : shape[i]) * f;
  }
}

/* Add a mode to one of the terms up to w^4. */
static void add_term(const modal_dataset *row, const parts *p, const left_out *of) {
  const modal_model *re    = p->re;
  double             power = of->square;
  if (!modal_dataset_is_term(row) || !modal_dataset_get(row, re)) return;
  if (row->kind == MODAL_LOAD) {
    add_forced(row, re, of, false, p->re);
    if (p->back) add_forced(row, re, of, true, p->back);
    return;
  }
  for (int t = MODAL_R; t < (int)row->part; t++) power *= of->square;
  add_outer(modal_dataset_get(row, re), p->im ? modal_dataset_get(row, p->im) : NULL,
            (int)modal_size_of(re, row->dims[0]), shape_of(of, row->dims[0]),
            (int)modal_size_of(re, row->dims[1]), shape_of(of, row->dims[1]), power);
}

/* Copy [rows][n] to [rows][more + n], whose first more columns are zero, and free the old one. */
static void *widen(void *data, size_t rows, size_t n, size_t more, size_t size) {
  char *wide = shb_alloc_zeroed(rows * (n + more), size);
  for (size_t i = 0; data && i < rows; i++)
    memcpy(wide + (i * (n + more) + more) * size, (const char *)data + i * n * size, n * size);
  free(data);
  return wide;
}

/* Insert more residual modes, zero, before those that exist. The number of them is as before. */
static void widen_row(const modal_dataset *row, const modal_model *sizes, size_t more,
                      modal_model *of) {
  const size_t n    = (size_t)sizes->n_residual;
  const size_t rows = row->dims[1] ? (size_t)modal_size_of(sizes, row->dims[0]) : 1;
  modal_dataset_set(row, of,
                    widen(modal_dataset_get(row, of), rows, n, more, modal_dataset_width(row)));
}

static void widen_residual_modes(const parts *p, int more) {
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    if (row->part != MODAL_RESIDUAL_MODES) continue;
    widen_row(row, p->re, (size_t)more, p->re);
    if (second_of(p, row)) widen_row(row, p->re, (size_t)more, second_of(p, row));
  }
  p->re->n_residual += more;
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
static void move_to_residuals(const parts *p, int modes) {
  const int       c = modal_model_contact_dofs(p->re), q = 3 * p->re->n_probes;
  double complex *phi = shb_alloc_zeroed((size_t)c + (size_t)q, sizeof *phi), *psi = phi + c;
  allocate_terms(p);
  const bool exact = p->re->residual_fourth;
  if (exact) widen_residual_modes(p, p->re->n_modes - modes);
  for (int mode = modes; mode < p->re->n_modes; mode++) {
    for (int i = 0; i < c; i++) phi[i] = at_contact(p, i, mode);
    for (int i = 0; i < q; i++) psi[i] = at_probe(p, i, mode);
    const double   w  = SHB_TWO_PI * p->re->frequency[mode];
    const left_out of = {mode, w * w, phi, psi};
    for (const modal_dataset *row = modal_datasets; row->path; row++) add_term(row, p, &of);
    if (exact) set_residual_mode(p, mode, mode - modes, phi, psi);
  }
  free(phi);
}

/* Shrink [rows][from] to [rows][to] in place. */
static void shrink(void *data, size_t rows, size_t from, size_t to, size_t size) {
  char *bytes = data;
  for (size_t i = 1; data && i < rows; i++)
    memmove(bytes + i * to * size, bytes + i * from * size, to * size);
}

/* Keep the first modes of an array [..][modes]; of [modes][modes] the rows too. */
static void shrink_row(const modal_dataset *row, const modal_model *sizes, int modes,
                       modal_model *of) {
  const int last = (int)strlen(row->dims) - 1;
  size_t    rows = 1;
  if (row->dims[last] != 'm') return;
  for (int i = 0; i < last; i++)
    rows *= row->dims[i] == 'm' ? (size_t)modes : (size_t)modal_size_of(sizes, row->dims[i]);
  shrink(modal_dataset_get(row, of), rows, (size_t)sizes->n_modes, (size_t)modes,
         modal_dataset_width(row));
}

static shb_status reduce(const parts *p, int modes, bool residuals) {
  modal_model *model = p->re;
  SHB_CHECK(modes >= 1 && modes <= model->n_modes, SHB_ERR_INPUT,
            "%d modes are to be kept; there are 1 to %d", modes, model->n_modes);
  if (!residuals) drop_residuals(p);
  if (residuals && modes < model->n_modes) move_to_residuals(p, modes);
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    shrink_row(row, model, modes, model);
    if (second_of(p, row)) shrink_row(row, model, modes, second_of(p, row));
  }
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

void modal_model_drop_residual_modes(modal_model *model) {
  modal_wave_drop_residual_modes(model, NULL, NULL);
}

void modal_wave_drop_residual_modes(modal_model *model, modal_model *imaginary,
                                    modal_model *backward) {
  const size_t  r  = (size_t)model->n_residual;
  const double *im = imaginary ? imaginary->residual_shape : NULL;
  if (r == 0) return;
  double complex shape[r];
  for (int c = 0; model->contact_tail && c < modal_model_contact_dofs(model); c++) {
    for (size_t i = 0; i < r; i++) shape[i] = entry(model->residual_shape, im, (size_t)c * r + i);
    extend_tail(model, shape, model->contact_tail + 2 * c);
  }
  for (int k = 0; model->load_tail && k <= model->n_load; k++)
    extend_tail(model, model->residual_force + (size_t)k * r, model->load_tail + 2 * k);
  const parts p = {model, imaginary, backward};
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    if (row->part == MODAL_RESIDUAL_MODES) drop(row, &p);
  model->n_residual = 0;
  model->tail_order = 3;
}
