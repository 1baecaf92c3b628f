/* Memory that asks for large pages: where it begins, and what the system notes of it. */
#include "fem/supernodal/large_pages.h"

#include <stdbool.h>

#include "tests/support/check.h"

/* Does the map of this process name a flag of the pages at an address? -1: it does not tell. */
static int has_flag(const void *memory, const char *flag) {
  FILE *file = fopen("/proc/self/smaps", "r");
  char  line[512];
  bool  here = false;
  int   has  = -1;
  while (file && has < 0 && fgets(line, sizeof line, file)) {
    uintptr_t begin, end;
    if (sscanf(line, "%lx-%lx", &begin, &end) == 2)
      here = begin <= (uintptr_t)memory && (uintptr_t)memory < end;
    if (here && strncmp(line, "VmFlags:", 8) == 0) has = strstr(line, flag) != NULL;
  }
  if (file) fclose(file);
  return has;
}

static void memory_begins_at_a_cache_line(void **state) {
  (void)state;
  const size_t sizes[] = {0, 1, 63, 64, 65, 1000003, 3 * FEM_LARGE_PAGE + 5};
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    char *memory = fem_large_alloc(sizes[i], 1);
    assert_non_null(memory);
    assert_int_equal((uintptr_t)memory % 64, 0);
    memset(memory, 7, sizes[i]);
    for (size_t k = 0; k < sizes[i]; k += 4093) assert_int_equal(memory[k], 7);
    free(memory);
  }
}

static void no_memory_is_left_alone(void **state) {
  (void)state;
  fem_prefer_large_pages(NULL, 0);
  fem_prefer_large_pages(NULL, 3 * (size_t)FEM_LARGE_PAGE);
}

/* Whole large pages are asked for, and no byte beyond the memory. */
static void whole_pages_are_asked_for(void **state) {
  (void)state;
  const size_t page = FEM_LARGE_PAGE;
  char *memory = mmap(NULL, 4 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  assert_ptr_not_equal(memory, MAP_FAILED);
  if (has_flag(memory, " rd") != 1 || madvise(memory, 4 * page, MADV_NOHUGEPAGE) != 0) {
    munmap(memory, 4 * page);
    skip(); /* no large pages here */
  }
  char *first = (char *)(((uintptr_t)memory + page - 1) / page * page);
  fem_prefer_large_pages(first + 1, page - 2); /* no whole page */
  assert_int_equal(has_flag(first + page / 2, " hg"), 0);
  fem_prefer_large_pages(first + 1, 2 * page); /* one */
  assert_int_equal(has_flag(first + page / 2, " hg"), 0);
  assert_int_equal(has_flag(first + page + page / 2, " hg"), 1);
  assert_int_equal(has_flag(first + 2 * page + page / 2, " hg"), 0);
  munmap(memory, 4 * page);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(memory_begins_at_a_cache_line),
      cmocka_unit_test(no_memory_is_left_alone),
      cmocka_unit_test(whole_pages_are_asked_for),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
