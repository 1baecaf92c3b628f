#define _GNU_SOURCE /* memfd_create */
#include "mesh/process/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"
#include "mesh/base/memory.h"

static const char start[] = "shroudhb: error: ";

enum { LINE = 4096 };

/* Descriptor of this program; negative: nobody asked. */
static int target(void) {
  const char *text = getenv(SHB_REPORT);
  const long  file = text ? strtol(text, NULL, 10) : -1;
  return file > STDERR_FILENO && file < 1L << 20 ? (int)file : -1;
}

void shb_report_to(int report, const char *line) {
  char text[LINE];
  int  n = snprintf(text, sizeof text, "%.*s\n", (int)strcspn(line, "\n"), line);
  if (n >= LINE) n = LINE - 1; /* cut */
  if (n == LINE - 1) text[n - 1] = '\n';
  if (report >= 0 && write(report, text, (size_t)n) < 0) return; /* the user has been told */
}

void shb_report(const char *line) {
  shb_report_to(target(), line);
}

void shb_error(const char *format, ...) {
  char    text[LINE - sizeof start];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  fprintf(stderr, "%s%s\n", start, text);
  shb_report(text);
}

void shb_report_join(void) {
  shb_end_reports(target());
}

int shb_report_open(void) {
  return memfd_create("shroudhb", 0); /* children write at its end */
}

char *shb_report_read(int report) {
  const off_t   size = report >= 0 ? lseek(report, 0, SEEK_END) : 0;
  const size_t  all = size > 0 ? (size_t)size : 0, skipped = sizeof start - 1;
  char         *text = shb_alloc(all + 1, 1), *to = text;
  const ssize_t n     = all ? pread(report, text, all, 0) : 0;
  text[n > 0 ? n : 0] = '\0';
  for (char *line = text; *line;) {
    const size_t named  = strncmp(line, start, skipped) == 0 ? skipped : 0;
    const size_t length = strcspn(line, "\n") + (strchr(line, '\n') != NULL);
    memmove(to, line + named, length - named);
    to += length - named;
    line += length;
  }
  *to = '\0';
  return text;
}
