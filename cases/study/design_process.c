#include "cases/study/design_process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cases/commands/stage.h"
#include "cases/study/design_message.h"
#include "mesh/base/memory.h"
#include "mesh/base/progress.h"
#include "mesh/process/child.h"

static const size_t MOST_BYTES = 1 << 24;

enum { N_TEXTS = 6 };

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

/* The design's messages are its reason, so it reports none. */
static shb_status spawn(design_process *p, int in, int out) {
  const char *words[COMMAND_WORDS];
  char        sharing[16];
  snprintf(sharing, sizeof sharing, "%d", p->job->sharing);
  int n                   = stage_program(COMMAND_DESIGN, words);
  words[n++]              = p->job->study;
  words[n++]              = sharing;
  words[n]                = NULL;
  shb_child child         = shb_child_of((char *const *)words);
  child.name              = "a process for designs";
  child.in                = in;
  child.out               = out;
  child.apart             = true;
  const shb_status status = shb_child_start(&child, &p->child);
  free((void *)words[0]);
  return status;
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
  shb_status status = open_pipe(in) && open_pipe(out)
                          ? spawn(p, in[0], out[1])
                          : shb_fail(SHB_ERR_IO, __FILE__, __LINE__,
                                     "a process for designs: cannot be started: %s%s",
                                     strerror(errno), errno == EMFILE ? "; raise ulimit -n" : "");
  if (in[0] >= 0) close(in[0]);
  if (out[1] >= 0) close(out[1]);
  p->to   = in[1];
  p->from = out[0];
  if (status == SHB_OK) { /* a child that is gone already is noticed at the first request */
    (void)(put_all(p->to, &p->job->size, sizeof p->job->size) &&
           put_all(p->to, p->job->texts, p->job->size));
    return SHB_OK;
  }
  p->child = 0;
  if (p->to >= 0) close(p->to);
  if (p->from >= 0) close(p->from);
  return status;
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
  char          how[SHB_CHILD_HOW], reason[160];
  design_study  one;
  shb_status    packed = design_study_create(0, p->job->n_outputs, p->job->n_derivatives, &one);
  study_design *d      = packed == SHB_OK ? design_study_add(&one, NULL) : NULL;
  snprintf(reason, sizeof reason, "the process %s", shb_child_how(status, how));
  if (d) {
    d->state = STUDY_FAILED;
    study_design_set_reason(d, reason);
    packed = design_message_pack(d, p->job->n_outputs, p->job->n_derivatives, bytes, size);
  } else {
    packed = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "out of memory");
  }
  design_study_free(&one);
  return packed;
}

/* Send a request to the child, which is started if it is not running. One that has died while it
 * had nothing to do is replaced. */
static shb_status ask(design_process *p, const double *value) {
  const size_t size    = (size_t)p->job->n_request * sizeof *value;
  const bool   running = p->child != 0;
  if (!running) SHB_TRY(start(p));
  if (put_all(p->to, value, size) || !running) return SHB_OK;
  reap(p);
  SHB_TRY(start(p));
  (void)put_all(p->to, value, size); /* the answer tells whether it has come */
  return SHB_OK;
}

/* The answer; false: the child is gone, or sends none. */
static bool listen_to(design_process *p, char **bytes, size_t *size) {
  *bytes    = NULL;
  bool good = get_all(p->from, size, sizeof *size) && *size <= MOST_BYTES;
  if (good) *bytes = malloc(*size + 1);
  good = good && *bytes && get_all(p->from, *bytes, *size);
  if (good) return true;
  free(*bytes);
  *bytes = NULL;
  return false;
}

shb_status design_process_run(design_process *p, const double *value, char **bytes, size_t *size) {
  SHB_TRY(ask(p, value));
  return listen_to(p, bytes, size) ? SHB_OK : pack_death(p, reap(p), bytes, size);
}

void design_process_stop(design_process *p) {
  if (p->child) reap(p);
}

/* ---------------------------------------------------------------- the pool */

shb_status design_pool_create(const design_job *job, int n, design_pool *pool) {
  *pool = (design_pool){n, shb_alloc_zeroed((size_t)n, sizeof *pool->process),
                        shb_alloc((size_t)n, sizeof *pool->design)};
  for (int i = 0; i < n; i++) pool->process[i].job = job;
  for (int i = 0; i < n; i++) pool->design[i] = -1;
  return SHB_OK;
}

void design_pool_free(design_pool *pool) {
  for (int i = 0; pool->process && pool->design && i < pool->n; i++) {
    design_process *p = &pool->process[i];
    if (p->child && pool->design[i] >= 0) kill(p->child, SIGTERM);
    design_process_stop(p);
  }
  free(pool->process);
  free(pool->design);
  *pool = (design_pool){0};
}

/* Give designs to those that have none. Returns how many are at work. */
static shb_status hand_out(design_pool *pool, const crew_work *w, int *busy) {
  *busy = 0;
  for (int i = 0; i < pool->n; i++) *busy += pool->design[i] >= 0;
  for (int i = 0; i < pool->n && !shb_interrupted(); i++) {
    const double *value;
    if (pool->design[i] >= 0) continue;
    const int design = w->next(w->context, &value);
    if (design < 0) return SHB_OK;
    pool->design[i] = design;
    ++*busy;
    SHB_TRY(ask(&pool->process[i], value));
  }
  return SHB_OK;
}

/* The answer of a process, or its death. What an interruption has cut is not done. */
static shb_status take_answer(design_pool *pool, int i, const crew_work *w) {
  design_process *p      = &pool->process[i];
  const int       design = pool->design[i];
  char           *bytes;
  size_t          size;
  shb_status      status = SHB_OK;
  const bool      good   = listen_to(p, &bytes, &size);
  pool->design[i]        = -1;
  if (!good) {
    const int how = reap(p);
    if (shb_interrupted()) return SHB_OK;
    status = pack_death(p, how, &bytes, &size);
  }
  if (status == SHB_OK) status = w->done(w->context, design, bytes, size);
  free(bytes);
  return status;
}

/* Wait for answers, a short time, and take those that have come. */
static shb_status wait_for_answers(design_pool *pool, const crew_work *w, struct pollfd *watched) {
  enum { LONGEST = 200 }; /* ms, for the ticks */
  for (int i = 0; i < pool->n; i++) {
    const bool at_work = pool->design[i] >= 0;
    watched[i]         = (struct pollfd){at_work ? pool->process[i].from : -1, POLLIN, 0};
  }
  if (poll(watched, (nfds_t)pool->n, LONGEST) <= 0) return SHB_OK;
  for (int i = 0; i < pool->n; i++)
    if (watched[i].revents) SHB_TRY(take_answer(pool, i, w));
  return SHB_OK;
}

static void stop_all(const design_pool *pool) {
  for (int i = 0; i < pool->n; i++)
    if (pool->process[i].child) kill(pool->process[i].child, SIGTERM);
}

shb_status design_pool_manage(void *context, const crew_work *w) {
  design_pool   *pool    = context;
  struct pollfd *watched = shb_alloc((size_t)pool->n, sizeof *watched);
  shb_status     status  = SHB_OK;
  bool           stopped = false;
  for (int busy = 1; status == SHB_OK && busy > 0;) {
    status = hand_out(pool, w, &busy);
    if (shb_interrupted() && !stopped) stop_all(pool);
    stopped = shb_interrupted();
    if (status == SHB_OK && busy > 0) status = wait_for_answers(pool, w, watched);
    if (status == SHB_OK) status = w->tick(w->context);
  }
  free(watched);
  return status;
}

/* ---------------------------------------------------------------- the child */

shb_status design_process_texts(char **texts, study_texts *out) {
  size_t       size;
  const char **to[N_TEXTS] = {&out->study,  &out->base, &out->columns,
                              &out->inputs, &out->sets, &out->into},
             *end;
  *texts    = NULL;
  bool good = get_all(STDIN_FILENO, &size, sizeof size) && size <= N_TEXTS * MOST_BYTES;
  if (good) *texts = malloc(size + 1);
  good     = good && *texts && get_all(STDIN_FILENO, *texts, size);
  char *at = *texts;
  end      = good ? *texts + size : NULL;
  if (good) (*texts)[size] = '\0';
  for (int i = 0; i < N_TEXTS && good; i++) {
    good   = at < end;
    *to[i] = at;
    if (good) at += strlen(at) + 1;
  }
  SHB_CHECK(good, SHB_ERR_IO,
            "standard input holds no study; `shroudhb study` starts this program");
  return SHB_OK;
}

shb_status design_process_serve(int n_request, design_compute *compute, void *context) {
  double *value = shb_alloc((size_t)n_request + 1, sizeof *value);
  /* what a library prints must not mix with answers, and a stage must not hold their pipe */
  int answers = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
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
