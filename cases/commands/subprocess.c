#define _GNU_SOURCE /* memfd_create */
#include "cases/commands/subprocess.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "mesh/base/progress.h"

extern char **environ;

char *subprocess_program(const char *name) {
  char    here[4096];
  ssize_t n = readlink("/proc/self/exe", here, sizeof here - 1);
  if (n > 0) {
    here[n]     = '\0';
    char *slash = strrchr(here, '/');
    if (slash) slash[1] = '\0';
    size_t size = strlen(here) + strlen(name) + 1;
    char  *path = malloc(size);
    if (path) snprintf(path, size, "%s%s", here, name);
    if (!path || access(path, X_OK) == 0) return path;
    free(path);
  }
  return strdup(name);
}

/* A blocked signal is delivered though it is ignored, as SIGHUP is by nohup: it is not blocked. */
static sigset_t waited_signals(void) {
  struct sigaction hangup;
  sigset_t         set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN)
    sigaddset(&set, SIGHUP);
  sigaddset(&set, SIGCHLD);
  return set;
}

/* out and err replace standard output and error unless they are negative. */
static int spawn(char *const argv[], const sigset_t *mask, int out, int err, pid_t *child) {
  posix_spawnattr_t          attributes;
  posix_spawn_file_actions_t files;
  int                        why = posix_spawnattr_init(&attributes);
  if (why) return why;
  why = posix_spawn_file_actions_init(&files);
  if (why == 0) {
    posix_spawnattr_setsigmask(&attributes, mask);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    if (out >= 0) why = posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
    if (err >= 0 && why == 0) why = posix_spawn_file_actions_adddup2(&files, err, STDERR_FILENO);
    if (why == 0) why = posix_spawnp(child, argv[0], &files, &attributes, argv, environ);
    posix_spawn_file_actions_destroy(&files);
  }
  posix_spawnattr_destroy(&attributes);
  return why;
}

/* Waits for the child and passes signals on. SIGINT and SIGHUP of the terminal reach the whole
 * foreground process group, the child included. */
static bool wait_for(pid_t child, const sigset_t *signals, int *status, struct rusage *usage) {
  bool  interrupted = false;
  pid_t ended;
  while ((ended = wait4(child, status, WNOHANG, usage)) == 0) {
    siginfo_t info;
    int       number = sigwaitinfo(signals, &info);
    if (number != SIGINT && number != SIGTERM && number != SIGHUP) continue;
    interrupted = true;
    if (info.si_code != SI_KERNEL) kill(child, number);
  }
  if (ended < 0) *status = SHB_ERR_IO << 8; /* status unknown: treated as exit code 4 */
  return interrupted;
}

static double seconds_of(struct timeval t) {
  return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

static const char *leaf(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

shb_status subprocess_run(char *const argv[], subprocess_result *result) {
  return subprocess_run_to(argv, -1, -1, result);
}

shb_status subprocess_run_to(char *const argv[], int out, int err, subprocess_result *result) {
  *result          = (subprocess_result){.code = SHB_ERR_IO};
  sigset_t signals = waited_signals(), before;
  signal(SIGCHLD, SIG_DFL); /* if SIGCHLD is inherited as ignored, the kernel reaps the child */
  sigprocmask(SIG_BLOCK, &signals, &before);
  double        started = shb_seconds();
  pid_t         child   = 0;
  int           why = spawn(argv, &before, out, err, &child), status = 0;
  struct rusage usage       = {0};
  bool          interrupted = !why && wait_for(child, &signals, &status, &usage);
  sigprocmask(SIG_SETMASK, &before, NULL);
  SHB_CHECK(!why, SHB_ERR_IO, "%s: cannot be started: %s", argv[0], strerror(why));
  result->seconds = shb_seconds() - started;
  result->cpu     = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  result->peak    = 1024.0 * (double)usage.ru_maxrss;
  result->code    = WIFEXITED(status) ? WEXITSTATUS(status) : SHB_ERR_IO;
  if (interrupted) {
    result->code = SHB_INTERRUPTED;
  } else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE) {
    result->code = SHB_OK; /* the reader of the output has closed it */
  } else if (WIFSIGNALED(status)) {
    int number = WTERMSIG(status);
    SHB_FAIL(SHB_ERR_IO, "%s was killed by signal %d (%s)%s", leaf(argv[0]), number,
             strsignal(number), number == SIGKILL ? "; out of memory?" : "");
  }
  return SHB_OK;
}

shb_status subprocess_copy(const char *text, int *copy, char path[SUBPROCESS_COPY]) {
  const size_t size = strlen(text);
  size_t       done = 0;
  *copy             = memfd_create("shroudhb", 0);
  while (*copy >= 0 && done < size) {
    const ssize_t n = write(*copy, text + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += (size_t)n;
  }
  if (*copy >= 0 && done == size) {
    snprintf(path, SUBPROCESS_COPY, "/proc/self/fd/%d", *copy);
    return SHB_OK;
  }
  const int why = errno;
  if (*copy >= 0) close(*copy);
  *copy = -1;
  SHB_FAIL(SHB_ERR_IO, "a copy of the case cannot be kept: %s", strerror(why));
}
