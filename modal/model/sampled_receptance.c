#include "modal/model/sampled_receptance.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "modal/model/receptance.h"

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
static shb_status sample(const modal_model *model, samples *of) {
  const int    m = model->n_modes, n = modal_model_contact_dofs(model), count = SAMPLES + m;
  const size_t each = (size_t)n * (size_t)n;
  *of               = (samples){.n = n, .count = count};
  if (n == 0 || model->coriolis || (size_t)count * each * sizeof(double complex) > MAX_BYTES)
    return SHB_OK;
  of->frequency = malloc((size_t)count * sizeof *of->frequency);
  of->error     = malloc((size_t)count * sizeof *of->error);
  of->value     = malloc((size_t)count * each * sizeof *of->value);
  SHB_CHECK(of->frequency && of->error && of->value, SHB_ERR_IO,
            "out of memory for the receptance");
  const double top = 1.1 * model->frequency[m - 1];
  for (int f = 0; f < SAMPLES; f++) of->frequency[f] = top * f / (SAMPLES - 1);
  memcpy(of->frequency + SAMPLES, model->frequency, (size_t)m * sizeof *of->frequency);
  qsort(of->frequency, (size_t)count, sizeof *of->frequency, compare);
  for (int f = 0; f < count; f++) {
    double complex *value = of->value + (size_t)f * each;
    modal_receptance(model, SHB_TWO_PI * of->frequency[f], value);
    of->error[f] = modal_receptance_error(model, SHB_TWO_PI * of->frequency[f], value);
  }
  return SHB_OK;
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

shb_status modal_sampled_write(hid_t file, const modal_model *model) {
  samples    s;
  shb_status status = sample(model, &s);
  if (status == SHB_OK && s.value) status = write_samples(file, &s);
  samples_free(&s);
  return status;
}

shb_status modal_sampled_replace(hid_t file, const modal_model *model) {
  samples    s;
  shb_status status = sample(model, &s);
  if (status == SHB_OK && s.value)
    status = h5_replace_complex(file, "receptance/contact", of_values(&s), s.value);
  if (status == SHB_OK && s.value && s.error[0] >= 0)
    status = h5_replace_double(file, "receptance/error", H5_SHAPE((hsize_t)s.count), s.error);
  samples_free(&s);
  return status;
}
