/* Growing text buffer: pages, pictures and tables are composed in memory and published as a whole.
 *
 * A failed allocation sets failed. Later puts then do nothing, and post_buffer_publish reports
 * it. */
#ifndef POSTPROC_DRAW_TEXT_BUFFER_H
#define POSTPROC_DRAW_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

#include "mesh/base/status.h"

typedef struct {
  char  *text; /* null-terminated once anything was put; NULL before */
  size_t length, capacity;
  bool   failed;
} post_buffer;

void post_put(post_buffer *buffer, const char *format, ...) __attribute__((format(printf, 2, 3)));
void post_put_bytes(post_buffer *buffer, const char *bytes, size_t n);

/* Text for HTML or XML content and double-quoted attributes. The characters & < > " ' become
 * entities. Bytes that are not UTF-8, and control characters but tab and newline, become U+FFFD. */
void post_put_escaped(post_buffer *buffer, const char *text);

/* Text for a terminal; control characters but newline and tab become '?'. */
void post_put_printable(post_buffer *buffer, const char *text);

/* A column of a table for a terminal: text to the right of `width` characters, at least one blank
 * before it. */
void post_put_column(post_buffer *buffer, int width, const char *text);

/* A field of a CSV file, in quotes if it needs them. Spreadsheets compute what begins with = + - or
 * @: an apostrophe stands before such a text unless it is a number. Control characters but newline
 * become '?'. */
void post_put_csv(post_buffer *buffer, const char *text);

/* A JSON string with its quotes. '<' is written \u003c, so it may stand inside <script>. */
void post_put_json(post_buffer *buffer, const char *text);

/* n floats, little-endian IEEE single, as base64. */
void post_put_base64(post_buffer *buffer, size_t n, const float *values);

/* Write to a temporary beside path, fsync, rename. Errors: SHB_ERR_IO. */
shb_status post_buffer_publish(const post_buffer *buffer, const char *path);
void       post_buffer_free(post_buffer *buffer);

#endif
