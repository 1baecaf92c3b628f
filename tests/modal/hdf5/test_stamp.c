/* The stamp of a file: every damaged byte is found, and other programs read past it. An earlier
 * result that would crash HDF5 is told apart. */
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "modal/hdf5/stamp.h"
#include "tests/support/files.h"

static const double reals[3] = {2.385, -1e-300, 6.02e23};

static void write_sample(const char *name) {
  hid_t file;
  assert_ok(h5_create(scratch(name), &file));
  assert_ok(h5_write_double(file, "/x", H5_SHAPE(3), reals, "m", "numbers"));
  assert_ok(h5_write_attribute_text(file, "/", "settings", "a = 1\n"));
  assert_ok(h5_close(file));
}

static void every_damaged_byte_is_found(void **state) {
  (void)state;
  size_t size;
  write_sample("a.h5");
  assert_int_equal(h5_stamp_check(scratch("a.h5")), H5_INTACT);
  char *data = slurp(scratch("a.h5"), &size);
  for (size_t i = H5_STAMP; i < size; i += 3) {
    data[i] ^= (char)(1 << (i % 8));
    spill(scratch("b.h5"), data, size);
    assert_int_equal(h5_stamp_check(scratch("b.h5")), H5_CHANGED);
    data[i] ^= (char)(1 << (i % 8));
  }
  data[40] ^= 1; /* of the checksum itself */
  spill(scratch("b.h5"), data, size);
  assert_int_equal(h5_stamp_check(scratch("b.h5")), H5_CHANGED);
  data[40] ^= 1;
  spill(scratch("b.h5"), data, size - 1);
  assert_int_equal(h5_stamp_check(scratch("b.h5")), H5_SHORT);
  data[0] = 'S';
  spill(scratch("b.h5"), data, size);
  assert_int_equal(h5_stamp_check(scratch("b.h5")), H5_UNSTAMPED);
  assert_int_equal(h5_stamp_check(scratch("none.h5")), H5_UNREADABLE);
  free(data);
}

/* Any program that uses HDF5: plain calls of the library. */
static void other_programs_read_and_edit_it(void **state) {
  (void)state;
  double   value[3] = {0, 0, 0}, *read;
  h5_shape shape    = H5_SHAPE(3);
  write_sample("a.h5");
  hid_t file = H5Fopen(scratch("a.h5"), H5F_ACC_RDWR, H5P_DEFAULT);
  assert_true(file >= 0);
  hid_t set = H5Dopen2(file, "/x", H5P_DEFAULT);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  assert_memory_equal(value, reals, sizeof reals);
  value[1] = 7;
  assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  H5Dclose(set);
  H5Fclose(file);
  assert_int_equal(h5_stamp_check(scratch("a.h5")), H5_CHANGED);
  assert_ok(h5_open(scratch("a.h5"), &file)); /* with a warning */
  assert_ok(h5_read_double(file, "/x", &shape, &read));
  assert_true(read[1] == 7);
  free(read);
  assert_ok(h5_close(file));
}

/* A process that may open no further file. */
static void a_file_that_cannot_be_opened_is_not_taken_for_another(void **state) {
  (void)state;
  struct rlimit before, none;
  hid_t         file;
  write_sample("a.h5");
  assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
  none          = before;
  none.rlim_cur = 0;
  setrlimit(RLIMIT_NOFILE, &none);
  const h5_stamp_state found   = h5_stamp_check(scratch("a.h5"));
  const int            why     = errno;
  const shb_status     opened  = h5_open(scratch("a.h5"), &file);
  const shb_status     earlier = h5_check_earlier(scratch("a.h5"));
  setrlimit(RLIMIT_NOFILE, &before);
  assert_int_equal(found, H5_UNREADABLE);
  assert_int_equal(why, EMFILE);
  assert_refused(opened, SHB_ERR_IO, "a.h5: cannot be opened: Too many open files");
  assert_refused(earlier, SHB_ERR_IO, "a.h5: cannot be opened: Too many open files");
  assert_int_equal(h5_stamp_check(scratch("a.h5")), H5_INTACT);
}

static void earlier_results_are_tried(void **state) {
  (void)state;
  size_t size;
  write_sample("a.h5");
  assert_ok(h5_check_earlier(scratch("none.h5")));
  assert_ok(h5_check_earlier(scratch("a.h5")));
  char *data = slurp(scratch("a.h5"), &size);
  data[size / 2] ^= 16;
  spill(scratch("b.h5"), data, size);
  assert_refused(h5_check_earlier(scratch("b.h5")), SHB_ERR_IO,
                 "b.h5: is damaged, or was changed since it was written");
  data[size / 2] ^= 16;
  spill(scratch("b.h5"), data + H5_STAMP, size - H5_STAMP); /* of an earlier version */
  assert_ok(h5_check_earlier(scratch("b.h5")));
  free(data);
  spill(scratch("b.h5"), "text", 4);
  assert_refused(h5_check_earlier(scratch("b.h5")), SHB_ERR_IO, "is not an HDF5 file");
  assert_refused(h5_check_earlier(DAMAGED), SHB_ERR_IO, "heap.h5: is damaged");
}

/* HDF5 would crash over the format of the first file, which is refused before. It goes round for
 * ever over the second. Over the third, whose first text is longer than its heap, it crashes when
 * it gives its memory back. */
static void a_file_that_hdf5_cannot_bear_is_one_line(void **state) {
  (void)state;
  hid_t file;
  for (int again = 0; again < 2; again++)
    assert_refused(h5_open(DAMAGED, &file), SHB_ERR_INPUT,
                   "heap.h5: is damaged (bad heap free list); write or copy it again");
  assert_refused(h5_open(ENDLESS, &file), SHB_ERR_INPUT,
                 "endless.h5: is damaged: HDF5 reads it without an end; write or copy it again");
  assert_refused(h5_open(WRITTEN_OVER, &file), SHB_ERR_INPUT,
                 "written_over.h5: is damaged: HDF5 crashed while it was read");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_damaged_byte_is_found),
      cmocka_unit_test(other_programs_read_and_edit_it),
      cmocka_unit_test(a_file_that_cannot_be_opened_is_not_taken_for_another),
      cmocka_unit_test(earlier_results_are_tried),
      cmocka_unit_test(a_file_that_hdf5_cannot_bear_is_one_line),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
