/* A result made from the same settings is kept; a damaged one is told and replaced. */
#include "cases/commands/up_to_date.h"
#include "tests/support/files.h"

static void write_result(void) {
  const shb_provenance from = {"case.yaml", "name: x\n", "a = 1\n", "test"};
  hid_t                file;
  assert_ok(h5_create(scratch("x.h5"), &file));
  assert_ok(h5_write_provenance(file, "shroudhb test", 1, &from));
  assert_ok(h5_close(file));
}

static void a_damaged_result_is_not_up_to_date(void **state) {
  (void)state;
  size_t size;
  assert_false(up_to_date_with(scratch("x.h5"), "a = 1\n"));
  write_result();
  assert_true(up_to_date_with(scratch("x.h5"), "a = 1\n"));
  assert_false(up_to_date_with(scratch("x.h5"), "a = 2\n"));
  char *data = slurp(scratch("x.h5"), &size);
  data[size - 1] ^= 1; /* beyond the settings */
  spill(scratch("x.h5"), data, size);
  free(data);
  const int kept = dup(STDERR_FILENO);
  assert_non_null(freopen(scratch("said"), "w", stderr));
  const bool same = up_to_date_with(scratch("x.h5"), "a = 1\n");
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  assert_false(same);
  data       = slurp(scratch("said"), &size);
  data[size] = '\0';
  assert_has(data, "shroudhb: warning: ");
  assert_has(data, "x.h5: is damaged, or was changed since it was written; it is replaced\n");
  free(data);
  write_result();
  assert_true(up_to_date_with(scratch("x.h5"), "a = 1\n"));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_damaged_result_is_not_up_to_date)};
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
