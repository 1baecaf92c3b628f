/* The table of phases: seconds add up, memory is the largest, ranks add a column. */
#include "postproc/inspect/phase_table.h"

#include "modal/hdf5/h5.h"
#include "tests/support/check.h"

static char path[64];

static void write(int ranks, int rows) {
  const char *const name[3]    = {"mesh", "factor", "modes"};
  const double      seconds[3] = {0.25, 1.5, 2.25}, cpu[3] = {0.5, 3, 4.5};
  const double      memory[3] = {10e6, 90e6, 70e6}, greatest[3] = {6e6, 50e6, 40e6};
  hid_t             file;
  strcpy(path, "/tmp/shroudhb-phases-XXXXXX");
  assert_true(mkstemp(path) >= 0);
  assert_ok(h5_create(path, &file));
  if (rows > 0) {
    const h5_shape shape = H5_SHAPE((hsize_t)rows);
    assert_ok(h5_write_strings(file, "phases/name", 3, name, "phase"));
    assert_ok(h5_write_double(file, "phases/seconds", shape, seconds, "s", "time"));
    assert_ok(h5_write_double(file, "phases/cpu", shape, cpu, "s", "processor time"));
    assert_ok(h5_write_double(file, "phases/memory", shape, memory, "B", "memory"));
    assert_ok(h5_write_double(file, "phases/greatest_memory", shape, greatest, "B", "of a rank"));
    assert_ok(h5_write_attribute_int(file, "/phases", "ranks", ranks));
  }
  assert_ok(h5_close(file));
}

static shb_status read_table(post_buffer *out) {
  hid_t file;
  assert_ok(h5_open(path, &file));
  shb_status status = post_phase_table(file, out);
  assert_ok(h5_close(file));
  remove(path);
  return status;
}

static void columns_are_summed(void **state) {
  (void)state;
  post_buffer out = {0};
  write(1, 3);
  assert_ok(read_table(&out));
  assert_string_equal(out.text,
                      "  phase                   s    CPU s  peak MB\n"
                      "  mesh                 0.25     0.50       10\n"
                      "  factor               1.50     3.00       90\n"
                      "  modes                2.25     4.50       70\n"
                      "  all                  4.00     8.00       90\n");
  post_buffer_free(&out);
}

static void ranks_have_a_column(void **state) {
  (void)state;
  post_buffer out = {0};
  write(4, 3);
  assert_ok(read_table(&out));
  assert_has(out.text, "   a rank  (4 ranks)\n");
  assert_has(out.text, "  all                  4.00     8.00       90       50\n");
  post_buffer_free(&out);
}

static void absent_phases_are_no_table(void **state) {
  (void)state;
  post_buffer out = {0};
  write(1, 0);
  assert_ok(read_table(&out));
  assert_null(out.text);
}

static void unequal_columns_are_refused(void **state) {
  (void)state;
  post_buffer out = {0};
  write(1, 2);
  assert_int_equal(read_table(&out), SHB_ERR_INPUT);
  assert_has(shb_message(), "/phases/seconds has shape [2] where [3] is wanted");
  post_buffer_free(&out);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(columns_are_summed), cmocka_unit_test(ranks_have_a_column),
      cmocka_unit_test(absent_phases_are_no_table), cmocka_unit_test(unequal_columns_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
