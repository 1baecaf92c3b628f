/* The errors of one input file: collected, sorted by place, printed together. */
#ifndef CASES_PARSE_DIAGNOSTICS_H
#define CASES_PARSE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "mesh/base/status.h"

enum { CASE_ISSUES_SHOWN = 50 }; /* issues of a file that are printed */

typedef struct {
  int   line, column; /* from 1; 0 stands for the whole file, -1 - i for override i */
  char *text;
} case_issue;

typedef struct {
  const char *path;   /* as the user gave it */
  const char *text;   /* contents of the file, not NUL-terminated */
  size_t      length; /* bytes */
  const char *const
             *override; /* texts of the overrides: an issue at the line -1 - i is shown with i */
  int         n, capacity;
  case_issue *issue;     /* [capacity]; the first min(n, capacity) hold a text */
  bool        no_memory; /* memory was short: other issues may only follow from that */
} case_issues;

case_issues case_issues_start(const char *path, const char *text, size_t length);

/* Record "KEY: TEXT" at a place, in plain text; key may be "" or NULL. */
void case_issue_add(case_issues *issues, int line, int column, const char *key, const char *format,
                    ...) __attribute__((format(printf, 5, 6)));

/* Memory was short while the file was read. It counts as an issue. */
void case_issues_no_memory(case_issues *issues);

/* Print each issue as "file:line:col: error: key: text" with its source line and a caret. "N
 * errors" follows. The issues are sorted by place. Nothing is printed where memory was short. */
void case_issues_print(case_issues *issues, FILE *out);

void case_issues_free(case_issues *issues);

/* Print and free the issues. SHB_ERR_INPUT: there were some; the message is empty, because they are
 * printed. SHB_ERR_IO: memory was short. */
shb_status case_issues_finish(case_issues *issues, FILE *out);

#endif
