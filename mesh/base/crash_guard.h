/* The end of the process at once: by a crash, a second signal, or without memory.
 *
 * A damaged file can crash the library that reads it. The program then ends with one line and the
 * exit code SHB_ERR_INPUT. */
#ifndef MESH_BASE_CRASH_GUARD_H
#define MESH_BASE_CRASH_GUARD_H

#include <stdbool.h>

/* Remove this file when this process ends at once, not one that it forks. The names of published
 * and removed files do no harm. The last eight names count, of at most 1023 bytes. */
void shb_end_removes(const char *name);

/* End the process at once with this exit code. The line, with its line end, goes where the program
 * speaks; then the files above are removed. Of several threads the first speaks. Safe in a signal
 * handler. */
_Noreturn void shb_end_at_once(const char *line, int code);

/* The line also goes to this descriptor, for the program that started this one. Negative: none. */
void shb_end_reports(int report);

/* From here to the end of the guard a fatal signal prints "shroudhb: error: PATH: WHY" and ends the
 * process. Temporary files of results are removed. What the C library prints before it aborts leads
 * nowhere. Guards do not nest: a second one replaces the text of the first.
 *   mute  in  so does the stream stderr, where other libraries print before they abort */
void shb_guard_begin(const char *path, const char *why, bool mute);
void shb_guard_end(void);

/* The program has told its last word, and ends with this code. A fatal signal under a guard that is
 * still up then ends it so without another line. So may end a library that cannot close a damaged
 * file. */
void shb_guard_told(int code);

#endif
