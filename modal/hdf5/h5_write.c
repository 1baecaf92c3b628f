#include <hdf5_hl.h>
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/h5_internal.h"

enum { COMPRESSED_FROM = 1 << 16, CHUNK = 1 << 20 }; /* bytes */

/* Whether at least half of the 8-byte words are zero, as harmonics that a point leaves out are. */
static bool mostly_zero(const void *data, size_t bytes) {
  const uint64_t *word = data;
  size_t          n = bytes / sizeof *word, zero = 0;
  for (size_t i = 0; i < n; i++) zero += word[i] == 0;
  return 2 * zero >= n;
}

/* Chunks of whole rows, about CHUNK bytes each, compressed. */
static herr_t compress(hid_t layout, h5_shape shape, size_t bytes) {
  hsize_t rows = 1 + (hsize_t)(CHUNK / (bytes / shape.dim[0] + 1));
  if (shape.dim[0] > rows) shape.dim[0] = rows;
  return H5Pset_chunk(layout, shape.rank, shape.dim) < 0 ? -1 : H5Pset_deflate(layout, 1);
}

/* Contiguous, but compressed where a large dataset holds mostly zeros. No time stamps: equal
 * contents give equal bytes. Groups in between are created. */
static shb_status create_dataset(hid_t at, const char *path, h5_shape shape, hid_t type,
                                 const void *data, hid_t space, hid_t *set) {
  shb_status status = SHB_OK;
  size_t     bytes  = h5_count(shape) * H5Tget_size(type);
  bool       sparse = shape.rank > 0 && bytes >= COMPRESSED_FROM && mostly_zero(data, bytes);
  hid_t      links = H5Pcreate(H5P_LINK_CREATE), layout = H5Pcreate(H5P_DATASET_CREATE);
  if (links < 0 || layout < 0 || H5Pset_create_intermediate_group(links, 1) < 0 ||
      H5Pset_obj_track_times(layout, 0) < 0 || (sparse && compress(layout, shape, bytes) < 0) ||
      (*set = H5Dcreate2(at, path, type, space, links, layout, H5P_DEFAULT)) < 0)
    status = h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  if (links >= 0) H5Pclose(links);
  if (layout >= 0) H5Pclose(layout);
  return status;
}

static shb_status write_dataset(hid_t at, const char *path, h5_shape shape, hid_t type,
                                const void *data) {
  hid_t space = shape.rank ? H5Screate_simple(shape.rank, shape.dim, NULL) : H5Screate(H5S_SCALAR);
  if (space < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  hid_t      set    = -1;
  shb_status status = create_dataset(at, path, shape, type, data, space, &set);
  if (status == SHB_OK) {
    if (h5_count(shape) > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
      status = h5_failed(SHB_ERR_IO, at, path, "cannot be written");
    H5Dclose(set);
  }
  H5Sclose(space);
  return status;
}

static shb_status describe(hid_t at, const char *path, const char *units, const char *long_name) {
  SHB_TRY(h5_write_attribute_text(at, path, "units", units ? units : "-"));
  return h5_write_attribute_text(at, path, "long_name", long_name ? long_name : path);
}

/* Inputs near the limits of double precision can give values beyond them. */
static shb_status check_values(hid_t at, const char *path, h5_shape shape, const void *data,
                               size_t per) {
  char label[H5_LABEL];
  return h5_check_finite(h5_label(at, path, label), shape, data, per,
                         "a number of the input is too large");
}

shb_status h5_write_double(hid_t at, const char *path, h5_shape shape, const double *data,
                           const char *units, const char *long_name) {
  SHB_TRY(check_values(at, path, shape, data, 1));
  SHB_TRY(write_dataset(at, path, shape, H5T_NATIVE_DOUBLE, data));
  return describe(at, path, units, long_name);
}

shb_status h5_write_single(hid_t at, const char *path, h5_shape shape, const float *data,
                           const char *units, const char *long_name) {
  SHB_TRY(write_dataset(at, path, shape, H5T_NATIVE_FLOAT, data));
  return describe(at, path, units, long_name);
}

shb_status h5_write_int(hid_t at, const char *path, h5_shape shape, const int *data,
                        const char *units, const char *long_name) {
  SHB_TRY(write_dataset(at, path, shape, H5T_NATIVE_INT, data));
  return describe(at, path, units, long_name);
}

shb_status h5_write_complex(hid_t at, const char *path, h5_shape shape, const double complex *data,
                            const char *units, const char *long_name) {
  SHB_TRY(check_values(at, path, shape, data, 2));
  hid_t type = h5_complex_type("r", "i");
  if (type < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  shb_status status = write_dataset(at, path, shape, type, data);
  H5Tclose(type);
  SHB_TRY(status);
  return describe(at, path, units, long_name);
}

shb_status h5_write_complex_single(hid_t at, const char *path, h5_shape shape,
                                   const float complex *data, const char *units,
                                   const char *long_name) {
  hid_t type = H5Tcreate(H5T_COMPOUND, sizeof *data);
  if (type < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  shb_status status = SHB_OK;
  if (H5Tinsert(type, "r", 0, H5T_NATIVE_FLOAT) < 0 ||
      H5Tinsert(type, "i", sizeof(float), H5T_NATIVE_FLOAT) < 0)
    status = h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  if (status == SHB_OK) status = write_dataset(at, path, shape, type, data);
  H5Tclose(type);
  SHB_TRY(status);
  return describe(at, path, units, long_name);
}

shb_status h5_write_strings(hid_t at, const char *path, int n, const char *const *text,
                            const char *long_name) {
  hid_t type = h5_text_type();
  if (type < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be written");
  shb_status status = write_dataset(at, path, H5_SHAPE((hsize_t)n), type, text);
  H5Tclose(type);
  SHB_TRY(status);
  return describe(at, path, "-", long_name);
}

static shb_status replace(hid_t at, const char *path, h5_shape shape, hid_t type,
                          const void *data) {
  char     label[H5_LABEL];
  h5_shape found;
  SHB_TRY(h5_shape_of(at, path, &found));
  SHB_CHECK(found.rank == shape.rank &&
                memcmp(found.dim, shape.dim, (size_t)shape.rank * sizeof *shape.dim) == 0,
            SHB_ERR_IO, "%s: has another shape", h5_label(at, path, label));
  hid_t      set    = H5Dopen2(at, path, H5P_DEFAULT);
  shb_status status = SHB_OK;
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    status = h5_failed(SHB_ERR_IO, at, path, "cannot be replaced");
  if (set >= 0) H5Dclose(set);
  return status;
}

shb_status h5_replace_double(hid_t at, const char *path, h5_shape shape, const double *data) {
  SHB_TRY(check_values(at, path, shape, data, 1));
  return replace(at, path, shape, H5T_NATIVE_DOUBLE, data);
}

shb_status h5_replace_complex(hid_t at, const char *path, h5_shape shape,
                              const double complex *data) {
  SHB_TRY(check_values(at, path, shape, data, 2));
  hid_t type = h5_complex_type("r", "i");
  if (type < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be replaced");
  shb_status status = replace(at, path, shape, type, data);
  H5Tclose(type);
  return status;
}

static shb_status check_scale(hid_t at, const char *path, int dim, const char *scale_path) {
  h5_shape shape, scale;
  char     label[H5_LABEL];
  SHB_TRY(h5_shape_of(at, path, &shape));
  SHB_TRY(h5_shape_of(at, scale_path, &scale));
  SHB_CHECK(scale.rank == 1 && dim >= 0 && dim < shape.rank && scale.dim[0] == shape.dim[dim],
            SHB_ERR_IO, "%s: dimension %d and its scale %s differ in length",
            h5_label(at, path, label), dim, scale_path);
  return SHB_OK;
}

shb_status h5_attach_scale(hid_t at, const char *path, int dim, const char *scale_path) {
  SHB_TRY(check_scale(at, path, dim, scale_path));
  shb_status  status = SHB_OK;
  hid_t       set = H5Dopen2(at, path, H5P_DEFAULT), scale = H5Dopen2(at, scale_path, H5P_DEFAULT);
  const char *slash = strrchr(scale_path, '/');
  if (set < 0 || scale < 0 ||
      (H5DSis_scale(scale) == 0 && H5DSset_scale(scale, slash ? slash + 1 : scale_path) < 0) ||
      H5DSattach_scale(set, scale, (unsigned)dim) < 0)
    status = h5_failed(SHB_ERR_IO, at, path, "cannot be given a dimension scale");
  if (set >= 0) H5Dclose(set);
  if (scale >= 0) H5Dclose(scale);
  return status;
}

shb_status h5_write_counter(hid_t file, const char *path, hsize_t n, const char *long_name) {
  int *count = malloc((n ? n : 1) * sizeof *count);
  SHB_CHECK(count, SHB_ERR_IO, "no memory to write %s", path);
  for (hsize_t i = 0; i < n; i++) count[i] = (int)i;
  shb_status status = h5_write_int(file, path, H5_SHAPE(n), count, "-", long_name);
  free(count);
  return status;
}
