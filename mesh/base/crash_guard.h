/* A damaged file can crash the library that reads it. The program then ends with one line and the
 * exit code SHB_ERR_INPUT. */
#ifndef MESH_BASE_CRASH_GUARD_H
#define MESH_BASE_CRASH_GUARD_H

#include <stdbool.h>

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
