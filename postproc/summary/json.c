#include "postproc/summary/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "mesh/base/shortest.h"

/* Comma, line, indentation and key before a value. */
static void begin(post_json *j, const char *key) {
  if (j->depth > 0) {
    bool *some = &j->some[j->depth - 1];
    post_put(j->out, *some ? ",\n%*s" : "\n%*s", 2 * j->depth, "");
    *some = true;
  }
  if (!key) return;
  post_put_json(j->out, key);
  post_put(j->out, ": ");
}

static void open_level(post_json *j, const char *key, char left, char right) {
  begin(j, key);
  post_put(j->out, "%c", left);
  if (j->depth == POST_JSON_DEPTH) {
    j->out->failed = true;
    return;
  }
  j->close[j->depth]  = right;
  j->some[j->depth++] = false;
}

void post_json_object(post_json *json, const char *key) {
  open_level(json, key, '{', '}');
}

void post_json_list(post_json *json, const char *key) {
  open_level(json, key, '[', ']');
}

void post_json_end(post_json *json) {
  if (json->depth == 0) return;
  const int level = --json->depth;
  if (json->some[level]) post_put(json->out, "\n%*s", 2 * level, "");
  post_put(json->out, level > 0 ? "%c" : "%c\n", json->close[level]);
}

static void put_number(post_buffer *out, double value) {
  char text[SHB_SHORTEST];
  post_put(out, "%s", isfinite(value) ? shb_shortest(value, text) : "null");
}

void post_json_number(post_json *json, const char *key, double value) {
  begin(json, key);
  put_number(json->out, value);
}

void post_json_numbers(post_json *json, const char *key, int n, const double *value) {
  begin(json, key);
  for (int i = 0; i < n; i++) {
    post_put(json->out, i ? ", " : "[");
    put_number(json->out, value[i]);
  }
  post_put(json->out, n > 0 ? "]" : "[]");
}

void post_json_integer(post_json *json, const char *key, long value) {
  begin(json, key);
  post_put(json->out, "%ld", value);
}

void post_json_bool(post_json *json, const char *key, bool value) {
  begin(json, key);
  post_put(json->out, value ? "true" : "false");
}

void post_json_text(post_json *json, const char *key, const char *text) {
  begin(json, key);
  if (text)
    post_put_json(json->out, text);
  else
    post_put(json->out, "null");
}

void post_json_null(post_json *json, const char *key) {
  post_json_text(json, key, NULL);
}
