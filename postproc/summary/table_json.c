#include "postproc/summary/table_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Take a field, without quotes, into word; returns what follows it. */
static const char *take_field(const char *at, post_buffer *word) {
  word->length = 0;
  if (word->text) word->text[0] = '\0';
  bool quoted = *at == '"';
  if (quoted) at++;
  for (; *at; at++) {
    if (quoted && *at == '"' && at[1] != '"') {
      at++;
      break;
    }
    if (quoted && *at == '"') at++;
    if (!quoted && strchr(",\r\n", *at)) break;
    post_put_bytes(word, at, 1);
  }
  return at;
}

static bool is_number(const char *word) {
  char  *end   = NULL;
  double value = strtod(word, &end);
  bool   plain = strspn(word, "-0123456789.eE+") == strlen(word);
  return plain && *end == '\0' && isfinite(value) && word[0] != '+' && word[0] != '.';
}

static void put_field(const char *word, bool head, post_buffer *out) {
  if (word[0] == '\'' && word[1] && strchr("=+-@", word[1])) word++; /* as post_put_csv has it */
  if (!head && (!*word || strcmp(word, "nan") == 0))
    post_put(out, "null");
  else if (!head && is_number(word))
    post_put(out, "%s", word);
  else
    post_put_json(out, word);
}

/* One line as a list; returns the start of the next one. */
static const char *put_row(const char *csv, bool head, post_buffer *word, post_buffer *out) {
  post_put(out, "[");
  for (bool more = true; more;) {
    csv = take_field(csv, word);
    put_field(word->text ? word->text : "", head, out);
    more = *csv == ',';
    if (more) post_put(out, ", ");
    csv += more;
  }
  post_put(out, "]");
  return csv + strspn(csv, "\r\n");
}

shb_status post_table_json(const char *csv, post_buffer *out) {
  post_buffer word = {0};
  post_put(out, "{\"columns\": ");
  csv = put_row(csv ? csv : "", true, &word, out);
  post_put(out, ",\n \"rows\": [");
  while (*csv) {
    post_put(out, "\n  ");
    csv = put_row(csv, false, &word, out);
    if (*csv) post_put(out, ",");
  }
  post_put(out, "]}\n");
  bool failed = word.failed || out->failed;
  post_buffer_free(&word);
  SHB_CHECK(!failed, SHB_ERR_IO, "out of memory for the table");
  return SHB_OK;
}
