#include "postproc/inspect/value_range.h"

#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

/* Chunks of one number each; value is written to the first of them if it is above 0. */
static hid_t chunked(hid_t file, const char *name, hsize_t length, double value) {
  const hsize_t dim[2] = {length, length}, chunk[2] = {1, 1}, start[2] = {0, 0}, one = 1;
  hid_t         list = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, dim, NULL);
  assert_true(H5Pset_chunk(list, 2, chunk) >= 0);
  hid_t set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT);
  assert_true(set >= 0);
  if (value > 0) {
    hid_t memory = H5Screate_simple(1, &one, NULL);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, chunk, NULL);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value) >= 0);
    H5Sclose(memory);
  }
  H5Sclose(space);
  H5Pclose(list);
  return set;
}

static void values_that_are_not_there_are_told(void **state) {
  (void)state;
  char  text[POST_VALUE_RANGE];
  hid_t file = H5Fcreate(scratch("empty.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hid_t set  = chunked(file, "x", 1000000000, 0);
  assert_string_equal(post_value_range(set, 10, text), "not written");
  H5Dclose(set);
  H5Fclose(file);
}

/* 1e18 numbers, of which one is in the file: reading ends after its time, and the text says so. */
static void reading_is_bounded(void **state) {
  (void)state;
  char  text[POST_VALUE_RANGE];
  hid_t file = H5Fcreate(scratch("huge.h5"), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hid_t set  = chunked(file, "x", 1000000000, 2.385);
  post_value_range(set, 0.01, text);
  printf("%s\n", text);
  assert_has(text, "0 … 2.385, first ");
  assert_has(text, " % read");
  H5Dclose(set);
  set = chunked(file, "y", 2, 2.385);
  assert_string_equal(post_value_range(set, 10, text), "0 … 2.385");
  H5Dclose(set);
  H5Fclose(file);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_that_are_not_there_are_told),
      cmocka_unit_test(reading_is_bounded),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
