#include "mesh/progress.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double shb_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

shb_progress shb_progress_start(const char *stage, bool quiet, bool verbose) {
  shb_progress progress = {.quiet    = quiet,
                           .verbose  = verbose && !quiet,
                           .terminal = isatty(STDERR_FILENO) == 1,
                           .stage    = stage,
                           .started  = shb_seconds()};
  return progress;
}

void shb_progress_show(shb_progress *progress, double percent, const char *format, ...) {
  if (!progress || progress->quiet || !progress->terminal) return;
  double now = shb_seconds();
  if (now - progress->shown < 0.1) return;
  progress->shown = now;
  char    text[160];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (percent >= 0) {
    fprintf(stderr, "\r\033[K%-5s %3.0f %%  %s", progress->stage, percent, text);
  } else {
    fprintf(stderr, "\r\033[K%-5s   …    %s", progress->stage, text);
  }
  fflush(stderr);
}

void shb_progress_clear(shb_progress *progress) {
  if (!progress || progress->quiet || !progress->terminal || progress->shown == 0) return;
  fputs("\r\033[K", stderr);
  fflush(stderr);
}

void shb_progress_note(shb_progress *progress, const char *format, ...) {
  if (!progress || !progress->verbose) return;
  shb_progress_clear(progress);
  va_list args;
  va_start(args, format);
  fprintf(stderr, "%s: ", progress->stage);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
}

static volatile sig_atomic_t interrupted;

static void on_signal(int number) {
  (void)number;
  interrupted = 1;
}

void shb_interrupt_catch(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  signal(SIGXFSZ, SIG_IGN); /* a file size limit shall fail the write, not kill the process */
}

bool shb_interrupted(void) {
  return interrupted != 0;
}
