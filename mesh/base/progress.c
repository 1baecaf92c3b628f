#include "mesh/base/progress.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/clock.h"
#include "mesh/base/crash_guard.h"

shb_progress shb_progress_start(const char *stage, bool quiet, bool verbose) {
  shb_progress progress = {.quiet    = quiet,
                           .verbose  = verbose && !quiet,
                           .terminal = isatty(STDERR_FILENO) == 1,
                           .stage    = stage,
                           .started  = shb_seconds()};
  shb_phases_start(&progress.phases);
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

void shb_progress_warn(shb_progress *progress, const char *format, ...) {
  if (!progress || progress->quiet) return;
  shb_progress_clear(progress);
  va_list args;
  va_start(args, format);
  fputs("shroudhb: warning: ", stderr);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
}

void shb_progress_phase(shb_progress *progress, const char *name, const char *format, ...) {
  if (!progress) return;
  shb_phase phase = shb_phases_lap(&progress->phases, name);
  char      text[160];
  va_list   args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  shb_phases_add(&progress->phases, &phase);
  shb_progress_note(progress, "%s: %s: %.2f s, CPU %.2f s, peak %.0f MB", name, text, phase.seconds,
                    phase.cpu, 1e-6 * phase.memory);
}

static volatile sig_atomic_t interrupted; /* number of the first signal */
static volatile sig_atomic_t grace_seconds;

static void exit_now(void) {
  shb_end_at_once("shroudhb: ended at once; what was published before is kept\n",
                  128 + interrupted);
}

static void on_signal(int number) {
  enum { DEFAULT_GRACE = 10 }; /* s */
  /* a terminal that closes may tell twice: by the shell and by the system */
  if (interrupted == SIGHUP && number == SIGHUP) return;
  if (interrupted) exit_now();
  interrupted = number;
  alarm((unsigned)(grace_seconds > 0 ? grace_seconds : number == SIGINT ? 0 : DEFAULT_GRACE));
}

static void on_alarm(int number) {
  (void)number;
  exit_now();
}

static void install(int number, void (*handler)(int)) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL);
}

void shb_interrupt_catch(void) {
  struct sigaction hangup;
  install(SIGINT, on_signal);
  install(SIGTERM, on_signal);
  if (sigaction(SIGHUP, NULL, &hangup) == 0 && hangup.sa_handler != SIG_IGN) /* nohup */
    install(SIGHUP, on_signal);
  install(SIGALRM, on_alarm);
  signal(SIGXFSZ, SIG_IGN); /* a file over the size limit fails the write, not the process */
}

void shb_interrupt_grace(int seconds) {
  grace_seconds = seconds;
}

bool shb_interrupted(void) {
  return interrupted != 0;
}
