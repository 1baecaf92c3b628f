/* Another mesh size in the text of a case: two numbers change and the rest stays. */
#include "cases/converge/resized_case.h"
#include "cases/schema/case.h"
#include "cases/schema/stage_settings.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/scratch.h"

enum { STAGES = CASE_MESH | CASE_MODAL | CASE_MHB };

static char folder[SCRATCH_PATH], from[2 * SCRATCH_PATH], to[2 * SCRATCH_PATH];

static int start(void **state) {
  (void)state;
  scratch_create(folder);
  snprintf(from, sizeof from, "%s/from.yaml", folder);
  snprintf(to, sizeof to, "%s/to.yaml", folder);
  return 0;
}

static int clean(void **state) {
  (void)state;
  scratch_remove(folder);
  return 0;
}

static void read(const char *path, case_file *file) {
  if (case_read(path, STAGES, stderr, file) != SHB_OK) fail_msg("%s: %s", path, shb_message());
}

/* sizes: as in the text, m */
static void check(char *text, const double sizes[2], double factor) {
  case_file a, b;
  scratch_write(folder, "from.yaml", text, strlen(text));
  free(text);
  read(from, &a);
  assert_true(a.blade.size == sizes[0] && a.blade.shroud_size == sizes[1]);
  if (case_resize_mesh(&a, factor, to) != SHB_OK) fail_msg("%s", shb_message());
  read(to, &b);
  assert_true(fabs(b.blade.size / sizes[0] - factor) < 1e-8);
  assert_true(fabs(b.blade.shroud_size - factor * sizes[1]) < 1e-8 * sizes[0]);
  b.blade.size        = a.blade.size;
  b.blade.shroud_size = a.blade.shroud_size;
  char *one = case_settings(&a, (case_stage)STAGES), *other = case_settings(&b, (case_stage)STAGES);
  assert_string_equal(one, other);
  free(one);
  free(other);
  case_free(&a);
  case_free(&b);
}

static void sizes_are_replaced(void **state) {
  (void)state;
  const double both[2] = {.008, .004}, one[2] = {.008, 0};
  check(scratch_case(NULL, NULL), both, 1.26);
  check(scratch_case("    shroud_size: 4 mm\n", ""), one, .8);
  check(scratch_case("size: 8 mm\n    shroud_size: 4 mm\n",
                     "shroud_size: 0.4 cm # fine \xc2\xb5\n    size: 8e-3\n"),
        both, 1.6);
  check(scratch_case("size: 8 mm\n    shroud_size: 4 mm\n",
                     "shroud_size: '4 mm'\n    size: \"8 mm\"   # all\n"),
        both, 1.6);
  check(scratch_case("    root: {length: 61 mm,",
                     "    root: {length: 61 mm, # \xc3\xa4\xc3\xb6\n          "),
        both, 1);
}

static void what_cannot_be_replaced_is_told(void **state) {
  (void)state;
  case_file a;
  char     *text = scratch_case("size: 8 mm", "size: \"8\\x20mm\"");
  scratch_write(folder, "from.yaml", text, strlen(text));
  free(text);
  read(from, &a);
  assert_int_equal(case_resize_mesh(&a, 2, to), SHB_ERR_INPUT);
  assert_non_null(strstr(shb_message(), "from.yaml:9:11: the element size cannot be replaced"));
  assert_int_equal(case_resize_mesh(&a, 2, "/no/such/folder/x.yaml") == SHB_OK, 0);
  case_free(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sizes_are_replaced),
                                     cmocka_unit_test(what_cannot_be_replaced_is_told)};
  return cmocka_run_group_tests(tests, start, clean);
}
