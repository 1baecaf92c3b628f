/* Writer of JSON (RFC 8259) into a text buffer: commas, indentation, shortest numbers. */
#ifndef POSTPROC_SUMMARY_JSON_H
#define POSTPROC_SUMMARY_JSON_H

#include <stdbool.h>

#include "postproc/draw/text_buffer.h"

enum { POST_JSON_DEPTH = 16 };

/* Zeroed but for out, it is at the top of a document. */
typedef struct {
  post_buffer *out;
  int          depth;
  char         close[POST_JSON_DEPTH]; /* bracket that ends each level */
  bool         some[POST_JSON_DEPTH];  /* the level holds a value already */
} post_json;

/* Every value has a key in an object, and NULL for a key in a list or at the top. */
void post_json_object(post_json *json, const char *key);
void post_json_list(post_json *json, const char *key);
void post_json_end(post_json *json); /* of the innermost object or list; a newline after the last */

/* With as few digits as give the same double back; null if not finite. */
void post_json_number(post_json *json, const char *key, double value);
void post_json_numbers(post_json *json, const char *key, int n, const double *value);
void post_json_integer(post_json *json, const char *key, long value);
void post_json_bool(post_json *json, const char *key, bool value);
void post_json_text(post_json *json, const char *key, const char *text); /* NULL: null */
void post_json_null(post_json *json, const char *key);

#endif
