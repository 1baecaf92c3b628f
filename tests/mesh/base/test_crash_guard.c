/* A crash under the guard ends a process with one line and code 2; after it, crashes are as
 * before. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "mesh/base/crash_guard.h"
#include "mesh/base/publish.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

static void segmentation_fault(void) {
  raise(SIGSEGV);
}

static void division(void) {
  raise(SIGFPE);
}

static void library_aborts(void) {
  fprintf(stderr, "Assertion `p != nullptr' failed.\n");
  abort();
}

/* The C library tells it, and aborts. */
static void heap_is_damaged(void) {
  char *volatile inside = (char *)malloc(64) + 8;
  fprintf(stderr, "spoken\n");
  free(inside);
}

static int deeper(volatile char *above) {
  volatile char here[4096];
  here[0] = above ? above[0] : 1;
  return here[0] == 0 ? 0 : deeper(here) + here[0]; /* never 0 */
}

static void stack_overflow(void) {
  exit(deeper(NULL));
}

static void crash_after_the_guard(void) {
  shb_guard_end();
  raise(SIGSEGV);
}

static void nothing(void) {
  shb_guard_end();
  fprintf(stderr, "spoken\n");
  _exit(7);
}

/* As of a library that cannot close a damaged file. */
static void crash_after_the_last_word(void) {
  fprintf(stderr, "spoken\n");
  shb_guard_told(4);
  raise(SIGSEGV);
}

/* The state of a child that does something under a guard, and what it printed. */
static int guarded(void (*act)(void), bool mute, char text[500]) {
  int ends[2], state = 0;
  assert_int_equal(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const struct rlimit no_core = {0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    for (int i = 1; i < 32; i++) signal(i, SIG_DFL); /* those of the test framework */
    dup2(ends[1], STDERR_FILENO);
    shb_guard_begin("a.msh", "is damaged", mute);
    act();
    _exit(99);
  }
  close(ends[1]);
  size_t n = 0;
  for (ssize_t got; (got = read(ends[0], text + n, 499 - n)) > 0;) n += (size_t)got;
  text[n] = '\0';
  close(ends[0]);
  assert_int_equal(waitpid(child, &state, 0), child);
  return state;
}

/* There is no guard then. */
static void skip_with_sanitizer(void) {
#ifdef __SANITIZE_ADDRESS__
  skip();
#endif
}

static void a_crash_is_one_line(void **state) {
  (void)state;
  skip_with_sanitizer();
  void (*const act[])(void) = {segmentation_fault, division, library_aborts, stack_overflow};
  for (size_t i = 0; i < sizeof act / sizeof *act; i++) {
    char      text[500];
    const int end = guarded(act[i], true, text);
    assert_true(WIFEXITED(end));
    assert_int_equal(WEXITSTATUS(end), SHB_ERR_INPUT);
    assert_string_equal(text, "shroudhb: error: a.msh: is damaged\n");
  }
}

static void the_program_may_speak_and_the_c_library_may_not(void **state) {
  (void)state;
  skip_with_sanitizer();
  char text[500];
  int  end = guarded(heap_is_damaged, false, text);
  assert_true(WIFEXITED(end));
  assert_int_equal(WEXITSTATUS(end), SHB_ERR_INPUT);
  assert_string_equal(text, "spoken\nshroudhb: error: a.msh: is damaged\n");
}

static void it_ends(void **state) {
  (void)state;
  skip_with_sanitizer();
  char text[500];
  int  end = guarded(crash_after_the_guard, true, text);
  assert_true(WIFSIGNALED(end) && WTERMSIG(end) == SIGSEGV);
  assert_string_equal(text, "");
  for (int mute = 0; mute < 2; mute++) {
    end = guarded(nothing, mute, text);
    assert_int_equal(WEXITSTATUS(end), 7);
    assert_string_equal(text, "spoken\n");
  }
}

static void crash_while_writing(void) {
  char *unpublished = shb_publish_temporary(scratch("result"));
  fclose(fopen(unpublished, "w"));
  fprintf(stderr, "%s\n", unpublished);
  free(unpublished);
  raise(SIGBUS);
}

static void temporary_files_are_removed(void **state) {
  (void)state;
  skip_with_sanitizer();
  char text[500];
  guarded(crash_while_writing, false, text);
  text[strcspn(text, "\n")] = '\0';
  assert_has(text, "result.tmp.");
  assert_int_not_equal(access(text, F_OK), 0);
}

static void a_crash_after_the_last_word_says_nothing(void **state) {
  (void)state;
  char text[500];
  skip_with_sanitizer();
  const int end = guarded(crash_after_the_last_word, false, text);
  assert_true(WIFEXITED(end));
  assert_int_equal(WEXITSTATUS(end), 4);
  assert_string_equal(text, "spoken\n");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_crash_is_one_line),
      cmocka_unit_test(the_program_may_speak_and_the_c_library_may_not),
      cmocka_unit_test(it_ends),
      cmocka_unit_test(temporary_files_are_removed),
      cmocka_unit_test(a_crash_after_the_last_word_says_nothing),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
