/* The session's heap is in large pages. Where the system has none, or addresses are limited, there
 * is nothing to see. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "modal/common/session.h"

enum { MANY = 64 << 20 };

static bool can_have_large_pages(void) {
#ifdef __SANITIZE_ADDRESS__
  return false;
#else
  char          line[128] = "never";
  struct rlimit addresses;
  FILE         *file = fopen("/sys/kernel/mm/transparent_hugepage/enabled", "r");
  if (file && !fgets(line, sizeof line, file)) line[0] = 0;
  if (file) fclose(file);
  getrlimit(RLIMIT_AS, &addresses);
  return file && !strstr(line, "[never]") && addresses.rlim_cur == RLIM_INFINITY;
#endif
}

/* Does the mapping with this address ask for large pages? */
static bool asks_for_large_pages(const void *address) {
  char      line[256];
  uintptr_t first, last;
  bool      here = false, asks = false;
  FILE     *file = fopen("/proc/self/smaps", "r");
  assert_non_null(file);
  while (fgets(line, sizeof line, file)) {
    if (sscanf(line, "%" SCNxPTR "-%" SCNxPTR " ", &first, &last) == 2)
      here = first <= (uintptr_t)address && (uintptr_t)address < last;
    else if (here && strncmp(line, "VmFlags:", 8) == 0)
      asks = strstr(line, " hg") != NULL;
  }
  fclose(file);
  return asks;
}

static void memory_is_in_large_pages(void **state) {
  (void)state;
  if (!can_have_large_pages()) skip();
  char *memory = malloc(MANY);
  assert_non_null(memory);
  memset(memory, 1, MANY);
  assert_true(asks_for_large_pages(memory + MANY / 2));
  free(memory);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(memory_is_in_large_pages)};
  modal_session           session;
  if (modal_session_start(&argc, &argv, &session) != SHB_OK) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  modal_session_end(&session, SHB_OK);
  return failed;
}
