#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "modal/hdf5/h5_internal.h"

/* Write an attribute, replacing one of the same name. */
static shb_status write_attribute(hid_t at, const char *path, const char *name, hid_t type,
                                  const void *value) {
  if (H5Aexists_by_name(at, path, name, H5P_DEFAULT) > 0)
    H5Adelete_by_name(at, path, name, H5P_DEFAULT);
  hid_t space = H5Screate(H5S_SCALAR);
  if (space < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be given an attribute");
  shb_status status = SHB_OK;
  hid_t      attribute =
      H5Acreate_by_name(at, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0 || H5Awrite(attribute, type, value) < 0)
    status = h5_failed(SHB_ERR_IO, at, path, "cannot be given an attribute");
  if (attribute >= 0) H5Aclose(attribute);
  H5Sclose(space);
  return status;
}

/* Variable length: the text lies in the heap, so it may exceed the attribute's limit of 64 kB. */
shb_status h5_write_attribute_text(hid_t at, const char *path, const char *name, const char *text) {
  hid_t type = h5_text_type();
  if (type < 0) return h5_failed(SHB_ERR_IO, at, path, "cannot be given an attribute");
  if (!text) text = "";
  shb_status status = write_attribute(at, path, name, type, &text);
  H5Tclose(type);
  return status;
}

shb_status h5_write_attribute_double(hid_t at, const char *path, const char *name, double value) {
  char label[H5_LABEL];
  SHB_CHECK(isfinite(value), SHB_ERR_INPUT, "%s: attribute %s is %s; it must be finite",
            h5_label(at, path, label), name, isnan(value) ? "not a number" : "infinite");
  return write_attribute(at, path, name, H5T_NATIVE_DOUBLE, &value);
}

shb_status h5_write_attribute_int(hid_t at, const char *path, const char *name, int value) {
  return write_attribute(at, path, name, H5T_NATIVE_INT, &value);
}

shb_status h5_write_provenance(hid_t file, const char *format, int version,
                               const shb_provenance *provenance) {
  char      created[32] = "";
  time_t    now         = time(NULL);
  struct tm utc;
  if (gmtime_r(&now, &utc)) strftime(created, sizeof created, "%Y-%m-%dT%H:%M:%SZ", &utc);
  const shb_provenance  none      = {0};
  const shb_provenance *p         = provenance ? provenance : &none;
  const char *const     text[][2] = {
          {"format", format},          {"revision", shb_revision()}, {"command", p->command},
          {"case_path", p->case_path}, {"case_text", p->case_text},  {"settings", p->settings},
          {"created", created},
  };
  for (size_t i = 0; i < sizeof text / sizeof *text; i++)
    SHB_TRY(h5_write_attribute_text(file, "/", text[i][0], text[i][1]));
  return h5_write_attribute_int(file, "/", "format_version", version);
}

/* Open an attribute holding one value of a wanted class; *attribute = -1 and SHB_OK if absent. */
static shb_status open_attribute(hid_t at, const char *path, const char *name, hid_t *attribute) {
  char label[H5_LABEL];
  *attribute    = -1;
  htri_t exists = H5Aexists_by_name(at, path, name, H5P_DEFAULT);
  SHB_CHECK(exists >= 0, SHB_ERR_INPUT, "%s: is missing or damaged", h5_label(at, path, label));
  if (exists == 0) return SHB_OK;
  *attribute = H5Aopen_by_name(at, path, name, H5P_DEFAULT, H5P_DEFAULT);
  if (*attribute < 0) return h5_failed(SHB_ERR_IO, at, path, "has an unreadable attribute");
  hid_t    space = H5Aget_space(*attribute);
  hssize_t count = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  if (space >= 0) H5Sclose(space);
  if (count == 1) return SHB_OK;
  H5Aclose(*attribute);
  *attribute = -1;
  SHB_FAIL(SHB_ERR_INPUT, "%s: attribute %s must hold one value", h5_label(at, path, label), name);
}

static shb_status wrong_kind(hid_t at, const char *path, const char *name, const char *wanted) {
  char label[H5_LABEL];
  SHB_FAIL(SHB_ERR_INPUT, "%s: attribute %s must be %s", h5_label(at, path, label), name, wanted);
}

/* Fixed-length text may lack its terminator: read one byte more. HDF5 does not convert between
 * character sets. */
static char *read_fixed(hid_t attribute, hid_t stored) {
  size_t size = H5Tget_size(stored);
  char  *text = calloc(size + 1, 1);
  hid_t  type = H5Tcopy(H5T_C_S1);
  if (!text || type < 0 || H5Tset_size(type, size + 1) < 0 ||
      H5Tset_cset(type, H5Tget_cset(stored)) < 0 || H5Aread(attribute, type, text) < 0) {
    free(text);
    text = NULL;
  }
  if (type >= 0) H5Tclose(type);
  return text;
}

static char *read_variable(hid_t attribute, hid_t stored) {
  char *library = NULL, *text = NULL;
  hid_t type = h5_text_type();
  if (type >= 0 && H5Tset_cset(type, H5Tget_cset(stored)) >= 0 &&
      H5Aread(attribute, type, &library) >= 0)
    text = strdup(library ? library : "");
  if (library) H5free_memory(library);
  if (type >= 0) H5Tclose(type);
  return text;
}

shb_status h5_read_attribute_text(hid_t at, const char *path, const char *name, char **text) {
  *text = NULL;
  hid_t attribute;
  SHB_TRY(open_attribute(at, path, name, &attribute));
  if (attribute < 0) return SHB_OK;
  hid_t stored   = H5Aget_type(attribute);
  bool  is_text  = stored >= 0 && H5Tget_class(stored) == H5T_STRING;
  bool  variable = is_text && H5Tis_variable_str(stored) > 0;
  if (is_text) *text = variable ? read_variable(attribute, stored) : read_fixed(attribute, stored);
  if (stored >= 0) H5Tclose(stored);
  H5Aclose(attribute);
  if (!is_text) return wrong_kind(at, path, name, "text");
  return *text ? SHB_OK : wrong_kind(at, path, name, "readable text (the file may be damaged)");
}

static shb_status read_number(hid_t at, const char *path, const char *name, hid_t type,
                              void *value) {
  hid_t attribute;
  SHB_TRY(open_attribute(at, path, name, &attribute));
  if (attribute < 0) return SHB_OK;
  hid_t       stored = H5Aget_type(attribute);
  H5T_class_t kind   = stored >= 0 ? H5Tget_class(stored) : H5T_NO_CLASS;
  bool good = (kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Aread(attribute, type, value) >= 0;
  if (stored >= 0) H5Tclose(stored);
  H5Aclose(attribute);
  return good ? SHB_OK : wrong_kind(at, path, name, "a number");
}

shb_status h5_read_attribute_double(hid_t at, const char *path, const char *name, double fallback,
                                    double *value) {
  *value = fallback;
  return read_number(at, path, name, H5T_NATIVE_DOUBLE, value);
}

/* Read through double, so that 1.5 is refused and not cut to 1. */
shb_status h5_read_attribute_int(hid_t at, const char *path, const char *name, int fallback,
                                 int *value) {
  double number = fallback;
  *value        = fallback;
  SHB_TRY(read_number(at, path, name, H5T_NATIVE_DOUBLE, &number));
  if (!(number >= -2147483648.0 && number <= 2147483647.0) || number != (int)number)
    return wrong_kind(at, path, name, "a whole number");
  *value = (int)number;
  return SHB_OK;
}

shb_status h5_write_attribute_ints(hid_t at, const char *path, const char *name, int n,
                                   const int *value) {
  const hsize_t count = (hsize_t)n;
  if (H5Aexists_by_name(at, path, name, H5P_DEFAULT) > 0)
    H5Adelete_by_name(at, path, name, H5P_DEFAULT);
  hid_t space     = H5Screate_simple(1, &count, NULL);
  hid_t attribute = H5Acreate_by_name(at, path, name, H5T_NATIVE_INT, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT);
  bool  good      = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT, value) >= 0;
  if (attribute >= 0) H5Aclose(attribute);
  if (space >= 0) H5Sclose(space);
  return good ? SHB_OK : h5_failed(SHB_ERR_IO, at, path, "cannot be given an attribute");
}

shb_status h5_read_attribute_ints(hid_t at, const char *path, const char *name, int *n,
                                  int **value) {
  *n     = 0;
  *value = NULL;
  if (H5Aexists_by_name(at, path, name, H5P_DEFAULT) <= 0) return SHB_OK;
  hid_t attribute = H5Aopen_by_name(at, path, name, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0) return h5_failed(SHB_ERR_IO, at, path, "has an unreadable attribute");
  hid_t    space = H5Aget_space(attribute), stored = H5Aget_type(attribute);
  hssize_t count = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  bool     good  = stored >= 0 && H5Tget_class(stored) == H5T_INTEGER && count >= 1;
  *value         = good && count < 1000000 ? malloc((size_t)count * sizeof **value) : NULL;
  good           = *value && H5Aread(attribute, H5T_NATIVE_INT, *value) >= 0;
  if (stored >= 0) H5Tclose(stored);
  if (space >= 0) H5Sclose(space);
  H5Aclose(attribute);
  if (!good) return wrong_kind(at, path, name, "a list of whole numbers");
  *n = (int)count;
  return SHB_OK;
}

shb_status h5_check_format(hid_t file, const char *format, int version) {
  char  label[H5_LABEL];
  char *found = NULL;
  SHB_TRY(h5_read_attribute_text(file, "/", "format", &found));
  h5_label(file, "/", label);
  label[strlen(label) - 3] = '\0'; /* keep the file's name alone */
  SHB_CHECK(found, SHB_ERR_INPUT, "%s: is not a %s: the root attribute format = \"%s\" is missing",
            label, format, format);
  bool       same   = strcmp(found, format) == 0;
  shb_status status = SHB_OK;
  if (!same)
    status = shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s: is a \"%s\" file, not a \"%s\" file",
                      label, found, format);
  free(found);
  SHB_TRY(status);
  int have;
  SHB_TRY(h5_read_attribute_int(file, "/", "format_version", -1, &have));
  SHB_CHECK(have != -1, SHB_ERR_INPUT, "%s: the root attribute format_version = %d is missing",
            label, version);
  SHB_CHECK(have >= 1 && have <= version, SHB_ERR_INPUT,
            "%s: format_version is %d; this program reads versions 1 to %d", label, have, version);
  return SHB_OK;
}
