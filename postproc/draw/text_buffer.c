#include "postproc/draw/text_buffer.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/publish.h"

static bool reserve(post_buffer *buffer, size_t more) {
  if (buffer->failed) return false;
  size_t wanted = buffer->length + more + 1;
  if (wanted <= buffer->capacity) return true;
  size_t capacity = buffer->capacity ? buffer->capacity : 4096;
  while (capacity < wanted) capacity *= 2;
  char *text = realloc(buffer->text, capacity);
  if (!text) {
    buffer->failed = true;
    return false;
  }
  buffer->text     = text;
  buffer->capacity = capacity;
  return true;
}

void post_put_bytes(post_buffer *buffer, const char *bytes, size_t n) {
  if (!reserve(buffer, n)) return;
  memcpy(buffer->text + buffer->length, bytes, n);
  buffer->length += n;
  buffer->text[buffer->length] = '\0';
}

void post_put(post_buffer *buffer, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(NULL, 0, format, list);
  va_end(list);
  if (n < 0 || !reserve(buffer, (size_t)n)) return;
  va_start(list, format);
  vsnprintf(buffer->text + buffer->length, (size_t)n + 1, format, list);
  va_end(list);
  buffer->length += (size_t)n;
}

/* Length in bytes of the UTF-8 sequence at text; 0 if it is none (RFC 3629: no overlong forms, no
 * surrogates). */
static int utf8_length(const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  if (c[0] < 0x80) return 1;
  int      n      = c[0] >= 0xf0 ? 4 : c[0] >= 0xe0 ? 3 : 2;
  uint32_t lowest = n == 4 ? 0x10000 : n == 3 ? 0x800 : 0x80;
  if (c[0] < 0xc2 || c[0] > 0xf4) return 0;
  uint32_t code = c[0] & (0xffu >> (n + 1));
  for (int i = 1; i < n; i++) {
    if ((c[i] & 0xc0) != 0x80) return 0;
    code = code << 6 | (c[i] & 0x3fu);
  }
  bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < lowest || code > 0x10ffff || surrogate ? 0 : n;
}

static const char *entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return NULL;
  }
}

static bool is_control(char c) {
  return ((unsigned char)c < 0x20 && c != '\t' && c != '\n') || c == 0x7f;
}

void post_put_escaped(post_buffer *buffer, const char *text) {
  while (*text) {
    int n = utf8_length(text);
    if (n == 1 && entity(*text)) {
      post_put(buffer, "%s", entity(*text));
    } else if (*text == '\r' && text[1] == '\n') {
      ; /* the newline that follows replaces both */
    } else if (n == 0 || is_control(*text)) {
      post_put(buffer, "\xef\xbf\xbd");
    } else {
      post_put_bytes(buffer, text, (size_t)n);
    }
    text += n ? n : 1;
  }
}

void post_put_printable(post_buffer *buffer, const char *text) {
  for (; *text; text++) post_put_bytes(buffer, is_control(*text) ? "?" : text, 1);
}

/* Would a spreadsheet take this text for a formula? */
static bool is_formula(const char *text) {
  char *end;
  if (!*text || !strchr("=+-@", *text)) return false;
  (void)strtod(text, &end);
  return end == text || *end != '\0' || strspn(text, "+-.0123456789eE") != strlen(text);
}

void post_put_csv(post_buffer *buffer, const char *text) {
  bool quoted = strpbrk(text, ",\"\n") != NULL;
  if (quoted) post_put(buffer, "\"");
  if (is_formula(text)) post_put(buffer, "'");
  for (const char *c = text; *c; c++) {
    const bool control = is_control(*c) || *c == '\t';
    post_put(buffer, *c == '"' ? "\"\"" : "%c", control ? '?' : *c);
  }
  if (quoted) post_put(buffer, "\"");
}

void post_put_json(post_buffer *buffer, const char *text) {
  post_put(buffer, "\"");
  while (*text) {
    int n = utf8_length(text);
    if (n == 0) {
      post_put(buffer, "\xef\xbf\xbd");
    } else if (*text == '"' || *text == '\\') {
      post_put(buffer, "\\%c", *text);
    } else if (n == 1 && ((unsigned char)*text < 0x20 || *text == '<' || *text == 0x7f)) {
      post_put(buffer, "\\u%04x", (unsigned char)*text);
    } else {
      post_put_bytes(buffer, text, (size_t)n);
    }
    text += n ? n : 1;
  }
  post_put(buffer, "\"");
}

void post_put_column(post_buffer *buffer, int width, const char *text) {
  int characters = 0;
  for (const char *c = text; *c; c++) characters += ((unsigned char)*c & 0xc0) != 0x80;
  post_put(buffer, "%*s%s", characters < width ? width - characters : 1, "", text);
}

/* Byte i of the floats in little-endian order, on any machine. */
static uint32_t float_byte(const float *values, size_t i, size_t n_bytes) {
  if (i >= n_bytes) return 0;
  uint32_t bits;
  memcpy(&bits, &values[i / 4], sizeof bits);
  return bits >> (8 * (i % 4)) & 0xffu;
}

void post_put_base64(post_buffer *buffer, size_t n, const float *values) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  size_t            n_bytes  = 4 * n;
  for (size_t i = 0; i < n_bytes; i += 3) {
    uint32_t three = float_byte(values, i, n_bytes) << 16 |
                     float_byte(values, i + 1, n_bytes) << 8 | float_byte(values, i + 2, n_bytes);
    char four[4] = {digits[three >> 18 & 63], digits[three >> 12 & 63],
                    i + 1 < n_bytes ? digits[three >> 6 & 63] : '=',
                    i + 2 < n_bytes ? digits[three & 63] : '='};
    post_put_bytes(buffer, four, 4);
  }
}

shb_status post_buffer_publish(const post_buffer *buffer, const char *path) {
  SHB_CHECK(!buffer->failed, SHB_ERR_IO, "%s: not enough memory to compose it", path);
  char *temporary = shb_publish_temporary(path);
  SHB_CHECK(temporary, SHB_ERR_IO, "%s: not enough memory", path);
  errno      = 0;
  FILE *file = fopen(temporary, "wb");
  bool  good = file && (buffer->length == 0 ||
                       fwrite(buffer->text, 1, buffer->length, file) == buffer->length);
  if (file && fclose(file) != 0) good = false;
  shb_status status;
  if (good) {
    status = shb_publish(temporary, path);
  } else {
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: cannot be written: %s", path,
                      errno ? strerror(errno) : "write error");
    if (file) unlink(temporary);
  }
  free(temporary);
  return status;
}

void post_buffer_free(post_buffer *buffer) {
  free(buffer->text);
  *buffer = (post_buffer){0};
}
