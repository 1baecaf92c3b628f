#include "modal/model/model_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"
#include "mesh/base/memory.h"

int modal_model_contact_dofs(const modal_model *model) {
  return 3 * model->n_pairs * (model->has_left ? 2 : 1);
}

/* ---------------------------------------------------------------- checks */

static shb_status check_frequencies(const modal_dataset *row, const char *path,
                                    const modal_model *model, const modal_model *im) {
  (void)im;
  for (int i = 0; i < model->n_modes; i++) {
    const double f = model->frequency[i];
    SHB_CHECK(f >= 0, SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0) is %g Hz; a frequency is 0 (of a free body) or positive",
              path, row->path, i, f);
    SHB_CHECK(i == 0 || f >= model->frequency[i - 1], SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0), %g Hz, is below the one before; sort the modes by "
              "frequency",
              path, row->path, i, f);
  }
  return SHB_OK;
}

static shb_status check_damping(const modal_dataset *row, const char *path,
                                const modal_model *model, const modal_model *im) {
  (void)im;
  for (int i = 0; i < model->n_modes; i++) {
    const double zeta = model->damping_ratio[i];
    SHB_CHECK(zeta >= 0 && zeta < 1, SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0) is %g; it must be at least 0 and below 1", path,
              row->path, i, zeta);
  }
  return SHB_OK;
}

/* How far a matrix is from sign times its conjugate transpose. */
typedef struct {
  double largest, worst; /* of its values; of the differences */
  size_t row, column;    /* where that is */
} asymmetry;

static asymmetry asymmetry_of(const modal_dataset *row, const modal_model *model,
                              const modal_model *imaginary, double sign) {
  const size_t  n      = (size_t)modal_size_of(model, row->dims[0]);
  const double *matrix = modal_dataset_get(row, model);
  const double *im     = imaginary ? modal_dataset_get(row, imaginary) : NULL;
  asymmetry     a      = {0};
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
static shb_status check_skew(const modal_dataset *row, const char *path, const modal_model *model,
                             const modal_model *im) {
  const asymmetry a = asymmetry_of(row, model, im, -1);
  SHB_CHECK(a.worst <= 1e-6 * a.largest, SHB_ERR_INPUT,
            "%s: /%s is not skew-%s: [%zu, %zu] and [%zu, %zu] add up to %.2g of the largest "
            "value; a matrix that does no work is wanted",
            path, row->path, im ? "Hermitian" : "symmetric", a.row, a.column, a.column, a.row,
            a.worst / a.largest);
  return SHB_OK;
}

/* Reciprocity: the matrix must be symmetric to 1e-6 of its largest value, or Hermitian. */
static shb_status check_symmetric(const modal_dataset *row, const char *path,
                                  const modal_model *model, const modal_model *im) {
  const asymmetry a = asymmetry_of(row, model, im, 1);
  SHB_CHECK(a.worst <= 1e-6 * a.largest, SHB_ERR_INPUT,
            "%s: /%s is not %s: [%zu, %zu] and [%zu, %zu] differ by %.2g of the largest value; a "
            "receptance must be %s to 1e-6",
            path, row->path, im ? "Hermitian" : "symmetric", a.row, a.column, a.column, a.row,
            a.worst / a.largest, im ? "Hermitian" : "symmetric");
  return SHB_OK;
}

/* Static flexibility of a contact dof by the modes. */
static double flexibility_of_modes(const modal_model *model, const modal_model *im, int dof) {
  const size_t  m = (size_t)model->n_modes, side = 3 * (size_t)model->n_pairs, i = (size_t)dof;
  const size_t  at    = i % side * m;
  const double *shape = (i < side ? model->right : model->left) + at;
  const double *other = im ? (i < side ? im->right : im->left) + at : NULL;
  double        sum   = 0;
  for (size_t k = 0; k < m; k++) {
    if (!(model->frequency[k] > 0)) continue; /* it has no static flexibility */
    sum += pow(shape[k] / (SHB_TWO_PI * model->frequency[k]), 2);
    if (other) sum += pow(other[k] / (SHB_TWO_PI * model->frequency[k]), 2);
  }
  return sum;
}

/* The residual flexibility is a sum of phi^2/omega^2: its diagonal is not negative, but for
 * rounding and other programs' integration rules. The margin is relative to the flexibility of the
 * modes. */
static shb_status check_flexibility(const modal_dataset *row, const char *path,
                                    const modal_model *model, const modal_model *im) {
  static const double allowed = 1e-3;
  const int           n       = modal_model_contact_dofs(model);
  SHB_TRY(check_symmetric(row, path, model, im));
  for (int i = 0; i < n; i++) {
    const double R     = model->residual_flexibility[(size_t)i * (size_t)(n + 1)];
    const double modes = flexibility_of_modes(model, im, i);
    SHB_CHECK(!(R < -allowed * modes), SHB_ERR_INPUT,
              "%s: /%s: value [%d, %d] is %.3g m/N; what modes leave out cannot be negative: "
              "static flexibility less that of the modes, %.3g m/N here, is wanted",
              path, row->path, i, i, R, modes);
  }
  return SHB_OK;
}

/* Values [n][2] */
static shb_status check_squares(const modal_dataset *row, const char *path,
                                const modal_model *model, const modal_model *im) {
  const double *tail = modal_dataset_get(row, model);
  const size_t  n    = modal_dataset_count(row, model);
  (void)im;
  for (size_t i = 0; i < n; i++)
    SHB_CHECK(tail[i] >= 0, SHB_ERR_INPUT,
              "%s: /%s: value [%zu, %zu] is %g; a sum of squares is wanted", path, row->path, i / 2,
              i % 2, tail[i]);
  return SHB_OK;
}

static shb_status check_areas(const modal_dataset *row, const char *path, const modal_model *model,
                              const modal_model *im) {
  (void)im;
  for (int i = 0; i < model->n_pairs; i++)
    SHB_CHECK(model->area[i] > 0, SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0) is %g m^2; all must be positive", path, row->path, i,
              model->area[i]);
  return SHB_OK;
}

static shb_status check_normals(const modal_dataset *row, const char *path,
                                const modal_model *model, const modal_model *im) {
  (void)im;
  for (int i = 0; i < model->n_pairs; i++) {
    const double *v      = model->normal + 3 * (size_t)i;
    const double  length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    SHB_CHECK(fabs(length - 1) < 1e-6, SHB_ERR_INPUT,
              "%s: /%s: row %d (from 0) has length %g; unit vectors are wanted", path, row->path, i,
              length);
  }
  return SHB_OK;
}

/* Columns of tables and keys of summaries are known by these names. */
static shb_status check_names(const modal_dataset *row, const char *path, const modal_model *model,
                              const modal_model *im) {
  char *const *name = modal_dataset_get(row, model);
  const size_t n    = modal_dataset_count(row, model);
  (void)im;
  for (size_t i = 0; i < n; i++) {
    SHB_CHECK(shb_name_is_plain(name[i]), SHB_ERR_INPUT,
              "%s: /%s: name %zu (from 0) is empty, or holds a control character or one that turns "
              "the direction of text; letters, digits and _ - . + would do",
              path, row->path, i);
    for (size_t k = 0; k < i; k++)
      SHB_CHECK(strcmp(name[i], name[k]) != 0, SHB_ERR_INPUT,
                "%s: /%s: names %zu and %zu (from 0) are both '%s'; give each its own", path,
                row->path, k, i, name[i]);
  }
  return SHB_OK;
}

static shb_status check_interfaces(const modal_dataset *row, const char *path,
                                   const modal_model *model, const modal_model *im) {
  (void)im;
  for (int i = 0; i < model->n_pairs; i++)
    SHB_CHECK(model->interface[i] >= 0 && model->interface[i] < model->n_interfaces, SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0) is %d; 0 to %d are wanted, as /contact/interface_name "
              "has names",
              path, row->path, i, model->interface[i], model->n_interfaces - 1);
  return SHB_OK;
}

/* The terms are read before. */
static shb_status check_residual_modes(const modal_dataset *row, const char *path,
                                       const modal_model *model, const modal_model *im) {
  const double *f = model->residual_frequency, last = model->frequency[model->n_modes - 1];
  (void)im;
  SHB_CHECK(model->residual_flexibility && model->residual_inertia && model->residual_fourth,
            SHB_ERR_INPUT,
            "%s: /residual_modes count beside /contact/residual_flexibility, residual_inertia and "
            "residual_fourth only; write those too, or leave the residual modes out",
            path);
  for (int i = 0; i < model->n_residual; i++)
    SHB_CHECK(f[i] > 0 && (i == 0 || f[i] >= f[i - 1]), SHB_ERR_INPUT,
              "%s: /%s: value %d (from 0) is %g Hz; all must be positive, and ascend", path,
              row->path, i, f[i]);
  SHB_CHECK(model->n_residual == 0 || f[0] >= 0.999 * last, SHB_ERR_INPUT,
            "%s: /%s: value 0 is %g Hz, below the last of /modes/frequency, %g Hz; a mode among "
            "those kept belongs to /modes",
            path, row->path, f[0], last);
  return SHB_OK;
}

/* ---------------------------------------------------------------- the table */

#define AT(member) offsetof(modal_model, member)
/* A row: path, dims, kind, part, member of modal_model, units, long name, and what else it has. */
#define ROW(path_, dims_, kind_, part_, member, units_, text, ...)              \
  {                                                                             \
    .path = path_, .dims = dims_, .kind = MODAL_##kind_, .part = MODAL_##part_, \
    .offset = AT(member), .units = units_, .long_name = text, __VA_ARGS__       \
  }

const modal_dataset modal_datasets[] = {
    ROW("modes/frequency", "m", REAL, KEPT, frequency, "Hz",
        "undamped natural frequency of the free blade", .with = ".", .check = check_frequencies),
    ROW("modes/damping_ratio", "m", REAL, KEPT, damping_ratio, "-", "modal damping ratio",
        .with = ".", .check = check_damping),
    ROW("modes/residual", "m", REAL, KEPT, eigen_residual, "-",
        "relative residual of the eigenpair"),
    ROW("modes/coriolis", "mm", SPLIT, KEPT, coriolis, "1/s",
        "Coriolis matrix phi^H G phi of the modes at the rotor speed: q'' + G q' + diag(omega^2) q",
        .check = check_skew),
    ROW("contact/right/shape", "p3m", SPLIT, KEPT, right, "kg^-1/2",
        "mass-normalised modes at the right contact", .with = "contact"),
    ROW("contact/left/shape", "l3m", SPLIT, KEPT, left, "kg^-1/2",
        "mass-normalised modes at the left contact", .with = "contact/left"),
    ROW("contact/residual_flexibility", "cc", SPLIT, R, residual_flexibility, "m/N",
        "static flexibility of the modes left out", .check = check_flexibility),
    ROW("contact/residual_inertia", "cc", SPLIT, R2, residual_inertia, "m s^2/N",
        "coefficient of omega^2 in the receptance of the modes left out", .check = check_symmetric),
    ROW("contact/residual_fourth", "cc", SPLIT, R3, residual_fourth, "m s^4/N",
        "coefficient of omega^4 in the receptance of the modes left out", .check = check_symmetric),
    ROW("contact/residual_tail", "c2", REAL, TAIL, contact_tail, "m s^2r/N, m s^(2r+2)/N",
        "a and b of what terms and residual modes leave out, a omega^2r + b omega^(2r+2) + .., r "
        "the attribute order",
        .check = check_squares),
    ROW("residual_modes/frequency", "r", REAL, RESIDUAL_MODES, residual_frequency, "Hz",
        "frequency of a mode that stands for modes left out", .with = "residual_modes",
        .check = check_residual_modes),
    ROW("residual_modes/contact", "cr", SPLIT, RESIDUAL_MODES, residual_shape, "kg^-1/2",
        "residual modes at the contact", .with = "residual_modes"),
    ROW("residual_modes/load", "kr", LOAD, RESIDUAL_MODES, residual_force, "N kg^-1/2",
        "force of the load on the residual modes", .zeros = true),
    ROW("residual_modes/probe", "Qr", SPLIT, RESIDUAL_MODES, residual_probe, "kg^-1/2",
        "residual modes at the probes", .zeros = true),
    ROW("contact/normal", "p3", REAL, KEPT, normal, "-",
        "unit normal v of the right face, cylindrical axes", .check = check_normals),
    ROW("contact/area", "p", REAL, KEPT, area, "m^2", "area of the contact patch",
        .check = check_areas),
    ROW("contact/coordinates", "p3", REAL, SIDES, position, "m",
        "centroids of the patches, right then left, mesh axes"),
    ROW("load/modal_force", "km", LOAD, KEPT, modal_force, "N kg^-1/2",
        "modal force; f(t) = Re sum_k f_k exp(j k omega t)", .with = ".",
        .backward = "modal force on the conjugate shapes"),
    ROW("load/residual_response", "kc", LOAD, R, load_residual, "m",
        "static response of the contact dofs to the load, modes removed"),
    ROW("load/residual_inertia", "kc", LOAD, R2, load_inertia, "m s^2",
        "coefficient of omega^2 in the response of the contact dofs to the load, modes removed"),
    ROW("load/residual_fourth", "kc", LOAD, R3, load_fourth, "m s^4", "its coefficient of omega^4"),
    ROW("load/residual_tail", "k2", REAL, TAIL, load_tail, "N m s^2r, N m s^(2r+2)",
        "as contact/residual_tail, of the load's work", .check = check_squares),
    ROW("probe/name", "q", NAMES, KEPT, probe_name, "-", "name of the probe", .with = "probe",
        .check = check_names),
    ROW("probe/shape", "q3m", SPLIT, KEPT, probe, "kg^-1/2", "mass-normalised modes at the probes",
        .with = "probe"),
    ROW("probe/contact_residual", "Qc", SPLIT, R, probe_contact_residual, "m/N",
        "static flexibility probe to contact, modes removed"),
    ROW("probe/load_residual", "kQ", LOAD, R, probe_load_residual, "m",
        "static response of the probes to the load, modes removed"),
    ROW("probe/contact_inertia", "Qc", SPLIT, R2, probe_contact_inertia, "m s^2/N",
        "coefficient of omega^2 in the receptance probe to contact, modes removed"),
    ROW("probe/load_inertia", "kQ", LOAD, R2, probe_load_inertia, "m s^2",
        "coefficient of omega^2 in the response of the probes to the load, modes removed"),
    ROW("probe/contact_fourth", "Qc", SPLIT, R3, probe_contact_fourth, "m s^4/N",
        "coefficient of omega^4 of the same"),
    ROW("probe/load_fourth", "kQ", LOAD, R3, probe_load_fourth, "m s^4",
        "coefficient of omega^4 of the same"),
    ROW("contact/interface_name", "i", NAMES, INTERFACES, interface_name, "-", "contact interface",
        .with = "contact/interface", .check = check_names),
    ROW("contact/interface", "p", INDEX, INTERFACES, interface, "-",
        "contact interface of the pair, from 0", .check = check_interfaces),
    {NULL}};

/* Bounds of what a file may hold: beyond them it is damaged. */
enum { MAX_MODES = 100000, MAX_PAIRS = 100000, MAX_HARMONICS = 10000, MAX_NAMES = 1 << 24 };

const modal_size modal_sizes[] = {
    {'m', "modes/frequency", "modes", 1, MAX_MODES, .offset = AT(n_modes)},
    {'p', "contact/right/shape", "contact pairs", 1, MAX_PAIRS, .offset = AT(n_pairs)},
    {'k', "load/modal_force", "harmonics", 1, MAX_HARMONICS, ", the first being the mean (k = 0)",
     .offset = AT(n_load), .beyond = 1},
    {'q', "probe/name", "probes", 0, MAX_NAMES, .offset = AT(n_probes)},
    {'r', "residual_modes/frequency", "residual modes", 0, MAX_MODES, .offset = AT(n_residual)},
    {'i', "contact/interface_name", "contact interfaces", 0, MAX_NAMES, .offset = AT(n_interfaces)},
    {0}};

/* ---------------------------------------------------------------- sizes */

static int number_of(const modal_size *size, const modal_model *model) {
  int number;
  memcpy(&number, (const char *)model + size->offset, sizeof number);
  return number;
}

hsize_t modal_size_of(const modal_model *model, char letter) {
  if (letter >= '1' && letter <= '9') return (hsize_t)(letter - '0');
  switch (letter) {
    case 'l':
      return model->has_left ? (hsize_t)model->n_pairs : 0;
    case 'c':
      return (hsize_t)modal_model_contact_dofs(model);
    case 'Q':
      return 3 * (hsize_t)model->n_probes;
    default:
      for (const modal_size *size = modal_sizes; size->path; size++)
        if (size->letter == letter) return (hsize_t)number_of(size, model) + (hsize_t)size->beyond;
      return 0;
  }
}

h5_shape modal_dataset_shape(const modal_dataset *row, const modal_model *sizes) {
  h5_shape shape = {.rank = (int)strlen(row->dims)};
  for (int i = 0; i < shape.rank; i++) shape.dim[i] = modal_size_of(sizes, row->dims[i]);
  return shape;
}

size_t modal_dataset_count(const modal_dataset *row, const modal_model *sizes) {
  return h5_count(modal_dataset_shape(row, sizes));
}

size_t modal_dataset_width(const modal_dataset *row) {
  static const size_t width[] = {[MODAL_REAL]  = sizeof(double),
                                 [MODAL_SPLIT] = sizeof(double),
                                 [MODAL_LOAD]  = sizeof(double complex),
                                 [MODAL_INDEX] = sizeof(int),
                                 [MODAL_NAMES] = sizeof(char *)};
  return width[row->kind];
}

const char *modal_scale_of(char letter) {
  switch (letter) {
    case 'm': /* the frequencies label the modes */
      return "modes/frequency";
    case 'r':
      return "residual_modes/frequency";
    case 'p':
    case 'l':
      return "contact/pair";
    case '3':
      return "axis";
    case 'c':
      return "contact/dof";
    case 'k':
      return "load/harmonic";
    case 'q':
      return "probe/name";
    case 'Q':
      return "probe/dof";
    default:
      return NULL;
  }
}

/* ---------------------------------------------------------------- arrays */

void *modal_dataset_get(const modal_dataset *row, const modal_model *model) {
  void *data;
  memcpy(&data, (const char *)model + row->offset, sizeof data);
  return data;
}

void modal_dataset_set(const modal_dataset *row, modal_model *model, void *data) {
  memcpy((char *)model + row->offset, &data, sizeof data);
}

void modal_dataset_free(const modal_dataset *row, modal_model *model) {
  void *data = modal_dataset_get(row, model);
  if (row->kind == MODAL_NAMES && data)
    for (size_t i = 0; i < modal_dataset_count(row, model); i++) free(((char **)data)[i]);
  free(data);
  modal_dataset_set(row, model, NULL);
}

static char **copy_names(char *const *name, size_t n) {
  char **copy = shb_alloc(n, sizeof *copy);
  for (size_t i = 0; i < n; i++) copy[i] = shb_text(name[i]);
  return copy;
}

void *modal_dataset_copy(const modal_dataset *row, const modal_model *sizes,
                         const modal_model *model) {
  const void  *data = modal_dataset_get(row, model);
  const size_t n = modal_dataset_count(row, sizes), width = modal_dataset_width(row);
  if (!data) return NULL;
  if (row->kind == MODAL_NAMES) return copy_names((char *const *)data, n);
  return memcpy(shb_alloc(n, width), data, n * width);
}

static void allocate(const modal_dataset *row, const modal_model *sizes, modal_model *of) {
  const size_t n = modal_dataset_count(row, sizes);
  if (!of || (n == 0 && strpbrk(row->dims, "plc"))) return;
  modal_dataset_set(row, of, shb_alloc_zeroed(n, modal_dataset_width(row)));
}

static bool is_computed(const modal_dataset *row, const modal_model *model) {
  if (modal_dataset_is_residual(row)) return model->n_pairs > 0;
  return row->part == MODAL_KEPT && strchr(row->dims, 'm') && row->offset != AT(coriolis);
}

void modal_model_allocate(modal_model *model, modal_model *imaginary, modal_model *backward) {
  for (const modal_dataset *row = modal_datasets; row->path; row++) {
    modal_model *second = row->kind == MODAL_SPLIT  ? imaginary
                          : row->kind == MODAL_LOAD ? backward
                                                    : NULL;
    if (!is_computed(row, model)) continue;
    allocate(row, model, model);
    allocate(row, model, second);
  }
}

modal_model modal_model_sizes(const modal_model *model) {
  modal_model to = {.has_left = model->has_left, .tail_order = model->tail_order};
  for (const modal_size *size = modal_sizes; size->path; size++)
    memcpy((char *)&to + size->offset, (const char *)model + size->offset, sizeof(int));
  return to;
}

void modal_model_copy(const modal_model *model, modal_model *copy) {
  for (const modal_dataset *row = modal_datasets; row->path; row++)
    modal_dataset_set(row, copy, modal_dataset_copy(row, copy, model));
}

bool modal_dataset_is_term(const modal_dataset *row) {
  return row->part == MODAL_R || row->part == MODAL_R2 || row->part == MODAL_R3;
}

bool modal_dataset_is_residual(const modal_dataset *row) {
  return modal_dataset_is_term(row) || row->part == MODAL_TAIL;
}
