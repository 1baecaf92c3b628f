#include "mesh/base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "revision.h"

enum { MESSAGE = 2048 };

static _Thread_local char message[MESSAGE];
static _Thread_local char origin[256];

unsigned shb_character(const char *text, const char *end, size_t *bytes) {
  static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000}; /* of so many bytes */
  const unsigned char  *c       = (const unsigned char *)text;
  const size_t          n       = c[0] < 0x80 ? 1 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : 4;
  unsigned              code    = n == 1 ? c[0] : c[0] & (0xFFu >> (n + 1));
  bool                  whole   = n == 1 || (c[0] >= 0xC0 && c[0] < 0xF8);
  *bytes                        = 1;
  whole                         = whole && n <= (size_t)(end - text);
  for (size_t i = 1; whole && i < n; i++) {
    whole = (c[i] & 0xC0) == 0x80;
    code  = code << 6 | (c[i] & 0x3Fu);
  }
  if (!whole || code < least[n] || code > 0x10FFFF) return SHB_NO_CHARACTER;
  *bytes = n;
  return code;
}

bool shb_is_shown(unsigned character) {
  /* C0, DEL and C1; Unicode's Bidi_Control; separators of lines and paragraphs; the byte-order
   * mark */
  static const unsigned hidden[][2] = {{0, 0x1F},        {0x7F, 0x9F},     {0x61C, 0x61C},
                                       {0x200E, 0x200F}, {0x2028, 0x202E}, {0x2066, 0x2069},
                                       {0xFEFF, 0xFEFF}};
  for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++)
    if (character >= hidden[i][0] && character <= hidden[i][1]) return false;
  return true;
}

void shb_plain_text(char *text) {
  const char *at = text, *end = text + strlen(text);
  char       *to = text;
  for (size_t n; at < end; at += n) {
    const unsigned c     = shb_character(at, end, &n);
    const bool     shown = shb_is_shown(c) && (c != SHB_NO_CHARACTER || n > 1);
    if (shown) memmove(to, at, n);
    if (!shown) *to = *at == '\n' || *at == '\t' ? ' ' : '?';
    to += shown ? n : 1;
  }
  *to = '\0';
}

shb_status shb_fail(shb_status code, const char *file, int line, const char *format, ...) {
  char    text[MESSAGE]; /* arguments may point into message */
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  shb_plain_text(text);
  memcpy(message, text, sizeof text);
  snprintf(origin, sizeof origin, "%s:%d", file, line);
  return code;
}

const char *shb_message(void) {
  return message;
}

const char *shb_message_origin(void) {
  return origin;
}

const char *shb_revision(void) {
  return SHB_REVISION;
}
