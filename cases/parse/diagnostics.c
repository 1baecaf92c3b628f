#include "cases/parse/diagnostics.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mesh/process/report.h"

enum { WIDTH = 120 }; /* columns of a source line */

case_issues case_issues_start(const char *path, const char *text, size_t length) {
  return (case_issues){.path = path, .text = text, .length = length};
}

void case_issue_add(case_issues *issues, int line, int column, const char *key, const char *format,
                    ...) {
  char    text[1024], full[1280];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  snprintf(full, sizeof full, "%s%s%s", key ? key : "", key && key[0] ? ": " : "", text);
  shb_plain_text(full);
  int at = issues->n++;
  if (at >= issues->capacity) {
    int         capacity = issues->capacity ? 2 * issues->capacity : 16;
    case_issue *grown    = realloc(issues->issue, (size_t)capacity * sizeof *grown);
    if (!grown) {
      issues->no_memory = true;
      return;
    }
    memset(grown + issues->capacity, 0, (size_t)(capacity - issues->capacity) * sizeof *grown);
    issues->issue    = grown;
    issues->capacity = capacity;
  }
  issues->issue[at] = (case_issue){line, column, strdup(full)};
  if (!issues->issue[at].text) issues->no_memory = true;
}

void case_issues_no_memory(case_issues *issues) {
  issues->n++;
  issues->no_memory = true;
}

static int by_place(const void *left, const void *right) {
  const case_issue *a = left, *b = right;
  if (a->line != b->line) return a->line < b->line ? -1 : 1;
  return (a->column > b->column) - (a->column < b->column);
}

/* Start and length of a line, without its end. The length is 0 if there is no such line. A line of
 * YAML ends with LF, CR LF or CR. */
static const char *find_line(const case_issues *issues, int line, size_t *length) {
  const char *at = issues->text, *end = at + issues->length;
  *length = 0;
  if (line < 1 || !at) return NULL;
  if (issues->length >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0) at += 3;
  for (int i = 1; i < line; i++) {
    while (at < end && *at != '\n' && *at != '\r') at++;
    if (at == end) return NULL;
    at += at + 1 < end && at[0] == '\r' && at[1] == '\n' ? 2 : 1;
  }
  const char *stop = at;
  while (stop < end && *stop != '\n' && *stop != '\r') stop++;
  *length = (size_t)(stop - at);
  return at;
}

/* Print the character at text, or '?': a broken file must not send control characters to the
 * terminal. Returns its bytes. */
static size_t put_character(const char *text, const char *end, FILE *out) {
  size_t         n;
  const unsigned c     = shb_character(text, end, &n);
  const bool     shown = c == '\t' || (shb_is_shown(c) && (c != SHB_NO_CHARACTER || n > 1));
  if (shown) fwrite(text, 1, n, out);
  if (!shown) fputc('?', out);
  return n;
}

/* The part of the line around column, and a caret under it. */
static void print_source(const case_issues *issues, const case_issue *issue, FILE *out) {
  size_t      length;
  const char *at = find_line(issues, issue->line, &length);
  if (length == 0) return;
  const char *end   = at + length;
  int         first = issue->column > WIDTH - 20 ? issue->column - WIDTH / 2 : 1, i = 1;
  size_t      n;
  for (; at < end && i < first; at += n, i++) shb_character(at, end, &n);
  const char *start = at;
  fputs("    ", out);
  for (; at < end && i < first + WIDTH; i++) at += put_character(at, end, out);
  fputs("\n    ", out);
  for (i = first, at = start; at < end && i < issue->column; at += n, i++) {
    fputc(*at == '\t' ? '\t' : ' ', out);
    shb_character(at, end, &n);
  }
  fputs("^\n", out);
}

static void print_override(const char *text, FILE *out) {
  char *plain = shb_text(text);
  shb_plain_text(plain);
  fprintf(out, " --set %s:", plain);
  free(plain);
}

static void print_issue(const case_issues *issues, const case_issue *issue, FILE *out) {
  fprintf(out, "%s:", issues->path);
  if (issue->line < 0) print_override(issues->override[-1 - issue->line], out);
  if (issue->line > 0) fprintf(out, "%d:%d:", issue->line, issue->column);
  fprintf(out, " error: %s\n", issue->text);
}

/* For the program that started this one: the line alone. */
static void report_issue(const case_issues *issues, const case_issue *issue) {
  char  *line = NULL;
  size_t size = 0;
  FILE  *out  = open_memstream(&line, &size);
  if (!out) return;
  print_issue(issues, issue, out);
  if (fclose(out) == 0) shb_report(line);
  free(line);
}

void case_issues_print(case_issues *issues, FILE *out) {
  if (issues->no_memory) return;
  int kept = issues->n < issues->capacity ? issues->n : issues->capacity;
  /* the order of issues at one place does not matter, so qsort may be unstable */
  if (kept > 0) qsort(issues->issue, (size_t)kept, sizeof *issues->issue, by_place);
  for (int i = 0; i < kept && i < CASE_ISSUES_SHOWN; i++) {
    const case_issue *issue = &issues->issue[i];
    print_issue(issues, issue, out);
    print_source(issues, issue, out);
    if (out == stderr) report_issue(issues, issue);
  }
  if (issues->n > CASE_ISSUES_SHOWN)
    fprintf(out, "... and %d more\n", issues->n - CASE_ISSUES_SHOWN);
  if (issues->n > 0) fprintf(out, "%d error%s\n", issues->n, issues->n == 1 ? "" : "s");
}

void case_issues_free(case_issues *issues) {
  int kept = issues->n < issues->capacity ? issues->n : issues->capacity;
  for (int i = 0; i < kept; i++) free(issues->issue[i].text);
  free(issues->issue);
  *issues = (case_issues){0};
}

shb_status case_issues_finish(case_issues *issues, FILE *out) {
  const case_issues found = *issues;
  case_issues_print(issues, out);
  case_issues_free(issues);
  SHB_CHECK(!found.no_memory, SHB_ERR_IO, "%s: out of memory", found.path);
  return found.n == 0 ? SHB_OK : shb_fail(SHB_ERR_INPUT, __FILE__, __LINE__, "%s", "");
}
