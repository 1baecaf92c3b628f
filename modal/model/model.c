#include "modal/model/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

static const char model_format[] = "shroudhb modal model";
/* Version 2 adds several speeds (modal/model/speeds.h), version 3 nodal diameters
 * (modal/model/nodal_diameters.h). The model itself is as in version 1. */
enum { MODEL_VERSION = 1, PATH = 128 };

bool modal_model_is_driven(const modal_model *m, int k) {
  for (int i = 0; k <= m->n_load && i < m->n_modes; i++)
    if (cabs(m->modal_force[k * m->n_modes + i]) > 0) return true;
  return false;
}

/* ---------------------------------------------------------------- writing */

/* The dimension scales that carry no data of their own, and the names of probes. */
static shb_status write_scales(hid_t at, const modal_model *model) {
  static const char *const axis[] = {"tangential", "axial", "radial"};
  SHB_TRY(h5_write_strings(at, "axis", 3, axis, "cylindrical axes about the engine axis"));
  if (model->n_pairs > 0) {
    SHB_TRY(
        h5_write_counter(at, "contact/pair", modal_size_of(model, 'p'), "contact pair, from 0"));
    SHB_TRY(h5_write_counter(at, "contact/dof", modal_size_of(model, 'c'),
                             "contact degree of freedom: (side * pairs + pair) * 3 + axis, side 0 "
                             "right, 1 left"));
  }
  SHB_TRY(h5_write_counter(at, "load/harmonic", modal_size_of(model, 'k'),
                           "harmonic of the excitation, from 0"));
  if (model->n_probes == 0) return SHB_OK;
  SHB_TRY(h5_write_strings(at, "probe/name", model->n_probes,
                           (const char *const *)model->probe_name, "name of the probe"));
  return h5_write_counter(at, "probe/dof", modal_size_of(model, 'Q'),
                          "probe degree of freedom: probe * 3 + axis");
}

static shb_status write_split(hid_t at, const modal_dataset *row, h5_shape shape, const double *re,
                              const double *im) {
  const size_t    n = h5_count(shape);
  double complex *z = shb_alloc(n, sizeof *z);
  for (size_t i = 0; i < n; i++) z[i] = CMPLX(re[i], im[i]);
  shb_status status = h5_write_complex(at, row->path, shape, z, row->units, row->long_name);
  free(z);
  return status;
}

/*   im  in  imaginary parts; NULL: real */
static shb_status write_values(hid_t at, const modal_dataset *row, h5_shape shape, const void *data,
                               const double *im) {
  if (im) return write_split(at, row, shape, data, im);
  switch (row->kind) {
    case MODAL_LOAD:
      return h5_write_complex(at, row->path, shape, data, row->units, row->long_name);
    case MODAL_INDEX:
      return h5_write_int(at, row->path, shape, data, row->units, row->long_name);
    case MODAL_NAMES:
      return h5_write_strings(at, row->path, (int)shape.dim[0], data, row->long_name);
    default:
      return h5_write_double(at, row->path, shape, data, row->units, row->long_name);
  }
}

static shb_status write_row(hid_t at, const modal_dataset *row, const modal_model *sizes,
                            const void *data, const double *im) {
  const h5_shape shape = modal_dataset_shape(row, sizes);
  const char    *first = modal_scale_of(row->dims[0]);
  if (!data || h5_count(shape) == 0) return SHB_OK; /* nothing at the contact where there is none */
  SHB_TRY(write_values(at, row, shape, data, im));
  if (first && strcmp(row->path, first) == 0) return SHB_OK; /* a scale has no scale */
  for (int i = 0; i < shape.rank; i++)
    if (modal_scale_of(row->dims[i]))
      SHB_TRY(h5_attach_scale(at, row->path, i, modal_scale_of(row->dims[i])));
  return SHB_OK;
}

/* A single interface has no name in the file. Names of a dimension are written as its scale. */
static bool is_written(const modal_dataset *row, const modal_model *model) {
  const char *scale = modal_scale_of(row->dims[0]);
  if (row->part == MODAL_INTERFACES) return model->n_interfaces > 1;
  if (row->kind == MODAL_NAMES && scale) return strcmp(row->path, scale) != 0;
  return row->part != MODAL_SIDES;
}

shb_status modal_model_write_complex_at(hid_t at, const modal_model *model,
                                        const modal_model *imaginary) {
  SHB_TRY(write_scales(at, model));
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    const double *im =
        imaginary && row->kind == MODAL_SPLIT ? modal_dataset_get(row, imaginary) : NULL;
    if (is_written(row, model))
      SHB_TRY(write_row(at, row, model, modal_dataset_get(row, model), im));
  }
  if (!model->contact_tail || model->n_pairs == 0) return SHB_OK;
  return h5_write_attribute_int(at, "contact/residual_tail", "order", model->tail_order);
}

shb_status modal_model_write_backward_at(hid_t at, const modal_model *model, const modal_model *l) {
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    char          path[PATH], text[PATH];
    modal_dataset backward = *row;
    if (row->kind != MODAL_LOAD) continue;
    snprintf(path, sizeof path, "backward/%s", row->path);
    snprintf(text, sizeof text, "as %s", row->path);
    backward.path      = path;
    backward.long_name = row->backward ? row->backward : text;
    SHB_TRY(write_row(at, &backward, model, modal_dataset_get(row, l), NULL));
  }
  return SHB_OK;
}

shb_status modal_model_write_at(hid_t at, const modal_model *model) {
  return modal_model_write_complex_at(at, model, NULL);
}

shb_status modal_model_write(hid_t file, const modal_model *model,
                             const shb_provenance *provenance) {
  SHB_TRY(h5_write_provenance(file, model_format, MODEL_VERSION, provenance));
  return modal_model_write_at(file, model);
}

/* ---------------------------------------------------------------- reading */

typedef struct {
  hid_t        at;
  const char  *path; /* in messages */
  modal_model *model, *imaginary;
} source;

static const modal_dataset *row_at(const char *path) {
  const modal_dataset *row = modal_datasets;
  while (strcmp(row->path, path) != 0) row++;
  return row;
}

/* A single name may be a scalar. */
static shb_status read_size(const source *from, const modal_size *size) {
  const modal_dataset *row   = row_at(size->path);
  h5_shape             shape = modal_dataset_shape(row, from->model);
  int                  count;
  if (!h5_exists(from->at, row->with)) return SHB_OK;
  shape.dim[0] = 0; /* any */
  if (row->kind == MODAL_NAMES) {
    SHB_TRY(h5_shape_of(from->at, row->path, &shape));
    if (shape.rank == 0) shape.dim[0] = 1;
  } else {
    SHB_TRY(h5_check_shape(from->at, row->path, &shape));
  }
  SHB_CHECK(shape.dim[0] >= (hsize_t)size->least && shape.dim[0] <= (hsize_t)size->most,
            SHB_ERR_INPUT, "%s: /%s holds %llu %s; %d to %d are wanted%s", from->path, size->path,
            (unsigned long long)shape.dim[0], size->noun, size->least, size->most,
            size->note ? size->note : "");
  count = (int)shape.dim[0] - size->beyond;
  memcpy((char *)from->model + size->offset, &count, sizeof count);
  return SHB_OK;
}

/* Real data; with im, that of complex data in two parts. */
static shb_status read_split(hid_t at, const char *dataset, h5_shape shape, double **re,
                             double **im) {
  if (!im) return h5_read_double(at, dataset, &shape, re);
  double complex *z = NULL;
  SHB_TRY(h5_read_complex(at, dataset, &shape, &z));
  const size_t n = h5_count(shape);
  *re            = shb_alloc(n, sizeof **re);
  *im            = shb_alloc(n, sizeof **im);
  for (size_t i = 0; i < n; i++) {
    (*re)[i] = creal(z[i]);
    (*im)[i] = cimag(z[i]);
  }
  free(z);
  return SHB_OK;
}

/* Read an array of its kind into *data, malloc'ed; im: the imaginary parts, or NULL. */
static shb_status read_values(hid_t at, const modal_dataset *row, h5_shape shape, void **data,
                              double **im) {
  double         *real    = NULL;
  double complex *both    = NULL;
  int            *index   = NULL;
  char          **name    = NULL;
  int             n_names = 0;
  shb_status      status  = SHB_OK;
  switch (row->kind) {
    case MODAL_LOAD:
      status = h5_read_complex(at, row->path, &shape, &both);
      *data  = both;
      break;
    case MODAL_INDEX:
      status = h5_read_int(at, row->path, &shape, &index);
      *data  = index;
      break;
    case MODAL_NAMES:
      status = h5_read_strings(at, row->path, &n_names, &name);
      *data  = name;
      break;
    default:
      status = read_split(at, row->path, shape, &real, im);
      *data  = real;
  }
  return status;
}

/* A dataset of both sides has one dimension more; the right side comes first. */
static h5_shape shape_in_file(const modal_dataset *row, const modal_model *model) {
  const h5_shape right = modal_dataset_shape(row, model);
  h5_shape       both  = {.rank = right.rank + 1, .dim = {model->has_left ? 2 : 1}};
  if (row->part != MODAL_SIDES) return right;
  for (int i = 0; i < right.rank; i++) both.dim[i + 1] = right.dim[i];
  return both;
}

static void zero(const modal_dataset *row, const modal_model *sizes, modal_model *model) {
  void *data = shb_alloc_zeroed(modal_dataset_count(row, sizes), modal_dataset_width(row));
  modal_dataset_set(row, model, data);
}

static shb_status read_row(const source *from, const modal_dataset *row) {
  modal_model *model = from->model;
  modal_model *im    = row->kind == MODAL_SPLIT ? from->imaginary : NULL;
  const bool   empty = modal_dataset_count(row, model) == 0, wanted = row->with && !empty;
  if (row->zeros && model->n_residual > 0 && (empty || !h5_exists(from->at, row->path))) {
    zero(row, model, model);
    if (im) zero(row, model, im);
    return SHB_OK;
  }
  if (empty || !h5_exists(from->at, wanted ? row->with : row->path)) return SHB_OK;
  void      *data  = NULL;
  double    *other = NULL;
  shb_status status =
      read_values(from->at, row, shape_in_file(row, model), &data, im ? &other : NULL);
  modal_dataset_set(row, model, data);
  if (im) modal_dataset_set(row, im, other);
  SHB_TRY(status);
  return row->check ? row->check(row, from->path, model, from->imaginary) : SHB_OK;
}

static shb_status read_order(hid_t at, const char *path, int *order) {
  SHB_TRY(h5_read_attribute_int(at, "contact/residual_tail", "order", 3, order));
  SHB_CHECK(*order >= 3 && *order <= 64, SHB_ERR_INPUT,
            "%s: /contact/residual_tail: attribute order is %d; 3 to 64 are wanted", path, *order);
  return SHB_OK;
}

shb_status modal_model_read_complex_at(hid_t at, const char *path, modal_model *model,
                                       modal_model *imaginary) {
  const source from = {at, path, model, imaginary};
  model->has_left   = h5_exists(at, "contact/left");
  for (const modal_size *size = modal_sizes; size->path; size++) SHB_TRY(read_size(&from, size));
  for (const modal_dataset *row = modal_datasets; row->path; row++) SHB_TRY(read_row(&from, row));
  return model->contact_tail ? read_order(at, path, &model->tail_order) : SHB_OK;
}

shb_status modal_model_read_at(hid_t at, const char *path, modal_model *model) {
  return modal_model_read_complex_at(at, path, model, NULL);
}

/* One response to the load: from the group backward, else the conjugate of the forward one. */
static shb_status read_backward(hid_t at, const modal_dataset *row, const modal_model *model,
                                modal_model *loads) {
  char                  path[PATH];
  h5_shape              shape   = modal_dataset_shape(row, model);
  const double complex *forward = modal_dataset_get(row, model);
  double complex       *back    = NULL;
  if (row->kind != MODAL_LOAD || !forward || h5_count(shape) == 0) return SHB_OK;
  snprintf(path, sizeof path, "backward/%s", row->path);
  if (h5_exists(at, "backward")) {
    SHB_TRY(h5_read_complex(at, path, &shape, &back));
  } else {
    const size_t n = h5_count(shape);
    back           = shb_alloc(n, sizeof *back);
    for (size_t i = 0; i < n; i++) back[i] = conj(forward[i]);
  }
  modal_dataset_set(row, loads, back);
  return SHB_OK;
}

shb_status modal_model_read_backward_at(hid_t at, const modal_model *model, modal_model *loads) {
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    SHB_TRY(read_backward(at, row, model, loads));
  return SHB_OK;
}

static shb_status check_real(const modal_dataset *row, const char *path, const modal_model *model,
                             const modal_model *imaginary) {
  const double *re = modal_dataset_get(row, model), *im = modal_dataset_get(row, imaginary);
  const size_t  n = re && im && row->kind == MODAL_SPLIT ? modal_dataset_count(row, model) : 0;
  double        largest = 0, worst = 0;
  for (size_t i = 0; i < n; i++) {
    largest = fmax(largest, fabs(re[i]));
    worst   = fmax(worst, fabs(im[i]));
  }
  SHB_CHECK(worst <= 1e-9 * largest, SHB_ERR_INPUT,
            "%s: /%s has an imaginary part, %.2g of the largest value; at nodal diameter 0 and N/2 "
            "it must be real: turn the phase of each mode",
            path, row->path, worst / largest);
  return SHB_OK;
}

shb_status modal_model_read_real_at(hid_t at, const char *path, modal_model *model) {
  modal_model imaginary = {0};
  shb_status  status    = modal_model_read_complex_at(at, path, model, &imaginary);
  for (const modal_dataset *row = modal_datasets; row->path && status == SHB_OK; row++)
    status = check_real(row, path, model, &imaginary);
  modal_model_free(&imaginary);
  return status;
}

/* Version 3 has no model of its own: that of nodal diameter 0 is taken. */
static shb_status read_parts(hid_t file, const char *path, modal_model *model) {
  int version;
  SHB_TRY(h5_check_format(file, model_format, MODAL_NEWEST));
  SHB_TRY(h5_read_attribute_int(file, "/", "format_version", MODEL_VERSION, &version));
  if (version < MODAL_DIAMETERS_VERSION) return modal_model_read_at(file, path, model);
  char label[1024];
  snprintf(label, sizeof label, "%s: /nodal_diameter_0", path);
  SHB_CHECK(h5_exists(file, "/nodal_diameter_0"), SHB_ERR_INPUT,
            "%s is missing; the static part of every motion stands at nodal diameter 0", label);
  hid_t group = H5Gopen2(file, "/nodal_diameter_0", H5P_DEFAULT);
  SHB_CHECK(group >= 0, SHB_ERR_INPUT, "%s is not a group", label);
  shb_status status = modal_model_read_real_at(group, label, model);
  H5Gclose(group);
  return status;
}

shb_status modal_model_read(const char *path, modal_model *model) {
  *model = (modal_model){0};
  hid_t file;
  SHB_TRY(h5_open(path, &file));
  shb_status status = read_parts(file, path, model);
  h5_close(file);
  if (status != SHB_OK) modal_model_free(model);
  return status;
}

void modal_model_release_terms(modal_model *model, int first) {
  enum { TERMS = 3 };
  double **const term[TERMS] = {&model->residual_flexibility, &model->residual_inertia,
                                &model->residual_fourth};
  const size_t   n           = (size_t)modal_model_contact_dofs(model);
  if (model->residual_diagonal || !*term[0] || !*term[1] || !*term[2]) return;
  double *diagonal = shb_alloc(TERMS * n, sizeof *diagonal);
  for (size_t t = 0; t < TERMS; t++)
    for (size_t i = 0; i < n; i++) diagonal[t * n + i] = (*term[t])[i * (n + 1)];
  model->residual_diagonal = diagonal;
  for (int t = first; t < TERMS; t++) {
    free(*term[t]);
    *term[t] = NULL;
  }
}

void modal_model_free(modal_model *model) {
  if (!model) return;
  for (const modal_dataset *row = modal_datasets; row->path; row++) modal_dataset_free(row, model);
  free(model->residual_diagonal);
  *model = (modal_model){0};
}
