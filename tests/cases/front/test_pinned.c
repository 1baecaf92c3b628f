/* What the key table makes of three cases is pinned: the echo of `shroudhb check`, and the settings
 * by which a result file is recognised. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cases/front/run.h"
#include "cases/parse/yaml.h"
#include "cases/schema/case.h"
#include "cases/schema/stage_settings.h"
#include "tests/support/scratch.h"

enum { STAGES = CASE_MESH | CASE_MODAL | CASE_MHB | CASE_POST };

static const char source[] = TESTS_SOURCE "/cases/front/pinned";

/* The text of pinned/NAME. */
static char *text_of(const char *name, const char *suffix) {
  char   path[512], *text = NULL;
  size_t length = 0;
  snprintf(path, sizeof path, "%s/%s%s", source, name, suffix);
  if (case_text_read(path, &text, &length) != SHB_OK) fail_msg("%s", shb_message());
  return text;
}

/* Echo and settings of the case, malloc'ed. */
static char *tell(const char *name) {
  static const case_stage  stage[] = {CASE_MESH, CASE_MODAL,    CASE_MHB,
                                      CASE_POST, CASE_CONVERGE, CASE_INTEGRATE};
  static const char *const words[] = {"mesh", "modal", "mhb", "post", "converge", "integrate"};
  char                    *said = NULL, *text = text_of(name, ".yaml");
  size_t                   size = 0;
  case_file                file;
  scratch_write(".", "c.yaml", text, strlen(text));
  if (case_read("c.yaml", STAGES, stderr, &file) != SHB_OK) fail_msg("%s was refused", name);
  FILE *out = open_memstream(&said, &size);
  assert_non_null(out);
  run_describe(&file, out);
  for (size_t i = 0; i < sizeof stage / sizeof *stage; i++) {
    char *settings = case_settings(&file, stage[i]);
    fprintf(out, "\n%s\n%s", words[i], settings);
    free(settings);
  }
  fclose(out);
  case_free(&file);
  free(text);
  return said;
}

static void compare(const char *name) {
  char folder[SCRATCH_PATH], back[1024];
  scratch_create(folder);
  assert_non_null(getcwd(back, sizeof back));
  assert_int_equal(chdir(folder), 0);
  scratch_write(".", "blade.geo", "x", 1);
  char *found = tell(name), *wanted = text_of(name, ".txt");
  assert_int_equal(chdir(back), 0);
  scratch_remove(folder);
  if (strcmp(found, wanted) != 0) {
    printf("--- %s.txt\n%s---\n", name, found);
    fail_msg("%s is not as in %s.txt; what was found is above", name, name);
  }
  free(found);
  free(wanted);
}

static void one_of_each(void **state) {
  (void)state;
  compare("single");
}

/* A list of one is computed as the block is, and shown with its name. */
static void lists_of_one(void **state) {
  (void)state;
  compare("list_of_one");
}

static void several_interfaces(void **state) {
  (void)state;
  compare("interfaces");
}

static void several_materials_and_loads(void **state) {
  (void)state;
  compare("materials");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_of_each), cmocka_unit_test(lists_of_one),
                                     cmocka_unit_test(several_interfaces),
                                     cmocka_unit_test(several_materials_and_loads)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
