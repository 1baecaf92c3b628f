/* Status of a function that can fail, and its one-line message.
 *
 * The values are the exit codes of the program. A message names the fault, its place and the remedy
 * in one line. It is stored per thread until the next failure. */
#ifndef MESH_BASE_STATUS_H
#define MESH_BASE_STATUS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum {
  SHB_OK            = 0,
  SHB_ERR_INPUT     = 2,   /* bad input: case file, mesh, contents of a data file */
  SHB_NOT_CONVERGED = 3,   /* an outcome; results are published */
  SHB_ERR_IO        = 4,   /* cannot open, read, write, rename; no memory */
  SHB_INTERRUPTED   = 130, /* SIGINT, SIGTERM, SIGHUP; results so far are published */
} shb_status;

enum { SHB_NO_CHARACTER = 0xFFFD }; /* Unicode's own word for it */

/* The character of UTF-8 at text, which ends at end. bytes: its length; one byte that begins none
 * is SHB_NO_CHARACTER. */
unsigned shb_character(const char *text, const char *end, size_t *bytes);

/* Does a character show itself? Control characters may command a terminal. Those that turn the
 * direction of a text show another one than there is. */
bool shb_is_shown(unsigned character);

/* Replace what does not show itself: line ends and tabs by spaces, others by question marks. */
void shb_plain_text(char *text);

/* Record a message (printf style) in plain text and return code. file and line are those of the
 * caller. */
shb_status shb_fail(shb_status code, const char *file, int line, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Last message of this thread ("" if none), and the source line that raised it. */
const char *shb_message(void);
const char *shb_message_origin(void);

/* Version and git revision of the build, e.g. "0.2.0-3f2a91c"; "+" appended if the tree was
 * dirty. */
const char *shb_revision(void);

#define SHB_FAIL(code, ...) return shb_fail((code), __FILE__, __LINE__, __VA_ARGS__)
#define SHB_CHECK(cond, code, ...)            \
  do {                                        \
    if (!(cond)) SHB_FAIL(code, __VA_ARGS__); \
  } while (0)
#define SHB_TRY(call)                        \
  do {                                       \
    shb_status shb_try_ = (call);            \
    if (shb_try_ != SHB_OK) return shb_try_; \
  } while (0)

#endif
