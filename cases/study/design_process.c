#include "cases/study/design_process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cases/commands/subprocess.h"
#include "cases/study/design_message.h"

extern char **environ;

static const size_t MOST_BYTES = 1 << 24;

static bool put_all(int fd, const void *data, size_t size) {
  for (const char *at = data; size > 0;) {
    ssize_t n = write(fd, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= (size_t)n;
  }
  return true;
}

static bool get_all(int fd, void *data, size_t size) {
  for (char *at = data; size > 0;) {
    ssize_t n = read(fd, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= (size_t)n;
  }
  return true;
}

/* Is this a variable of the launcher? With it a program on MPI would take itself for a rank. */
static bool of_launcher(const char *variable) {
  return strncmp(variable, "OMPI_", 5) == 0 || strncmp(variable, "PMIX_", 5) == 0 ||
         strncmp(variable, "PMI_", 4) == 0 || strncmp(variable, "PRTE_", 5) == 0;
}

/* The environment without those variables; the texts are not copied. */
static char **own_environment(void) {
  int n = 0, kept = 0;
  while (environ[n]) n++;
  char **out = calloc((size_t)n + 1, sizeof *out);
  for (int i = 0; out && i < n; i++)
    if (!of_launcher(environ[i]) || strncmp(environ[i], "OMPI_ALLOW", 10) == 0)
      out[kept++] = environ[i];
  return out;
}

static int spawn(design_process *p, int in, int out) {
  char                      *program = subprocess_program("shroudhb-design");
  char                      *study = strdup(p->study), **own = own_environment(), sharing[16];
  char                      *words[] = {program, study, sharing, NULL};
  posix_spawn_file_actions_t actions;
  snprintf(sharing, sizeof sharing, "%d", p->sharing);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  int why = program && study && own ? posix_spawnp(&p->child, program, &actions, NULL, words, own)
                                    : ENOMEM;
  posix_spawn_file_actions_destroy(&actions);
  free(program);
  free(study);
  free(own);
  return why;
}

/* A pipe whose ends no other child inherits. */
static bool open_pipe(int ends[2]) {
  if (pipe(ends) != 0) return false;
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  return true;
}

static shb_status start(design_process *p) {
  int in[2] = {-1, -1}, out[2] = {-1, -1};
  signal(SIGPIPE, SIG_IGN);
  bool good = open_pipe(in) && open_pipe(out);
  int  why  = good ? spawn(p, in[0], out[1]) : errno;
  if (in[0] >= 0) close(in[0]);
  if (out[1] >= 0) close(out[1]);
  p->to   = in[1];
  p->from = out[0];
  if (!why) return SHB_OK;
  p->child = 0;
  if (p->to >= 0) close(p->to);
  if (p->from >= 0) close(p->from);
  SHB_FAIL(SHB_ERR_IO, "shroudhb-design cannot be started: %s", strerror(why));
}

/* Wait for the end of the child; its status. */
static int reap(design_process *p) {
  int status = 0;
  close(p->to);
  close(p->from);
  while (waitpid(p->child, &status, 0) < 0 && errno == EINTR) {
  }
  p->child = 0;
  return status;
}

/* A failed design that says how the process ended. */
static shb_status pack_death(const design_process *p, int status, char **bytes, size_t *size) {
  char          reason[160];
  design_study  one;
  shb_status    packed = design_study_create(0, p->n_outputs, p->n_derivatives, &one);
  study_design *d      = packed == SHB_OK ? design_study_add(&one, NULL) : NULL;
  if (WIFSIGNALED(status)) {
    int number = WTERMSIG(status);
    snprintf(reason, sizeof reason, "the process was killed by signal %d (%s)%s", number,
             strsignal(number), number == SIGKILL ? "; out of memory?" : "");
  } else {
    snprintf(reason, sizeof reason, "the process ended with code %d",
             WIFEXITED(status) ? WEXITSTATUS(status) : -1);
  }
  if (d) {
    d->state = STUDY_FAILED;
    study_design_set_reason(d, reason);
    packed = design_message_pack(d, p->n_outputs, p->n_derivatives, bytes, size);
  } else {
    packed = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  design_study_free(&one);
  return packed;
}

shb_status design_process_run(design_process *p, const double *value, char **bytes, size_t *size) {
  *bytes = NULL;
  if (!p->child) SHB_TRY(start(p));
  bool good = put_all(p->to, value, (size_t)p->n_request * sizeof *value) &&
              get_all(p->from, size, sizeof *size) && *size <= MOST_BYTES;
  if (good) *bytes = malloc(*size + 1);
  good = good && *bytes && get_all(p->from, *bytes, *size);
  if (good) return SHB_OK;
  free(*bytes);
  return pack_death(p, reap(p), bytes, size);
}

void design_process_stop(design_process *p) {
  if (p->child) reap(p);
}

shb_status design_process_serve(int n_request, design_compute *compute, void *context) {
  double *value = calloc((size_t)n_request + 1, sizeof *value);
  SHB_CHECK(value, SHB_ERR_IO, "out of memory");
  int answers = dup(STDOUT_FILENO); /* what a library prints must not mix with answers */
  dup2(STDERR_FILENO, STDOUT_FILENO);
  shb_status status = SHB_OK;
  while (status == SHB_OK && get_all(STDIN_FILENO, value, (size_t)n_request * sizeof *value)) {
    char  *bytes = NULL;
    size_t size  = 0;
    status       = compute(context, value, &bytes, &size);
    if (status == SHB_OK &&
        !(put_all(answers, &size, sizeof size) && put_all(answers, bytes, size)))
      status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "the manager is gone");
    free(bytes);
  }
  close(answers);
  free(value);
  return status;
}
