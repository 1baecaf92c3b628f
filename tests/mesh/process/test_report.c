/* Messages reach the program that asked, as data. */
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"
#include "mesh/process/child.h"
#include "mesh/process/report.h"
#include "tests/support/check.h"

/* A fork that tells errors into a place, and what came. */
static char *told_by(void (*tell)(void)) {
  const int report = shb_report_open();
  char      number[16];
  assert_true(report > 2);
  fflush(NULL);
  const pid_t child = fork();
  if (child == 0) {
    snprintf(number, sizeof number, "%d", report);
    setenv(SHB_REPORT, number, 1);
    shb_report_join();
    freopen("/dev/null", "w", stderr);
    tell();
    _exit(0);
  }
  assert_int_equal(waitpid(child, NULL, 0), child);
  char *text = shb_report_read(report);
  close(report);
  return text;
}

static void tell_two(void) {
  shb_error("%s: is %d mm", "blade.msh", 7);
  shb_report("case.yaml:3:9: error: mu: above 10\n    mu: 11\n");
}

static void every_message_is_a_line(void **state) {
  (void)state;
  char *text = told_by(tell_two);
  assert_string_equal(text, "blade.msh: is 7 mm\ncase.yaml:3:9: error: mu: above 10\n");
  free(text);
}

static void end_at_once(void) {
  shb_end_at_once("shroudhb: error: a.h5: is damaged\n", 2);
}

static void the_end_at_once_reports_too(void **state) {
  (void)state;
  char *text = told_by(end_at_once);
  assert_string_equal(text, "a.h5: is damaged\n");
  free(text);
}

static void tell_much(void) {
  char long_text[9000];
  memset(long_text, 'x', sizeof long_text - 1);
  long_text[sizeof long_text - 1] = '\0';
  shb_report(long_text);
  shb_report("short");
}

static void a_long_message_is_cut_and_the_next_one_is_whole(void **state) {
  (void)state;
  char *text = told_by(tell_much);
  assert_true(strlen(text) < 5000);
  assert_string_equal(text + strlen(text) - strlen("x\nshort\n"), "x\nshort\n");
  free(text);
}

static void the_grandchildren_report_to_the_same_place(void **state) {
  (void)state;
  char *const   words[] = {"/bin/sh", "-c",
                           "eval \"echo first >&$" SHB_REPORT
                           "\"; "
                             "sh -c 'eval \"echo second >&$" SHB_REPORT "\"'",
                           NULL};
  shb_child     child   = shb_child_of(words);
  shb_child_end end;
  child.report = shb_report_open();
  assert_ok(shb_child_run(&child, &end));
  char *text = shb_report_read(child.report);
  assert_string_equal(text, "first\nsecond\n");
  free(text);
  close(child.report);
}

static void without_a_place_nothing_is_reported(void **state) {
  (void)state;
  unsetenv(SHB_REPORT);
  shb_report("nobody asked");
  setenv(SHB_REPORT, "1", 1); /* standard output is no such place */
  shb_report("neither here");
  unsetenv(SHB_REPORT);
  char *text = shb_report_read(-1);
  assert_string_equal(text, "");
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_message_is_a_line), cmocka_unit_test(the_end_at_once_reports_too),
      cmocka_unit_test(a_long_message_is_cut_and_the_next_one_is_whole),
      cmocka_unit_test(the_grandchildren_report_to_the_same_place),
      cmocka_unit_test(without_a_place_nothing_is_reported)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
