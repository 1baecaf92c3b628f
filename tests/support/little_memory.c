#include "tests/support/little_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/memory.h"
#include "mesh/base/status.h"
#include "tests/support/check.h"

void little_memory_run(void (*work)(void)) {
  int         status;
  const pid_t child = fork();
  if (child == 0) {
    work();
    fflush(stdout);
    _exit(0);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
}

double little_memory_limit(double wanted) {
  struct rlimit limit;
  getrlimit(RLIMIT_AS, &limit);
  for (limit.rlim_cur = 300 << 20;; limit.rlim_cur += 16 << 20) {
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
    const double left = shb_memory_available();
    if (left >= wanted) return left;
  }
}

int little_memory_number(const char *key) {
  const char *found = strstr(shb_message(), key);
  assert_non_null(found);
  return (int)strtol(found + strlen(key), NULL, 10);
}
