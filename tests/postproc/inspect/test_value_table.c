#include <stdlib.h>

#include "modal/hdf5/h5.h"
#include "postproc/inspect/value_table.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

enum { POINTS = 6 };

static void write_file(void) {
  hid_t                 file;
  const double          frequency[POINTS] = {90.5, 91, 92.125, 93, 1.0 / 3, 95};
  const int             special[POINTS]   = {0, 1, 2, 0, 2, 0};
  const char *const     names[2]          = {"tip", "a,b \"c\""};
  double complex        motion[POINTS][2][3];
  static const h5_shape wave = {3, {POINTS, 2, 3}};
  for (int i = 0; i < POINTS; i++)
    for (int p = 0; p < 2; p++)
      for (int k = 0; k < 3; k++) motion[i][p][k] = 100 * i + 10 * p + k + I * (i + 0.5);
  assert_ok(h5_create(scratch("x.h5"), &file));
  assert_ok(h5_write_double(file, "/b/frequency", H5_SHAPE(POINTS), frequency, "Hz", "f"));
  assert_ok(h5_write_double(file, "/b/error/modal", H5_SHAPE(POINTS), frequency, "-", "e"));
  assert_ok(h5_write_int(file, "/b/special", H5_SHAPE(POINTS), special, "-", "s"));
  assert_ok(h5_write_complex(file, "/b/motion", wave, **motion, "m", "x"));
  assert_ok(h5_write_strings(file, "/name", 2, names, "names"));
  assert_ok(h5_close(file));
}

static void assert_table(const char *place, bool csv, const char *wanted) {
  post_buffer out = {0};
  assert_ok(post_value_table(scratch("x.h5"), place, csv, &out));
  assert_string_equal(out.text, wanted);
  post_buffer_free(&out);
}

static void a_selection_gives_its_rows_and_columns(void **state) {
  (void)state;
  assert_table("b/frequency[1:3]", true, "index,frequency in Hz\n1,91\n2,92.125\n");
  assert_table("/b/frequency[-2]", true, "index,frequency in Hz\n4,0.3333333333333333\n");
  assert_table("b/motion[peak, 1, -1]", true,
               "index,\"motion[1,2].re in m\",\"motion[1,2].im in m\"\n2,212,2.5\n4,412,4.5\n");
  assert_table("b/motion[fold,:,0]", true,
               "index,\"motion[0,0].re in m\",\"motion[0,0].im in m\",\"motion[1,0].re in "
               "m\",\"motion[1,0].im in m\"\n1,100,1.5,110,1.5\n");
  assert_table("name", true, "index,name\n0,tip\n1,\"a,b \"\"c\"\"\"\n");
}

static void a_group_gives_one_number_a_point(void **state) {
  (void)state;
  assert_table("b[5]", true, "index,frequency in Hz,error/modal,special\n5,95,95,0\n");
  assert_table("b[2]", false,
               "  index  frequency in Hz      error/modal          special\n"
               "      2           92.125           92.125                2\n");
}

static void assert_error(const char *place, const char *text) {
  post_buffer out = {0};
  assert_refused(post_value_table(scratch("x.h5"), place, false, &out), SHB_ERR_INPUT, text);
  assert_null(out.text);
}

static void each_wrong_place_is_told(void **state) {
  (void)state;
  assert_error("b/phase", "holds no such object");
  assert_error("b/frequency[6]", "'6' is outside of dimension 1, which has the indices 0 to 5");
  assert_error("b/frequency[3:3]", "outside of dimension 1");
  assert_error("b/frequency[one]", "'one' is no selection");
  assert_error("b/frequency[1,2]", "2 selections for 1 dimension");
  assert_error("b/motion[0", "written PATH[first, second, ...]");
  assert_error("name[peak]", "no dataset 'special' beside it");
  assert_error("b[peak,0]", "a group takes one selection");
  assert_error("b/error", "a group without the dataset frequency");
}

static int setup(void **state) {
  if (scratch_make(state)) return 1;
  write_file();
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_selection_gives_its_rows_and_columns),
                                     cmocka_unit_test(a_group_gives_one_number_a_point),
                                     cmocka_unit_test(each_wrong_place_is_told)};
  return cmocka_run_group_tests(tests, setup, scratch_remove);
}
