#define _GNU_SOURCE /* dup3 */
#include "mesh/base/crash_guard.h"

#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/status.h"

enum { MAX_FILES = 8 };

/* Files to remove. */
static struct {
  volatile sig_atomic_t used;
  pid_t                 owner;
  char                  name[1024];
} file_of_end[MAX_FILES];

void shb_end_removes(const char *name) {
  static atomic_int next;
  const int         at = atomic_fetch_add(&next, 1) % MAX_FILES;
  file_of_end[at].used = 0;
  if (strlen(name) >= sizeof file_of_end[at].name) return;
  strcpy(file_of_end[at].name, name);
  file_of_end[at].owner = getpid();
  file_of_end[at].used  = 1;
}

static const int fatal[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};

enum { SIGNALS = sizeof fatal / sizeof *fatal, STACK = 1 << 16 };

/* Signal handlers have no arguments. */
static struct {
  bool             active, muted;
  int              code; /* of the end */
  char             line[1400];
  struct sigaction before[SIGNALS];
  stack_t          stack_before;
} guard;

/* A signal stack of its own: the crash may be an overflow of the usual one. */
static char stack[STACK];

/* What the program itself says goes to a descriptor of its own. That of the libraries leads nowhere
 * meanwhile. Once made, the stream stays: threads may use it. */
static struct {
  FILE *stream, *before;
  int   file; /* of the stream */
} speech;

static volatile sig_atomic_t report_of_end = -1;

void shb_end_reports(int report) {
  report_of_end = report;
}

void shb_end_at_once(const char *line, int code) {
  static atomic_flag ending = ATOMIC_FLAG_INIT;
  const int          where  = guard.muted ? speech.file : STDERR_FILENO;
  if (atomic_flag_test_and_set(&ending)) {
    sleep(1); /* another thread ends the process meanwhile; or this one has crashed over it */
  } else {
    ssize_t done = write(where, line, strlen(line));
    if (report_of_end >= 0) done = write(report_of_end, line, strlen(line));
    (void)done;
  }
  for (int i = 0; i < MAX_FILES; i++)
    if (file_of_end[i].used && file_of_end[i].owner == getpid()) unlink(file_of_end[i].name);
  _exit(code);
}

static void end_program(int number) {
  (void)number;
  shb_end_at_once(guard.line, guard.code);
}

static bool make_own_stream(void) {
  speech.file   = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  speech.stream = speech.file >= 0 ? fdopen(speech.file, "w") : NULL;
  if (!speech.stream && speech.file >= 0) close(speech.file);
  if (speech.stream) setvbuf(speech.stream, NULL, _IONBF, 0);
  return speech.stream != NULL;
}

static void mute_stderr(bool stream) {
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  fflush(stderr);
  if (null >= 0 && (speech.stream || make_own_stream()) &&
      dup3(STDERR_FILENO, speech.file, O_CLOEXEC) >= 0 && dup2(null, STDERR_FILENO) >= 0) {
    guard.muted   = true;
    speech.before = stderr;
    if (!stream) stderr = speech.stream;
  }
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
  guard.code = SHB_ERR_INPUT;
  if (guard.active || !USED) return;
  const stack_t    own    = {.ss_sp = stack, .ss_size = sizeof stack};
  struct sigaction action = {.sa_handler = end_program, .sa_flags = SA_ONSTACK | SA_RESETHAND};
  sigemptyset(&action.sa_mask);
  sigaltstack(&own, &guard.stack_before);
  for (int i = 0; i < SIGNALS; i++) sigaction(fatal[i], &action, &guard.before[i]);
  mute_stderr(mute);
  guard.active = true;
}

void shb_guard_told(int code) {
  guard.line[0] = '\0';
  guard.code    = code;
}

void shb_guard_end(void) {
  if (!guard.active) return;
  if (guard.muted) {
    fflush(speech.before);
    dup2(speech.file, STDERR_FILENO);
    stderr      = speech.before;
    guard.muted = false;
  }
  for (int i = 0; i < SIGNALS; i++) sigaction(fatal[i], &guard.before[i], NULL);
  sigaltstack(&guard.stack_before, NULL);
  guard.active = false;
}
