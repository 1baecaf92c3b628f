#include "mesh/base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "revision.h"

enum { MESSAGE = 2048 };

static _Thread_local char message[MESSAGE];
static _Thread_local char origin[256];

void shb_plain_text(char *text) {
  for (unsigned char *c = (unsigned char *)text; *c; c++) {
    const int two_bytes = c[0] == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0; /* U+0080 to U+009F */
    if (*c == '\n' || *c == '\t') {
      *c = ' ';
    } else if (*c < 0x20 || *c == 0x7F || two_bytes) {
      *c = '?';
    }
    if (two_bytes) *++c = '?';
  }
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
