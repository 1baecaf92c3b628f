/* What a child did, and how it ended, in one line. */
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "mesh/process/child.h"
#include "mesh/process/report.h"
#include "tests/support/check.h"

/* Runs the words of a shell. */
static shb_status run(const char *command, int out, shb_child_end *end) {
  char *const words[] = {"/bin/sh", "-c", (char *)command, NULL};
  shb_child   child   = shb_child_of(words);
  child.out           = out;
  return shb_child_run(&child, end);
}

static void an_exit_code_and_the_cost_are_told(void **state) {
  (void)state;
  shb_child_end end;
  assert_ok(run("i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); done; exit 7", -1, &end));
  printf("code %d, %.3f s of the clock, %.3f s of the processor, %.1f MB\n", end.code, end.seconds,
         end.cpu, end.peak / 1e6);
  assert_int_equal(end.code, 7);
  assert_int_equal(end.signal, 0);
  assert_true(end.cpu > 0 && end.cpu < 10 && end.seconds > 0 && end.peak > 1e5);
}

static void a_signal_is_one_line(void **state) {
  (void)state;
  shb_child_end end;
  assert_refused(run("kill -SEGV $$", -1, &end), SHB_ERR_IO,
                 "sh was killed by signal 11 (Segmentation fault)");
  assert_int_equal(end.signal, SIGSEGV);
  assert_refused(run("kill -KILL $$", -1, &end), SHB_ERR_IO,
                 "sh was killed by signal 9 (Killed); out of memory?");
  assert_ok(run("kill -PIPE $$", -1, &end)); /* the reader has closed the output */
  assert_int_equal(end.code, SHB_OK);
}

static void a_program_that_is_missing_is_named(void **state) {
  (void)state;
  char *const   words[] = {"/nowhere/shroudhb-none", NULL};
  shb_child     child   = shb_child_of(words);
  shb_child_end end;
  assert_refused(shb_child_run(&child, &end), SHB_ERR_IO,
                 "shroudhb-none: cannot be started: No such file or directory");
  child.name = "the stage";
  assert_refused(shb_child_run(&child, &end), SHB_ERR_IO, "the stage: cannot be started");
}

/* What a shell with some variables of mpiexec prints of its environment. */
static void environment_of(bool apart, char text[200]) {
  char *const   words[] = {"/bin/sh", "-c", "echo \"$PMIX_RANK,$OMPI_ALLOW_RUN,$OTHER\"", NULL};
  int           ends[2];
  shb_child_end end;
  shb_child     child = shb_child_of(words);
  assert_int_equal(pipe(ends), 0);
  child.out   = ends[1];
  child.apart = apart;
  assert_ok(shb_child_run(&child, &end));
  close(ends[1]);
  const ssize_t n     = read(ends[0], text, 199);
  text[n > 0 ? n : 0] = '\0';
  close(ends[0]);
}

static void a_child_apart_is_no_rank(void **state) {
  (void)state;
  char text[200];
  setenv("PMIX_RANK", "3", 1);
  setenv("OMPI_ALLOW_RUN", "1", 1);
  setenv("OTHER", "kept", 1);
  environment_of(false, text);
  assert_string_equal(text, "3,1,kept\n");
  environment_of(true, text);
  assert_string_equal(text, ",1,kept\n");
}

static int crash(void *unused) {
  (void)unused;
  fputs("not to be seen\n", stderr);
  signal(SIGABRT, SIG_DFL);
  abort();
}

static int work_without_end(void *unused) {
  (void)unused;
  for (volatile double x = 0; x >= 0; x += 1) continue;
  return 0;
}

static int give_back(void *number) {
  return *(int *)number;
}

static void a_function_that_crashes_leaves_this_process(void **state) {
  (void)state;
  int           number = 41;
  shb_child_end end;
  assert_ok(shb_child_try(give_back, &number, 5, &end));
  assert_int_equal(end.code, 41);
  assert_ok(shb_child_try(crash, NULL, 5, &end));
  assert_int_equal(end.signal, SIGABRT);
}

static void a_function_without_end_is_ended(void **state) {
  (void)state;
  shb_child_end end;
  assert_ok(shb_child_try(work_without_end, NULL, 1, &end));
  printf("ended by signal %d after %.2f s of the processor\n", end.signal, end.cpu);
  assert_int_equal(end.signal, SIGXCPU);
}

static void a_text_is_a_file_of_children(void **state) {
  (void)state;
  char          path[SHB_CHILD_TEXT], command[100];
  int           copy;
  shb_child_end end;
  assert_ok(shb_child_text("contact: {mu: 0.29}\n", &copy, path));
  snprintf(command, sizeof command, "[ \"$(cat %s)\" = 'contact: {mu: 0.29}' ]", path);
  assert_ok(run(command, -1, &end));
  assert_int_equal(end.code, 0);
  close(copy);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(an_exit_code_and_the_cost_are_told),
                                     cmocka_unit_test(a_signal_is_one_line),
                                     cmocka_unit_test(a_program_that_is_missing_is_named),
                                     cmocka_unit_test(a_child_apart_is_no_rank),
                                     cmocka_unit_test(a_function_that_crashes_leaves_this_process),
                                     cmocka_unit_test(a_function_without_end_is_ended),
                                     cmocka_unit_test(a_text_is_a_file_of_children)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
