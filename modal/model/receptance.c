#include "modal/model/receptance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"
#include "modal/model/residual_series.h"

static const double *shape_of(const modal_model *model, int dof) {
  const int side = 3 * model->n_pairs;
  return dof < side ? model->right + (size_t)dof * (size_t)model->n_modes
                    : model->left + (size_t)(dof - side) * (size_t)model->n_modes;
}

static double complex modal_sum(const modal_model *model, double omega, const double *p,
                                const double *l) {
  double complex sum = 0;
  for (int i = 0; i < model->n_modes; i++) {
    double w = SHB_TWO_PI * model->frequency[i];
    sum += p[i] * l[i] / (w * w - omega * omega + 2 * I * model->damping_ratio[i] * w * omega);
  }
  return sum;
}

/* sum_i psi_ip psi_il times the weight of residual mode i */
static double residual_sum(const modal_model *model, const modal_series *series, int p, int l) {
  const size_t r   = (size_t)model->n_residual;
  double       sum = 0, unused;
  for (size_t i = 0; i < r; i++)
    sum += model->residual_shape[(size_t)p * r + i] * model->residual_shape[(size_t)l * r + i] *
           modal_series_mode(model, (int)i, series, &unused);
  return sum;
}

void modal_receptance(const modal_model *model, double omega, double complex *receptance) {
  const int          n      = modal_model_contact_dofs(model);
  const modal_series series = modal_series_at(model, omega);
  for (int p = 0; p < n; p++)
    for (int l = 0; l <= p; l++) {
      size_t         at    = (size_t)p * (size_t)n + (size_t)l;
      double complex value = modal_sum(model, omega, shape_of(model, p), shape_of(model, l));
      if (model->residual_flexibility) value += model->residual_flexibility[at];
      if (model->residual_inertia) value += series.weight[1] * model->residual_inertia[at];
      if (series.weight[2] != 0) value += series.weight[2] * model->residual_fourth[at];
      value += residual_sum(model, &series, p, l);
      receptance[at] = receptance[(size_t)l * (size_t)n + (size_t)p] = value;
    }
}

double modal_receptance_error(const modal_model *model, double omega,
                              const double complex *receptance) {
  const int n    = modal_model_contact_dofs(model);
  double    most = 0, error = 0;
  for (int p = 0; p < n; p++) {
    double here = modal_series_error(model, omega, p);
    if (here < 0) return -1;
    error = fmax(error, here);
    most  = fmax(most, cabs(receptance[(size_t)p * (size_t)n + (size_t)p]));
  }
  return most > 0 ? error / most : 0;
}

/* ---------------------------------------------------------------- samples */

enum { SAMPLES = 201, MAX_BYTES = 64 << 20 };

static int compare(const void *a, const void *b) {
  const double *p = a, *q = b;
  return (*p > *q) - (*p < *q);
}

/* The receptance of the contact dofs at count frequencies. */
typedef struct {
  int             n, count;
  double         *frequency;
  double         *error; /* negative where the model does not hold it */
  double complex *value; /* [count][n][n] */
} samples;

/* of is zeroed. value stays NULL where the samples would be too large, and with Coriolis terms,
 * which they would lack. */
static void sample(const modal_model *model, samples *of) {
  const int    m = model->n_modes, n = modal_model_contact_dofs(model), count = SAMPLES + m;
  const size_t each = (size_t)n * (size_t)n;
  *of               = (samples){.n = n, .count = count};
  if (n == 0 || model->coriolis || (size_t)count * each * sizeof(double complex) > MAX_BYTES)
    return;
  of->frequency    = shb_alloc((size_t)count, sizeof *of->frequency);
  of->error        = shb_alloc((size_t)count, sizeof *of->error);
  of->value        = shb_alloc((size_t)count * each, sizeof *of->value);
  const double top = 1.1 * model->frequency[m - 1];
  for (int f = 0; f < SAMPLES; f++) of->frequency[f] = top * f / (SAMPLES - 1);
  memcpy(of->frequency + SAMPLES, model->frequency, (size_t)m * sizeof *of->frequency);
  qsort(of->frequency, (size_t)count, sizeof *of->frequency, compare);
  for (int f = 0; f < count; f++) {
    double complex *value = of->value + (size_t)f * each;
    modal_receptance(model, SHB_TWO_PI * of->frequency[f], value);
    of->error[f] = modal_receptance_error(model, SHB_TWO_PI * of->frequency[f], value);
  }
}

static void samples_free(samples *of) {
  free(of->frequency);
  free(of->error);
  free(of->value);
}

static h5_shape of_values(const samples *s) {
  return H5_SHAPE((hsize_t)s->count, (hsize_t)s->n, (hsize_t)s->n);
}

static shb_status write_samples(hid_t file, const samples *s) {
  const h5_shape each = H5_SHAPE((hsize_t)s->count);
  SHB_TRY(h5_write_double(file, "receptance/frequency", each, s->frequency, "Hz", "frequency"));
  SHB_TRY(h5_write_complex(file, "receptance/contact", of_values(s), s->value, "m/N",
                           "receptance of the contact dofs, damped, with residual terms"));
  if (s->error[0] >= 0) {
    SHB_TRY(h5_write_double(file, "receptance/error", each, s->error, "-",
                            "estimated relative error of the contact receptance"));
    SHB_TRY(h5_attach_scale(file, "receptance/error", 0, "receptance/frequency"));
  }
  SHB_TRY(h5_attach_scale(file, "receptance/contact", 0, "receptance/frequency"));
  SHB_TRY(h5_attach_scale(file, "receptance/contact", 1, "contact/dof"));
  return h5_attach_scale(file, "receptance/contact", 2, "contact/dof");
}

shb_status modal_receptance_write(hid_t file, const modal_model *model) {
  samples    s;
  shb_status status = SHB_OK;
  sample(model, &s);
  if (s.value) status = write_samples(file, &s);
  samples_free(&s);
  return status;
}

shb_status modal_receptance_replace(hid_t file, const modal_model *model) {
  samples    s;
  shb_status status = SHB_OK;
  sample(model, &s);
  if (s.value) status = h5_replace_complex(file, "receptance/contact", of_values(&s), s.value);
  if (status == SHB_OK && s.value && s.error[0] >= 0)
    status = h5_replace_double(file, "receptance/error", H5_SHAPE((hsize_t)s.count), s.error);
  samples_free(&s);
  return status;
}
