/* The HDF5 layer: exact round trips, files of other writers, and damaged files. */
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "tests/support/files.h"

#include <hdf5_hl.h>

static hid_t create(const char *name) {
  hid_t file = -1;
  assert_ok(h5_create(scratch(name), &file));
  return file;
}

static hid_t reopen(const char *name) {
  hid_t file = -1;
  assert_ok(h5_open(scratch(name), &file));
  return file;
}

static const double         reals[2][3]  = {{2.385, -1e-300, 0}, {1.0 / 3, 6.02e23, -0.0}};
static const double complex waves[2]     = {1.5 - 2.25 * I, -7e-9 + I * 0.1};
static const int            wholes[4]    = {-2147483647 - 1, 0, 5, 2147483647};
static const char *const    names[3]     = {"tip", "r\xc3\xa9sonance \xcf\x88", ""};
static const char           long_label[] = "a long name";

static void write_sample(const char *name) {
  hid_t file = create(name);
  assert_ok(h5_write_double(file, "/a/b/real", H5_SHAPE(2, 3), *reals, "m/N", long_label));
  assert_ok(h5_write_complex(file, "/a/wave", H5_SHAPE(2), waves, "N", long_label));
  assert_ok(h5_write_int(file, "whole", H5_SHAPE(4), wholes, "-", long_label));
  assert_ok(h5_write_strings(file, "/name", 3, names, long_label));
  assert_ok(h5_write_double(file, "/scalar", (h5_shape){0}, &reals[1][0], "s", long_label));
  assert_ok(h5_write_double(file, "/none", H5_SHAPE(0, 3), NULL, "s", long_label));
  assert_ok(h5_close(file));
}

static void test_round_trip(void **state) {
  (void)state;
  write_sample("trip.h5");
  hid_t           file  = reopen("trip.h5");
  h5_shape        shape = H5_SHAPE(2, 0);
  double         *real;
  double complex *wave;
  int            *whole, n;
  char          **text;
  assert_ok(h5_read_double(file, "/a/b/real", &shape, &real));
  assert_int_equal(shape.dim[1], 3);
  assert_memory_equal(real, reals, sizeof reals);
  shape = H5_SHAPE(0);
  assert_ok(h5_read_complex(file, "a/wave", &shape, &wave));
  assert_int_equal(shape.dim[0], 2);
  assert_memory_equal(wave, waves, sizeof waves);
  shape = H5_SHAPE(4);
  assert_ok(h5_read_int(file, "/whole", &shape, &whole));
  assert_memory_equal(whole, wholes, sizeof wholes);
  assert_ok(h5_read_strings(file, "/name", &n, &text));
  assert_int_equal(n, 3);
  for (int i = 0; i < n; i++) assert_string_equal(text[i], names[i]);
  for (int i = 0; i < n; i++) free(text[i]);
  free(text);
  free(real);
  shape = (h5_shape){0};
  assert_ok(h5_read_double(file, "/scalar", &shape, &real));
  assert_true(*real == reals[1][0]);
  free(real);
  shape = H5_SHAPE(0, 3);
  assert_ok(h5_read_double(file, "/none", &shape, &real));
  assert_int_equal(shape.dim[0], 0);
  free(real);
  free(wave);
  free(whole);
  assert_ok(h5_close(file));
  assert_int_equal(assert_described(scratch("trip.h5")), 6);
}

/* Large datasets with many zeros are compressed, others are not; both are read unchanged. */
static void test_compression(void **state) {
  (void)state;
  enum { ROWS = 50021, COLUMNS = 7 };
  double *sparse = calloc(ROWS * COLUMNS, sizeof *sparse), *back;
  double *dense  = calloc(ROWS * COLUMNS, sizeof *dense);
  for (int i = 0; i < ROWS * COLUMNS; i++) dense[i] = sin(i + 0.1);
  for (int i = 0; i < ROWS * COLUMNS; i += 6) sparse[i] = dense[i];
  hid_t    file  = create("zeros.h5");
  h5_shape shape = H5_SHAPE(ROWS, COLUMNS);
  assert_ok(h5_write_double(file, "sparse", shape, sparse, "m", long_label));
  assert_ok(h5_write_double(file, "dense", shape, dense, "m", long_label));
  assert_ok(h5_close(file));
  file = reopen("zeros.h5");
  assert_ok(h5_read_double(file, "sparse", &shape, &back));
  assert_memory_equal(back, sparse, ROWS * COLUMNS * sizeof *back);
  free(back);
  hsize_t bytes[2];
  for (int i = 0; i < 2; i++) {
    hid_t set = H5Dopen2(file, i ? "dense" : "sparse", H5P_DEFAULT);
    bytes[i]  = H5Dget_storage_size(set);
    H5Dclose(set);
  }
  printf("sparse %llu bytes, dense %llu\n", (unsigned long long)bytes[0],
         (unsigned long long)bytes[1]);
  assert_true(bytes[0] < bytes[1] / 3);
  assert_int_equal(bytes[1], ROWS * COLUMNS * sizeof *dense);
  assert_ok(h5_close(file));
  free(sparse);
  free(dense);
}

static void test_exists(void **state) {
  (void)state;
  write_sample("exists.h5");
  hid_t file = reopen("exists.h5");
  assert_true(h5_exists(file, "/a/b/real") && h5_exists(file, "a") && h5_exists(file, "/"));
  assert_false(h5_exists(file, "/a/c/real") || h5_exists(file, "x") || h5_exists(file, "/a/b/y"));
  assert_false(h5_exists(file, "/a/wave/below")); /* a dataset is no group */
  assert_ok(h5_close(file));
}

static void test_attributes(void **state) {
  (void)state;
  size_t n    = 200000; /* beyond the 64 kB of a fixed-length attribute */
  char  *many = malloc(n + 1), *text;
  int    whole;
  double real;
  memset(many, 'x', n);
  many[n]    = '\0';
  hid_t file = create("attribute.h5");
  assert_ok(h5_write_attribute_text(file, "/", "many", many));
  assert_ok(h5_write_attribute_text(file, "/", "twice", "first"));
  assert_ok(h5_write_attribute_text(file, "/", "twice", "second"));
  assert_ok(h5_write_attribute_int(file, "/", "whole", -40));
  assert_ok(h5_write_attribute_double(file, "/", "real", 2.385));
  assert_ok(h5_close(file));
  file = reopen("attribute.h5");
  assert_ok(h5_read_attribute_text(file, "/", "many", &text));
  assert_string_equal(text, many);
  free(text);
  assert_ok(h5_read_attribute_text(file, "/", "twice", &text));
  assert_string_equal(text, "second");
  free(text);
  assert_ok(h5_read_attribute_text(file, "/", "absent", &text));
  assert_null(text);
  assert_ok(h5_read_attribute_int(file, "/", "whole", 7, &whole));
  assert_int_equal(whole, -40);
  assert_ok(h5_read_attribute_int(file, "/", "absent", 7, &whole));
  assert_int_equal(whole, 7);
  assert_ok(h5_read_attribute_double(file, "/", "real", 0, &real));
  assert_true(real == 2.385);
  assert_refused(h5_read_attribute_int(file, "/", "real", 0, &whole), SHB_ERR_INPUT,
                 "whole number");
  assert_refused(h5_read_attribute_int(file, "/", "many", 0, &whole), SHB_ERR_INPUT, "a number");
  assert_refused(h5_read_attribute_text(file, "/", "real", &text), SHB_ERR_INPUT, "must be text");
  assert_refused(h5_read_attribute_text(file, "/nowhere", "real", &text), SHB_ERR_INPUT, "missing");
  assert_ok(h5_close(file));
  free(many);
}

static void test_provenance_and_format(void **state) {
  (void)state;
  const shb_provenance from = {"c.yaml", "name: c\n", "a = 1\n", "shroudhb-modal"};
  hid_t                file = create("format.h5");
  assert_refused(h5_check_format(file, "x", 1), SHB_ERR_INPUT, "is not a x: the root attribute");
  assert_ok(h5_write_provenance(file, "shroudhb response", 2, &from));
  assert_ok(h5_check_format(file, "shroudhb response", 2));
  assert_ok(h5_check_format(file, "shroudhb response", 3));
  assert_refused(h5_check_format(file, "shroudhb response", 1), SHB_ERR_INPUT, "versions 1 to 1");
  assert_refused(h5_check_format(file, "shroudhb modal model", 2), SHB_ERR_INPUT,
                 "format.h5: is a \"shroudhb response\" file, not a \"shroudhb modal model\"");
  static const char *const wanted[][2] = {{"case_path", "c.yaml"},
                                          {"case_text", "name: c\n"},
                                          {"settings", "a = 1\n"},
                                          {"command", "shroudhb-modal"}};
  char                    *text;
  for (int i = 0; i < 4; i++) {
    assert_ok(h5_read_attribute_text(file, "/", wanted[i][0], &text));
    assert_string_equal(text, wanted[i][1]);
    free(text);
  }
  assert_ok(h5_read_attribute_text(file, "/", "created", &text));
  assert_int_equal(strlen(text), strlen("2024-01-01T00:00:00Z"));
  free(text);
  H5Adelete(file, "format_version");
  assert_refused(h5_check_format(file, "shroudhb response", 2), SHB_ERR_INPUT, "format_version");
  h5_abandon(file);
}

static void test_scales(void **state) {
  (void)state;
  hid_t file = create("scale.h5");
  assert_ok(h5_write_double(file, "/f", H5_SHAPE(3), *reals, "Hz", "frequency"));
  assert_ok(h5_write_double(file, "/y", H5_SHAPE(2, 3), *reals, "m", "motion"));
  assert_ok(h5_attach_scale(file, "/y", 1, "/f"));
  assert_refused(h5_attach_scale(file, "/y", 0, "/f"), SHB_ERR_IO, "differ in length");
  assert_refused(h5_attach_scale(file, "/y", 2, "/f"), SHB_ERR_IO, "differ in length");
  assert_refused(h5_attach_scale(file, "/y", 0, "/g"), SHB_ERR_INPUT, "/g is missing");
  assert_ok(h5_close(file));
  file    = reopen("scale.h5");
  hid_t y = H5Dopen2(file, "/y", H5P_DEFAULT), f = H5Dopen2(file, "/f", H5P_DEFAULT);
  assert_int_equal(H5DSis_attached(y, f, 1), 1);
  assert_int_equal(H5DSis_attached(y, f, 0), 0);
  H5Dclose(y);
  H5Dclose(f);
  assert_ok(h5_close(file));
}

/* A dimension scale may label thousands of datasets: HDF5's list of them must not reach 64 kB. */
static void test_many_attachments(void **state) {
  (void)state;
  enum { MANY = 5000 };
  hid_t file = create("many.h5");
  char  name[32];
  assert_ok(h5_write_double(file, "/f", H5_SHAPE(1), *reals, "Hz", "frequency"));
  for (int i = 0; i < MANY; i++) {
    snprintf(name, sizeof name, "/y%d", i);
    assert_ok(h5_write_double(file, name, H5_SHAPE(1), *reals, "m", "motion"));
    assert_ok(h5_attach_scale(file, name, 0, "/f"));
  }
  assert_ok(h5_close(file));
  file    = reopen("many.h5");
  hid_t y = H5Dopen2(file, name, H5P_DEFAULT), f = H5Dopen2(file, "/f", H5P_DEFAULT);
  assert_int_equal(H5DSis_attached(y, f, 0), 1);
  H5Dclose(y);
  H5Dclose(f);
  assert_ok(h5_close(file));
}

/* ------------------------------------------------------------ other writers */

static hid_t native_complex(void) {
  hid_t type = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
  H5Tinsert(type, "r", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "i", sizeof(double), H5T_NATIVE_DOUBLE);
  return type;
}

static void put(hid_t file, const char *name, hid_t stored, hid_t memory, h5_shape shape,
                const void *data) {
  hid_t space = shape.rank ? H5Screate_simple(shape.rank, shape.dim, NULL) : H5Screate(H5S_SCALAR);
  hid_t set   = H5Dcreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(set >= 0 &&
              (!data || H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0));
  H5Dclose(set);
  H5Sclose(space);
}

/* {imag, real} as big-endian floats: other names, order, width and byte order at once. */
static hid_t foreign_complex(void) {
  hid_t type = H5Tcreate(H5T_COMPOUND, 8);
  H5Tinsert(type, "imag", 0, H5T_IEEE_F32BE);
  H5Tinsert(type, "real", 4, H5T_IEEE_F32BE);
  return type;
}

static void test_foreign_numbers(void **state) {
  (void)state;
  const double    pairs[4] = {0.25, -3, 8, 1.5}; /* imag, real */
  const long      big[2]   = {3, 1L << 40};
  hid_t           file = create("foreign.h5"), stored = foreign_complex();
  hid_t           memory = H5Tcreate(H5T_COMPOUND, 16);
  double complex *wave;
  double         *real;
  int            *whole;
  h5_shape        two = H5_SHAPE(2);
  H5Tinsert(memory, "imag", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(memory, "real", 8, H5T_NATIVE_DOUBLE);
  put(file, "wave", stored, memory, two, pairs);
  put(file, "float", H5T_IEEE_F32BE, H5T_NATIVE_DOUBLE, two, pairs);
  put(file, "short", H5T_STD_I16BE, H5T_NATIVE_LONG, H5_SHAPE(1), big);
  put(file, "long", H5T_STD_I64LE, H5T_NATIVE_LONG, two, big);
  assert_ok(h5_read_complex(file, "wave", &two, &wave));
  assert_true(wave[0] == -3 + 0.25 * I && wave[1] == 1.5 + 8 * I);
  free(wave);
  assert_ok(h5_read_complex(file, "float", &two, &wave));
  assert_true(wave[0] == 0.25 && wave[1] == -3);
  free(wave);
  h5_shape one = H5_SHAPE(1);
  assert_ok(h5_read_double(file, "short", &one, &real));
  assert_true(*real == 3);
  free(real);
  assert_ok(h5_read_int(file, "short", &one, &whole));
  assert_int_equal(*whole, 3);
  free(whole);
  assert_refused(h5_read_int(file, "long", &two, &whole), SHB_ERR_INPUT,
                 "whole numbers are wanted");
  assert_refused(h5_read_int(file, "float", &two, &whole), SHB_ERR_INPUT, "holds 0.25 where");
  assert_refused(h5_read_double(file, "wave", &two, &real), SHB_ERR_INPUT,
                 "holds complex numbers where real numbers are wanted");
  H5Tclose(stored);
  H5Tclose(memory);
  h5_abandon(file);
}

static void test_foreign_texts(void **state) {
  (void)state;
  hid_t  file = create("texts.h5"), fixed = H5Tcopy(H5T_C_S1), padded = H5Tcopy(H5T_C_S1);
  int    n;
  char **text, *attribute;
  H5Tset_size(fixed, 3);
  H5Tset_strpad(fixed, H5T_STR_NULLPAD); /* as numpy's S3: no terminator when full */
  H5Tset_size(padded, 6);
  H5Tset_strpad(padded, H5T_STR_SPACEPAD); /* as Fortran */
  put(file, "fixed", fixed, fixed, H5_SHAPE(2), "tipab");
  put(file, "padded", padded, padded, (h5_shape){0}, "tip   ");
  put(file, "real", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, H5_SHAPE(2), *reals);
  assert_ok(h5_read_strings(file, "fixed", &n, &text));
  assert_int_equal(n, 2);
  assert_string_equal(text[0], "tip");
  assert_string_equal(text[1], "ab");
  for (int i = 0; i < n; i++) free(text[i]);
  free(text);
  assert_ok(h5_read_strings(file, "padded", &n, &text));
  assert_int_equal(n, 1);
  assert_string_equal(text[0], "tip");
  free(text[0]);
  free(text);
  assert_refused(h5_read_strings(file, "real", &n, &text), SHB_ERR_INPUT,
                 "real numbers where texts");
  double *real;
  assert_refused(h5_read_double(file, "fixed", &H5_SHAPE(2), &real), SHB_ERR_INPUT,
                 "text where real");
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t put_  = H5Acreate2(file, "format", fixed, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(put_, fixed, "abc");
  assert_ok(h5_read_attribute_text(file, "/", "format", &attribute));
  assert_string_equal(attribute, "abc");
  free(attribute);
  H5Aclose(put_);
  H5Sclose(space);
  H5Tclose(fixed);
  H5Tclose(padded);
  h5_abandon(file);
}

/* ------------------------------------------------------------ bad data */

static void test_bad_datasets(void **state) {
  (void)state;
  const double         bad[4] = {1, 2, NAN, INFINITY};
  const double complex odd[2] = {1, CMPLX(0, -INFINITY)};
  hid_t                file   = create("bad.h5");
  double              *real;
  double complex      *wave;
  h5_shape             two = H5_SHAPE(2, 2), any = H5_SHAPE(0), wide = H5_SHAPE(3, 0);
  hid_t                type = native_complex(), group = H5Gcreate2(file, "g", 0, 0, 0);
  put(group, "bad", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, two, bad);
  put(file, "odd", type, type, H5_SHAPE(2), odd);
  H5Tclose(type);
  H5Gclose(group);
  assert_refused(h5_read_double(file, "/g/bad", &two, &real), SHB_ERR_INPUT,
                 "bad.h5: /g/bad: the value at [1, 0] (from 0) is not a number");
  assert_null(real);
  assert_refused(h5_read_complex(file, "odd", &any, &wave), SHB_ERR_INPUT,
                 "[1] (from 0) is infinite");
  any = H5_SHAPE(0);
  assert_refused(h5_read_double(file, "/g/bad", &any, &real), SHB_ERR_INPUT,
                 "/g/bad has shape [2, 2] where [any] is wanted");
  assert_refused(h5_read_double(file, "/g/bad", &wide, &real), SHB_ERR_INPUT,
                 "/g/bad has shape [2, 2] where [3, any] is wanted");
  assert_refused(h5_read_double(file, "/g/x", &any, &real), SHB_ERR_INPUT,
                 "bad.h5: /g/x is missing");
  assert_refused(h5_read_double(file, "/g", &any, &real), SHB_ERR_INPUT, "not a readable dataset");
  hid_t null = H5Screate(H5S_NULL);
  H5Dclose(H5Dcreate2(file, "null", H5T_NATIVE_DOUBLE, null, 0, 0, 0));
  H5Sclose(null);
  assert_refused(h5_read_double(file, "null", &any, &real), SHB_ERR_INPUT, "holds nothing");
  hsize_t six[6] = {1, 1, 1, 1, 1, 1};
  hid_t   space  = H5Screate_simple(6, six, NULL);
  H5Dclose(H5Dcreate2(file, "six", H5T_NATIVE_DOUBLE, space, 0, 0, 0));
  H5Sclose(space);
  assert_refused(h5_read_double(file, "six", &any, &real), SHB_ERR_INPUT, "6 dimensions");
  h5_abandon(file);
}

/* What no reader would take is not written either. */
static void test_only_finite_values_are_written(void **state) {
  (void)state;
  const double         bad[3] = {1, 2, -INFINITY};
  const double complex odd[2] = {1, CMPLX(0, NAN)};
  hid_t                file   = create("finite.h5");
  assert_refused(
      h5_write_double(file, "/g/bad", H5_SHAPE(3), bad, "m", long_label), SHB_ERR_INPUT,
      "finite.h5: /g/bad: the value at [2] (from 0) is infinite; a number of the input is ");
  assert_refused(h5_write_complex(file, "/g/odd", H5_SHAPE(2), odd, "m", long_label), SHB_ERR_INPUT,
                 "finite.h5: /g/odd: the value at [1] (from 0) is not a number");
  assert_refused(h5_write_attribute_double(file, "/", "psi", NAN), SHB_ERR_INPUT,
                 "finite.h5: /: attribute psi is not a number; it must be finite");
  assert_false(h5_exists(file, "/g/bad") || h5_exists(file, "/g/odd"));
  assert_ok(h5_write_double(file, "/g/bad", H5_SHAPE(2), bad, "m", long_label));
  h5_abandon(file);
}

/* A small file that declares terabytes must not cause their allocation. */
static void test_huge_claims(void **state) {
  (void)state;
  hid_t         file = create("huge.h5"), layout = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk[2] = {4096, 1};
  h5_shape      any      = H5_SHAPE(0, 0);
  double       *real;
  H5Pset_chunk(layout, 2, chunk);
  static const struct {
    const char *name, *text;
    hsize_t     dim[2];
  } claim[] = {{"a", "too large", {1ull << 40, 4}},
               {"b", "too large", {1ull << 30, 1ull << 30}},
               {"c", "declares 8589934592 bytes", {1ull << 30, 1}}};
  for (int i = 0; i < 3; i++) {
    hid_t space = H5Screate_simple(2, claim[i].dim, NULL);
    H5Dclose(H5Dcreate2(file, claim[i].name, H5T_NATIVE_DOUBLE, space, 0, layout, 0));
    H5Sclose(space);
    any = H5_SHAPE(0, 0);
    assert_refused(h5_read_double(file, claim[i].name, &any, &real), SHB_ERR_INPUT, claim[i].text);
  }
  H5Pclose(layout);
  h5_abandon(file);
}

/* ------------------------------------------------------------ bad files */

static shb_status open_and_close(const char *path) {
  hid_t file;
  SHB_TRY(h5_open(path, &file));
  return h5_close(file);
}

static void test_bad_files(void **state) {
  (void)state;
  spill(scratch("text.h5"), "frequency,amplitude\n1,2\n", 24);
  spill(scratch("empty.h5"), "", 0);
  assert_refused(open_and_close(scratch("none.h5")), SHB_ERR_IO,
                 "none.h5: cannot be opened: No such file");
  assert_refused(open_and_close(scratch("text.h5")), SHB_ERR_IO, "text.h5: is not an HDF5 file");
  assert_refused(open_and_close(scratch("empty.h5")), SHB_ERR_IO, "is empty, not an HDF5 file");
  assert_refused(open_and_close(scratch_folder), SHB_ERR_IO, "is not a file");
  assert_refused(open_and_close("/dev/null"), SHB_ERR_IO, "is not a file");
}

/* In a child process without root's rights, to which permissions apply. */
static void test_no_permission(void **state) {
  (void)state;
  write_sample("private.h5");
  chmod(scratch("private.h5"), 0);
  chmod(scratch_folder, 0755);
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    hid_t file;
    if (geteuid() == 0 && seteuid(65534) != 0) _exit(77);
    bool read_refused = h5_open(scratch("private.h5"), &file) == SHB_ERR_IO &&
                        strstr(shb_message(), "Permission denied");
    bool write_refused = h5_create("/proc/version", &file) == SHB_ERR_IO &&
                         strstr(shb_message(), "cannot be written: Permission denied");
    _exit(read_refused && write_refused ? 0 : 1);
  }
  int how;
  waitpid(child, &how, 0);
  unlink(scratch("private.h5"));
  if (WIFEXITED(how) && WEXITSTATUS(how) == 77) skip();
  assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 0);
}

static void test_truncated(void **state) {
  (void)state;
  write_sample("whole.h5");
  assert_prefixes_refused(scratch("whole.h5"), 37, open_and_close);
}

/* ------------------------------------------------------------ failing writes */

static void test_no_folder(void **state) {
  (void)state;
  hid_t file;
  assert_refused(h5_create(scratch("no/such/x.h5.tmp.12"), &file), SHB_ERR_IO,
                 "no/such/x.h5: cannot be written: No such file or directory");
  assert_true(file < 0);
  assert_ok(h5_close(file)); /* nothing to close */
}

/* The disk fills up while writing: a one-line message, no partial file, and HDF5 still works. */
static void test_disk_full(void **state) {
  (void)state;
  struct rlimit before, tight;
  hid_t         file = create("limit.h5.tmp.34");
  double       *ones = malloc(100000 * sizeof *ones);
  for (int i = 0; i < 100000; i++) ones[i] = 1; /* zeros would be compressed */
  assert_ok(h5_write_double(file, "/x", H5_SHAPE(100000), ones, "m", long_label));
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &before);
  tight          = before;
  tight.rlim_cur = 65536;
  setrlimit(RLIMIT_FSIZE, &tight);
  shb_status status = h5_close(file);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  assert_int_equal(status, SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "limit.h5: cannot be written: File too large"));
  assert_int_not_equal(access(scratch("limit.h5.tmp.34"), F_OK), 0);
  free(ones);
  if (access("/dev/full", W_OK) == 0) {
    assert_ok(h5_create("/dev/full", &file));
    assert_refused(h5_close(file), SHB_ERR_IO, "/dev/full: cannot be written: No space left");
    assert_int_equal(access("/dev/full", F_OK), 0); /* a device is not removed */
  }
  write_sample("after.h5");
  assert_ok(open_and_close(scratch("after.h5")));
}

/* The temporary file of h5_create can no longer be opened when it is to be filled. */
static void test_no_descriptor_left(void **state) {
  (void)state;
  struct rlimit before, none;
  hid_t         file = create("late.h5.tmp.56");
  assert_int_equal(access(scratch("late.h5.tmp.56"), F_OK), 0);
  getrlimit(RLIMIT_NOFILE, &before);
  none          = before;
  none.rlim_cur = 0;
  setrlimit(RLIMIT_NOFILE, &none);
  shb_status status = h5_close(file);
  setrlimit(RLIMIT_NOFILE, &before);
  assert_int_equal(status, SHB_ERR_IO);
  assert_non_null(strstr(shb_message(), "late.h5: cannot be written: Too many open files"));
  assert_int_not_equal(access(scratch("late.h5.tmp.56"), F_OK), 0);
}

static void test_abandoned(void **state) {
  (void)state;
  int before = files_in_scratch();
  h5_abandon(create("abandoned.h5"));
  h5_abandon(-1);
  assert_int_equal(files_in_scratch(), before);
  write_sample("kept.h5");
  h5_abandon(reopen("kept.h5")); /* a file opened for reading stays */
  assert_int_equal(files_in_scratch(), before + 1);
}

/* Every handle is closed, also after errors. */
static void test_no_open_handles(void **state) {
  (void)state;
  assert_int_equal(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
  hsize_t lists = 0;
  H5Inmembers(H5I_GENPROP_LST, &lists);
  hsize_t again = 0;
  for (int i = 0; i < 3; i++) write_sample("again.h5");
  test_bad_datasets(state);
  H5Inmembers(H5I_GENPROP_LST, &again);
  assert_int_equal(lists, again);
  assert_int_equal(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
}

/* The earlier file stays as it is; a changed one is refused. */
static void test_created_like_another(void **state) {
  (void)state;
  static const double         doubled[2][3] = {{1, 2, 3}, {4, 5, 6}};
  static const double complex turned[2]     = {I, -I};
  hid_t                       file;
  double                     *real;
  double complex             *wave;
  char                      **text;
  int                         n;
  size_t                      size;
  write_sample("first.h5");
  assert_ok(h5_create_like(scratch("first.h5"), scratch("second.h5"), &file));
  assert_ok(h5_replace_double(file, "/a/b/real", H5_SHAPE(2, 3), *doubled));
  assert_ok(h5_replace_complex(file, "/a/wave", H5_SHAPE(2), turned));
  assert_int_equal(h5_replace_double(file, "/a/b/real", H5_SHAPE(3, 2), *doubled), SHB_ERR_IO);
  assert_has(shb_message(), "second.h5: /a/b/real: has another shape");
  assert_true(h5_replace_double(file, "/gone", H5_SHAPE(1), *doubled) != SHB_OK);
  assert_ok(h5_close(file));
  file           = reopen("second.h5");
  h5_shape shape = H5_SHAPE(2, 3);
  assert_ok(h5_read_double(file, "/a/b/real", &shape, &real));
  assert_memory_equal(real, doubled, sizeof doubled);
  shape = H5_SHAPE(2);
  assert_ok(h5_read_complex(file, "/a/wave", &shape, &wave));
  assert_memory_equal(wave, turned, sizeof turned);
  assert_ok(h5_read_strings(file, "/name", &n, &text));
  assert_string_equal(text[1], names[1]);
  for (int i = 0; i < n; i++) free(text[i]);
  free(text);
  free(real);
  free(wave);
  h5_close(file);
  file  = reopen("first.h5");
  shape = H5_SHAPE(2, 3);
  assert_ok(h5_read_double(file, "/a/b/real", &shape, &real));
  assert_memory_equal(real, reals, sizeof reals);
  free(real);
  h5_close(file);
  char *data = slurp(scratch("first.h5"), &size);
  data[size - 1] ^= 1;
  spill(scratch("first.h5"), data, size);
  free(data);
  assert_int_equal(h5_create_like(scratch("first.h5"), scratch("third.h5"), &file), SHB_ERR_INPUT);
  assert_has(shb_message(), "first.h5: was changed since it was written");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_round_trip),
      cmocka_unit_test(test_compression),
      cmocka_unit_test(test_exists),
      cmocka_unit_test(test_attributes),
      cmocka_unit_test(test_provenance_and_format),
      cmocka_unit_test(test_scales),
      cmocka_unit_test(test_many_attachments),
      cmocka_unit_test(test_foreign_numbers),
      cmocka_unit_test(test_foreign_texts),
      cmocka_unit_test(test_bad_datasets),
      cmocka_unit_test(test_huge_claims),
      cmocka_unit_test(test_only_finite_values_are_written),
      cmocka_unit_test(test_bad_files),
      cmocka_unit_test(test_no_permission),
      cmocka_unit_test(test_truncated),
      cmocka_unit_test(test_no_folder),
      cmocka_unit_test(test_disk_full),
      cmocka_unit_test(test_no_descriptor_left),
      cmocka_unit_test(test_abandoned),
      cmocka_unit_test(test_created_like_another),
      cmocka_unit_test(test_no_open_handles),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
