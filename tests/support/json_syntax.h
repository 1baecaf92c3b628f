/* Syntax of JSON (RFC 8259), checked to the end of a value. */
#ifndef TESTS_SUPPORT_JSON_SYNTAX_H
#define TESTS_SUPPORT_JSON_SYNTAX_H

#include <ctype.h>
#include <stddef.h>
#include <string.h>

/* Behind white space. */
static inline const char *json_blank(const char *p) {
  return p + strspn(p, " \t\r\n");
}

static inline const char *json_string(const char *p) {
  if (*p++ != '"') return NULL;
  for (; *p != '"'; p++) {
    if ((unsigned char)*p < 0x20) return NULL;
    if (*p == '\\' && !strchr("\"\\/bfnrtu", *++p)) return NULL;
  }
  return p + 1;
}

static inline const char *json_digits(const char *p) {
  size_t n = strspn(p, "0123456789");
  return n ? p + n : NULL;
}

static inline const char *json_number(const char *p) {
  p += *p == '-';
  if (*p == '0' && isdigit((unsigned char)p[1])) return NULL;
  p = json_digits(p);
  if (p && *p == '.') p = json_digits(p + 1);
  if (p && (*p == 'e' || *p == 'E')) {
    p++;
    p = json_digits(p + (*p == '-' || *p == '+'));
  }
  return p;
}

/* End of the value at p; NULL: it is not JSON. */
static inline const char *json_value(const char *p) {
  p = json_blank(p);
  if (*p == '"') return json_string(p);
  if (!strncmp(p, "true", 4) || !strncmp(p, "null", 4)) return p + 4;
  if (!strncmp(p, "false", 5)) return p + 5;
  if (*p != '{' && *p != '[') return json_number(p);
  char close = *p == '{' ? '}' : ']';
  p          = json_blank(p + 1);
  if (*p == close) return p + 1;
  for (;; p++) {
    if (close == '}') {
      p = json_string(json_blank(p));
      if (!p || *(p = json_blank(p)) != ':') return NULL;
      p++;
    }
    p = json_value(p);
    if (!p) return NULL;
    p = json_blank(p);
    if (*p == close) return p + 1;
    if (*p != ',') return NULL;
  }
}

#endif
