/* The table of commands is whole, and its help says all that it knows. */
#include "cases/options/command_table.h"
#include "cases/options/help.h"
#include "tests/support/check.h"

static char *help_of(const command_row *row) {
  char  *text = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&text, &size);
  assert_non_null(out);
  if (row)
    help_print(row, out);
  else
    help_print_all(out);
  fclose(out);
  return text;
}

static void every_command_is_found_by_its_name(void **state) {
  (void)state;
  char name[64];
  for (int i = 0; i < COMMANDS; i++) {
    const command_row *row = command_row_of((command_id)i);
    assert_non_null(row->name);
    assert_int_equal(command_find(row->name), i);
    snprintf(name, sizeof name, "/usr/bin/shroudhb-%s", row->name);
    assert_int_equal(command_called(name), i);
  }
  assert_int_equal(command_called("/usr/bin/shroudhb"), COMMANDS);
  assert_int_equal(command_called("shroudhb-pool"), COMMANDS);
  assert_int_equal(command_find("chek"), COMMANDS);
  assert_string_equal(command_nearest("chek"), "check");
  assert_null(command_nearest("frobnicate"));
  assert_null(command_nearest("sampel")); /* it is not shown */
}

static void every_shown_command_and_option_is_in_the_help(void **state) {
  (void)state;
  char *all     = help_of(NULL), start[64];
  int   options = 0;
  for (int i = 0; i < COMMANDS; i++) {
    const command_row *row = command_row_of((command_id)i);
    snprintf(start, sizeof start, "\n  %s ", row->name);
    if (row->brief) assert_has(all, start);
    if (!row->brief) assert_has_not(all, start);
    char *own = help_of(row);
    snprintf(start, sizeof start, "usage: shroudhb %s ", row->name);
    assert_true(strncmp(own, start, strlen(start)) == 0);
    for (const command_option *o = row->option; o->word; o++, options++) {
      snprintf(start, sizeof start, "\n  %s ", o->word);
      if (o->text) assert_has(own, start);
      if (!o->text) assert_has_not(own, start);
      assert_true(!o->argument || o->needs);
    }
    for (const char *line = own; (line = strchr(line, '\n')) != NULL;) {
      const size_t length = strcspn(++line, "\n");
      assert_true(length <= 110);
    }
    free(own);
  }
  printf("%d commands, %d options\n", COMMANDS, options);
  free(all);
}

static void help_is_answered_before_the_end_of_the_options(void **state) {
  (void)state;
  char *none[] = {"mhb", "--quiet", "--", "--help", NULL};
  assert_true(help_answer(command_row_of(COMMAND_MHB), 4, none) < 0);
  char *asked[] = {"mhb", "case.yaml", "--version", NULL};
  assert_int_equal(help_answer(command_row_of(COMMAND_MHB), 3, asked), SHB_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_command_is_found_by_its_name),
      cmocka_unit_test(every_shown_command_and_option_is_in_the_help),
      cmocka_unit_test(help_is_answered_before_the_end_of_the_options)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
