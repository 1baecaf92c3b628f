/* One progress line on stderr, rewritten in place, only when stderr is a terminal and not --quiet; and the
 * flag that SIGINT or SIGTERM sets. */
#ifndef MESH_BASE_PROGRESS_H
#define MESH_BASE_PROGRESS_H

#include <stdbool.h>

#include "mesh/base/clock.h"
#include "mesh/base/phases.h"

typedef struct {
  bool        quiet;    /* --quiet: no line, no summary */
  bool        verbose;  /* --verbose: phase times on stderr, terminal or not */
  bool        terminal; /* stderr is a terminal */
  const char *stage;    /* "mesh", "modal", "mhb", "post" */
  double      started;  /* shb_seconds() at start of the stage */
  double      shown;    /* shb_seconds() of the last line drawn */
  shb_phases  phases;   /* of the stage so far */
} shb_progress;

shb_progress shb_progress_start(const char *stage, bool quiet, bool verbose);

/* Draw "stage  42 %  text" (at most 10 times a second). percent < 0: unknown. NULL progress: nothing. */
void shb_progress_show(shb_progress *progress, double percent, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Erase the line (call before other output to stderr, and at the end). */
void shb_progress_clear(shb_progress *progress);

/* With --verbose: a lasting line "stage: text" on stderr. */
void shb_progress_note(shb_progress *progress, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The phase that began at the end of the last one ends here: keep it and, with --verbose, say so: "stage: name: text: 1.20 s,
 * CPU 1.19 s, peak 210 MB". On several ranks see modal/common/phases.h. NULL progress: nothing. */
void shb_progress_phase(shb_progress *progress, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Install handlers for SIGINT and SIGTERM once; then ask whether one came.
 *
 * A second signal ends the process at once with 128 + the signal's number, and so does the first if the process still runs
 * after some seconds: grace of them (from 1; for stages that have nothing to save), else 10 after a SIGTERM and no end after
 * a SIGINT. What shb_publish_temporary named and was not published is removed. */
void shb_interrupt_catch(void);
void shb_interrupt_grace(int seconds);
bool shb_interrupted(void);

#endif
