/* Progress line on stderr, notes, phases of a stage, and the flag set by signals.
 *
 * The line is rewritten in place. It appears only on a terminal and without --quiet. */
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

/* Draw "stage  42 %  text", at most 10 times a second.
 *   progress  in  NULL: nothing is drawn
 *   percent   in  negative: unknown */
void shb_progress_show(shb_progress *progress, double percent, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Erase the line; call it before other output to stderr and at the end. */
void shb_progress_clear(shb_progress *progress);

/* With --verbose: print "stage: text" on a line of its own. */
void shb_progress_note(shb_progress *progress, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Without --quiet: print "shroudhb: warning: text" on a line of its own. */
void shb_progress_warn(shb_progress *progress, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* End the current phase, record it and, with --verbose, print it:
 * "stage: name: text: 1.20 s, CPU 1.19 s, peak 210 MB". On several ranks see modal/common/phases.h.
 *   progress  in  NULL: nothing is done */
void shb_progress_phase(shb_progress *progress, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Install the handlers of SIGINT, SIGTERM and SIGHUP once, then ask whether a signal came. SIGHUP
 * comes where the terminal is closed; nohup has it ignored.
 *
 * A second signal ends the process at once with exit code 128 + number of the signal. The first
 * signal does so after a grace period: the given seconds (at least 1; for stages without results to
 * save). By default it is unlimited after SIGINT and 10 s after the others. Temporary files of
 * shb_publish_temporary that are not published yet are removed. */
void shb_interrupt_catch(void);
void shb_interrupt_grace(int seconds);
bool shb_interrupted(void);

#endif
