#include "mesh/base/crash_guard.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/publish.h"
#include "mesh/base/status.h"

static const int fatal[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};

enum { SIGNALS = sizeof fatal / sizeof *fatal, STACK = 1 << 16 };

/* Signal handlers have no arguments. */
static struct {
  bool             active;
  int              stderr_kept; /* -1: not muted */
  char             line[1400];
  struct sigaction before[SIGNALS];
  stack_t          stack_before;
} guard = {.stderr_kept = -1};

/* A signal stack of its own: the crash may be an overflow of the usual one. */
static char stack[STACK];

static void end_program(int number) {
  (void)number;
  const int where = guard.stderr_kept >= 0 ? guard.stderr_kept : STDERR_FILENO;
  ssize_t   done  = write(where, guard.line, strlen(guard.line));
  (void)done;
  shb_publish_abandon();
  _exit(SHB_ERR_INPUT);
}

static void mute_stderr(void) {
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  fflush(stderr);
  guard.stderr_kept = null >= 0 ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3) : -1;
  if (guard.stderr_kept >= 0) dup2(null, STDERR_FILENO);
  if (null >= 0) close(null);
}

#ifdef __SANITIZE_ADDRESS__
enum { USED = false }; /* the sanitizer tells more */
#else
enum { USED = true };
#endif

void shb_guard_begin(const char *path, const char *why, bool mute) {
  snprintf(guard.line, sizeof guard.line - 1, "shroudhb: error: %s: %s", path, why);
  strcat(guard.line, "\n");
  if (guard.active || !USED) return;
  const stack_t    own    = {.ss_sp = stack, .ss_size = sizeof stack};
  struct sigaction action = {.sa_handler = end_program, .sa_flags = SA_ONSTACK | SA_RESETHAND};
  sigemptyset(&action.sa_mask);
  sigaltstack(&own, &guard.stack_before);
  for (int i = 0; i < SIGNALS; i++) sigaction(fatal[i], &action, &guard.before[i]);
  if (mute) mute_stderr();
  guard.active = true;
}

void shb_guard_end(void) {
  if (!guard.active) return;
  if (guard.stderr_kept >= 0) {
    fflush(stderr);
    dup2(guard.stderr_kept, STDERR_FILENO);
    close(guard.stderr_kept);
    guard.stderr_kept = -1;
  }
  for (int i = 0; i < SIGNALS; i++) sigaction(fatal[i], &guard.before[i], NULL);
  sigaltstack(&guard.stack_before, NULL);
  guard.active = false;
}
