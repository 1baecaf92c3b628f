/* Arrays are there, or the process ends: one line, exit code 4, no temporary file of its own. */
#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/arena.h"
#include "mesh/base/crash_guard.h"
#include "mesh/base/memory.h"
#include "mesh/base/publish.h"
#include "tests/support/check.h"
#include "tests/support/scratch_folder.h"

/* A sanitizer ends the process itself where more is wanted than there can be. */
#ifdef __SANITIZE_ADDRESS__
enum { WITH_MALLOC = 0 };
#else
enum { WITH_MALLOC = 1 };
#endif

static void arrays_are_there(void **state) {
  (void)state;
  const size_t count[] = {0, 1, 7, 1000};
  for (int i = 0; i < 4; i++) {
    double *array = shb_alloc(count[i], sizeof *array);
    double *zero  = shb_alloc_zeroed(count[i], sizeof *zero),
           *lined = shb_alloc_aligned(64, count[i], 8);
    assert_non_null(array);
    assert_int_equal((uintptr_t)lined % 64, 0);
    for (size_t k = 0; k < count[i]; k++) {
      assert_true(zero[k] == 0);
      array[k] = lined[k] = (double)k;
    }
    array = shb_realloc(array, 2 * count[i], sizeof *array);
    for (size_t k = 0; k < count[i]; k++) assert_true(array[k] == (double)k);
    free(array);
    free(zero);
    free(lined);
  }
  int *grown = shb_realloc(NULL, 3, sizeof *grown);
  grown      = shb_realloc(grown, 0, sizeof *grown);
  assert_non_null(grown);
  free(grown);
}

static void texts_are_copies(void **state) {
  (void)state;
  const char text[] = "two words";
  char *all = shb_text(text), *start = shb_text_start(text, 3), *more = shb_text_start(text, 99);
  char *made = shb_text_of("%s, %d", text, 42), *none = shb_text_of("%s", "");
  assert_string_equal(all, text);
  assert_string_equal(start, "two");
  assert_string_equal(more, text);
  assert_string_equal(made, "two words, 42");
  assert_string_equal(none, "");
  free(all);
  free(start);
  free(more);
  free(made);
  free(none);
}

/* ---- the end ---- */

static volatile size_t count, size;

static void take(void) {
  free(shb_alloc(count, size));
}

static void take_zeroed(void) {
  free(shb_alloc_zeroed(count, size));
}

static void take_aligned(void) {
  free(shb_alloc_aligned(64, count, size));
}

static void grow(void) {
  free(shb_realloc(shb_alloc(2, 8), count, size));
}

static void take_from_arena(void) {
  shb_arena arena = {0};
  shb_arena_take(&arena, count, size);
}

static void take_under_a_guard(void) {
  shb_guard_begin("a.msh", "is damaged", true);
  take();
}

static pthread_barrier_t barrier;

static void *take_in_thread(void *unused) {
  pthread_barrier_wait(&barrier);
  take();
  return unused;
}

static void take_in_threads(void) {
  enum { THREADS = 8 };
  pthread_t thread[THREADS];
  pthread_barrier_init(&barrier, NULL, THREADS);
  for (int i = 0; i < THREADS; i++) pthread_create(&thread[i], NULL, take_in_thread, NULL);
  for (int i = 0; i < THREADS; i++) pthread_join(thread[i], NULL);
}

static int n_files(const char *folder) {
  int  n    = 0;
  DIR *list = opendir(folder);
  assert_non_null(list);
  while (readdir(list)) n++;
  closedir(list);
  return n - 2; /* itself and the one above */
}

/* A child with a temporary file of its own does something; its exit code, and what it printed. */
static int end_of(void (*act)(void), char text[500]) {
  int         ends[2], state = 0;
  const char *path = scratch("result");
  assert_int_equal(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    for (int i = 1; i < 32; i++) signal(i, SIG_DFL); /* those of the test framework */
    dup2(ends[1], STDERR_FILENO);
    close(open(shb_publish_temporary(path), O_CREAT | O_WRONLY, 0600));
    act();
    _exit(99);
  }
  close(ends[1]);
  size_t n = 0;
  for (ssize_t got; (got = read(ends[0], text + n, 499 - n)) > 0;) n += (size_t)got;
  text[n] = '\0';
  close(ends[0]);
  assert_int_equal(waitpid(child, &state, 0), child);
  assert_true(WIFEXITED(state));
  return WEXITSTATUS(state);
}

static void assert_ends(void (*act)(void), const char *block) {
  char text[500], line[500];
  snprintf(line, sizeof line,
           "shroudhb: error: out of memory: a block of %s MB cannot be had; fewer nodes, "
           "harmonics, points or threads need less\n",
           block);
  assert_int_equal(end_of(act, text), SHB_ERR_IO);
  assert_string_equal(text, line);
  assert_int_equal(n_files(scratch_folder), 0);
}

static void (*const every[])(void) = {take, take_zeroed, take_aligned, grow, take_from_arena};

static void a_product_beyond_size_t_ends_it(void **state) {
  (void)state;
  count = SIZE_MAX / 4, size = 16;
  for (size_t i = 0; i < sizeof every / sizeof *every; i++) assert_ends(every[i], "7.38e+13");
}

static void more_than_there_is_ends_it(void **state) {
  (void)state;
  if (!WITH_MALLOC) skip();
  count = (size_t)1 << 60, size = 2; /* beyond the addresses of the machine */
  for (size_t i = 0; i < sizeof every / sizeof *every; i++) assert_ends(every[i], "2.31e+12");
}

static void threads_end_it_once(void **state) {
  (void)state;
  count = SIZE_MAX / 4, size = 16;
  for (int i = 0; i < 5; i++) assert_ends(take_in_threads, "7.38e+13");
}

static void a_muted_program_says_it_too(void **state) {
  (void)state;
  count = SIZE_MAX / 4, size = 16;
  assert_ends(take_under_a_guard, "7.38e+13");
}

static void a_child_keeps_the_files_of_its_parent(void **state) {
  (void)state;
  char  text[500];
  char *own = shb_publish_temporary(scratch("parent"));
  close(open(own, O_CREAT | O_WRONLY, 0600));
  count = SIZE_MAX / 4, size = 16;
  assert_int_equal(end_of(take, text), SHB_ERR_IO);
  assert_int_equal(access(own, F_OK), 0);
  unlink(own);
  free(own);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arrays_are_there),
      cmocka_unit_test(texts_are_copies),
      cmocka_unit_test(a_product_beyond_size_t_ends_it),
      cmocka_unit_test(more_than_there_is_ends_it),
      cmocka_unit_test(threads_end_it_once),
      cmocka_unit_test(a_muted_program_says_it_too),
      cmocka_unit_test(a_child_keeps_the_files_of_its_parent),
  };
  return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
