#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5_internal.h"

bool h5_exists(hid_t at, const char *path) {
  char *part = strdup(path);
  if (!part) return false;
  /* H5Lexists fails where a group in between is absent: test every link on the way */
  bool there = true;
  for (char *slash = strchr(part + 1, '/'); slash && there; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    there  = H5Lexists(at, part, H5P_DEFAULT) > 0;
    *slash = '/';
  }
  if (there && strcmp(path, "/") != 0 && strcmp(path, ".") != 0)
    there = H5Lexists(at, path, H5P_DEFAULT) > 0 && H5Oexists_by_name(at, path, H5P_DEFAULT) > 0;
  free(part);
  return there;
}

static shb_status open_set(hid_t at, const char *path, hid_t *set) {
  char label[H5_LABEL];
  *set = -1;
  SHB_CHECK(h5_exists(at, path), SHB_ERR_INPUT, "%s is missing", h5_label(at, path, label));
  *set = H5Dopen2(at, path, H5P_DEFAULT);
  if (*set < 0) return h5_failed(SHB_ERR_INPUT, at, path, "is not a readable dataset");
  return SHB_OK;
}

/* Shape of an open dataset; label is used in messages. Every dimension must fit an int, and the
 * number of values a size_t. */
static shb_status shape_of(hid_t set, const char *label, h5_shape *shape) {
  hid_t space = H5Dget_space(set);
  SHB_CHECK(space >= 0, SHB_ERR_INPUT, "%s: its shape cannot be read", label);
  H5S_class_t kind = H5Sget_simple_extent_type(space);
  int         rank = H5Sget_simple_extent_ndims(space);
  bool        good = kind != H5S_NULL && rank >= 0 && rank <= H5_MAX_RANK;
  *shape           = (h5_shape){0};
  if (good) {
    shape->rank = rank;
    good        = H5Sget_simple_extent_dims(space, shape->dim, NULL) == rank;
  }
  H5Sclose(space);
  SHB_CHECK(kind != H5S_NULL, SHB_ERR_INPUT, "%s holds nothing (a null dataspace)", label);
  SHB_CHECK(good, SHB_ERR_INPUT, "%s has %d dimensions, more than the %d allowed", label, rank,
            H5_MAX_RANK);
  hsize_t count = 1;
  for (int i = 0; i < rank; i++) {
    bool over = shape->dim[i] > INT_MAX || __builtin_mul_overflow(count, shape->dim[i], &count);
    SHB_CHECK(!over && count < (hsize_t)1 << 40, SHB_ERR_INPUT, "%s is too large to be read",
              label);
  }
  return SHB_OK;
}

shb_status h5_shape_of(hid_t at, const char *path, h5_shape *shape) {
  char  label[H5_LABEL];
  hid_t set;
  SHB_TRY(open_set(at, path, &set));
  shb_status status = shape_of(set, h5_label(at, path, label), shape);
  H5Dclose(set);
  return status;
}

static shb_status check_shape(const char *label, h5_shape found, h5_shape wanted) {
  bool same = found.rank == wanted.rank;
  for (int i = 0; same && i < wanted.rank; i++)
    same = wanted.dim[i] == 0 || wanted.dim[i] == found.dim[i];
  char have[128], want[128];
  SHB_CHECK(same, SHB_ERR_INPUT, "%s has shape %s where %s is wanted", label,
            h5_shape_text(found, false, have), h5_shape_text(wanted, true, want));
  return SHB_OK;
}

/* HDF5 gives a fill value where nothing was written, and where a view finds no source. */
static shb_status check_written(hid_t set, const char *label, size_t bytes) {
  const hid_t        creation = H5Dget_create_plist(set);
  const H5D_layout_t layout   = creation >= 0 ? H5Pget_layout(creation) : H5D_LAYOUT_ERROR;
  H5D_space_status_t space;
  if (creation >= 0) H5Pclose(creation);
  SHB_CHECK(layout != H5D_VIRTUAL, SHB_ERR_INPUT,
            "%s is a view of other datasets (a virtual dataset); copy the values into it", label);
  SHB_CHECK(
      bytes == 0 || H5Dget_space_status(set, &space) < 0 || space != H5D_SPACE_STATUS_NOT_ALLOCATED,
      SHB_ERR_INPUT, "%s holds no values: it was never written", label);
  return SHB_OK;
}

/* A small damaged file can declare terabytes. No filter of HDF5 compresses by more than about
 * 1000. */
static shb_status check_size(hid_t set, const char *label, size_t bytes) {
  hsize_t stored = H5Dget_storage_size(set);
  SHB_CHECK(bytes < (1u << 24) || bytes / 2048 <= stored, SHB_ERR_INPUT,
            "%s declares %zu bytes of data, but the file holds %llu: damaged, or never written",
            label, bytes, (unsigned long long)stored);
  return check_written(set, label, bytes);
}

/* Read the whole dataset as type into malloc'ed memory. */
static shb_status read_all(hid_t set, const char *label, hid_t type, size_t count, void **data) {
  size_t size = H5Tget_size(type);
  SHB_TRY(check_size(set, label, count * size));
  *data = calloc(count ? count : 1, size);
  SHB_CHECK(*data, SHB_ERR_IO, "%s: no memory for %zu values", label, count);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *data) >= 0) return SHB_OK;
  char reason[H5_LABEL];
  h5_reason(reason, sizeof reason);
  free(*data);
  *data = NULL;
  SHB_FAIL(SHB_ERR_IO, "%s cannot be read: %s", label, reason);
}

/* How the values of a dataset are stored. */
typedef enum { REAL, COMPLEX, TEXT, OTHER } stored_kind;

static const char *const complex_names[][2] = {{"r", "i"}, {"real", "imag"}, {"re", "im"}};

static bool is_number(hid_t type, unsigned member) {
  H5T_class_t kind = H5Tget_member_class(type, member);
  return kind == H5T_FLOAT || kind == H5T_INTEGER;
}

/* Row of complex_names that holds both members of type, or -1. */
static int complex_row(hid_t type) {
  if (H5Tget_nmembers(type) != 2 || !is_number(type, 0) || !is_number(type, 1)) return -1;
  for (int i = 0; i < (int)(sizeof complex_names / sizeof *complex_names); i++)
    if (H5Tget_member_index(type, complex_names[i][0]) >= 0 &&
        H5Tget_member_index(type, complex_names[i][1]) >= 0)
      return i;
  return -1;
}

/* Kind of the stored values. *type: memory type of a complex dataset, which the caller closes; else
 * -1. */
static stored_kind kind_of(hid_t set, hid_t *type) {
  *type        = -1;
  hid_t stored = H5Dget_type(set);
  if (stored < 0) return OTHER;
  stored_kind kind  = OTHER;
  H5T_class_t class = H5Tget_class(stored);
  if (class == H5T_INTEGER || class == H5T_FLOAT) kind = REAL;
  if (class == H5T_STRING) kind = TEXT;
  if (class == H5T_COMPOUND) {
    int row = complex_row(stored);
    if (row >= 0) *type = h5_complex_type(complex_names[row][0], complex_names[row][1]);
    if (*type >= 0) kind = COMPLEX;
  }
  H5Tclose(stored);
  return kind;
}

static shb_status wrong_kind(const char *label, stored_kind found, const char *wanted) {
  static const char *const name[] = {"real numbers", "complex numbers", "text",
                                     "values of an unknown type"};
  SHB_FAIL(SHB_ERR_INPUT, "%s holds %s where %s are wanted", label, name[found], wanted);
}

typedef struct {
  hid_t    set;
  char     label[H5_LABEL];
  h5_shape shape;
} source;

/* Open a dataset, check its shape and store it back. On success the caller closes from->set. */
static shb_status open_source(hid_t at, const char *path, h5_shape *expected, source *from) {
  SHB_TRY(open_set(at, path, &from->set));
  h5_label(at, path, from->label);
  shb_status status = shape_of(from->set, from->label, &from->shape);
  if (status == SHB_OK) status = check_shape(from->label, from->shape, *expected);
  if (status == SHB_OK) {
    *expected = from->shape;
  } else {
    H5Dclose(from->set);
  }
  return status;
}

shb_status h5_check_shape(hid_t at, const char *path, h5_shape *expected) {
  source from;
  SHB_TRY(open_source(at, path, expected, &from));
  H5Dclose(from.set);
  return SHB_OK;
}

static const char all_finite[] = "all must be finite";

static shb_status read_real(const source *from, double **data) {
  hid_t       type;
  stored_kind kind = kind_of(from->set, &type);
  if (type >= 0) H5Tclose(type);
  if (kind != REAL) return wrong_kind(from->label, kind, "real numbers");
  void *raw;
  SHB_TRY(read_all(from->set, from->label, H5T_NATIVE_DOUBLE, h5_count(from->shape), &raw));
  shb_status status = h5_check_finite(from->label, from->shape, raw, 1, all_finite);
  if (status != SHB_OK) {
    free(raw);
    return status;
  }
  *data = raw;
  return SHB_OK;
}

shb_status h5_read_double(hid_t at, const char *path, h5_shape *expected, double **data) {
  *data = NULL;
  source from;
  SHB_TRY(open_source(at, path, expected, &from));
  shb_status status = read_real(&from, data);
  H5Dclose(from.set);
  return status;
}

static shb_status widen(const source *from, double complex **data) {
  double *real = NULL;
  SHB_TRY(read_real(from, &real));
  size_t count = h5_count(from->shape);
  *data        = malloc((count ? count : 1) * sizeof **data);
  if (!*data) {
    free(real);
    SHB_FAIL(SHB_ERR_IO, "%s: no memory", from->label);
  }
  for (size_t i = 0; i < count; i++) (*data)[i] = real[i];
  free(real);
  return SHB_OK;
}

static shb_status read_complex(const source *from, double complex **data) {
  hid_t       type;
  stored_kind kind = kind_of(from->set, &type);
  if (kind == REAL) return widen(from, data);
  if (kind != COMPLEX) return wrong_kind(from->label, kind, "complex numbers {r, i}");
  void      *raw    = NULL;
  shb_status status = read_all(from->set, from->label, type, h5_count(from->shape), &raw);
  H5Tclose(type);
  if (status == SHB_OK) status = h5_check_finite(from->label, from->shape, raw, 2, all_finite);
  if (status != SHB_OK) {
    free(raw);
    return status;
  }
  *data = raw;
  return SHB_OK;
}

shb_status h5_read_complex(hid_t at, const char *path, h5_shape *expected, double complex **data) {
  *data = NULL;
  source from;
  SHB_TRY(open_source(at, path, expected, &from));
  shb_status status = read_complex(&from, data);
  H5Dclose(from.set);
  return status;
}

/* Read through double, which holds every int exactly: HDF5 would convert 1.5 to 1 and 2^40 to
 * INT_MAX. */
shb_status h5_read_int(hid_t at, const char *path, h5_shape *expected, int **data) {
  *data        = NULL;
  double *real = NULL;
  SHB_TRY(h5_read_double(at, path, expected, &real));
  size_t count = h5_count(*expected), good = 0;
  int   *out = malloc((count ? count : 1) * sizeof *out);
  char   label[H5_LABEL];
  h5_label(at, path, label);
  while (out && good < count && real[good] >= INT_MIN && real[good] <= INT_MAX &&
         real[good] == (int)real[good]) {
    out[good] = (int)real[good];
    good++;
  }
  double bad = good < count ? real[good] : 0;
  free(real);
  SHB_CHECK(out, SHB_ERR_IO, "%s: no memory", label);
  if (good < count) {
    free(out);
    SHB_FAIL(SHB_ERR_INPUT, "%s holds %g where whole numbers are wanted", label, bad);
  }
  *data = out;
  return SHB_OK;
}

static void free_strings(int n, char **text) {
  for (int i = 0; text && i < n; i++) free(text[i]);
  free(text);
}

/* Split n cells of size bytes each into strings; NULL if out of memory. */
static char **split_fixed(const char *raw, int n, size_t size) {
  char **text = calloc(n ? (size_t)n : 1, sizeof *text);
  for (int i = 0; text && i < n; i++)
    if (!(text[i] = strndup(raw + (size_t)i * size, size))) {
      free_strings(n, text);
      text = NULL;
    }
  return text;
}

static char **split_variable(char *const *raw, int n) {
  char **text = calloc(n ? (size_t)n : 1, sizeof *text);
  for (int i = 0; text && i < n; i++)
    if (!(text[i] = strdup(raw[i] ? raw[i] : ""))) {
      free_strings(n, text);
      text = NULL;
    }
  return text;
}

/* Read text of fixed or variable length. HDF5 does not convert character sets: memory has the
 * file's. */
static shb_status read_text(const source *from, hid_t stored, int n, char ***text) {
  bool  variable = H5Tis_variable_str(stored) > 0;
  hid_t type     = variable ? h5_text_type() : H5Tcopy(H5T_C_S1);
  if (type >= 0 && (H5Tset_cset(type, H5Tget_cset(stored)) < 0 ||
                    (!variable && H5Tset_size(type, H5Tget_size(stored) + 1) < 0))) {
    H5Tclose(type);
    type = -1;
  }
  SHB_CHECK(type >= 0, SHB_ERR_IO, "%s cannot be read", from->label);
  void      *raw    = NULL;
  shb_status status = read_all(from->set, from->label, type, (size_t)n, &raw);
  if (status == SHB_OK) {
    *text = variable ? split_variable(raw, n) : split_fixed(raw, n, H5Tget_size(type));
    if (!*text) status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: no memory", from->label);
    for (int i = 0; variable && i < n; i++)
      if (((char **)raw)[i]) H5free_memory(((char **)raw)[i]);
  }
  free(raw);
  H5Tclose(type);
  return status;
}

shb_status h5_read_strings(hid_t at, const char *path, int *n, char ***text) {
  *n    = 0;
  *text = NULL;
  source   from;
  h5_shape shape;
  SHB_TRY(h5_shape_of(at, path, &shape));
  /* a single string may be a scalar */
  h5_shape wanted = shape.rank == 0 ? (h5_shape){0} : H5_SHAPE(0);
  SHB_TRY(open_source(at, path, &wanted, &from));
  hid_t       type, stored = H5Dget_type(from.set);
  stored_kind kind = kind_of(from.set, &type);
  if (type >= 0) H5Tclose(type);
  int        count  = (int)h5_count(wanted);
  shb_status status = kind == TEXT && stored >= 0 ? read_text(&from, stored, count, text)
                                                  : wrong_kind(from.label, kind, "texts");
  if (status == SHB_OK) *n = count;
  if (stored >= 0) H5Tclose(stored);
  H5Dclose(from.set);
  return status;
}
