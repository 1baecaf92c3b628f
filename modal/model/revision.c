#include "modal/model/revision.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "modal/hdf5/h5.h"
#include "modal/model/model.h"
#include "modal/model/receptance.h"

static shb_status scale_complex(hid_t file, const char *path, const double complex *ratio) {
  h5_shape        shape = {.rank = 2};
  double complex *value;
  SHB_TRY(h5_read_complex(file, path, &shape, &value));
  for (hsize_t k = 0; k < shape.dim[0]; k++)
    for (hsize_t i = 0; i < shape.dim[1]; i++) value[k * shape.dim[1] + i] *= ratio[k];
  shb_status status = h5_replace_complex(file, path, shape, value);
  free(value);
  return status;
}

static shb_status scale_work(hid_t file, const char *path, const double complex *ratio) {
  h5_shape shape = {.rank = 2};
  double  *value;
  SHB_TRY(h5_read_double(file, path, &shape, &value));
  for (hsize_t k = 0; k < shape.dim[0]; k++)
    for (hsize_t i = 0; i < shape.dim[1]; i++)
      value[k * shape.dim[1] + i] *= creal(ratio[k] * conj(ratio[k]));
  shb_status status = h5_replace_double(file, path, shape, value);
  free(value);
  return status;
}

/* path: PREFIXmodes/damping_ratio. */
static shb_status set_damping(hid_t file, const char *path, const modal_damping *damping) {
  char     modes[256];
  h5_shape shape = {.rank = 1};
  double  *frequency, *ratio;
  snprintf(modes, sizeof modes, "%.*sfrequency", (int)(strlen(path) - strlen("damping_ratio")),
           path);
  SHB_TRY(h5_read_double(file, modes, &shape, &frequency));
  shb_status status = h5_read_double(file, path, &shape, &ratio);
  if (status == SHB_OK) {
    for (hsize_t i = 0; i < shape.dim[0] && status == SHB_OK; i++)
      status = modal_damping_ratio(damping, (int)i, SHB_TWO_PI * frequency[i], &ratio[i]);
    if (status == SHB_OK) status = h5_replace_double(file, path, shape, ratio);
    free(ratio);
  }
  free(frequency);
  return status;
}

/* Does path end with this tail, as a whole name? */
static bool ends_with(const char *path, const char *tail) {
  const size_t n = strlen(path), t = strlen(tail);
  return n >= t && strcmp(path + n - t, tail) == 0 && (n == t || path[n - t - 1] == '/');
}

/* Datasets [K + 1, ...] of each model that a file holds change with the load. The tail is that of
 * the load's work. */
static shb_status revise_dataset(hid_t file, const char *path, const modal_revision *revision) {
  if (ends_with(path, "modes/damping_ratio")) return set_damping(file, path, &revision->damping);
  if (ends_with(path, "residual/load_weight")) return scale_complex(file, path, revision->ratio);
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    if (row->dims[0] == 'k' && ends_with(path, row->path))
      return row->kind == MODAL_REAL ? scale_work(file, path, revision->ratio)
                                     : scale_complex(file, path, revision->ratio);
  return SHB_OK;
}

typedef struct {
  const modal_revision *revision;
  shb_status            status;
} visit;

static herr_t revise_object(hid_t file, const char *path, const H5O_info_t *info, void *of) {
  visit *v = of;
  if (info->type == H5O_TYPE_DATASET) v->status = revise_dataset(file, path, v->revision);
  return v->status == SHB_OK ? 0 : -1;
}

/* The sampled receptance is damped. */
static shb_status sample_again(hid_t file, const char *path) {
  modal_model model = {0};
  if (!h5_exists(file, "/receptance/contact")) return SHB_OK;
  shb_status status = modal_model_read_at(file, path, &model);
  if (status == SHB_OK) status = modal_receptance_replace(file, &model);
  modal_model_free(&model);
  return status;
}

typedef struct {
  const char           *path;
  const modal_revision *revision;
  const shb_provenance *provenance;
} job;

static shb_status revise(hid_t file, const void *context) {
  const job *j = context;
  int        version;
  visit      v = {j->revision, SHB_OK};
  SHB_TRY(h5_read_attribute_int(file, "/", "format_version", 1, &version));
  if (H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, revise_object, &v) < 0 && v.status == SHB_OK)
    SHB_FAIL(SHB_ERR_IO, "%s: cannot be read", j->path);
  SHB_TRY(v.status);
  SHB_TRY(sample_again(file, j->path));
  return h5_write_provenance(file, "shroudhb modal model", version, j->provenance);
}

shb_status modal_revise(const char *earlier, const char *path, const modal_revision *revision,
                        const shb_provenance *provenance) {
  const job j = {path, revision, provenance};
  return h5_publish_like(earlier, path, revise, &j);
}
