#include "mhb/truncation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mhb/fourier.h"
#include "mhb/newton.h"

static const double PI = 3.14159265358979323846;

shb_status mhb_truncation_create(const mhb_residual *residual, mhb_truncation **out) {
  mhb_truncation *t = calloc(1, sizeof *t);
  SHB_CHECK(t, SHB_ERR_IO, "out of memory");
  t->narrow             = residual;
  t->settings           = *residual->settings;
  t->settings.harmonics = 2 * residual->m;
  shb_status status = mhb_residual_create(residual->receptance->model, &t->settings, &t->doubled);
  size_t     n      = status == SHB_OK ? (size_t)t->doubled->n : 0;
  if (status == SHB_OK) {
    t->x = calloc(n, sizeof(double));
    t->r = calloc(n, sizeof(double));
    if (!(t->x && t->r)) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  if (status != SHB_OK) {
    mhb_truncation_destroy(t);
    return status;
  }
  *out = t;
  return SHB_OK;
}

void mhb_truncation_destroy(mhb_truncation *t) {
  if (!t) return;
  mhb_residual_destroy(t->doubled);
  free(t->x);
  free(t->r);
  free(t);
}

double mhb_truncation_error(mhb_truncation *t, const double *x, double omega) {
  mhb_residual *b      = t->doubled;
  int           narrow = t->narrow->nb, rows = 3 * b->n_pairs;
  double        missing = 0, size = mhb_norm(x, t->narrow->n);
  mhb_residual_preload(b, t->narrow->n0);
  for (int row = 0; row < rows; row++)
    memcpy(t->x + (size_t)row * (size_t)b->nb, x + (size_t)row * (size_t)narrow,
           sizeof(double) * (size_t)narrow);
  mhb_residual_evaluate(b, t->x, omega, t->r, NULL, NULL);
  for (int row = 0; row < rows; row++)
    for (int i = narrow; i < b->nb; i++) missing += pow(t->r[row * b->nb + i], 2);
  return size > 0 ? sqrt(missing) / size : 0;
}

/* Motion, squared, by the terms of the residual series that the model does not hold: the last one held times
 * (k w/w_m)^2. */
static double modal_term(const mhb_residual *b, int k, const double complex *p) {
  const mhb_receptance *r    = b->receptance;
  int                   n    = r->n;
  double                w    = k * r->omega / r->nu;
  double                top  = 2 * PI * r->model->frequency[r->n_modes - 1];
  double                held = r->inertia ? w * w : 1, ratio = w * w / (top * top), sum = 0;
  const double complex *last = r->inertia ? r->inertia : r->flexibility;
  for (int i = 0; i < n; i++) {
    double complex u = 0;
    for (int j = 0; j < n; j++)
      u += held * last[((size_t)k * (size_t)n + (size_t)i) * (size_t)n + (size_t)j] * p[j];
    sum += creal(u) * creal(u) + cimag(u) * cimag(u);
  }
  return sum * ratio * ratio;
}

double mhb_modal_error(const mhb_residual *b, const double *x) {
  double complex p[3 * b->n_pairs];
  double         unheld = 0, size = mhb_norm(x, b->n);
  if (!b->receptance->flexibility) return -1;
  for (int k = 0; k <= b->m; k++) {
    mhb_residual_force(b, k, p);
    unheld += modal_term(b, k, p);
  }
  return size > 0 ? sqrt(unheld) / size : 0;
}
