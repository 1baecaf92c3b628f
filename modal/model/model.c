#include "modal/model/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/publish.h"

static const char model_format[] = "shroudhb modal model";
/* Version 2 adds several speeds (modal/model/speeds.h), version 3 nodal diameters
 * (modal/model/nodal_diameters.h). The model itself is as in version 1. */
enum { MODEL_VERSION = 1, MAX_MODES = 100000, MAX_PAIRS = 100000, MAX_HARMONICS = 10000 };

bool modal_model_is_driven(const modal_model *m, int k) {
  for (int i = 0; k <= m->n_load && i < m->n_modes; i++)
    if (cabs(m->modal_force[k * m->n_modes + i]) > 0) return true;
  return false;
}

int modal_model_contact_dofs(const modal_model *model) {
  return 3 * model->n_pairs * (model->has_left ? 2 : 1);
}

/* ---------------------------------------------------------------- writing */

/* A dataset of the table below. Each letter of dims names one dimension:
 *
 *   m  modes             p  pairs             2, 3  that number   c  contact dofs
 *   k  load harmonics    q  probes            Q  probe dofs, 3 q  r  residual modes */
typedef struct {
  const char *path, *dims, *units, *long_name;
  bool        is_complex;
  const void *data; /* NULL: not written */
} entry;

static hsize_t size_of(const modal_model *model, char letter) {
  switch (letter) {
    case 'm':
      return (hsize_t)model->n_modes;
    case 'p':
      return (hsize_t)model->n_pairs;
    case '2':
      return 2;
    case '3':
      return 3;
    case 'r':
      return (hsize_t)model->n_residual;
    case 'c':
      return (hsize_t)modal_model_contact_dofs(model);
    case 'k':
      return (hsize_t)model->n_load + 1;
    case 'q':
      return (hsize_t)model->n_probes;
    default:
      return 3 * (hsize_t)model->n_probes;
  }
}

/* Dimension scale of a dimension, if there is one; the frequencies label the modes. */
static const char *scale_of(char letter) {
  switch (letter) {
    case '2':
      return NULL;
    case 'm':
      return "modes/frequency";
    case 'r':
      return "residual_modes/frequency";
    case 'p':
      return "contact/pair";
    case '3':
      return "axis";
    case 'c':
      return "contact/dof";
    case 'k':
      return "load/harmonic";
    case 'q':
      return "probe/name";
    default:
      return "probe/dof";
  }
}

static h5_shape shape_from(const modal_model *model, const char *dims) {
  h5_shape shape = {.rank = (int)strlen(dims)};
  for (int i = 0; i < shape.rank; i++) shape.dim[i] = size_of(model, dims[i]);
  return shape;
}

/* The dimension scales that carry no data of their own. */
static shb_status write_scales(hid_t at, const modal_model *model) {
  static const char *const axis[] = {"tangential", "axial", "radial"};
  SHB_TRY(h5_write_strings(at, "axis", 3, axis, "cylindrical axes about the engine axis"));
  if (model->n_pairs > 0) {
    SHB_TRY(h5_write_counter(at, "contact/pair", size_of(model, 'p'), "contact pair, from 0"));
    SHB_TRY(h5_write_counter(at, "contact/dof", size_of(model, 'c'),
                             "contact degree of freedom: (side * pairs + pair) * 3 + axis, side 0 "
                             "right, 1 left"));
  }
  SHB_TRY(h5_write_counter(at, "load/harmonic", size_of(model, 'k'),
                           "harmonic of the excitation, from 0"));
  if (model->n_probes == 0) return SHB_OK;
  SHB_TRY(h5_write_strings(at, "probe/name", model->n_probes,
                           (const char *const *)model->probe_name, "name of the probe"));
  return h5_write_counter(at, "probe/dof", size_of(model, 'Q'),
                          "probe degree of freedom: probe * 3 + axis");
}

static shb_status write_split(hid_t at, const entry *e, h5_shape shape, const double *im) {
  const double   *re = e->data;
  const size_t    n  = h5_count(shape);
  double complex *z  = malloc(n * sizeof *z);
  SHB_CHECK(z, SHB_ERR_IO, "out of memory");
  for (size_t i = 0; i < n; i++) z[i] = CMPLX(re[i], im[i]);
  shb_status status = h5_write_complex(at, e->path, shape, z, e->units, e->long_name);
  free(z);
  return status;
}

/* The imaginary part that belongs to an array of the model; NULL: it is real. */
static const double *imaginary_of(const void *data, const modal_model *m, const modal_model *im) {
  const struct {
    const double *re, *im;
  } both[] = {{m->right, im->right},
              {m->left, im->left},
              {m->coriolis, im->coriolis},
              {m->residual_flexibility, im->residual_flexibility},
              {m->residual_inertia, im->residual_inertia},
              {m->residual_fourth, im->residual_fourth},
              {m->residual_shape, im->residual_shape},
              {m->residual_probe, im->residual_probe},
              {m->probe, im->probe},
              {m->probe_contact_residual, im->probe_contact_residual},
              {m->probe_contact_inertia, im->probe_contact_inertia},
              {m->probe_contact_fourth, im->probe_contact_fourth}};
  for (size_t i = 0; i < sizeof both / sizeof *both; i++)
    if (both[i].re == data) return both[i].im;
  return NULL;
}

static shb_status write_entry(hid_t at, const modal_model *model, const modal_model *imaginary,
                              const entry *e) {
  if (!e->data) return SHB_OK;
  h5_shape shape = shape_from(model, e->dims);
  if (h5_count(shape) == 0) return SHB_OK; /* nothing at the contact where there is none */
  const double *im = imaginary ? imaginary_of(e->data, model, imaginary) : NULL;
  if (im) {
    SHB_TRY(write_split(at, e, shape, im));
  } else if (e->is_complex) {
    SHB_TRY(h5_write_complex(at, e->path, shape, e->data, e->units, e->long_name));
  } else {
    SHB_TRY(h5_write_double(at, e->path, shape, e->data, e->units, e->long_name));
  }
  if (strcmp(e->path, scale_of(e->dims[0])) == 0) return SHB_OK; /* a scale has no scale */
  for (int i = 0; i < shape.rank; i++)
    if (scale_of(e->dims[i])) SHB_TRY(h5_attach_scale(at, e->path, i, scale_of(e->dims[i])));
  return SHB_OK;
}

/* A single interface has no name in the file. */
static shb_status write_interfaces(hid_t at, const modal_model *model) {
  if (model->n_interfaces < 2) return SHB_OK;
  SHB_TRY(h5_write_strings(at, "contact/interface_name", model->n_interfaces,
                           (const char *const *)model->interface_name, "contact interface"));
  SHB_TRY(h5_write_int(at, "contact/interface", H5_SHAPE((hsize_t)model->n_pairs), model->interface,
                       "-", "contact interface of the pair, from 0"));
  return h5_attach_scale(at, "contact/interface", 0, "contact/pair");
}

shb_status modal_model_write_complex_at(hid_t at, const modal_model *model,
                                        const modal_model *imaginary) {
  const bool  probes = model->n_probes > 0, residual = model->n_residual > 0;
  const entry table[] = {
      {"modes/frequency", "m", "Hz", "undamped natural frequency of the free blade", false,
       model->frequency},
      {"modes/damping_ratio", "m", "-", "modal damping ratio", false, model->damping_ratio},
      {"modes/residual", "m", "-", "relative residual of the eigenpair", false,
       model->eigen_residual},
      {"modes/coriolis", "mm", "1/s",
       "Coriolis matrix phi^H G phi of the modes at the rotor speed: q'' + G q' + diag(omega^2) q",
       false, model->coriolis},
      {"contact/right/shape", "p3m", "kg^-1/2", "mass-normalised modes at the right contact", false,
       model->right},
      {"contact/left/shape", "p3m", "kg^-1/2", "mass-normalised modes at the left contact", false,
       model->has_left ? model->left : NULL},
      {"contact/residual_flexibility", "cc", "m/N", "static flexibility of the modes left out",
       false, model->residual_flexibility},
      {"contact/residual_inertia", "cc", "m s^2/N",
       "coefficient of omega^2 in the receptance of the modes left out", false,
       model->residual_inertia},
      {"contact/residual_fourth", "cc", "m s^4/N",
       "coefficient of omega^4 in the receptance of the modes left out", false,
       model->residual_fourth},
      {"contact/residual_tail", "c2", "m s^2r/N, m s^(2r+2)/N",
       "a and b of what terms and residual modes leave out, a omega^2r + b omega^(2r+2) + .., r "
       "the "
       "attribute order",
       false, model->contact_tail},
      {"residual_modes/frequency", "r", "Hz", "frequency of a mode that stands for modes left out",
       false, residual ? model->residual_frequency : NULL},
      {"residual_modes/contact", "cr", "kg^-1/2", "residual modes at the contact", false,
       residual ? model->residual_shape : NULL},
      {"residual_modes/load", "kr", "N kg^-1/2", "force of the load on the residual modes", true,
       residual ? model->residual_force : NULL},
      {"residual_modes/probe", "Qr", "kg^-1/2", "residual modes at the probes", false,
       residual && probes ? model->residual_probe : NULL},
      {"contact/normal", "p3", "-", "unit normal v of the right face, cylindrical axes", false,
       model->normal},
      {"contact/area", "p", "m^2", "area of the contact patch", false, model->area},
      {"load/modal_force", "km", "N kg^-1/2", "modal force; f(t) = Re sum_k f_k exp(j k omega t)",
       true, model->modal_force},
      {"load/residual_response", "kc", "m",
       "static response of the contact dofs to the load, modes removed", true,
       model->load_residual},
      {"load/residual_inertia", "kc", "m s^2",
       "coefficient of omega^2 in the response of the contact dofs to the load, modes removed",
       true, model->load_inertia},
      {"load/residual_fourth", "kc", "m s^4", "its coefficient of omega^4", true,
       model->load_fourth},
      {"load/residual_tail", "k2", "N m s^2r, N m s^(2r+2)",
       "as contact/residual_tail, of the load's work", false, model->load_tail},
      {"probe/shape", "q3m", "kg^-1/2", "mass-normalised modes at the probes", false,
       probes ? model->probe : NULL},
      {"probe/contact_residual", "Qc", "m/N", "static flexibility probe to contact, modes removed",
       false, probes ? model->probe_contact_residual : NULL},
      {"probe/load_residual", "kQ", "m", "static response of the probes to the load, modes removed",
       true, probes ? model->probe_load_residual : NULL},
      {"probe/contact_inertia", "Qc", "m s^2/N",
       "coefficient of omega^2 in the receptance probe to contact, modes removed", false,
       probes ? model->probe_contact_inertia : NULL},
      {"probe/load_inertia", "kQ", "m s^2",
       "coefficient of omega^2 in the response of the probes to the load, modes removed", true,
       probes ? model->probe_load_inertia : NULL},
      {"probe/contact_fourth", "Qc", "m s^4/N", "coefficient of omega^4 of the same", false,
       probes ? model->probe_contact_fourth : NULL},
      {"probe/load_fourth", "kQ", "m s^4", "coefficient of omega^4 of the same", true,
       probes ? model->probe_load_fourth : NULL},
  };
  SHB_TRY(write_scales(at, model));
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    SHB_TRY(write_entry(at, model, imaginary, &table[i]));
  if (model->contact_tail && model->n_pairs > 0)
    SHB_TRY(h5_write_attribute_int(at, "contact/residual_tail", "order", model->tail_order));
  return write_interfaces(at, model);
}

shb_status modal_model_write_backward_at(hid_t at, const modal_model *model, const modal_model *l) {
  const entry table[] = {
      {"backward/load/modal_force", "km", "N kg^-1/2", "modal force on the conjugate shapes", true,
       l->modal_force},
      {"backward/load/residual_response", "kc", "m", "as load/residual_response", true,
       l->load_residual},
      {"backward/load/residual_inertia", "kc", "m s^2", "as load/residual_inertia", true,
       l->load_inertia},
      {"backward/load/residual_fourth", "kc", "m s^4", "as load/residual_fourth", true,
       l->load_fourth},
      {"backward/residual_modes/load", "kr", "N kg^-1/2", "as residual_modes/load", true,
       model->n_residual > 0 ? l->residual_force : NULL},
      {"backward/probe/load_residual", "kQ", "m", "as probe/load_residual", true,
       l->probe_load_residual},
      {"backward/probe/load_inertia", "kQ", "m s^2", "as probe/load_inertia", true,
       l->probe_load_inertia},
      {"backward/probe/load_fourth", "kQ", "m s^4", "as probe/load_fourth", true,
       l->probe_load_fourth},
  };
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    SHB_TRY(write_entry(at, model, NULL, &table[i]));
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

static shb_status check_modes(const char *path, const modal_model *model) {
  for (int i = 0; i < model->n_modes; i++) {
    double f = model->frequency[i], zeta = model->damping_ratio[i];
    SHB_CHECK(
        f >= 0, SHB_ERR_INPUT,
        "%s: /modes/frequency: value %d (from 0) is %g Hz; a frequency is 0 (of a free body) or "
        "positive",
        path, i, f);
    SHB_CHECK(i == 0 || f >= model->frequency[i - 1], SHB_ERR_INPUT,
              "%s: /modes/frequency: value %d (from 0), %g Hz, is below the one before; sort the "
              "modes by frequency",
              path, i, f);
    SHB_CHECK(
        zeta >= 0 && zeta < 1, SHB_ERR_INPUT,
        "%s: /modes/damping_ratio: value %d (from 0) is %g; it must be at least 0 and below 1",
        path, i, zeta);
  }
  return SHB_OK;
}

/* Real data; with im, that of complex data in two parts. */
static shb_status read_split(hid_t at, const char *dataset, h5_shape *shape, double **re,
                             double **im) {
  if (!im) return h5_read_double(at, dataset, shape, re);
  double complex *z = NULL;
  SHB_TRY(h5_read_complex(at, dataset, shape, &z));
  const size_t n = h5_count(*shape);
  *re            = malloc((n + 1) * sizeof **re);
  *im            = malloc((n + 1) * sizeof **im);
  for (size_t i = 0; *re && *im && i < n; i++) {
    (*re)[i] = creal(z[i]);
    (*im)[i] = cimag(z[i]);
  }
  free(z);
  SHB_CHECK(*re && *im, SHB_ERR_IO, "out of memory");
  return SHB_OK;
}

/* Read a dataset if the file holds it. */
static shb_status read_optional(hid_t at, const char *dataset, h5_shape shape, double **data,
                                double **im) {
  return h5_exists(at, dataset) ? read_split(at, dataset, &shape, data, im) : SHB_OK;
}

static shb_status read_optional_complex(hid_t at, const char *dataset, h5_shape shape,
                                        double complex **data) {
  return h5_exists(at, dataset) ? h5_read_complex(at, dataset, &shape, data) : SHB_OK;
}

/* How far a matrix is from sign times its conjugate transpose. */
typedef struct {
  double largest, worst; /* of its values; of the differences */
  size_t row, column;    /* where that is */
} asymmetry;

/*   matrix, im  in  [n][n] real and imaginary part; im NULL: real */
static asymmetry asymmetry_of(size_t n, const double *matrix, const double *im, double sign) {
  asymmetry a = {0};
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const size_t here = i * n + j, there = j * n + i;
      const double off    = matrix[here] - sign * matrix[there];
      const double across = im ? im[here] + sign * im[there] : 0;
      a.largest         = fmax(a.largest, im ? hypot(matrix[here], im[here]) : fabs(matrix[here]));
      const double size = im ? hypot(off, across) : fabs(off);
      if (size <= a.worst) continue;
      a.worst  = size;
      a.row    = i;
      a.column = j;
    }
  return a;
}

/* Coriolis forces do no work: the matrix must be skew-symmetric to 1e-6 of its largest value, or
 * skew-Hermitian. */
static shb_status read_coriolis(hid_t at, const char *path, modal_model *model, modal_model *im) {
  const size_t m     = (size_t)model->n_modes;
  h5_shape     shape = H5_SHAPE((hsize_t)m, (hsize_t)m);
  if (!h5_exists(at, "modes/coriolis")) return SHB_OK;
  SHB_TRY(read_split(at, "modes/coriolis", &shape, &model->coriolis, im ? &im->coriolis : NULL));
  const asymmetry a = asymmetry_of(m, model->coriolis, im ? im->coriolis : NULL, -1);
  SHB_CHECK(a.worst <= 1e-6 * a.largest, SHB_ERR_INPUT,
            "%s: /modes/coriolis is not skew-%s: [%zu, %zu] and [%zu, %zu] add up to %.2g of the "
            "largest value; a matrix that does no work is wanted",
            path, im ? "Hermitian" : "symmetric", a.row, a.column, a.column, a.row,
            a.worst / a.largest);
  return SHB_OK;
}

static shb_status read_modes(hid_t at, const char *path, modal_model *model, modal_model *im) {
  h5_shape shape = H5_SHAPE(0);
  SHB_TRY(h5_read_double(at, "modes/frequency", &shape, &model->frequency));
  SHB_CHECK(shape.dim[0] > 0 && shape.dim[0] <= MAX_MODES, SHB_ERR_INPUT,
            "%s: /modes/frequency holds %llu modes; 1 to %d are wanted", path,
            (unsigned long long)shape.dim[0], MAX_MODES);
  model->n_modes = (int)shape.dim[0];
  SHB_TRY(h5_read_double(at, "modes/damping_ratio", &shape, &model->damping_ratio));
  SHB_TRY(read_optional(at, "modes/residual", shape, &model->eigen_residual, NULL));
  SHB_TRY(read_coriolis(at, path, model, im));
  return check_modes(path, model);
}

/* Reciprocity: the matrix must be symmetric to 1e-6 of its largest value, or Hermitian. */
static shb_status check_symmetric(const char *path, const char *dataset, const double *matrix,
                                  const double *im, int n) {
  const asymmetry a = asymmetry_of((size_t)n, matrix, im, 1);
  SHB_CHECK(a.worst <= 1e-6 * a.largest, SHB_ERR_INPUT,
            "%s: /%s is not %s: [%zu, %zu] and [%zu, %zu] differ by %.2g of the largest value; a "
            "receptance must be %s to 1e-6",
            path, dataset, im ? "Hermitian" : "symmetric", a.row, a.column, a.column, a.row,
            a.worst / a.largest, im ? "Hermitian" : "symmetric");
  return SHB_OK;
}

static shb_status read_symmetric(hid_t at, const char *path, const char *dataset, int n,
                                 double **matrix, double **im) {
  if (!h5_exists(at, dataset)) return SHB_OK;
  h5_shape shape = H5_SHAPE((hsize_t)n, (hsize_t)n);
  SHB_TRY(read_split(at, dataset, &shape, matrix, im));
  return check_symmetric(path, dataset, *matrix, im ? *im : NULL, n);
}

static shb_status read_tail(hid_t at, const char *path, const char *dataset, int n, double **tail) {
  if (!h5_exists(at, dataset)) return SHB_OK;
  h5_shape shape = H5_SHAPE((hsize_t)n, 2);
  SHB_TRY(h5_read_double(at, dataset, &shape, tail));
  for (int i = 0; i < 2 * n; i++)
    SHB_CHECK((*tail)[i] >= 0, SHB_ERR_INPUT,
              "%s: /%s: value [%d, %d] is %g; a sum of squares is wanted", path, dataset, i / 2,
              i % 2, (*tail)[i]);
  return SHB_OK;
}

/* The residual flexibility is a sum of phi^2/omega^2: its diagonal is not negative, but for
 * rounding and other programs' integration rules. The margin is relative to the flexibility of the
 * modes. */
static shb_status check_flexibility(const char *path, const modal_model *model,
                                    const modal_model *im) {
  static const double allowed = 1e-3;
  const int m = model->n_modes, n = modal_model_contact_dofs(model), right = 3 * model->n_pairs;
  for (int i = 0; model->residual_flexibility && i < n; i++) {
    const double *shape = i < right ? model->right + (size_t)i * (size_t)m
                                    : model->left + (size_t)(i - right) * (size_t)m;
    double        R = model->residual_flexibility[(size_t)i * (size_t)(n + 1)], modes = 0;
    const double *other = NULL;
    if (im)
      other = i < right ? im->right + (size_t)i * (size_t)m
                        : im->left + (size_t)(i - right) * (size_t)m;
    for (int k = 0; k < m; k++) {
      if (!(model->frequency[k] > 0)) continue; /* it has no static flexibility */
      modes += pow(shape[k] / (SHB_TWO_PI * model->frequency[k]), 2);
      if (other) modes += pow(other[k] / (SHB_TWO_PI * model->frequency[k]), 2);
    }
    SHB_CHECK(!(R < -allowed * modes), SHB_ERR_INPUT,
              "%s: /contact/residual_flexibility: value [%d, %d] is %.3g m/N; what modes leave out "
              "cannot be negative: static flexibility less that of the modes, %.3g m/N here, is "
              "wanted",
              path, i, i, R, modes);
  }
  return SHB_OK;
}

static shb_status check_patches(const char *path, const modal_model *model) {
  for (int i = 0; i < model->n_pairs; i++) {
    SHB_CHECK(!model->area || model->area[i] > 0, SHB_ERR_INPUT,
              "%s: /contact/area: value %d (from 0) is %g m^2; all must be positive", path, i,
              model->area[i]);
    if (!model->normal) continue;
    const double *v      = model->normal + 3 * (size_t)i;
    double        length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    SHB_CHECK(fabs(length - 1) < 1e-6, SHB_ERR_INPUT,
              "%s: /contact/normal: row %d (from 0) has length %g; unit vectors are wanted", path,
              i, length);
  }
  return SHB_OK;
}

/* /contact/coordinates holds both sides; the right one is kept. */
static shb_status read_positions(hid_t at, modal_model *model) {
  const hsize_t sides = model->has_left ? 2 : 1;
  h5_shape      shape = H5_SHAPE(sides, (hsize_t)model->n_pairs, 3);
  return read_optional(at, "contact/coordinates", shape, &model->position, NULL);
}

static shb_status read_contact(hid_t at, const char *path, modal_model *model, modal_model *im) {
  h5_shape shape = H5_SHAPE(0, 3, (hsize_t)model->n_modes);
  if (!h5_exists(at, "contact")) return SHB_OK; /* a body that touches nothing */
  SHB_TRY(read_split(at, "contact/right/shape", &shape, &model->right, im ? &im->right : NULL));
  SHB_CHECK(shape.dim[0] > 0 && shape.dim[0] <= MAX_PAIRS, SHB_ERR_INPUT,
            "%s: /contact/right/shape holds %llu contact pairs; 1 to %d are wanted", path,
            (unsigned long long)shape.dim[0], MAX_PAIRS);
  model->n_pairs  = (int)shape.dim[0];
  model->has_left = h5_exists(at, "contact/left");
  if (model->has_left)
    SHB_TRY(read_split(at, "contact/left/shape", &shape, &model->left, im ? &im->left : NULL));
  const int n = modal_model_contact_dofs(model);
  SHB_TRY(read_symmetric(at, path, "contact/residual_flexibility", n, &model->residual_flexibility,
                         im ? &im->residual_flexibility : NULL));
  SHB_TRY(read_symmetric(at, path, "contact/residual_inertia", n, &model->residual_inertia,
                         im ? &im->residual_inertia : NULL));
  SHB_TRY(read_symmetric(at, path, "contact/residual_fourth", n, &model->residual_fourth,
                         im ? &im->residual_fourth : NULL));
  SHB_TRY(read_tail(at, path, "contact/residual_tail", n, &model->contact_tail));
  h5_shape normals = H5_SHAPE(shape.dim[0], 3), areas = H5_SHAPE(shape.dim[0]);
  SHB_TRY(read_optional(at, "contact/normal", normals, &model->normal, NULL));
  SHB_TRY(read_optional(at, "contact/area", areas, &model->area, NULL));
  SHB_TRY(read_positions(at, model));
  SHB_TRY(check_flexibility(path, model, im));
  return check_patches(path, model);
}

/* Columns of tables and keys of summaries are known by these names. */
static shb_status check_names(const char *path, const char *dataset, int n, char *const *name) {
  for (int i = 0; i < n; i++) {
    SHB_CHECK(shb_name_is_plain(name[i]), SHB_ERR_INPUT,
              "%s: /%s: name %d (from 0) is empty, or holds a control character or one that turns "
              "the direction of text; letters, digits and _ - . + would do",
              path, dataset, i);
    for (int k = 0; k < i; k++)
      SHB_CHECK(strcmp(name[i], name[k]) != 0, SHB_ERR_INPUT,
                "%s: /%s: names %d and %d (from 0) are both '%s'; give each its own", path, dataset,
                k, i, name[i]);
  }
  return SHB_OK;
}

/* Read which interface each pair belongs to. */
static shb_status read_interfaces(hid_t at, const char *path, modal_model *model) {
  h5_shape pairs = H5_SHAPE((hsize_t)model->n_pairs);
  if (!h5_exists(at, "contact/interface")) return SHB_OK;
  SHB_TRY(
      h5_read_strings(at, "contact/interface_name", &model->n_interfaces, &model->interface_name));
  SHB_TRY(check_names(path, "contact/interface_name", model->n_interfaces, model->interface_name));
  SHB_TRY(h5_read_int(at, "contact/interface", &pairs, &model->interface));
  for (int i = 0; i < model->n_pairs; i++)
    SHB_CHECK(model->interface[i] >= 0 && model->interface[i] < model->n_interfaces, SHB_ERR_INPUT,
              "%s: /contact/interface: value %d (from 0) is %d; 0 to %d are wanted, as "
              "/contact/interface_name has names",
              path, i, model->interface[i], model->n_interfaces - 1);
  return SHB_OK;
}

static shb_status read_load(hid_t at, const char *path, modal_model *model) {
  h5_shape shape = H5_SHAPE(0, (hsize_t)model->n_modes);
  SHB_TRY(h5_read_complex(at, "load/modal_force", &shape, &model->modal_force));
  SHB_CHECK(shape.dim[0] > 0 && shape.dim[0] <= MAX_HARMONICS, SHB_ERR_INPUT,
            "%s: /load/modal_force holds %llu harmonics; 1 to %d are wanted, the first being the "
            "mean (k = 0)",
            path, (unsigned long long)shape.dim[0], MAX_HARMONICS);
  model->n_load = (int)shape.dim[0] - 1;
  if (model->n_pairs == 0) return SHB_OK;
  h5_shape residual = H5_SHAPE(shape.dim[0], (hsize_t)modal_model_contact_dofs(model));
  SHB_TRY(read_optional_complex(at, "load/residual_response", residual, &model->load_residual));
  SHB_TRY(read_optional_complex(at, "load/residual_inertia", residual, &model->load_inertia));
  SHB_TRY(read_optional_complex(at, "load/residual_fourth", residual, &model->load_fourth));
  return read_tail(at, path, "load/residual_tail", model->n_load + 1, &model->load_tail);
}

static shb_status read_probes(hid_t at, const char *path, modal_model *model, modal_model *im) {
  if (!h5_exists(at, "probe")) return SHB_OK;
  SHB_TRY(h5_read_strings(at, "probe/name", &model->n_probes, &model->probe_name));
  const hsize_t q = (hsize_t)model->n_probes, c = (hsize_t)modal_model_contact_dofs(model);
  if (q == 0) return SHB_OK;
  SHB_TRY(check_names(path, "probe/name", model->n_probes, model->probe_name));
  h5_shape shape = H5_SHAPE(q, 3, (hsize_t)model->n_modes);
  SHB_TRY(read_split(at, "probe/shape", &shape, &model->probe, im ? &im->probe : NULL));
  h5_shape contact = H5_SHAPE(3 * q, c), load = H5_SHAPE((hsize_t)model->n_load + 1, 3 * q);
  SHB_TRY(read_optional(at, "probe/contact_residual", contact, &model->probe_contact_residual,
                        im ? &im->probe_contact_residual : NULL));
  SHB_TRY(read_optional_complex(at, "probe/load_residual", load, &model->probe_load_residual));
  SHB_TRY(read_optional(at, "probe/contact_inertia", contact, &model->probe_contact_inertia,
                        im ? &im->probe_contact_inertia : NULL));
  SHB_TRY(read_optional_complex(at, "probe/load_inertia", load, &model->probe_load_inertia));
  SHB_TRY(read_optional(at, "probe/contact_fourth", contact, &model->probe_contact_fourth,
                        im ? &im->probe_contact_fourth : NULL));
  SHB_TRY(read_optional_complex(at, "probe/load_fourth", load, &model->probe_load_fourth));
  return SHB_OK;
}

static shb_status read_order(hid_t at, const char *path, int *order) {
  SHB_TRY(h5_read_attribute_int(at, "contact/residual_tail", "order", 3, order));
  SHB_CHECK(*order >= 3 && *order <= 64, SHB_ERR_INPUT,
            "%s: /contact/residual_tail: attribute order is %d; 3 to 64 are wanted", path, *order);
  return SHB_OK;
}

static shb_status check_residual_modes(const char *path, const modal_model *model) {
  SHB_CHECK(model->residual_flexibility && model->residual_inertia && model->residual_fourth,
            SHB_ERR_INPUT,
            "%s: /residual_modes count beside /contact/residual_flexibility, residual_inertia and "
            "residual_fourth only; write those too, or leave the residual modes out",
            path);
  for (int i = 0; i < model->n_residual; i++)
    SHB_CHECK(
        model->residual_frequency[i] > 0 &&
            (i == 0 || model->residual_frequency[i] >= model->residual_frequency[i - 1]),
        SHB_ERR_INPUT,
        "%s: /residual_modes/frequency: value %d (from 0) is %g Hz; all must be positive, and "
        "ascend",
        path, i, model->residual_frequency[i]);
  const double last = model->frequency[model->n_modes - 1];
  SHB_CHECK(model->n_residual == 0 || model->residual_frequency[0] >= 0.999 * last, SHB_ERR_INPUT,
            "%s: /residual_modes/frequency: value 0 is %g Hz, below the last of /modes/frequency, "
            "%g Hz; a mode among those kept belongs to /modes",
            path, model->residual_frequency[0], last);
  return SHB_OK;
}

/* Read the residual modes. Load and probe parts are zero where the file has none. */
static shb_status read_residual_modes(hid_t at, const char *path, modal_model *model,
                                      modal_model *im) {
  static const char *const load = "residual_modes/load", *const probe = "residual_modes/probe";
  const size_t K = (size_t)model->n_load + 1, q = 3 * (size_t)model->n_probes;
  h5_shape     shape = H5_SHAPE(0);
  if (!h5_exists(at, "residual_modes")) return SHB_OK;
  SHB_TRY(h5_read_double(at, "residual_modes/frequency", &shape, &model->residual_frequency));
  SHB_CHECK(shape.dim[0] <= MAX_MODES, SHB_ERR_INPUT,
            "%s: /residual_modes holds %llu modes; %d are the most", path,
            (unsigned long long)shape.dim[0], MAX_MODES);
  model->n_residual   = (int)shape.dim[0];
  h5_shape by_contact = H5_SHAPE((hsize_t)modal_model_contact_dofs(model), shape.dim[0]),
           by_load = H5_SHAPE(K, shape.dim[0]), by_probe = H5_SHAPE(q, shape.dim[0]);
  SHB_TRY(read_split(at, "residual_modes/contact", &by_contact, &model->residual_shape,
                     im ? &im->residual_shape : NULL));
  SHB_TRY(read_optional_complex(at, load, by_load, &model->residual_force));
  if (q && h5_exists(at, probe))
    SHB_TRY(
        read_split(at, probe, &by_probe, &model->residual_probe, im ? &im->residual_probe : NULL));
  if (!model->residual_force)
    model->residual_force = calloc(K * shape.dim[0] + 1, sizeof(double complex));
  if (!model->residual_probe) model->residual_probe = calloc(q * shape.dim[0] + 1, sizeof(double));
  if (im && !im->residual_probe) im->residual_probe = calloc(q * shape.dim[0] + 1, sizeof(double));
  SHB_CHECK(model->residual_force && model->residual_probe && (!im || im->residual_probe),
            SHB_ERR_IO, "out of memory");
  return check_residual_modes(path, model);
}

shb_status modal_model_read_complex_at(hid_t at, const char *path, modal_model *model,
                                       modal_model *imaginary) {
  SHB_TRY(read_modes(at, path, model, imaginary));
  SHB_TRY(read_contact(at, path, model, imaginary));
  SHB_TRY(read_interfaces(at, path, model));
  SHB_TRY(read_load(at, path, model));
  SHB_TRY(read_probes(at, path, model, imaginary));
  if (model->contact_tail) SHB_TRY(read_order(at, path, &model->tail_order));
  return read_residual_modes(at, path, model, imaginary);
}

shb_status modal_model_read_at(hid_t at, const char *path, modal_model *model) {
  return modal_model_read_complex_at(at, path, model, NULL);
}

/* One response to the load: from the group backward, else the conjugate of the forward one. */
static shb_status read_backward(hid_t at, const char *dataset, h5_shape shape,
                                const double complex *forward, double complex **backward) {
  char path[64];
  if (!forward) return SHB_OK;
  snprintf(path, sizeof path, "backward/%s", dataset);
  if (h5_exists(at, "backward")) return h5_read_complex(at, path, &shape, backward);
  const size_t n = h5_count(shape);
  *backward      = malloc((n + 1) * sizeof **backward);
  SHB_CHECK(*backward, SHB_ERR_IO, "out of memory");
  for (size_t i = 0; i < n; i++) (*backward)[i] = conj(forward[i]);
  return SHB_OK;
}

shb_status modal_model_read_backward_at(hid_t at, const modal_model *m, modal_model *l) {
  const hsize_t K = (hsize_t)m->n_load + 1, q = 3 * (hsize_t)m->n_probes;
  h5_shape      mode = H5_SHAPE(K, (hsize_t)m->n_modes), rest = H5_SHAPE(K, (hsize_t)m->n_residual);
  h5_shape      contact = H5_SHAPE(K, (hsize_t)modal_model_contact_dofs(m)), probe = H5_SHAPE(K, q);
  SHB_TRY(read_backward(at, "load/modal_force", mode, m->modal_force, &l->modal_force));
  SHB_TRY(
      read_backward(at, "load/residual_response", contact, m->load_residual, &l->load_residual));
  SHB_TRY(read_backward(at, "load/residual_inertia", contact, m->load_inertia, &l->load_inertia));
  SHB_TRY(read_backward(at, "load/residual_fourth", contact, m->load_fourth, &l->load_fourth));
  if (m->n_residual > 0)
    SHB_TRY(read_backward(at, "residual_modes/load", rest, m->residual_force, &l->residual_force));
  SHB_TRY(read_backward(at, "probe/load_residual", probe, m->probe_load_residual,
                        &l->probe_load_residual));
  SHB_TRY(read_backward(at, "probe/load_inertia", probe, m->probe_load_inertia,
                        &l->probe_load_inertia));
  return read_backward(at, "probe/load_fourth", probe, m->probe_load_fourth, &l->probe_load_fourth);
}

/* An array of the imaginary part beside its real part. */
typedef struct {
  const double *re, *im;
  size_t        n;
  const char   *dataset;
} split_array;

static shb_status check_real(const char *path, const split_array *a) {
  double largest = 0, worst = 0;
  for (size_t i = 0; a->re && a->im && i < a->n; i++) {
    largest = fmax(largest, fabs(a->re[i]));
    worst   = fmax(worst, fabs(a->im[i]));
  }
  SHB_CHECK(worst <= 1e-9 * largest, SHB_ERR_INPUT,
            "%s: /%s has an imaginary part, %.2g of the largest value; at nodal diameter 0 and N/2 "
            "it must be real: turn the phase of each mode",
            path, a->dataset, worst / largest);
  return SHB_OK;
}

static shb_status check_all_real(const char *path, const modal_model *m, const modal_model *im) {
  const size_t c = (size_t)modal_model_contact_dofs(m), q = 3 * (size_t)m->n_probes;
  const size_t modes = (size_t)m->n_modes, r = (size_t)m->n_residual, pairs = (size_t)m->n_pairs;
  const split_array all[] = {
      {m->right, im->right, 3 * pairs * modes, "contact/right/shape"},
      {m->left, im->left, 3 * pairs * modes, "contact/left/shape"},
      {m->coriolis, im->coriolis, modes * modes, "modes/coriolis"},
      {m->residual_flexibility, im->residual_flexibility, c * c, "contact/residual_flexibility"},
      {m->residual_inertia, im->residual_inertia, c * c, "contact/residual_inertia"},
      {m->residual_fourth, im->residual_fourth, c * c, "contact/residual_fourth"},
      {m->residual_shape, im->residual_shape, c * r, "residual_modes/contact"},
      {m->residual_probe, im->residual_probe, q * r, "residual_modes/probe"},
      {m->probe, im->probe, q * modes, "probe/shape"},
      {m->probe_contact_residual, im->probe_contact_residual, q * c, "probe/contact_residual"},
      {m->probe_contact_inertia, im->probe_contact_inertia, q * c, "probe/contact_inertia"},
      {m->probe_contact_fourth, im->probe_contact_fourth, q * c, "probe/contact_fourth"}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) SHB_TRY(check_real(path, &all[i]));
  return SHB_OK;
}

shb_status modal_model_read_real_at(hid_t at, const char *path, modal_model *model) {
  modal_model imaginary = {0};
  shb_status  status    = modal_model_read_complex_at(at, path, model, &imaginary);
  if (status == SHB_OK) status = check_all_real(path, model, &imaginary);
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

shb_status modal_model_release_terms(modal_model *model, int first) {
  enum { TERMS = 3 };
  double **const term[TERMS] = {&model->residual_flexibility, &model->residual_inertia,
                                &model->residual_fourth};
  const size_t   n           = (size_t)modal_model_contact_dofs(model);
  if (model->residual_diagonal || !*term[0] || !*term[1] || !*term[2]) return SHB_OK;
  double *diagonal = malloc((TERMS * n + 1) * sizeof *diagonal);
  SHB_CHECK(diagonal, SHB_ERR_IO, "out of memory for the residual terms");
  for (size_t t = 0; t < TERMS; t++)
    for (size_t i = 0; i < n; i++) diagonal[t * n + i] = (*term[t])[i * (n + 1)];
  model->residual_diagonal = diagonal;
  for (int t = first; t < TERMS; t++) {
    free(*term[t]);
    *term[t] = NULL;
  }
  return SHB_OK;
}

void modal_model_free(modal_model *model) {
  if (!model) return;
  for (int i = 0; model->probe_name && i < model->n_probes; i++) free(model->probe_name[i]);
  for (int i = 0; model->interface_name && i < model->n_interfaces; i++)
    free(model->interface_name[i]);
  void *part[] = {model->interface_name,
                  model->interface,
                  model->frequency,
                  model->damping_ratio,
                  model->coriolis,
                  model->right,
                  model->left,
                  model->residual_flexibility,
                  model->residual_inertia,
                  model->residual_fourth,
                  model->residual_diagonal,
                  model->residual_frequency,
                  model->residual_shape,
                  model->residual_force,
                  model->residual_probe,
                  model->contact_tail,
                  model->load_tail,
                  model->load_fourth,
                  model->probe_contact_fourth,
                  model->probe_load_fourth,
                  model->modal_force,
                  model->load_residual,
                  model->load_inertia,
                  model->probe_name,
                  model->probe,
                  model->probe_contact_residual,
                  model->probe_load_residual,
                  model->probe_contact_inertia,
                  model->probe_load_inertia,
                  model->normal,
                  model->area,
                  model->position,
                  model->eigen_residual};
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) free(part[i]);
  *model = (modal_model){0};
}
