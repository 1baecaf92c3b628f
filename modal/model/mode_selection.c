#include "modal/model/mode_selection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/model/receptance.h"
#include "modal/model/reduce.h"
#include "modal/model/residual_series.h"

enum { SAMPLES = 100 };

static const double BAND_MARGIN = 1.2;

typedef struct {
  const modal_model *model;
  const modal_model *imaginary;      /* NULL: real */
  int                n;              /* contact dofs */
  double             band;           /* Hz */
  double             scale[SAMPLES]; /* largest diagonal receptance, m/N */
} selection;

static double omega_at(const selection *s, int sample) {
  return SHB_TWO_PI * s->band * (sample + 1) / SAMPLES;
}

/* The model with the imaginary parts of the shapes, whose receptance is what they add to that of
 * the real parts on the diagonal. */
static modal_model shapes_of_imaginary(const modal_model *re, const modal_model *im) {
  return (modal_model){.n_modes            = re->n_modes,
                       .n_pairs            = re->n_pairs,
                       .has_left           = re->has_left,
                       .n_residual         = im->residual_shape ? re->n_residual : 0,
                       .frequency          = re->frequency,
                       .damping_ratio      = re->damping_ratio,
                       .right              = im->right,
                       .left               = im->left,
                       .residual_frequency = re->residual_frequency,
                       .residual_shape     = im->residual_shape};
}

/* Largest diagonal receptance of the full model, to which errors are relative. */
static void find_scales(selection *s) {
  const size_t    n     = (size_t)s->n;
  double complex *value = shb_alloc_zeroed(2 * n * n, sizeof *value), *more = value + n * n;
  modal_model     im = {0};
  if (s->imaginary) im = shapes_of_imaginary(s->model, s->imaginary);
  for (int f = 0; f < SAMPLES; f++) {
    modal_receptance(s->model, omega_at(s, f), value);
    if (s->imaginary) modal_receptance(&im, omega_at(s, f), more);
    s->scale[f] = 0;
    for (size_t c = 0; c < n; c++)
      s->scale[f] = fmax(s->scale[f], cabs(value[c * (n + 1)] + more[c * (n + 1)]));
  }
  free(value);
}

/* Relative error of the model with fewer modes. */
static double error_of(const selection *s, const modal_model *fewer) {
  double worst = 0;
  for (int f = 0; f < SAMPLES; f++)
    for (int c = 0; c < s->n && s->scale[f] > 0; c++)
      worst = fmax(worst, modal_series_error(fewer, omega_at(s, f), c) / s->scale[f]);
  return worst;
}

/* Copy the contact part of the model, the part that the selection reduces. A load is not needed. */
static void copy_contact(const modal_model *model, modal_model *copy) {
  *copy        = modal_model_sizes(model);
  copy->n_load = copy->n_probes = 0;
  modal_model_copy(model, copy);
  if (!copy->modal_force)
    copy->modal_force = shb_alloc_zeroed((size_t)model->n_modes, sizeof *copy->modal_force);
}

static shb_status remove_modes(selection *s, double tolerance, modal_model *reduced, int *modes,
                               double *error) {
  *modes = 0;
  *error = error_of(s, reduced);
  if (*error > tolerance || reduced->frequency[reduced->n_modes - 1] < BAND_MARGIN * s->band)
    return SHB_OK;
  for (*modes = reduced->n_modes; *modes > 1; *modes = reduced->n_modes) {
    if (reduced->frequency[*modes - 1] <= BAND_MARGIN * s->band) return SHB_OK;
    SHB_TRY(modal_model_reduce(reduced, *modes - 1, true));
    double next = error_of(s, reduced);
    if (next > tolerance) return SHB_OK;
    *error = next;
  }
  return SHB_OK;
}

shb_status modal_select_modes(const modal_model *model, double band, double tolerance, int *modes,
                              double *error) {
  selection   s = {.model = model, .n = modal_model_contact_dofs(model), .band = band};
  modal_model reduced;
  SHB_CHECK(modal_series_has_fourth(model) && !model->residual_diagonal && model->contact_tail,
            SHB_ERR_INPUT, "the modal model does not hold what estimates its error");
  copy_contact(model, &reduced);
  find_scales(&s);
  shb_status status = remove_modes(&s, tolerance, &reduced, modes, error);
  modal_model_free(&reduced);
  return status;
}

shb_status modal_modes_suffice(const modal_model *model, const modal_model *imaginary, double band,
                               double tolerance, bool *enough, double *error) {
  selection s = {
      .model = model, .imaginary = imaginary, .n = modal_model_contact_dofs(model), .band = band};
  SHB_CHECK(modal_series_has_fourth(model) && model->contact_tail, SHB_ERR_INPUT,
            "the modal model does not hold what estimates its error");
  find_scales(&s);
  *error  = error_of(&s, model);
  *enough = *error <= tolerance && model->frequency[model->n_modes - 1] >= BAND_MARGIN * band;
  return SHB_OK;
}
