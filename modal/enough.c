#include "modal/enough.h"

#include <math.h>
#include <stdlib.h>

#include "modal/receptance.h"
#include "modal/series.h"

enum { SAMPLES = 100 };

static const double TWO_PI = 6.28318530717958647692, margin = 1.2;

typedef struct {
  const modal_model *model;
  int                n;             /* contact dofs */
  double             band;          /* Hz */
  double            *moment;        /* [n][MODAL_MOMENTS] of the modes left out */
  double             most[SAMPLES]; /* greatest diagonal receptance, m/N */
} search;

static double omega_at(const search *s, int sample) {
  return TWO_PI * s->band * (sample + 1) / SAMPLES;
}

/* The receptance that errors are relative to, from all modes there are. */
static shb_status find_scale(search *s) {
  const size_t    n     = (size_t)s->n;
  double complex *value = malloc(n * n * sizeof *value);
  SHB_CHECK(value, SHB_ERR_IO, "out of memory for the receptance");
  for (int f = 0; f < SAMPLES; f++) {
    modal_receptance(s->model, omega_at(s, f), value);
    s->most[f] = 0;
    for (size_t c = 0; c < n; c++) s->most[f] = fmax(s->most[f], cabs(value[c * (n + 1)]));
  }
  free(value);
  return SHB_OK;
}

/* Relative error with the modes left out whose moments are there; last: rad/s of the last mode kept. */
static double error_with(const search *s, double last) {
  double worst = 0;
  for (int f = 0; f < SAMPLES; f++)
    for (int c = 0; c < s->n; c++) {
      double left = modal_series_left(s->moment + MODAL_MOMENTS * c, omega_at(s, f), last);
      if (s->most[f] > 0) worst = fmax(worst, left / s->most[f]);
    }
  return worst;
}

static void leave_out(search *s, int mode) {
  const modal_model *model = s->model;
  const int          side = 3 * model->n_pairs, m = model->n_modes;
  double             w = TWO_PI * model->frequency[mode], lambda = w * w;
  for (int c = 0; c < s->n; c++) {
    double phi = c < side ? model->right[c * m + mode] : model->left[(c - side) * m + mode];
    double sum = phi * phi;
    for (int j = 0; j < MODAL_MOMENTS; j++) s->moment[MODAL_MOMENTS * c + j] += sum /= lambda;
  }
}

static void count(search *s, double tolerance, int *modes, double *error) {
  const modal_model *model = s->model;
  int                kept  = model->n_modes;
  *modes                   = 0;
  *error                   = error_with(s, TWO_PI * model->frequency[kept - 1]);
  if (*error > tolerance || model->frequency[kept - 1] < margin * s->band) return;
  for (*modes = kept; kept > 1; *modes = kept) {
    if (model->frequency[kept - 1] <= margin * s->band) return;
    leave_out(s, --kept);
    double next = error_with(s, TWO_PI * model->frequency[kept - 1]);
    if (next > tolerance) return;
    *error = next;
  }
}

shb_status modal_enough(const modal_model *model, double band, double tolerance, int *modes,
                        double *error) {
  search s = {.model = model, .n = 3 * model->n_pairs * (model->has_left ? 2 : 1), .band = band};
  SHB_CHECK(modal_series_has_fourth(model) && model->moment_fourth && model->moment_fifth,
            SHB_ERR_INPUT, "the modal model does not hold what estimates its error");
  s.moment = calloc((size_t)s.n * MODAL_MOMENTS, sizeof *s.moment);
  SHB_CHECK(s.moment, SHB_ERR_IO, "out of memory to choose the modes");
  for (int c = 0; c < s.n; c++) modal_series_moments(model, c, s.moment + MODAL_MOMENTS * c);
  shb_status status = find_scale(&s);
  if (status == SHB_OK) count(&s, tolerance, modes, error);
  free(s.moment);
  return status;
}
