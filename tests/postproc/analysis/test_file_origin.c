/* Origin of a result file: what was written is read, what is absent reads as "". */
#include "postproc/analysis/file_origin.h"

#include "modal/hdf5/h5.h"
#include "tests/support/check.h"

static char path[64];

static hid_t create(void) {
  hid_t file;
  strcpy(path, "/tmp/shroudhb-origin-XXXXXX");
  assert_true(mkstemp(path) >= 0);
  assert_ok(h5_create(path, &file));
  return file;
}

static void attributes_are_read(void **state) {
  (void)state;
  const shb_provenance written = {"cases/x.yaml", "name: x\n", "contact.mu = 0.3\n",
                                  "shroudhb-mhb"};
  post_origin          origin;
  hid_t                file = create();
  assert_ok(h5_write_provenance(file, "shroudhb response", 1, &written));
  assert_ok(h5_close(file));
  assert_ok(post_origin_open(path, &origin));
  assert_string_equal(origin.format, "shroudhb response");
  assert_string_equal(origin.revision, shb_revision());
  assert_string_equal(origin.command, written.command);
  assert_string_equal(origin.case_path, written.case_path);
  assert_string_equal(origin.case_text, written.case_text);
  assert_string_equal(origin.settings, written.settings);
  assert_int_equal(strlen(origin.created), strlen("2026-01-02T03:04:05Z"));
  assert_int_equal(origin.version, 1);
  post_origin_free(&origin);
  remove(path);
}

static void absent_attributes_are_empty(void **state) {
  (void)state;
  const double value = 1;
  post_origin  origin;
  hid_t        file = create();
  assert_ok(h5_write_double(file, "x", H5_SHAPE(1), &value, "-", "a number"));
  assert_ok(h5_close(file));
  assert_ok(post_origin_open(path, &origin));
  assert_string_equal(origin.format, "");
  assert_string_equal(origin.case_text, "");
  assert_int_equal(origin.version, 0);
  post_origin_free(&origin);
  remove(path);
  assert_int_equal(post_origin_open(path, &origin), SHB_ERR_IO);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(attributes_are_read),
                                     cmocka_unit_test(absent_attributes_are_empty)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
