#define _GNU_SOURCE /* memfd_create */
#include "mesh/process/child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "mesh/base/clock.h"
#include "mesh/base/crash_guard.h"
#include "mesh/base/memory.h"
#include "mesh/process/report.h"

extern char **environ;

char *shb_child_program(const char *name) {
  char    here[4096];
  ssize_t n = readlink("/proc/self/exe", here, sizeof here - 1);
  if (n > 0) {
    here[n]     = '\0';
    char *slash = strrchr(here, '/');
    if (slash) slash[1] = '\0';
    char *path = shb_text_of("%s%s", here, name);
    if (access(path, X_OK) == 0) return path;
    free(path);
  }
  return shb_text(name);
}

/* A blocked signal is delivered though it is ignored, as SIGHUP is by nohup: it is not blocked. */
static sigset_t waited_signals(void) {
  struct sigaction hangup;
  sigset_t         set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGCHLD);
  if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN)
    sigaddset(&set, SIGHUP);
  return set;
}

/* Is this a variable of the launcher? With it a program on MPI would take itself for a rank. */
static bool of_launcher(const char *variable) {
  return strncmp(variable, "OMPI_ALLOW", 10) != 0 &&
         (strncmp(variable, "OMPI_", 5) == 0 || strncmp(variable, "PMIX_", 5) == 0 ||
          strncmp(variable, "PMI_", 4) == 0 || strncmp(variable, "PRTE_", 5) == 0);
}

/* The environment of a child; only the last text is its own. */
static char **environment_of(const shb_child *child, const char *report) {
  const size_t named = strlen(SHB_REPORT);
  size_t       n = 0, kept = 0;
  while (environ[n]) n++;
  char **out = shb_alloc(n + 2, sizeof *out);
  for (size_t i = 0; i < n; i++) {
    const bool replaced = child->apart || child->report >= 0;
    const bool told     = strncmp(environ[i], SHB_REPORT, named) == 0 && environ[i][named] == '=';
    if ((child->apart && of_launcher(environ[i])) || (replaced && told)) continue;
    out[kept++] = environ[i];
  }
  if (child->report >= 0) out[kept++] = (char *)report;
  out[kept] = NULL;
  return out;
}

shb_child shb_child_of(char *const words[]) {
  return (shb_child){.words = words, .in = -1, .out = -1, .err = -1, .report = -1};
}

/* Returns 0 or the number of an error. */
static int spawn(const shb_child *child, const sigset_t *mask, pid_t *pid) {
  const int                  own[] = {child->in, child->out, child->err};
  char                       report[64];
  posix_spawnattr_t          attributes;
  posix_spawn_file_actions_t files;
  snprintf(report, sizeof report, "%s=%d", SHB_REPORT, child->report);
  char **environment = environment_of(child, report);
  int    why         = posix_spawnattr_init(&attributes);
  if (why == 0) why = posix_spawn_file_actions_init(&files);
  if (why == 0) {
    if (mask) posix_spawnattr_setsigmask(&attributes, mask);
    if (mask) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    for (int i = 0; i <= STDERR_FILENO && why == 0; i++)
      if (own[i] >= 0) why = posix_spawn_file_actions_adddup2(&files, own[i], i);
    if (why == 0)
      why = posix_spawnp(pid, child->words[0], &files, &attributes, child->words, environment);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  free(environment);
  return why;
}

static const char *leaf(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static const char *name_of(const shb_child *child) {
  return child->name ? child->name : leaf(child->words[0]);
}

static shb_status not_started(const shb_child *child, int why) {
  SHB_FAIL(SHB_ERR_IO, "%s: cannot be started: %s%s", name_of(child), strerror(why),
           why == EMFILE ? "; raise ulimit -n" : "");
}

shb_status shb_child_start(const shb_child *child, pid_t *pid) {
  const int why = spawn(child, NULL, pid);
  return why ? not_started(child, why) : SHB_OK;
}

/* Waits for the child and passes signals on. SIGINT and SIGHUP of the terminal reach the whole
 * foreground process group, the child included. */
static bool wait_for(pid_t child, const sigset_t *signals, int *status, struct rusage *usage) {
  bool  interrupted = false;
  pid_t ended;
  while ((ended = wait4(child, status, WNOHANG, usage)) == 0) {
    /* in a program with threads another one may take the signal of the end: look again */
    const struct timespec pause = {.tv_nsec = 200000000};
    siginfo_t             info;
    int                   number = sigtimedwait(signals, &info, &pause);
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

const char *shb_child_how(int status, char text[SHB_CHILD_HOW]) {
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number)
    snprintf(text, SHB_CHILD_HOW, "was killed by signal %d (%s)%s", number, strsignal(number),
             number == SIGKILL ? "; out of memory?" : "");
  else
    snprintf(text, SHB_CHILD_HOW, "ended with code %d",
             WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  return text;
}

static shb_child_end end_of(int status, const struct rusage *usage, double started) {
  return (shb_child_end){
      .code    = WIFEXITED(status) ? WEXITSTATUS(status) : SHB_ERR_IO,
      .signal  = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
      .seconds = shb_seconds() - started,
      .cpu     = seconds_of(usage->ru_utime) + seconds_of(usage->ru_stime),
      .peak    = 1024.0 * (double)usage->ru_maxrss,
  };
}

shb_status shb_child_run(const shb_child *child, shb_child_end *end) {
  *end             = (shb_child_end){.code = SHB_ERR_IO};
  sigset_t signals = waited_signals(), before;
  signal(SIGCHLD, SIG_DFL); /* if SIGCHLD is inherited as ignored, the kernel reaps the child */
  sigprocmask(SIG_BLOCK, &signals, &before);
  const double  started = shb_seconds();
  pid_t         pid     = 0;
  int           why = spawn(child, &before, &pid), status = 0;
  struct rusage usage       = {0};
  const bool    interrupted = !why && wait_for(pid, &signals, &status, &usage);
  char          how[SHB_CHILD_HOW];
  sigprocmask(SIG_SETMASK, &before, NULL);
  if (why) return not_started(child, why);
  *end = end_of(status, &usage, started);
  if (interrupted) end->code = SHB_INTERRUPTED;
  if (interrupted || !end->signal) return SHB_OK;
  if (end->signal == SIGPIPE) end->code = SHB_OK; /* the reader of the output has closed it */
  if (end->signal == SIGPIPE) return SHB_OK;
  SHB_FAIL(SHB_ERR_IO, "%s %s", name_of(child), shb_child_how(status, how));
}

/* In the child. */
static _Noreturn void work_apart(int (*work)(void *), void *context, long seconds) {
  const struct rlimit time = {(rlim_t)seconds, (rlim_t)seconds + 1};
  const int           null = open("/dev/null", O_WRONLY);
  shb_end_reports(-1); /* the parent tells */
  if (null >= 0) dup2(null, STDERR_FILENO);
  signal(SIGXCPU, SIG_DFL);
  setrlimit(RLIMIT_CPU, &time);
  _exit(work(context));
}

shb_status shb_child_try(int (*work)(void *context), void *context, long seconds,
                         shb_child_end *end) {
  const double  started = shb_seconds();
  struct rusage usage   = {0};
  int           status  = 0;
  fflush(NULL);
  const pid_t pid = fork();
  SHB_CHECK(pid >= 0, SHB_ERR_IO, "no process can be started: %s", strerror(errno));
  if (pid == 0) work_apart(work, context, seconds);
  while (wait4(pid, &status, 0, &usage) < 0 && errno == EINTR) continue;
  *end = end_of(status, &usage, started);
  return SHB_OK;
}

shb_status shb_child_text(const char *text, int *copy, char path[SHB_CHILD_TEXT]) {
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
    snprintf(path, SHB_CHILD_TEXT, "/proc/self/fd/%d", *copy);
    return SHB_OK;
  }
  const int why = errno;
  if (*copy >= 0) close(*copy);
  *copy = -1;
  SHB_FAIL(SHB_ERR_IO, "a copy of the case cannot be kept: %s", strerror(why));
}
