/* Content that lies in another file is refused, and that file is never opened. */
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "modal/hdf5/stamp.h"
#include "tests/support/files.h"

static const hsize_t four[] = {4};

/* A plain file of another program with one dataset. */
static hid_t plain(const char *name) {
  const double x[]  = {2.385, -7, 0.5, 12};
  hid_t        file = H5Fcreate(scratch(name), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hid_t        set, group, space = H5Screate_simple(1, four, NULL);
  set = H5Dcreate2(file, "own", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0);
  group = H5Gcreate2(file, "deep", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Lcreate_hard(file, "/", group, "loop", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  assert_true(H5Lcreate_soft("/own", group, "soft", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  H5Gclose(group);
  H5Dclose(set);
  H5Sclose(space);
  return file;
}

static void put(hid_t file, const char *name, hid_t creation) {
  hid_t space = H5Screate_simple(1, four, NULL);
  hid_t set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  assert_true(set >= 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(creation);
}

static void external(const char *name, const char *source) {
  hid_t file = plain(name), creation = H5Pcreate(H5P_DATASET_CREATE);
  assert_true(H5Pset_external(creation, source, 0, 32) >= 0);
  put(file, "deep/er", creation);
  H5Fclose(file);
}

/* source ".": a dataset of the same file. A name with %b stands for any number of files. */
static void virtual(const char *name, const char *source) {
  hid_t file = plain(name), creation = H5Pcreate(H5P_DATASET_CREATE);
  hid_t space = H5Screate_simple(1, four, NULL);
  assert_true(H5Pset_virtual(creation, space, source, "own", space) >= 0);
  put(file, "deep/er", creation);
  H5Sclose(space);
  H5Fclose(file);
}

static void linked(const char *name, const char *target) {
  hid_t file = plain(name);
  assert_true(H5Lcreate_external(target, "/own", file, "deep/er", H5P_DEFAULT, H5P_DEFAULT) >= 0);
  H5Fclose(file);
}

static void assert_told(const char *name, const char *why) {
  hid_t file = -1;
  assert_int_equal(h5_open(scratch(name), &file), SHB_ERR_INPUT);
  assert_true(file < 0);
  assert_has(shb_message(), name);
  assert_has(shb_message(), "/deep/er");
  assert_has(shb_message(), why);
}

/* A file with two names for a group and a soft link has all its content itself. */
static void a_file_with_its_own_content_is_read(void **state) {
  (void)state;
  H5Fclose(plain("own.h5"));
  hid_t    file    = -1;
  h5_shape four_of = H5_SHAPE(4);
  double  *x;
  assert_ok(h5_open(scratch("own.h5"), &file));
  assert_ok(h5_read_double(file, "/deep/soft", &four_of, &x));
  assert_true(x[0] == 2.385);
  free(x);
  assert_ok(h5_close(file));
  virtual("itself.h5", ".");
  assert_ok(h5_open(scratch("itself.h5"), &file));
  assert_ok(h5_close(file));
}

/* HDF5 reads its fill value where nothing was written and where a view has no source. */
static void fill_values_are_no_content(void **state) {
  (void)state;
  hid_t    file    = plain("never.h5");
  h5_shape four_of = H5_SHAPE(4);
  double  *x;
  put(file, "deep/er", H5Pcreate(H5P_DATASET_CREATE));
  assert_int_equal(h5_read_double(file, "/deep/er", &four_of, &x), SHB_ERR_INPUT);
  assert_has(shb_message(), "/deep/er holds no values: it was never written");
  H5Fclose(file);
  virtual("view.h5", ".");
  assert_ok(h5_open(scratch("view.h5"), &file));
  assert_int_equal(h5_read_double(file, "/deep/er", &four_of, &x), SHB_ERR_INPUT);
  assert_has(shb_message(), "/deep/er is a view of other datasets");
  assert_ok(h5_close(file));
}

static void content_of_another_file_is_refused(void **state) {
  (void)state;
  spill(scratch("secret"), "what nobody else may read, 32 b", 32);
  external("raw.h5", scratch("secret"));
  assert_told("raw.h5", "external storage");
  H5Fclose(plain("source.h5"));
  virtual("virtual.h5", scratch("source.h5"));
  assert_told("virtual.h5", "virtual dataset");
  virtual("missing.h5", scratch("nowhere.h5"));
  assert_told("missing.h5", "virtual dataset");
  linked("link.h5", scratch("source.h5"));
  assert_told("link.h5", "external link");
}

/* An open of the pipe would wait for a writer: the test would end with SIGALRM. */
static void a_pipe_behind_the_file_is_not_opened(void **state) {
  (void)state;
  assert_int_equal(mkfifo(scratch("pipe"), 0600), 0);
  external("raw_pipe.h5", scratch("pipe"));
  virtual("virtual_pipe.h5", scratch("pipe"));
  linked("link_pipe.h5", scratch("pipe"));
  alarm(20);
  assert_told("raw_pipe.h5", "external storage");
  assert_told("virtual_pipe.h5", "virtual dataset");
  assert_told("link_pipe.h5", "external link");
  alarm(0);
}

/* Put a stamp that fits in front of a file. */
static void stamp(const char *from, const char *to) {
  char   head[H5_STAMP];
  size_t n;
  char  *image = slurp(scratch(from), &n), *all = malloc(H5_STAMP + n);
  h5_stamp_make(image, n, head);
  memcpy(all, head, H5_STAMP);
  memcpy(all + H5_STAMP, image, n);
  spill(scratch(to), all, H5_STAMP + n);
  free(image);
  free(all);
}

/* Anybody can make a checksum: it does not stand for the content. Nor is such a file written on,
 * which would change the other one. */
static void a_checksum_that_fits_does_not_help(void **state) {
  (void)state;
  spill(scratch("kept"), "what nobody else may change ...", 32);
  external("plain.h5", scratch("kept"));
  stamp("plain.h5", "stamped.h5");
  assert_int_equal(h5_stamp_check(scratch("stamped.h5")), H5_INTACT);
  assert_told("stamped.h5", "external storage");
  hid_t file = -1;
  assert_int_equal(h5_create_like(scratch("stamped.h5"), scratch("next.h5"), &file), SHB_ERR_INPUT);
  assert_true(file < 0);
  assert_has(shb_message(), "external storage");
  assert_int_not_equal(access(scratch("next.h5"), F_OK), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_file_with_its_own_content_is_read),
                                     cmocka_unit_test(fill_values_are_no_content),
                                     cmocka_unit_test(content_of_another_file_is_refused),
                                     cmocka_unit_test(a_pipe_behind_the_file_is_not_opened),
                                     cmocka_unit_test(a_checksum_that_fits_does_not_help)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
