/* Notes and phases on stderr, and signals. */
#include "mesh/base/progress.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/check.h"

/* What body writes to stderr. */
static void capture(void (*body)(void), char text[512]) {
  int ends[2], saved;
  fflush(stderr);
  assert_int_equal(pipe(ends), 0);
  saved = dup(STDERR_FILENO);
  dup2(ends[1], STDERR_FILENO);
  body();
  fflush(stderr);
  dup2(saved, STDERR_FILENO);
  close(saved);
  close(ends[1]);
  ssize_t n = read(ends[0], text, 511);
  close(ends[0]);
  text[n > 0 ? n : 0] = 0;
}

static void speak_verbosely(void) {
  shb_progress progress = shb_progress_start("mesh", false, true);
  shb_progress_show(&progress, 42, "not a terminal: no line");
  shb_progress_note(&progress, "%d elements", 7);
  shb_progress_phase(&progress, "solid", "three parts");
  shb_progress_phase(&progress, "solid", "again");
  assert_int_equal(progress.phases.n, 1);
  shb_progress_clear(&progress);
}

static void speak_quietly(void) {
  shb_progress progress = shb_progress_start("mesh", true, true);
  shb_progress_note(&progress, "nothing");
  shb_progress_show(&progress, -1, "nothing");
  shb_progress_show(NULL, 1, "nothing");
  shb_progress_phase(NULL, "none", "nothing");
}

static void notes_are_for_verbose_runs(void **state) {
  (void)state;
  char text[512];
  capture(speak_verbosely, text);
  assert_has(text, "mesh: 7 elements\n");
  assert_has(text, "mesh: solid: three parts: ");
  assert_has_not(text, "no line");
  capture(speak_quietly, text);
  assert_string_equal(text, "");
}

/* Exit code of a child that catches signals and sends itself one or two SIGTERM. */
static int child(int signals) {
  pid_t pid = fork();
  if (pid == 0) {
    close(STDERR_FILENO);
    shb_interrupt_catch();
    for (int i = 0; i < signals; i++) raise(SIGTERM);
    _exit(shb_interrupted() ? 3 : 4);
  }
  int status = 0;
  assert_int_equal(waitpid(pid, &status, 0), pid);
  assert_true(WIFEXITED(status));
  return WEXITSTATUS(status);
}

static void the_second_signal_ends_the_process(void **state) {
  (void)state;
  assert_int_equal(child(0), 4);
  assert_int_equal(child(1), 3);
  assert_int_equal(child(2), 128 + SIGTERM);
}

static void clocks_go_forward(void **state) {
  (void)state;
  const double start = shb_seconds(), processor = shb_processor_seconds();
  volatile int work = 0;
  while (shb_processor_seconds() < processor + 1e-3) work++;
  assert_true(shb_seconds() - start > 0.5e-3 && work > 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(notes_are_for_verbose_runs),
                                     cmocka_unit_test(the_second_signal_ends_the_process),
                                     cmocka_unit_test(clocks_go_forward)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
